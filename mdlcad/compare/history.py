"""Many builds in figures: one row a build, in the order given, with gaps where a build did not get that far."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TypeVar

from mdlcad.artefact import ShapeError
from mdlcad.compare.folders import Build, NotComparable, open_build, read
from mdlcad.errors import UsageError
from mdlcad.parts.store import Parts
from mdlcad.proof.outcome import Proof
from mdlcad.signoff.lvs import LvsResult

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Row:
    """A build in figures; None where it was stopped before that, or another version did not say.

    Attributes:
        bytes: size of all files that the report vouches for.
        margin, margin_drawn: smallest |x| at a read-out, of the network and of the device as drawn.
        strain: largest of any flexure; carrier_ratio: least stiffness of a carrier over that of a coupler it drives.
        findings: of the design rules, all rules together.
        width_mm, depth_mm, height_mm: extent in x, y, z.
        seconds: wall time of all stages.
        edited: files that are not the ones the report vouches for.
    """

    folder: str
    design: str
    version: str
    cells: str
    process: str
    seed: int | None
    masses: int | None
    couplings: int | None
    gates: int | None
    cycles_per_tick: int | None
    margin: float | None
    margin_drawn: float | None
    strain: float | None
    carrier_ratio: float | None
    findings: int | None
    plates: int | None
    parts: int | None
    width_mm: float | None
    depth_mm: float | None
    height_mm: float | None
    bytes: int
    seconds: float | None
    edited: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class History:
    """All rows; ``troubles`` are builds or files that cannot be read as they should."""

    rows: tuple[Row, ...]
    troubles: tuple[str, ...] = ()


def history_of(folders: Sequence[Path]) -> History:
    """The history of some build folders."""
    rows: list[Row] = []
    troubles: list[str] = []
    for folder in folders:
        try:
            build = open_build(folder)
        except UsageError as problem:
            troubles.append(str(problem))
            continue
        troubles += [f"{build.folder / name}: is missing from the build; build it again" for name in build.missing]
        rows.append(_row(build, troubles))
    return History(tuple(rows), tuple(dict.fromkeys(troubles)))


def _row(build: Build, troubles: list[str]) -> Row:
    facts = build.facts
    proof = _read(build, "proof.json", Proof, troubles)
    extraction = _read(build, "extraction.json", tuple[LvsResult, Proof], troubles)
    parts = _read(build, "parts.json", Parts, troubles)
    width, depth, height = facts.extent_mm or (None, None, None)
    mechanics = facts.mechanics
    seconds = [stage.seconds for stage in facts.stages if stage.seconds is not None]
    return Row(
        folder=build.label,
        design=facts.design,
        version=facts.version,
        cells=facts.cells,
        process=facts.process,
        seed=facts.seed,
        masses=facts.masses,
        couplings=facts.couplings,
        gates=facts.gates,
        cycles_per_tick=facts.cycles_per_tick,
        margin=proof.margin if proof is not None else None,
        margin_drawn=extraction[1].margin if extraction is not None else None,
        strain=mechanics.strain_worst if mechanics is not None else None,
        carrier_ratio=mechanics.carrier_stiffness_ratio_worst if mechanics is not None else None,
        findings=sum(facts.drc.values()) if facts.drc is not None else None,
        plates=len(facts.plates) if facts.extent_mm is not None else None,
        parts=len(parts.bodies) if parts is not None else None,
        width_mm=width,
        depth_mm=depth,
        height_mm=height,
        bytes=sum((build.folder / name).stat().st_size for name in build.hashes),
        seconds=round(sum(seconds), 3) if seconds else None,
        edited=build.edited,
    )


def _read(build: Build, name: str, kind: type[T], troubles: list[str]) -> T | None:
    try:
        return read(build, name, kind)
    except NotComparable:
        return None
    except (ShapeError, UsageError) as problem:
        troubles.append(str(problem))
        return None


def as_csv(history: History) -> bytes:
    """One line a build; an empty cell is a gap, several edited files are joined by spaces."""
    names = [item.name for item in fields(Row)]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    for row in history.rows:
        values = [getattr(row, name) for name in names]
        writer.writerow([" ".join(value) if isinstance(value, tuple) else value for value in values])
    return text.getvalue().encode()
