"""A device in a small world: walls or hands press its sensors, its actuators answer, and the world moves."""

from mdlcad.scenario.run import run_scenario

__all__ = ["run_scenario"]
