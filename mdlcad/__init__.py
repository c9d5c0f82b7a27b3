"""mdlcad: from a mechanical description language to devices that can be made and are proved to compute."""

__version__ = "0.1.0"
