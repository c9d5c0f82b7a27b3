"""What placement and routing may rely on: footprints, strokes and clearances, in millimetres.

These numbers are *results* of sizing (``mechanics``); nobody downstream chooses a dimension.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class LayoutRules:
    """Dimensions in mm. x is power (clock plates move in x), y is signal (shuttles and carriers move in y).

    Attributes:
        unit_left, unit_right: reach of a unit's footprint in x from the hub's centre, frame rib included.
        column_pitch: distance between hub columns; at least unit_left + unit_right.
        column_most: largest distance between hub columns at which a carrier to the next column is stiff enough.
        near: couplings so stiff that a carrier to the next column would be too soft for them at any distance between
            columns: their source and target share a column.
        row_pitch: distance between rows; two bodies in neighbouring rows may move towards each other.
        frame_width: width of the rim along the boundary polygon, inwards.
        gap: least distance of two bodies that move independently, at the worst of their strokes.
        throw: half stroke of a shuttle and its carriers in y (the body sweeps its section moved by -throw..+throw).
        clock_throw: half stroke of a clock plate in x.
        bar_width: width of carrier bars.
        pin: side of the square pins that join plates.
        hub_pin_offset: the two pins of a hub stand at x = hub +- this.
        hub_half: half width in x of the hub on a link plate (each side has its own block from hub_gap/2 to hub_half).
        hub_gap: clearance between the left and the right block of a hub.
        hub_height: height in y of a hub block and of a coupler, the tallest thing a row of a link plate holds.
        track_pitch: least distance of two vertical trunks side by side.
        couplers: coupler reach by coupling name: distance in x from the hub's centre to where the carrier bar begins.
        biases: for every biased mass, distance in x from the hub's centre to the post of its bias leaf.
        post_radius: radius of the fixed posts (rocker pivots, bias posts) that come down from the cover.
        post_offset: for every negative coupling, distance in x from the hub's centre to its pivot.
        link_plates: names of the rung plates, bottom to top ("H0", "H1", ...); posts reach down from the top.
        bias_offsets: for every biased mass, where its post stands in y, measured from its row's centre.
        bias_ends: for every biased mass, distance in x from the hub's centre to the far end of its leaf's slotted eye.
        eye_radius: outer radius of the eye that turns on a post (it stands still, but for its own row's flexure).
    """

    unit_left: float
    unit_right: float
    column_pitch: float
    row_pitch: float
    frame_width: float
    gap: float
    throw: float
    clock_throw: float
    bar_width: float
    pin: float
    hub_pin_offset: float
    hub_half: float
    hub_gap: float
    hub_height: float
    track_pitch: float
    couplers: dict[str, float]
    biases: dict[str, float]
    post_radius: float
    post_offset: dict[str, float]
    link_plates: tuple[str, ...]
    bias_offsets: dict[str, float] = field(default_factory=dict)
    eye_radius: float = 0.0
    bias_ends: dict[str, float] = field(default_factory=dict)
    column_most: float = math.inf
    near: tuple[str, ...] = ()
