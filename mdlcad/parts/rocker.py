"""A negative coupling: two meanders joined by an eye that turns on a fixed post, so one end up is the other down."""

from __future__ import annotations

from mdlcad.mechanics.leaves import eye_radius
from mdlcad.mechanics.sizes import CouplerSize
from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.leaf import hub_block, leaf_start, meander_path, outward, rung_end, wall_strip
from mdlcad.parts.shapes import closed, cut, disc, join, only, square
from mdlcad.parts.stack import FRAME_REF, Hub, Stack
from mdlcad.parts.unit import hub_pin_x
from mdlcad.routing.layout import CouplerLeaf


def rocker_bodies(stack: Stack, source: Hub, target: Hub, leaf: CouplerLeaf, size: CouplerSize) -> list[Body]:
    """The rocker and its post."""
    rules, link = stack.sizing.rules, stack.process.link
    shape, direction = size.leaf.shape, outward(leaf.side)
    start = leaf_start(stack, target, leaf.side)
    centre = start + direction * size.leaf.reach / 2.0
    near = [*meander_path(shape, start, target.y, direction), (centre, target.y)]
    far = [*meander_path(shape, start + direction * size.leaf.reach, target.y, -direction), (centre, target.y)]
    rung = rung_end(stack, *far[0], direction)
    whole = join(
        [
            rung,
            hub_block(stack, target, leaf.side),
            wall_strip(near, shape.wall),
            wall_strip(far, shape.wall),
            disc(centre, target.y, eye_radius(stack.process)),
        ]
    )
    holes = [
        rung,
        square(hub_pin_x(stack, target, leaf.side), target.y, rules.pin),
        disc(centre, target.y, link.post_radius + link.post_fit),
    ]
    return [
        stack.sheet(
            f"rocker.{leaf.coupling}",
            BodyKind.ROCKER,
            leaf.plate,
            only(cut(closed(whole, shape.fillet), holes)),
            (size.leaf.sweep, rules.throw),
            (source.ref, target.ref, FRAME_REF),
            palette.ROCKER,
        ),
        stack.upright(
            f"post.{leaf.coupling}",
            BodyKind.POST,
            leaf.plate,
            stack.cover_plate,
            disc(centre, target.y, link.post_radius),
            (0.0, 0.0),
            FRAME_REF,
            palette.POST,
        ),
    ]
