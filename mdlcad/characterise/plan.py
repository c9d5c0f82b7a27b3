"""What a characterisation tries, and the slice of it that a quick one repeats."""

from __future__ import annotations

from dataclasses import dataclass, replace

from mdlcad.mapping.characterisation import Characterisation


@dataclass(frozen=True, slots=True)
class Sweep:
    """Numbers tried.

    Attributes:
        periods, dampings: of the map, all combinations.
        spreads: at the library's own T and b, ``samples`` devices each.
        loads, echoes: fan-outs and echoes at spread ``load_spread``, ``load_samples`` devices each.
        candidates: for each key of a number what else it might be.
        choice_spread, choice_samples: with what spread, and by how many devices a cell and corner, these compete.
    """

    periods: tuple[float, ...]
    dampings: tuple[float, ...]
    spreads: tuple[float, ...]
    samples: int
    loads: tuple[int, ...]
    echoes: tuple[int, ...]
    load_spread: float
    load_samples: int
    candidates: tuple[tuple[str, tuple[float | str, ...]], ...]
    choice_spread: float
    choice_samples: int


THRESHOLD_SWEEP = Sweep(
    periods=(2.0, 3.0, 5.0, 10.0, 20.0, 40.0),
    dampings=(0.025, 0.05, 0.1, 0.25, 0.5, 1.0),
    spreads=(0.03, 0.05, 0.1),
    samples=10,
    loads=(4, 8, 12, 16),
    echoes=(6, 10, 12, 16),
    load_spread=0.06,
    load_samples=3,
    candidates=(
        ("coupling.strength", (0.1, 0.15, 0.2, 0.25, 0.3)),
        ("bias.force", (0.2, 0.25, 0.3, 0.35)),
        ("mass.k0", (1.5, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0)),
        ("dynamics.period", (5.0, 10.0, 20.0)),
        # damping is no choice: it is what air and bearings give; the map says which are borne
    ),
    choice_spread=0.15,
    choice_samples=2,
)

NOR_SWEEP = Sweep(
    periods=(1.0, 1.5, 3.0, 5.0, 10.0, 20.0, 40.0),
    dampings=(0.025, 0.05, 0.1, 0.25, 0.5, 1.0),
    spreads=(0.05, 0.1),
    samples=10,
    loads=(),
    echoes=(),
    load_spread=0.05,
    load_samples=0,
    candidates=(("default", ("literal", "near", "robust")),),
    choice_spread=0.05,
    choice_samples=2,
)


def quick(sweep: Sweep, standing: Characterisation | None, period: float) -> Sweep:
    """A slice: the standing window at its ends and at the library's own ``period``, its spread, the first choice."""
    ends = (standing.periods[0], standing.periods[-1]) if standing and standing.periods else ()
    return replace(
        sweep,
        periods=tuple(t for t in sweep.periods if t in (period, *ends[:1])),
        spreads=(standing.spread,) if standing else sweep.spreads[:1],
        samples=10,
        loads=(),
        echoes=(),
        candidates=sweep.candidates[:1],
        choice_samples=1,
    )
