"""Behaviour and margins: what the proofs, the design rules and the report say of each build."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from mdlcad.compare.change import Change, FieldChange, Sort, Spot
from mdlcad.compare.fields import field_changes, keyed_changes, largest_first, worded
from mdlcad.compare.folders import NotComparable
from mdlcad.compare.pair import Findings, Pair
from mdlcad.errors import UsageError
from mdlcad.mechanics.drive import DriveLoads
from mdlcad.proof.outcome import Proof
from mdlcad.signoff.drc import Finding
from mdlcad.signoff.lvs import LvsResult
from mdlcad.signoff.summary import DesignRules

# told one by one, or elsewhere
_APART = frozenset({"peaks", "seed", "design", "cells"})
_NOT_OF_THE_DEVICE = frozenset({"files", "stages", "version", "seed", "design", "cells", "process", "plates"})
# figures of the report that are counted from the artefacts, and told from those where they can be read
_COUNTED = frozenset({"masses", "couplings", "gates", "cycles_per_tick", "period"})
# half the side of the box that shows a finding, mm
_AROUND_MM = 4.0


def behaviour_changes(pair: Pair) -> Findings:
    """Changes of what was proved and measured.

    Raises:
        NotComparable: one side has no proof.
    """
    changes: list[Change] = []
    notes: list[str] = []
    troubles: list[str] = []
    apart: list[str] = []
    told = _NOT_OF_THE_DEVICE
    if all(build.has(name) for build in (pair.a, pair.b) for name in ("netlist.json", "network.json")):
        told |= _COUNTED
    for look, figures in (
        (_proofs, {"behaviour"}),
        (_extractions, {"extracted", "lvs"}),
        (_rules, {"drc"}),
        (_drive, set()),
    ):
        try:
            changes += look(pair)
            told |= figures
        except NotComparable as problem:
            notes.append(str(problem))
            apart.append(problem.file)
        except UsageError as problem:
            troubles.append(str(problem))
    if len(apart) == 4:
        raise NotComparable(notes[0], apart[0])
    fields = field_changes(pair.a.facts, pair.b.facts, skip=told)
    # a build that stopped early has fewer figures; that is told by the levels it lacks
    left = tuple(item for item in fields if item.before is not None and item.after is not None)
    changes += [Change("figure", item.name, Sort.CHANGED, worded((replace(item, name=""),)), (item,)) for item in left]
    return Findings(largest_first(changes), notes, troubles, apart)


def _proofs(pair: Pair) -> list[Change]:
    a, b = pair.both("proof.json", Proof)
    return _proof(pair, "proof of the network", a, b)


def _proof(pair: Pair, what: str, a: Proof, b: Proof) -> list[Change]:
    named = replace(a, margin_mass=pair.mass(a.margin_mass))
    changes = []
    for item in field_changes(named, b, skip=_APART):
        size = _distance(item) if item.name == "margin" else None
        changes.append(Change(what, item.name, Sort.CHANGED, worded((replace(item, name=""),)), (item,), size))
    peaks_a, peaks_b = {pair.mass(name): peak for name, peak in a.peaks.items()}, b.peaks
    for name, before in peaks_a.items():
        after = peaks_b.get(name)
        if after is not None and field_changes(before, after):
            field = FieldChange("peak", before, after)
            changes.append(
                Change(f"peak in the {what}", name, Sort.CHANGED, worded((field,)), (field,), _distance(field))
            )
    return changes


def _distance(item: FieldChange) -> float | None:
    if isinstance(item.before, float) and isinstance(item.after, float):
        return abs(item.after - item.before)
    return None


def _extractions(pair: Pair) -> list[Change]:
    (lvs_a, proof_a), (lvs_b, proof_b) = pair.both("extraction.json", tuple[LvsResult, Proof])
    changes = keyed_changes("layout versus network", {"": lvs_a}, {"": lvs_b})
    return changes + _proof(pair, "proof of the device as drawn", proof_a, proof_b)


def _rules(pair: Pair) -> list[Change]:
    a, b = pair.both("drc.json", DesignRules)
    changes = keyed_changes("design rule", a.counts, b.counts)
    findings_a, findings_b = _by_name(a.findings), _by_name(b.findings)
    for change in keyed_changes("finding", findings_a, findings_b, lambda item: item.message):
        item = findings_b.get(change.name) or findings_a[change.name]
        box = (item.x - _AROUND_MM, item.y - _AROUND_MM, item.x + _AROUND_MM, item.y + _AROUND_MM)
        changes.append(replace(change, spots=(Spot("", box),)))
    return changes


def _drive(pair: Pair) -> list[Change]:
    """What must drive the device, and what it gives."""
    a, b = pair.both("drive.json", DriveLoads)
    return [
        Change("drive", item.name, Sort.CHANGED, worded((replace(item, name=""),)), (item,))
        for item in field_changes(a, b)
    ]


def _by_name(findings: Sequence[Finding]) -> dict[str, Finding]:
    """By rule and bodies; several of the same are numbered from the second on."""
    found: dict[str, Finding] = {}
    for item in findings:
        stem = f"{item.rule}: {', '.join(item.bodies)}"
        name, number = stem, 2
        while name in found:
            name, number = f"{stem} ({number})", number + 1
        found[name] = item
    return found
