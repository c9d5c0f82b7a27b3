"""Where things work and where they stop: the yield of a device, and the windows of a cell library."""

from mdlcad.characterise.yields import run_spread

__all__ = ["run_spread"]
