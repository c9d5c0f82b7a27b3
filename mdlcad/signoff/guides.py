"""Design rules on the guides of clock plates, measured on their bodies as drawn.

What turns a plate comes from the simulation of its drive; how its guides bear that comes from their outlines.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import shapely

from mdlcad.mechanics.guides import GuideLeaf, guide_findings, guide_load
from mdlcad.mechanics.leaves import trim
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.parts.body import Body, BodyKind
from mdlcad.signoff.corners import fillet_at
from mdlcad.signoff.drc import Finding
from mdlcad.signoff.summary import GuidesFound

_TOUCH = 0.05
"""How far inside of an edge a line is laid, mm: less than any fillet or wall."""
GUIDE_RULES = ("guide_missing", "guide_strain", "guide_buckling", "guide_turn")


def check_guides(
    bodies: Sequence[Body], moments: Mapping[str, float], process: Process
) -> tuple[list[Finding], list[GuidesFound]]:
    """Rules ``guide_missing``, ``guide_strain``, ``guide_buckling`` and ``guide_turn`` on every clock plate.

    Args:
        moments: N mm about its handle, by plate.
    """
    findings: list[Finding] = []
    found: list[GuidesFound] = []
    for plate in process.plates(PlateRole.CLOCK):
        sheets = [body for body in bodies if body.plate == plate.name and body.kind is BodyKind.CLOCK]
        if not sheets:
            continue  # a network may have fewer phases than the process has clock plates
        middle = sheets[0].section.centroid
        guides = [body for body in bodies if body.plate == plate.name and body.kind is BodyKind.GUIDE]
        handles = [body for body in bodies if body.plate == plate.name and body.kind is BodyKind.TAB]
        if len(guides) != 2 or not handles:
            words = (
                f"{len(guides)} guides have room on it, 2 are needed to keep it from turning: a larger device would do"
            )
            findings.append(Finding("guide_missing", (plate.name,), middle.x, middle.y, len(guides), 2.0, words))
            continue
        leaves = [measured(body, process) for body in guides]
        handle = handles[0].section.centroid.y
        rows = [
            body.section.centroid.y
            for body in bodies
            if body.kind is BodyKind.PIN and body.moves_with == sheets[0].moves_with
        ]
        places = [body.section.centroid for body in guides]
        span, moment = abs(places[1].x - places[0].x), moments.get(plate.name, 0.0)
        lever = (places[0].y + places[1].y) / 2.0 - handle
        reach = max((abs(row - handle) for row in rows), default=0.0)
        loads = [guide_load(leaf, span, sheets[0].throw[0], moment, lever, reach) for leaf in leaves]
        for guide, place, leaf, load in zip(guides, places, leaves, loads, strict=True):
            findings += [
                Finding(item.rule, (item.subject,), place.x, place.y, item.value, item.limit, item.message)
                for item in guide_findings(guide.name, leaf, load, process, plate)
            ]
        soft = min(leaves, key=lambda leaf: leaf.along)
        worst = (
            max(load.load for load in loads),
            max(load.strain for load in loads),
            max(load.error for load in loads),
        )
        found.append(GuidesFound(plate.name, *map(trim, (soft.wall, soft.length, span, moment, *worst))))
    return findings, found


def measured(body: Body, process: Process) -> GuideLeaf:
    """The leaf of a guide as drawn: its wall halfway along, its length without a foot, the fillets at its two roots.

    A foot is broader than the leaf's fillets, and as high as it is.
    """
    x_low, y_low, x_high, y_high = body.section.bounds
    middle = shapely.intersection(body.section, _line((x_low, x_high), (y_low + y_high) / 2.0))
    wall, x = middle.length, middle.centroid.x
    ends, corners = [], []
    for edge, way in ((y_low, 1.0), (y_high, -1.0)):
        across = shapely.intersection(body.section, _line((x_low, x_high), edge + way * _TOUCH))
        if across.length > wall + 2.0 * process.link.gap:  # a foot: the leaf's root is at its other side
            beside = shapely.LineString([(x_low + _TOUCH, y_low - 1.0), (x_low + _TOUCH, y_high + 1.0)])
            foot = shapely.intersection(body.section, beside).bounds
            edge = foot[3] if way > 0.0 else foot[1]
        ends.append(edge)
        corners += [((x + side * wall / 2.0, edge), (side, way)) for side in (-1.0, 1.0)]
    fillets = [fillet_at(body.section, corner, way) for corner, way in corners]
    plate = process.plate(body.plate)
    return GuideLeaf(wall, ends[1] - ends[0], plate.thickness, process.material(plate).modulus, min(fillets))


def _line(x: tuple[float, float], y: float) -> shapely.LineString:
    return shapely.LineString([(x[0] - 1.0, y), (x[1] + 1.0, y)])
