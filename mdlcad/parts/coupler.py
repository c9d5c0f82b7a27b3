"""A positive coupling: a meander from the carrier's bar to a block on the target's hub."""

from __future__ import annotations

from mdlcad.mechanics.sizes import CouplerSize
from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.leaf import hub_block, leaf_start, meander_path, outward, rung_end, wall_strip
from mdlcad.parts.shapes import closed, cut, join, only, square
from mdlcad.parts.stack import Hub, Stack
from mdlcad.parts.unit import hub_pin_x
from mdlcad.routing.layout import CouplerLeaf


def coupler_body(stack: Stack, source: Hub, target: Hub, leaf: CouplerLeaf, size: CouplerSize) -> Body:
    """The coupler's body, its block on the target's hub included."""
    rules = stack.sizing.rules
    path = meander_path(size.leaf.shape, leaf_start(stack, target, leaf.side), target.y, outward(leaf.side))
    block = hub_block(stack, target, leaf.side)
    rung = rung_end(stack, *path[-1], outward(leaf.side))
    whole = closed(join([block, wall_strip(path, size.leaf.shape.wall), rung]), size.leaf.shape.fillet)
    section = only(cut(whole, [rung, square(hub_pin_x(stack, target, leaf.side), target.y, rules.pin)]))
    return stack.sheet(
        f"coupler.{leaf.coupling}",
        BodyKind.COUPLER,
        leaf.plate,
        section,
        (size.leaf.sweep, rules.throw),
        (source.ref, target.ref),
        palette.COUPLER,
    )
