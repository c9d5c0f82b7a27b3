"""The written files held against the bodies they are to show."""

from __future__ import annotations

from collections.abc import Sequence

from mdlcad.parts.arcs import arc_length, true_area
from mdlcad.parts.body import Body
from mdlcad.parts.shapes import GRID
from mdlcad.signoff.readback import ReadBody

VOLUME_TOLERANCE = 1e-6
# the sum of what two readings of one outline may differ in, over its whole length
AREA_TOLERANCE_MM2 = 1e-3
# drawn chords have their ends on the grid, those of an arc read back on the arc, which may be two that meet
ARC_TOLERANCE_MM = 5.0 * GRID


def check_bodies(bodies: Sequence[Body], found: Sequence[ReadBody]) -> list[str]:
    """Differences between the bodies and what a STEP file holds, in words: names, outlines, heights, volumes."""
    problems = []
    by_name: dict[str, list[ReadBody]] = {}
    for item in found:
        by_name.setdefault(item.name, []).append(item)
    for name in sorted(set(by_name) - {body.name for body in bodies}):
        problems.append(f"{name}: is in the STEP file but not in the device")
    for body in bodies:
        copies = by_name.get(body.name, [])
        if len(copies) != 1:
            problems.append(f"{body.name}: the STEP file holds it {len(copies)} times")
            continue
        read = copies[0]
        section = body.assembled if body.assembled is not None else body.section
        volume = true_area(section) * body.thickness
        if abs(read.volume - volume) > VOLUME_TOLERANCE * volume:
            problems.append(f"{body.name}: {read.volume:.6f} mm3 in the STEP file, {volume:.6f} mm3 drawn")
        if max(abs(read.z - body.z), abs(read.thickness - body.thickness)) > 1e-6:
            problems.append(f"{body.name}: lies at another height in the STEP file than drawn")
        difference = read.section.symmetric_difference(section).area
        if difference > AREA_TOLERANCE_MM2 + ARC_TOLERANCE_MM * arc_length(section):
            problems.append(
                f"{body.name}: its outline in the STEP file differs by {difference:.4f} mm2 from that drawn"
            )
    return problems
