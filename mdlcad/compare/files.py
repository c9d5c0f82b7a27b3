"""The files by hash: what differs in bytes, and whether a level has looked into it."""

from __future__ import annotations

from collections.abc import Mapping

from mdlcad.compare.change import Change, FieldChange, Level, LevelState, Sort
from mdlcad.compare.pair import Findings, Pair

# the report is told at the levels of settings and behaviour; its seconds, and the page made from it, are no difference
REPORTS = frozenset({"report.html"})


def file_changes(pair: Pair, readers: Mapping[str, Level]) -> Findings:
    """Files that came, went or differ in bytes.

    Args:
        readers: for each file that a level has read on both sides, that level. If it found nothing, the file's other
            bytes are the same in meaning and no change.
    """
    a, b = pair.a.hashes, pair.b.hashes
    changes = [Change("file", name, Sort.REMOVED) for name in a if name not in b and name not in REPORTS]
    changes += [Change("file", name, Sort.ADDED) for name in b if name not in a and name not in REPORTS]
    notes = []
    for name, before in a.items():
        after = b.get(name, before)
        if before == after or name in REPORTS:
            continue
        level = readers.get(name)
        if level is not None and level.state is LevelState.SAME:
            notes.append(f"{name}: other bytes, the same in meaning ({level.name})")
        else:
            hashes = FieldChange("SHA-256", before, after)
            words = "other bytes" if level is None else f"other bytes, see {level.name}"
            changes.append(Change("file", name, Sort.CHANGED, words, (hashes,)))
    changes += [
        Change("file", name, Sort.CHANGED, f"is not the file that was built in {build.label}")
        for build in (pair.a, pair.b)
        for name in build.edited
        if name in REPORTS
    ]
    missing = [
        f"{build.folder / name}: is missing from the build; build it again"
        for build in (pair.a, pair.b)
        for name in build.missing
    ]
    return Findings(changes, notes, missing)
