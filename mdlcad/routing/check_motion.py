"""Clearances of everything that moves, plate by plate."""

from __future__ import annotations

from collections.abc import Sequence

from shapely import STRtree

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.routing.check_bodies import Solid

Raw = tuple[str, str, float, float, tuple[str, ...]]
TOLERANCE = 1e-5


def check_motion(solids: Sequence[Solid], rules: LayoutRules) -> list[Raw]:
    """Pairs on one plate that come too near at the worst of their strokes, and leaves that run into their bodies."""
    found: list[Raw] = []
    for plate in sorted({solid.plate for solid in solids}):
        members = [solid for solid in solids if solid.plate == plate]
        tree = STRtree([solid.swept for solid in members])
        near, other = tree.query([solid.swept for solid in members], predicate="dwithin", distance=rules.gap)
        for i, j in sorted(zip(near.tolist(), other.tolist(), strict=True)):
            if i < j:
                item = _pair(members[i], members[j], rules)
                if item is not None:
                    found.append(item)
    return found


def _pair(a: Solid, b: Solid, rules: LayoutRules) -> Raw | None:
    if a.name in b.tied or b.name in a.tied:
        return None
    together = not set(a.masses).isdisjoint(b.masses)
    first, second = sorted((a.name, b.name))
    x, y = (a.shape.centroid.x + b.shape.centroid.x) / 2, (a.shape.centroid.y + b.shape.centroid.y) / 2
    if together and not (a.flexible or b.flexible):
        return None
    if together and a.flexible != b.flexible:
        if a.shape.intersection(b.shape).area > TOLERANCE:
            return "overlap", f"{first} runs into {second} on plate {a.plate}", x, y, (first, second)
        return None
    distance = a.swept.distance(b.swept)
    if distance < rules.gap - TOLERANCE:
        words = f"{first} and {second} come to {distance:.2f} mm on plate {a.plate}, {rules.gap:g} mm is needed"
        return "clearance", words, x, y, (first, second)
    return None
