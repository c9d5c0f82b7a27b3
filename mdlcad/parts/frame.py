"""What stands still: base, cover, the rim of every plate, ribs, rib posts and the shims between plates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import shapely
from shapely import MultiPolygon, Polygon
from shapely.affinity import translate
from shapely.geometry.base import BaseGeometry

from mdlcad.mechanics.decks import Deck, deck_of_plate
from mdlcad.mechanics.process import PlateRole
from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.screws import screw_hole
from mdlcad.parts.shapes import GRID, box, cut, pieces, square
from mdlcad.parts.stack import FRAME_REF, Hub, Stack

STILL = (0.0, 0.0)


def interior(stack: Stack, boundary: Polygon, inset: float = 0.0) -> Polygon:
    """The boundary's inside without the rim and a further ``inset``, mm; may be several polygons."""
    return boundary.buffer(-(stack.sizing.rules.frame_width + inset), join_style="mitre")


def ribs(stack: Stack, hubs: Sequence[Hub], boundary: Polygon) -> list[Polygon]:
    """The ribs of the unit plate: one strip a column, to the left of its units, through to the rim."""
    rules, span = stack.sizing.rules, stack.process.unit.span
    found: list[Polygon] = []
    _, y_low, _, y_high = boundary.bounds
    for x in sorted({hub.x for hub in hubs}):
        strip = box(x - rules.unit_left, y_low, x - rules.hub_half - span, y_high)
        for piece in pieces(shapely.intersection(strip, boundary)):
            low, high = piece.bounds[1], piece.bounds[3]
            if any(hub.x == x and low < hub.y < high for hub in hubs):
                found.append(piece)
    return found


def rib_posts(stack: Stack, hubs: Sequence[Hub], found: Sequence[Polygon], boundary: Polygon) -> list[Body]:
    """Posts from the base up to the ribs, between the rows: a rib alone would bend under its units' clock forces."""
    rules = stack.sizing.rules
    walls = rules.pin + 2.0 * stack.process.pin.wall
    clear = rules.clock_throw + rules.gap + stack.process.pin.wall
    inner = interior(stack, boundary, rules.gap)
    width = stack.process.unit.rib_width
    bodies: list[Body] = []
    for rib in found:
        x = rib.bounds[2] - width / 2.0
        rows = sorted(
            {hub.y for hub in hubs if hub.x - rules.unit_left < x < hub.x and rib.bounds[1] < hub.y < rib.bounds[3]}
        )
        places = sorted(round(y + step, 4) for y in rows for step in (-rules.row_pitch / 2.0, rules.row_pitch / 2.0))
        # the place above one row is the place below the next, but for rounding
        distinct = [y for index, y in enumerate(places) if index == 0 or y - places[index - 1] > rules.pin]
        for y in distinct:
            swept = box(x - walls / 2.0 - clear, y - walls / 2.0, x + walls / 2.0 + clear, y + walls / 2.0)
            if not inner.contains(swept):
                continue  # the rim holds the rib there
            bodies.append(
                stack.upright(
                    f"post.rib.{len(bodies)}.{x:.2f}",
                    BodyKind.POST,
                    stack.base_plate,
                    stack.unit_plate,
                    square(x, y, rules.pin),
                    STILL,
                    FRAME_REF,
                    palette.POST,
                )
            )
    name = "post.rib" if stack.deck is Deck.LOWER else f"post.rib.{stack.deck}"
    return [_renamed(body, f"{name}.{index}") for index, body in enumerate(bodies)]


def _renamed(body: Body, name: str) -> Body:
    return Body(
        name, body.kind, body.plate, body.z, body.thickness, body.section, body.throw, body.moves_with, body.colour
    )


