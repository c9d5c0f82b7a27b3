"""The paper's library: NOR logic on two power clocks, with latches and a clock of co-prime loops."""

from mdlcad.mapping.two_phase.cell_library import Options, TwoPhaseLibrary
from mdlcad.mapping.two_phase.liberty import liberty
from mdlcad.mapping.two_phase.load import load_two_phase
from mdlcad.mapping.two_phase.mapper import map_two_phase

__all__ = ["Options", "TwoPhaseLibrary", "liberty", "load_two_phase", "map_two_phase"]
