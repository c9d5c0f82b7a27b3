"""What the report of any version may say: but for name, version and files every figure is optional, and what is unknown
is ignored."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class BehaviourFacts:
    """See ``Behaviour`` of the report."""

    transitions_total: int | None = None
    transitions_checked: int | None = None
    mismatches: int | None = None
    exhaustive: bool | None = None


@dataclass(frozen=True, slots=True)
class LvsFacts:
    """See ``Lvs`` of the report."""

    matched: bool | None = None


@dataclass(frozen=True, slots=True)
class MechanicsFacts:
    """See ``Mechanics`` of the report."""

    strain_worst: float | None = None
    carrier_stiffness_ratio_worst: float | None = None
    throw_mm: float | None = None
    clock_stroke_mm: float | None = None
    compensation_difference_worst: float | None = None


@dataclass(frozen=True, slots=True)
class StageFacts:
    """See ``StageRecord`` of the report."""

    name: str = ""
    seconds: float | None = None


@dataclass(frozen=True, slots=True)
class Facts:
    """See ``Report``."""

    design: str
    version: str
    files: dict[str, str]
    cells: str = ""
    process: str = ""
    seed: int | None = None
    masses: int | None = None
    couplings: int | None = None
    gates: int | None = None
    cycles_per_tick: int | None = None
    period: float | None = None
    behaviour: BehaviourFacts | None = None
    extracted: BehaviourFacts | None = None
    lvs: LvsFacts | None = None
    drc: dict[str, int] | None = None
    mechanics: MechanicsFacts | None = None
    extent_mm: tuple[float, float, float] | None = None
    plates: tuple[str, ...] = ()
    tiles: int | None = None
    stages: tuple[StageFacts, ...] = ()
