"""Every kind of part of a small device, over its working range."""

from __future__ import annotations

from functools import cache

from mdlcad.mechanics import Process, Sizing, load_process, size
from mdlcad.mechanics.beam.curves import Curve, leaf_curve, series_curve, unit_curve
from mdlcad.mechanics.leaves import LeafKind
from tests.parts.device import small_network

# k at the three clock positions p = 0, 1, 2 of a library, and a reach that no mass of the maze robot exceeds there in
# simulation with random inputs (0.46, 1.09 and 1.77; sensors, which are driven from outside, 0.70, 1.34 and 1.92)
WORKING = ((3.5, 0.7), (0.5, 1.35), (-2.5, 1.95))


@cache
def sized(name: str) -> tuple[Process, Sizing]:
    process, network = load_process(name), small_network()
    return process, size(network, process, {mass.name: 1.8 for mass in network.masses})


def units(process: Process, sizing: Sizing) -> list[Curve]:
    unit = process.unit.throw_unit
    return [unit_curve(process, sizing.law, sizing.series, k, reach * unit) for k, reach in WORKING]


def leaves(process: Process, sizing: Sizing) -> list[Curve]:
    throw = sizing.rules.throw
    curves = []
    for coupler in sizing.couplers:
        curves.append(leaf_curve(process, coupler.leaf, "one end at rest", lambda d: (d, 0.0), throw))
        curves.append(leaf_curve(process, coupler.leaf, "ends opposite", lambda d: (d, -d), throw))
        if coupler.leaf.kind is LeafKind.ROCKER:
            curves.append(leaf_curve(process, coupler.leaf, "ends together", lambda d: (d, d), throw))
    for bias in sizing.biases:
        curves.append(leaf_curve(process, bias.leaf, "", lambda d, off=bias.offset: (d - off, 0.0), throw))
    return curves


def spring(process: Process, sizing: Sizing) -> Curve:
    return series_curve(process, sizing.series, sizing.series.travel)
