"""Design rules on tiles: each fits the bed, and no seam crosses or comes near what bends or what carries a signal."""

from __future__ import annotations

from collections.abc import Sequence

import shapely

from mdlcad.parts.body import Body
from mdlcad.parts.tiles import DIVISIBLE, Tile, Tiling, fits
from mdlcad.signoff.drc import TOLERANCE_MM, Finding


def check_tiles(bodies: Sequence[Body], tiling: Tiling, bed_mm: tuple[float, float], wall_mm: float) -> list[Finding]:
    """Rules ``bed`` and ``seam`` on the tiles of one plate.

    The check looks at the tiles alone: every body that must stay whole is in one of them, as large as it was drawn, and
    the new edges of those that were cut keep a wall's distance from what is rooted in them.
    """
    findings = [
        Finding("bed", item.bodies, item.x, item.y, item.size, max(bed_mm), item.reason) for item in tiling.untiled
    ]
    for tile in tiling.tiles:
        whole = shapely.GeometryCollection([body.section for body in tile.bodies])
        if not fits(whole, bed_mm):
            x0, y0, x1, y1 = whole.bounds
            message = f"tile {tile.name} of {x1 - x0:.1f} x {y1 - y0:.1f} mm is larger than the machine's bed"
            names = (tile.bodies[0].name,)
            findings.append(Finding("bed", names, x0, y0, max(x1 - x0, y1 - y0), max(bed_mm), message))
    given_up = {name for item in tiling.untiled for name in item.bodies}
    return findings + _check_seams(bodies, tiling.tiles, wall_mm, given_up)


def _check_seams(bodies: Sequence[Body], tiles: Sequence[Tile], wall_mm: float, given_up: set[str]) -> list[Finding]:
    found: dict[str, list[Body]] = {}
    for tile in tiles:
        for body in tile.bodies:
            # the parts of a body that was cut are numbered after a stroke
            name = body.name.rpartition("/")[0] or body.name if body.kind in DIVISIBLE else body.name
            found.setdefault(name, []).append(body)
    fixed = [body for body in bodies if body.kind not in DIVISIBLE]
    tree = shapely.STRtree([body.section for body in fixed])
    findings = []
    for body in bodies:
        parts = found.get(body.name, [])
        if len(parts) == 1 and abs(parts[0].section.area - body.section.area) < TOLERANCE_MM:
            continue
        place = body.section.representative_point()
        if body.kind not in DIVISIBLE:
            if body.name not in given_up:
                message = f"a seam crosses it: it is in {len(parts)} parts, and has to be whole"
                findings.append(Finding("seam", (body.name,), place.x, place.y, float(len(parts)), 1.0, message))
            continue
        rooted = set(tree.query(body.section, predicate="dwithin", distance=2.0 * TOLERANCE_MM).tolist())
        for part in parts:
            edges = shapely.difference(part.section.boundary, body.section.boundary.buffer(2.0 * TOLERANCE_MM))
            near_seam = tree.query(edges, predicate="dwithin", distance=wall_mm - 2.0 * TOLERANCE_MM).tolist()
            for index in sorted(rooted.intersection(near_seam)):
                near = shapely.shortest_line(edges, fixed[index].section)
                message = f"a seam comes within {near.length:.3f} mm of {fixed[index].name}"
                names = (part.name, fixed[index].name)
                x, y = near.centroid.x, near.centroid.y
                findings.append(Finding("seam", names, x, y, near.length, wall_mm, message))
    return findings
