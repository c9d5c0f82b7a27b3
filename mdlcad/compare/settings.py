"""What was asked for: design, cell library, process with all its figures, seed and version."""

from __future__ import annotations

from typing import Any

from mdlcad.compare.change import Change, Sort
from mdlcad.compare.fields import field_changes, worded
from mdlcad.compare.folders import NotComparable
from mdlcad.compare.pair import Findings, Pair
from mdlcad.mechanics import Process

_ASKED = ("design", "cells", "process", "seed", "version")


def setting_changes(pair: Pair) -> Findings:
    """Changes of the settings."""
    before = {name: getattr(pair.a.facts, name) for name in _ASKED}
    after = {name: getattr(pair.b.facts, name) for name in _ASKED}
    changes = [
        Change("setting", item.name, Sort.CHANGED, worded((item,)).removeprefix(f"{item.name} "), (item,))
        for item in field_changes(before, after)
    ]
    notes, apart = [], []
    # what a library holds differs from kind to kind, so it is compared as it is written
    for what, name, kind in (("process", "process.json", Process), ("cells", "cells.json", dict[str, Any])):
        if what == "cells" and pair.a.facts.cells != pair.b.facts.cells:
            continue  # two libraries, and no two versions of one: their names say it
        try:
            a, b = pair.both(name, kind)
        except NotComparable as problem:
            notes.append(str(problem))
            apart.append(problem.file)
        else:
            changes += [
                Change(what, item.name, Sort.CHANGED, worded((item,)).removeprefix(f"{item.name} "), (item,))
                for item in field_changes(a, b, skip=frozenset({"name", "summary"}))
            ]
    return Findings(changes, notes, apart=apart)
