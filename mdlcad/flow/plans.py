"""Which steps a build takes: as far as its cell library has parts."""

from __future__ import annotations

from mdlcad.errors import UsageError
from mdlcad.flow.steps import STEPS, Step
from mdlcad.mapping import Library
from mdlcad.mapping.two_phase import TwoPhaseLibrary

NETWORK_STEPS: tuple[Step, ...] = tuple(
    step for step in STEPS if step.name in ("device", "netlist", "network", "proof")
)
"""The steps with a library whose springs have no parts yet."""


def steps_with(library: Library, last: str | None) -> tuple[Step, ...]:
    """The steps of a build with ``library`` that is to go as far as the step ``last`` (None: as far as there is).

    Raises:
        UsageError: the library has no parts for what comes before ``last``; says how far it goes.
    """
    if not isinstance(library, TwoPhaseLibrary):
        return STEPS
    beyond = {step.name for step in STEPS} - {step.name for step in NETWORK_STEPS}
    if last is None or last in beyond:
        raise UsageError(
            f"the cell library {library.name} couples masses by springs that the power clock switches and opens "
            "latches by springs that multiply, for which there are no parts yet; a whole build would have to leave "
            f"them out. Build with --to {NETWORK_STEPS[-1].name}, or with --cells parametron"
        )
    return NETWORK_STEPS
