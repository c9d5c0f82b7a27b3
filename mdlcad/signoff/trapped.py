"""The design rule on the order of assembly: nothing that is there already is in the way of a part."""

from __future__ import annotations

from collections.abc import Sequence

import shapely

from mdlcad.parts.body import Body
from mdlcad.parts.leaf import occupied
from mdlcad.signoff.drc import TOLERANCE_MM, Finding


def check_assembly(order: Sequence[Body]) -> list[Finding]:
    """Rule ``trapped``: every body comes straight down to its place past all that is before it in ``order``.

    Taken apart in the opposite order, every body then comes straight up.
    """
    shapes = [occupied(body) for body in order]
    tree = shapely.STRtree(shapes)
    findings = []
    for later, (body, shape) in enumerate(zip(order, shapes, strict=True)):
        for earlier in sorted(tree.query(shape, predicate="intersects").tolist()):
            other = order[earlier]
            below = other.z + other.thickness - body.z
            if earlier >= later or below < 1e-6:
                continue
            common = shapely.intersection(shape, shapes[earlier])
            if common.area > TOLERANCE_MM:
                place = common.representative_point()
                message = f"cannot come down past {other.name}, which is there before it"
                findings.append(
                    Finding("trapped", (body.name, other.name), place.x, place.y, round(below, 4), 0.0, message)
                )
    return findings
