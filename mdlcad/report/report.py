"""report.json: what was asked, what came out, and whether it holds."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from msgspec import UNSET, UnsetType

from mdlcad.mechanics.drive import DriveLoads
from mdlcad.parts.bom import Bom
from mdlcad.signoff.margins import Margins
from mdlcad.signoff.mixtures import Mixtures


@dataclass(frozen=True, slots=True)
class Behaviour:
    """A proof in figures: transitions that there are, that were simulated, and that went wrong."""

    transitions_total: int
    transitions_checked: int
    mismatches: int
    exhaustive: bool


@dataclass(frozen=True, slots=True)
class Lvs:
    """Whether the geometry read back from the STEP file is the network; differences in words."""

    matched: bool
    differences: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Mechanics:
    """Figures that decide whether the parts can work.

    Attributes:
        strain_worst: largest strain of any flexure over the motion seen in simulation.
        carrier_stiffness_ratio_worst: smallest ratio of a carrier's stiffness to that of a coupler it drives; None
            before there is a layout.
        throw_mm: half stroke of the shuttles; clock_stroke_mm: half stroke of the clock plates.
        compensation_difference_worst: largest difference, in units of k, between the compensation the network assumes
            and the one that the built parts need.
        warnings: what the sizing found wanting, in words with numbers.
        compensation_left: largest |k| that a unit and its springs miss the network's k by at p = 0, 1 and 2, by the
            unit's law, preloads solved with the carriers as routed; None before there is a layout.
        lean_worst: largest share of a coupling that its two shuttles take by tilting freely; None before a layout.
    """

    strain_worst: float
    carrier_stiffness_ratio_worst: float | None
    throw_mm: float
    clock_stroke_mm: float
    compensation_difference_worst: float
    warnings: tuple[str, ...]
    compensation_left: tuple[float, float, float] | None = None
    lean_worst: float | None = None


@dataclass(frozen=True, slots=True)
class TiltReport:
    """How far shuttles tilt in the proof ``tilting``.

    Attributes:
        largest_rad, mass: the largest angle about x that any would have if no plate stopped it, and whose.
        stopped: shuttles that surely meet a plate; of shuttles.
        friction_most: bound of what plates can brake a shuttle with, in F0; friction_mean: of all shuttles.
    """

    largest_rad: float
    mass: str
    stopped: int
    shuttles: int
    friction_most: float
    friction_mean: float


class Origin(StrEnum):
    """Where a stage's result is from: made in this build, kept from the build before it in its place (the same bytes,
    since nothing it depends on has changed), or loaded from the folder that ``--from`` starts at."""

    MADE = "made"
    KEPT = "kept"
    LOADED = "loaded"


@dataclass(frozen=True, slots=True)
class StageRecord:
    """One stage.

    Attributes:
        seconds: wall time; of a stage that was kept, of taking it over.
        checksum: SHA-256 of its artefact.
        inputs: SHA-256 over all that its result depends on; "" if that is not known (it was loaded).
        files: what it wrote, relative to the folder.
    """

    name: str
    seconds: float
    checksum: str
    inputs: str = ""
    files: tuple[str, ...] = ()
    origin: Origin = Origin.MADE


@dataclass(frozen=True, slots=True)
class Stopped:
    """Where a build ended because what a stage made does not hold, and why, in words."""

    stage: str
    reason: str


@dataclass(frozen=True, slots=True)
class Seeds:
    """The seeds that placement tried side by side, the one that was kept, and those that led to no layout."""

    tried: tuple[int, ...]
    won: int
    failed: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Likeness:
    """The earlier build that this one was to be like, and what became of its masses.

    Attributes:
        build: SHA-256 of what was taken from it (of lines "SHA-256  NAME" of its netlist, network, ...).
        kept: masses that are in both; changed: those of them that are of other inputs, bias or phase now; moved: those
            that did not change, but are in another slot now, but for the shift.
        new, gone: masses that only this one, or only the earlier one, has.
        shift: columns and rows by which the whole stands elsewhere on a lattice of another size.
    """

    build: str
    kept: int
    changed: int
    moved: int
    new: int
    gone: int
    shift: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Search:
    """How a placement was found: by which placer, with which seeds (None: one), like which build (None: like none).

    Attributes:
        second_plate: why there is a second unit plate; left out where there is one.
    """

    placer: str
    seeds: Seeds | None
    like: Likeness | None
    second_plate: str | UnsetType = UNSET


@dataclass(frozen=True, slots=True)
class Report:
    """The machine's copy of the build's result. None: the build ended before that was known.

    All of it but the seconds and the origin of the stages is the same for the same input, seed and version.

    Attributes:
        stages: those that ended well, in order.
        stopped: None if all stages that were asked for (``--to``) ran.
        failures: what does not hold, in words with numbers; empty if all that was checked holds.
        unit_plates: how many; second_plate: why there are two.
        mixtures: whether the device as drawn is right if plates hold some of its shuttles from tilting.
        margins: largest errors of dimensions at which the device as drawn still proves right.
        files: SHA-256 by path, of every file but report.json itself and report.html, which is made from it.
    """

    design: str
    cells: str
    process: str
    seed: int
    version: str
    masses: int | None
    couplings: int | None
    gates: int | None
    cycles_per_tick: int | None
    period: float | None
    behaviour: Behaviour | None
    extracted: Behaviour | None
    lvs: Lvs | None
    drc: dict[str, int] | None
    mechanics: Mechanics | None
    extent_mm: tuple[float, float, float] | None
    plates: tuple[str, ...]
    tiles: int | None
    stages: tuple[StageRecord, ...]
    files: dict[str, str]
    # later than the first reports, which can still be read
    tilting: Behaviour | None = None
    tilts: TiltReport | None = None
    mixtures: Mixtures | None = None
    stopped: Stopped | None = None
    failures: tuple[str, ...] = ()
    bom: Bom | None = None
    drive: DriveLoads | None = None
    margins: Margins | None = None
    placer: str | None = None
    seeds: Seeds | None = None
    like: Likeness | None = None
    unit_plates: int | None = None
    second_plate: str | None = None
