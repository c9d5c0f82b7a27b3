"""A bias: a meander from a hub's block to a fixed post that stands off the row, so that the leaf is always bent."""

from __future__ import annotations

import shapely
from shapely import Polygon
from shapely.affinity import translate

from mdlcad.mechanics.flexure import deflect, drawn_in, examine
from mdlcad.mechanics.leaves import LeafKind, chain_of, eye_radius
from mdlcad.mechanics.sizes import BiasSize
from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.leaf import (
    Path,
    deflected_path,
    heights,
    hub_block,
    leaf_envelope,
    leaf_start,
    meander_path,
    outward,
    wall_strip,
)
from mdlcad.parts.shapes import closed, cut, disc, join, only, square
from mdlcad.parts.stack import FRAME_REF, Hub, Stack
from mdlcad.parts.unit import hub_pin_x
from mdlcad.routing.layout import BiasLeaf


def bias_bodies(stack: Stack, hub: Hub, leaf: BiasLeaf, size: BiasSize) -> list[Body]:
    """The bias leaf, cut straight and assembled bent, and its post.

    Raises:
        ValueError: the layout's post is neither on the row nor where sizing put it.
    """
    if min(abs(leaf.post_y - hub.y), abs(leaf.post_y - hub.y - size.offset)) > 1e-3:
        raise ValueError(f"bias {leaf.mass}: its post is at y = {leaf.post_y}, sizing wants {hub.y + size.offset}")
    rules, link = stack.sizing.rules, stack.process.link
    shape, direction = size.leaf.shape, outward(leaf.side)
    start = leaf_start(stack, hub, leaf.side)
    chain = chain_of(LeafKind.BIAS, shape, stack.process)
    straight = meander_path(shape, start, hub.y, direction)
    bent = deflected_path(chain, 0.0, size.offset, start, hub.y, direction)
    settled = deflect(chain, 0.0, size.offset)
    x = start + direction * size.leaf.reach
    root = (start - direction * 0.2, hub.y)  # 0.2 mm into the block, so that no slit is left there
    post_y = round(hub.y + size.offset, 4)

    def eye(radius: float, at: float, y: float) -> Polygon:
        """The slotted eye: discs about where the post is when the leaf is least and most drawn in."""
        ends = [disc(at + direction * slide, y, radius) for slide in size.leaf.slot]
        return shapely.union_all(ends).convex_hull

    def shape_of(path: Path, y: float, drawn: float, shortening: float) -> Polygon:
        at = x - direction * drawn
        # the frame's solution leaves lengths along x as they are: draw the shortening in, evenly
        walls = [(px - shortening * (px - start) / size.leaf.reach, py) for px, py in path]
        whole = join(
            [
                hub_block(stack, hub, leaf.side),
                wall_strip([root, *walls, (at, y)], shape.wall),
                eye(eye_radius(stack.process), at, y),
            ]
        )
        pin = square(hub_pin_x(stack, hub, leaf.side), hub.y, rules.pin)
        return only(cut(closed(whole, shape.fillet), [pin, eye(link.post_radius + link.post_fit, at, y)]))

    def covered(path: Path, height: float) -> Polygon:
        near = translate(hub_block(stack, hub, leaf.side), 0.0, height)
        rings = [eye(eye_radius(stack.process), x - direction * slide, post_y) for slide in size.leaf.slot]
        return shapely.union_all([near, wall_strip([*path, (x, post_y)], shape.wall), *rings])

    envelope = leaf_envelope(chain, heights(rules.throw), [size.offset], covered, (start, hub.y), direction)
    return [
        stack.sheet(
            f"bias.{leaf.mass}",
            BodyKind.BIAS,
            leaf.plate,
            shape_of(straight, hub.y, 0.0, 0.0),
            (size.leaf.sweep, rules.throw),
            (hub.ref, FRAME_REF),
            palette.BIAS,
            shape_of(bent, post_y, drawn_in(chain, settled), examine(chain, settled).shortening),
            envelope,
        ),
        stack.upright(
            f"post.bias.{leaf.mass}",
            BodyKind.POST,
            leaf.plate,
            stack.cover_plate,
            disc(x, post_y, link.post_radius),
            (0.0, 0.0),
            FRAME_REF,
            palette.POST,
        ),
    ]
