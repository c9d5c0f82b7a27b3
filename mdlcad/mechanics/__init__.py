"""Beam laws, sizing and compensation: the network's numbers turned into millimetres, and back."""

from mdlcad.mechanics.findings import Finding
from mdlcad.mechanics.process import Process, load_process, process_names
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.mechanics.sizing import Sizing, size

__all__ = ["Finding", "LayoutRules", "Process", "Sizing", "load_process", "process_names", "size"]
