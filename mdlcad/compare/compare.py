"""Two build folders held against each other: one flat list of levels, from what was asked for to the files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from mdlcad.compare.behaviour import behaviour_changes
from mdlcad.compare.bodies import bodies_of_both
from mdlcad.compare.change import Comparison, Level, LevelState, Side, Verdict
from mdlcad.compare.files import file_changes
from mdlcad.compare.folders import Build, NotComparable, open_build, read
from mdlcad.compare.netlist import netlist_changes
from mdlcad.compare.network import network_changes
from mdlcad.compare.pair import Findings, Pair
from mdlcad.compare.parts import part_changes
from mdlcad.compare.placement import placement_changes
from mdlcad.compare.plates import plate_changes
from mdlcad.compare.program import program_changes
from mdlcad.compare.routing import routing_changes
from mdlcad.compare.settings import setting_changes
from mdlcad.errors import UsageError
from mdlcad.network.matching import renamed_masses
from mdlcad.network.model import Network

DEFAULT_TOLERANCE_UM = 1.0


@dataclass(frozen=True, slots=True)
class Step:
    """A level: its name, what compares it, and the files it answers for ("plates/" for all in a folder)."""

    name: str
    look: Callable[[Pair], Findings]
    files: tuple[str, ...]


STEPS = (
    Step("settings", setting_changes, ("process.json", "cells.json")),
    Step("program", program_changes, ("device.json",)),
    Step("netlist", netlist_changes, ("netlist.json",)),
    Step("network", network_changes, ("network.json",)),
    Step("placement", placement_changes, ("placement.json",)),
    Step("routing", routing_changes, ("layout.json",)),
    Step("plates", plate_changes, ("plates/",)),
    Step("parts", part_changes, ("parts.json", "sizing.json", "compensation.json")),
    Step("behaviour", behaviour_changes, ("proof.json", "extraction.json", "drc.json", "drive.json")),
)
FILES = "files"


def compare(folder_a: Path, folder_b: Path, tolerance_um: float = DEFAULT_TOLERANCE_UM) -> Comparison:
    """Compare two builds at every level that both have.

    Raises:
        UsageError: a folder is no build (there is no readable report in it).
    """
    a, b = open_build(folder_a), open_build(folder_b)
    pair = Pair(a, b, tolerance_um / 1000.0, _renamed(a, b), bodies_of_both(a, b))
    levels: list[Level] = []
    troubles: list[str] = []
    readers: dict[str, Level] = {}
    for step in STEPS:
        level, apart = _level(step.name, step.look, pair, troubles)
        levels.append(level)
        folders = tuple(name for name in step.files if name.endswith("/"))
        for name in a.hashes:
            if name in b.hashes and name not in apart and (name in step.files or name.startswith(folders)):
                readers[name] = level
    levels.append(_level(FILES, lambda both: file_changes(both, readers), pair, troubles)[0])
    return Comparison(
        verdict=_verdict(levels, troubles),
        a=_side(a),
        b=_side(b),
        tolerance_um=tolerance_um,
        levels=tuple(levels),
        troubles=tuple(dict.fromkeys(troubles)),
    )


def _level(name: str, look: Callable[[Pair], Findings], pair: Pair, troubles: list[str]) -> tuple[Level, Sequence[str]]:
    """A level, and the files that it would have read and could not compare."""
    try:
        found = look(pair)
    except NotComparable as problem:
        return Level(name, LevelState.NOT_COMPARED, reason=str(problem)), (problem.file,)
    except UsageError as problem:
        troubles.append(str(problem))
        return Level(name, LevelState.NOT_COMPARED, reason=str(problem)), ()
    troubles.extend(found.troubles)
    if found.changes:
        state = LevelState.DIFFERENT
    else:
        state = LevelState.NOT_COMPARED if found.troubles else LevelState.SAME
    level = Level(name, state, tuple(found.changes), tuple(found.notes), "; ".join(found.troubles))
    return level, found.apart


def _verdict(levels: list[Level], troubles: list[str]) -> Verdict:
    if troubles:
        return Verdict.TROUBLE
    differs = any(level.state is LevelState.DIFFERENT for level in levels)
    return Verdict.DIFFERENT if differs else Verdict.SAME


def _renamed(a: Build, b: Build) -> dict[str, str]:
    """Masses under other names; none if a network cannot be read, which its own level tells."""
    try:
        return renamed_masses(read(a, "network.json", Network), read(b, "network.json", Network))
    except (NotComparable, UsageError):
        return {}


def _side(build: Build) -> Side:
    facts = build.facts
    return Side(build.label, facts.design, facts.version, facts.cells, facts.process, facts.seed, build.edited)
