"""A finished build as its viewers need it: read from its folder, held against its hashes and against itself."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import TypeVar

import msgspec

from mdlcad import __version__
from mdlcad.artefact import checksum, load
from mdlcad.errors import UsageError
from mdlcad.language import Device
from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.compensation import COMPENSATION_FILE, Compensation, compensated
from mdlcad.network.model import Network
from mdlcad.parts.body import Body
from mdlcad.parts.stiffness import CarrierStiffness
from mdlcad.parts.store import Parts, bodies_of
from mdlcad.placement.placement import Placement
from mdlcad.routing.decks import process_of

T = TypeVar("T")
_REPORT = "report.json"
_COLOUR = re.compile("#[0-9a-fA-F]{6}")
# no machine makes a part of this size; a longer one is a slip of somebody's editor
_LONGEST_MM = 1e5


class Trust(Enum):
    """Whether a file must be the one that was built, or may have been changed since."""

    BUILT = "built"
    EDITED = "edited"


@dataclass(frozen=True, slots=True)
class Reported:
    """Of report.json, the artefact of a later stage, what a viewer needs."""

    design: str
    cells: str
    process: str
    version: str
    masses: int | None
    couplings: int | None
    cycles_per_tick: int | None
    extent_mm: tuple[float, float, float] | None
    drc: dict[str, int] | None
    plates: tuple[str, ...]
    files: dict[str, str]


@dataclass(frozen=True, slots=True, eq=False)
class Built:
    """What a build folder holds, read and found to fit together."""

    report: Reported
    device: Device
    network: Network
    placement: Placement
    sizing: Sizing
    process: Process
    bodies: tuple[Body, ...]
    carriers: tuple[CarrierStiffness, ...]


def read_build(folder: Path, trust: Trust = Trust.BUILT) -> Built:
    """Read the build in ``folder``.

    Raises:
        UsageError: it is no build, or one of its files is missing, truncated, not the file that was built (its hash
            differs; not asked with ``Trust.EDITED``), of another shape or version, or contradicts the others; the
            message names the file.
    """
    if not folder.is_dir():
        raise UsageError(f"{folder}: no such build folder")
    report = load(folder, _REPORT, Reported)

    def artefact(name: str, kind: type[T]) -> T:
        if trust is Trust.BUILT:
            _check_hash(folder, name, report)
        try:
            return load(folder, name, kind)
        except UsageError as problem:
            raise UsageError(f"{problem}{_other_version(report)}") from None

    device, network = artefact("device.json", Device), artefact("network.json", Network)
    sizing, process = artefact("sizing.json", Sizing), artefact("process.json", Process)
    if COMPENSATION_FILE in report.files:
        sizing = compensated(sizing, artefact(COMPENSATION_FILE, Compensation))
    placement, parts = artefact("placement.json", Placement), artefact("parts.json", Parts)
    try:
        bodies = bodies_of(parts.bodies)
    except msgspec.ValidationError as problem:
        raise UsageError(f"{folder / 'parts.json'}: {problem}; build it again") from None
    process = process_of(process, placement)
    built = Built(report, device, network, placement, sizing, process, bodies, parts.carriers)
    for words in _contradictions(built):
        raise UsageError(f"{folder}/{words}; build it again{_other_version(report)}")
    return built


def _check_hash(folder: Path, name: str, report: Reported) -> None:
    path = folder / name
    if name not in report.files:
        raise UsageError(
            f"{folder / _REPORT}: lists no {name}: the build was stopped early (--to), or another version made it "
            f"({report.version}; this is {__version__}); build it again"
        )
    try:
        found = checksum(path.read_bytes())
    except OSError:
        return  # reading it says what is wrong, in its own words
    if found != report.files[name]:
        raise UsageError(
            f"{path}: is not the file that was built (its SHA-256 differs from report.json); build it again, or look "
            "at it as it is with --edited"
        )


def _other_version(report: Reported) -> str:
    if report.version == __version__:
        return ""
    return f" (version {report.version} of mdlcad made it, this is {__version__})"


def _contradictions(built: Built) -> Iterator[str]:
    """What does not fit together, as "FILE: words"."""
    masses = {mass.name for mass in built.network.masses}
    couplings = {coupling.name for coupling in built.network.couplings}
    yield from _same("sizing.json", "unit", masses, [unit.mass for unit in built.sizing.units])
    yield from _same("sizing.json", "coupler", couplings, [item.coupling for item in built.sizing.couplers])
    yield from _same("placement.json", "place", masses, [place.mass for place in built.placement.masses])
    phases = built.network.dynamics.phases
    for mass in built.network.masses:
        if not 0 <= mass.phase < phases:
            yield f"network.json: the mass {mass.name!r} has phase {mass.phase} of {phases}"
    for coupling in built.network.couplings:
        for end in (coupling.source, coupling.target):
            if end not in masses:
                yield f"network.json: the coupling {coupling.name!r} names no mass of it"
    biased = {bias.mass for bias in built.sizing.biases}
    if biased - masses:
        yield f"sizing.json: the mass {min(biased - masses)!r} has a bias, and is not in network.json"
    known = {"frame", *(f"clock:{phase}" for phase in range(phases)), *(f"mass:{name}" for name in masses)}
    if not built.bodies:
        yield "parts.json: holds no bodies"
    names: set[str] = set()
    for body in built.bodies:
        if body.name in names:
            yield f"parts.json: two bodies are called {body.name!r}"
        names.add(body.name)
        yield from _body_trouble(body, known)


def _body_trouble(body: Body, known: set[str]) -> Iterator[str]:
    strange = [ref for ref in body.moves_with if ref not in known]
    if strange or not body.moves_with:
        yield f"parts.json: body {body.name}: moves with {strange[0] if strange else 'nothing'}, which is not there"
    numbers = (body.z, body.thickness, *body.throw, *body.section.bounds)
    if not all(math.isfinite(value) and abs(value) < _LONGEST_MM for value in numbers) or body.thickness <= 0.0:
        yield f"parts.json: body {body.name}: has a length that no part has"
    if not _COLOUR.fullmatch(body.colour):
        yield f"parts.json: body {body.name}: {body.colour!r} is no colour (#rrggbb)"


def _same(file: str, what: str, wanted: set[str], found: list[str]) -> Iterator[str]:
    if len(found) != len(set(found)):
        yield f"{file}: names a {what} twice"
    missing, strange = sorted(wanted - set(found)), sorted(set(found) - wanted)
    if missing:
        yield f"{file}: has no {what} for {missing[0]!r} of network.json"
    if strange:
        yield f"{file}: has a {what} for {strange[0]!r}, which is not in network.json"