def frame_bodies(
    stack: Stack,
    boundary: Polygon,
    found_ribs: Sequence[Polygon],
    posts: Sequence[Body],
    notches: Mapping[str, Sequence[Polygon]],
    screws: Sequence[Body],
    windows: Sequence[Polygon],
) -> list[Body]:
    """Base, cover, rims (with the ribs on the unit plate) and shims.

    Args:
        posts: all posts; those that reach the base or the cover get their holes there.
        notches: what is to be cut from the rim of a plate and from the shims on both sides of it, by plate name.
        screws: go through everything here; of rims and shims over the unit plate, what none goes through is left out.
            windows: go through the cover.
    """
    inside = interior(stack, boundary)
    through = [screw_hole(stack, screw) for screw in screws]
    rim = cut(shapely.difference(boundary, inside), through)
    bodies: list[Body] = []
    for plate in stack.plates:
        z = stack.bottom(plate.name)
        holes = [p.section for p in posts if p.z < z + plate.thickness / 2.0 < p.z + p.thickness]
        if plate.role in (PlateRole.BASE, PlateRole.COVER):
            base = plate.role is PlateRole.BASE
            colour = palette.BASE if base else palette.COVER
            shape = cut(boundary, [*holes, *through, *(() if base else windows)])
            bodies += _pieces(stack, plate.name, BodyKind.BASE if base else BodyKind.COVER, plate.name, shape, colour)
            continue
        shape = rim
        if plate.role is PlateRole.UNIT and found_ribs:
            shape = cut(_filled(stack, rim, found_ribs), [*holes, *through])
        kind = BodyKind.SPACER if plate.role is PlateRole.CLOCK else BodyKind.FRAME
        colour = palette.SPACER if kind is BodyKind.SPACER else palette.FRAME
        shape = cut(shape, notches.get(plate.name, ()))
        if plate.role in (PlateRole.RUNG, PlateRole.TRUNK):
            shape = _screwed(shape, screws)
        bodies += _pieces(stack, f"{kind.value}.{plate.name}", kind, plate.name, shape, colour)
    for below, above in pairwise(stack.process.stack.plates):
        if deck_of_plate(above.name) is not stack.deck:
            continue
        z = stack.top(below.name)
        height = round(stack.bottom(above.name) - z, 6)
        # what passes the rim of a plate would rub on shims that go on above or below it
        passed = [*notches.get(below.name, ()), *notches.get(above.name, ())]
        for index, piece in enumerate(pieces(_screwed(cut(rim, passed), screws))):
            name = f"shim.{above.name}" if index == 0 else f"shim.{above.name}.{index}"
            bodies.append(Body(name, BodyKind.SPACER, "shims", z, height, piece, STILL, (FRAME_REF,), palette.SPACER))
    return bodies


def _screwed(shape: BaseGeometry, screws: Sequence[Body]) -> BaseGeometry:
    """``shape`` without the pieces that no screw goes through: between two near tabs there is no room for one.

    Nothing would hold such a piece but its neighbours' pressure. All of ``shape`` if there are no screws at all.
    """
    places = [screw.section.centroid for screw in screws]
    kept = [piece for piece in pieces(shape) if any(Polygon(piece.exterior).contains(place) for place in places)]
    return MultiPolygon(kept) if kept else shape


def _filled(stack: Stack, rim: Polygon, found_ribs: Sequence[Polygon]) -> Polygon:
    """Rim and ribs; a slit between a rib and the rim on its left that is narrower than a rib is filled."""
    whole = shapely.union_all([rim, *found_ribs], grid_size=GRID)
    half = stack.process.unit.rib_width / 2.0
    closed = whole.buffer(half, join_style="mitre").buffer(-half, join_style="mitre")
    beside = [translate(rib, -2.0 * half, 0.0) for rib in found_ribs]
    fill = shapely.intersection(closed, shapely.union_all(beside))
    return shapely.union_all([whole, fill], grid_size=GRID)


def _pieces(stack: Stack, name: str, kind: BodyKind, plate: str, shape: Polygon, colour: str) -> list[Body]:
    return [
        stack.sheet(name if index == 0 else f"{name}.{index}", kind, plate, piece, STILL, (FRAME_REF,), colour)
        for index, piece in enumerate(pieces(shape))
    ]
