"""Sizing: from the network's numbers to millimetres, and back to the numbers that the parts really have."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from statistics import median_low

from mdlcad.errors import UsageError
from mdlcad.mechanics.findings import Finding, findings_of, most_preload
from mdlcad.mechanics.leaves import LeafKind, LeafSize, bias_offset, eye_radius, size_leaf, trim
from mdlcad.mechanics.preload import TILT_STEPS, compensator, most_self_terms, room_for, self_terms
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.mechanics.series import SeriesSpring, series_spring
from mdlcad.mechanics.sizes import BiasSize, CouplerSize, UnitSize
from mdlcad.mechanics.strains import cases_of, unit_strains
from mdlcad.mechanics.unit import UnitLaw, clock_swing, unit_law
from mdlcad.network.model import Coupling, Network


@dataclass(frozen=True, slots=True)
class Sizing:
    """Every dimension, with the numbers it gives the network back."""

    process: str
    law: UnitLaw
    series: SeriesSpring
    units: tuple[UnitSize, ...]
    couplers: tuple[CouplerSize, ...]
    biases: tuple[BiasSize, ...]
    rules: LayoutRules
    findings: tuple[Finding, ...]


def size(network: Network, process: Process, peak: Mapping[str, float]) -> Sizing:
    """Size every unit and flexure of ``network`` for ``process``.

    Args:
        peak: largest |x| of every mass in simulation.

    Raises:
        UsageError: a mass has no peak, or no part of the process can have the network's numbers.
    """
    for mass in network.masses:
        if mass.name not in peak:
            raise UsageError(f"no simulated peak for the mass {mass.name!r}")
    law = unit_law(process)
    throw = math.ceil(process.unit.throw_unit * max(peak[mass.name] for mass in network.masses) / 0.05 - 1e-9) * 0.05
    throw = round(throw, 6)
    couplers = _couplers(network, process, law, throw)
    biases = _biases(network, process, law, throw)
    absorbed = self_terms(network, couplers, biases, law, {})
    least_stiff = {item.coupling: process.link.carrier_ratio * item.leaf.own for item in couplers}
    softened = self_terms(network, couplers, biases, law, least_stiff)
    # a cut edge may stand out by the repeatability; a strained leaf bulges by less than that beyond its ends
    row_pitch = _up(law.shuttle_height + 2.0 * throw + process.link.gap + process.machine.repeatability)
    k_least = min(min(mass.k0, mass.k0 + 2.0 * mass.k1) for mass in network.masses)
    series = series_spring(process, law, row_pitch, k_least, max(absorbed.values()))
    solver = compensator(network, process, law, series, peak, absorbed)
    try:
        preloads, softest = solver.preloads(absorbed), solver.preloads(softened)
        most, more = (
            solver.preloads(most_self_terms(network, couplers, biases, law, process.link.carrier_ratio, steps))
            for steps in (0.0, TILT_STEPS)
        )
    except ArithmeticError as error:
        raise UsageError(f"process {process.name}: unit: {error}") from error
    strains = unit_strains(network, process, law, series, preloads, peak)
    series = replace(series, strain=trim(strains.peak), strain_settled=trim(strains.settled))
    # hundredths of a micrometre less, for room is rounded up
    pushed = most_preload(network, process, law, series) - 1e-4
    units = tuple(
        UnitSize(
            mass=mass.name,
            phase=mass.phase,
            compensation_network=mass.compensation,
            compensation=trim(0.0 - absorbed[mass.name]),
            preload=preloads[mass.name],
            room=room_for(softest[mass.name], max(most[mass.name], min(more[mass.name], pushed))),
            amplitude=process.unit.throw_unit * peak[mass.name],
            strain=trim(strains.beams[mass.name]),
        )
        for mass in network.masses
    )
    rules = _rules(network, process, law, series, units, couplers, biases, throw, row_pitch)
    findings = findings_of(network, process, law, series, units, couplers, biases, rules)
    return Sizing(process.name, law, series, units, couplers, biases, rules, findings)


def _up(value: float) -> float:
    """Rounded up to 0.05 mm."""
    return round(math.ceil(value / 0.05 - 1e-9) * 0.05, 6)


def _couplers(network: Network, process: Process, law: UnitLaw, throw: float) -> tuple[CouplerSize, ...]:
    sized: dict[float, LeafSize] = {}
    for coupling in network.couplings:
        if coupling.strength not in sized:
            sized[coupling.strength] = _coupler_leaf(coupling, process, law, throw)
    return tuple(coupler_size(item, sized[item.strength], process, law) for item in network.couplings)


def coupler_size(coupling: Coupling, leaf: LeafSize, process: Process, law: UnitLaw) -> CouplerSize:
    """What ``leaf`` does as that coupling."""
    sign = math.copysign(1.0, coupling.strength)
    return CouplerSize(
        coupling.name,
        leaf,
        trim(sign * leaf.coupling / law.stiffness_unit),
        trim(leaf.own / law.stiffness_unit),
        trim(leaf.quartic * process.unit.throw_unit**2 / law.stiffness_unit),
    )


def _coupler_leaf(coupling: Coupling, process: Process, law: UnitLaw, throw: float) -> LeafSize:
    stiffness = abs(coupling.strength) * law.stiffness_unit
    try:
        kind = LeafKind.COUPLER if coupling.strength > 0.0 else LeafKind.ROCKER
        return size_leaf(kind, stiffness, cases_of(kind, throw, 0.0), process, law)
    except ValueError as error:
        raise UsageError(f"coupling {coupling.name}: {error}") from error


def _biases(network: Network, process: Process, law: UnitLaw, throw: float) -> tuple[BiasSize, ...]:
    stiffness = process.link.bias_ratio * law.stiffness_unit
    sized: dict[float, tuple[LeafSize, float]] = {}
    result = []
    for mass in network.masses:
        if mass.bias == 0.0:
            continue
        if mass.bias not in sized:
            try:
                sized[mass.bias] = _bias_leaf(mass.bias * law.force_unit, stiffness, process, law, throw)
            except ValueError as error:
                raise UsageError(f"bias of {mass.name}: {error}") from error
        leaf, offset = sized[mass.bias]
        slope = leaf.own - 2.0 * leaf.skew * offset + 3.0 * leaf.quartic * offset**2
        result.append(BiasSize(mass.name, leaf, offset, mass.bias, trim(slope / law.stiffness_unit)))
    return tuple(result)


def _bias_leaf(force: float, stiffness: float, process: Process, law: UnitLaw, throw: float) -> tuple[LeafSize, float]:
    """The leaf that holds a shuttle at 0 back with ``force`` (N), and where its post stands (mm).

    Its range is known only with its offset, which linear theory gives to begin with; the first leaf says it better.
    """
    bent = force / stiffness
    for _ in range(2):
        leaf = size_leaf(LeafKind.BIAS, stiffness, cases_of(LeafKind.BIAS, throw, -bent), process, law)
        bent = round(bias_offset(leaf, force, process), 4)
    return leaf, -bent


TURN_SHARE = 0.45
"""Of what a carrier may give, so much to the shuttle's turning; the rest to bars and pins."""


def turn_stiffness(law: UnitLaw, series: SeriesSpring) -> float:
    """N mm/rad of a shuttle turning in the plane: its left beams end in the rib, its right ones in a sprung block."""
    half = law.shuttle_turn / 2.0
    return half + 1.0 / (1.0 / half + 1.0 / series.turn_stiffness)


def _columns_apart(
    process: Process, law: UnitLaw, series: SeriesSpring, couplers: tuple[CouplerSize, ...], hub_half: float
) -> dict[str, float]:
    """By coupling, the distance of columns at which its pull turns a source in the next column by the share of it.

    A force F at an arm a turns the shuttle by F a / K and gives way by F a^2 / K; a coupler pulls at its middle, a
    rocker in the middle of its half on the carrier's side.
    """
    apart = {}
    for item in couplers:
        give = TURN_SHARE / (process.link.carrier_ratio * item.leaf.own)
        pull = item.leaf.reach * (0.75 if item.leaf.kind is LeafKind.ROCKER else 0.5)
        apart[item.coupling] = _up(math.sqrt(give * turn_stiffness(law, series)) + hub_half + pull)
    return apart


def _rules(
    network: Network,
    process: Process,
    law: UnitLaw,
    series: SeriesSpring,
    units: tuple[UnitSize, ...],
    couplers: tuple[CouplerSize, ...],
    biases: tuple[BiasSize, ...],
    throw: float,
    row_pitch: float,
) -> LayoutRules:
    unit, pin, link = process.unit, process.pin, process.link
    hub_half = pin.hub_gap / 2.0 + pin.side + 2.0 * pin.wall
    # hundredths: what it is rounded up by, every slot has to make room for
    clock_throw = round(math.ceil(clock_swing(network, law) / 0.01 - 1e-9) * 0.01, 6)
    overrun = max(0.0, clock_throw - min(item.room[0] for item in units))
    left = _up(hub_half + unit.span + unit.rib_width)
    right = _up(hub_half + unit.span + series.reach + overrun + link.gap)
    reach = {item.coupling: round(hub_half + item.leaf.reach, 6) for item in couplers}
    track = link.bar_width + link.gap
    # beside what most couplings reach a channel has room for all its trunks, beside the longest for one
    one_trunk = hub_half + link.gap + link.bar_width
    usual = median_low(reach.values()) + (link.channel_tracks - 1) * track if reach else 0.0
    channel = one_trunk + max(usual, max(reach.values(), default=0.0))
    apart = _columns_apart(process, law, series, couplers, hub_half)
    # what most couplings allow; the few stronger ones stay within a column
    column_most = median_low(apart.values()) if apart else math.inf
    pitch = max(_up(left + right), _up(channel))
    return LayoutRules(
        unit_left=left,
        unit_right=right,
        column_pitch=pitch,
        column_most=column_most,
        near=tuple(name for name, most in apart.items() if most < column_most),
        row_pitch=row_pitch,
        frame_width=process.frame.width,
        gap=link.gap,
        throw=throw,
        clock_throw=clock_throw,
        bar_width=link.bar_width,
        pin=pin.side,
        hub_pin_offset=pin.hub_gap / 2.0 + pin.wall + pin.side / 2.0,
        hub_half=hub_half,
        hub_gap=pin.hub_gap,
        hub_height=law.shuttle_height,
        track_pitch=track,
        couplers=reach,
        biases={item.mass: round(hub_half + item.leaf.reach, 6) for item in biases},
        post_radius=link.post_radius,
        post_offset={
            item.coupling: round(hub_half + item.leaf.reach / 2.0, 6)
            for item in couplers
            if item.leaf.kind is LeafKind.ROCKER
        },
        link_plates=tuple(plate.name for plate in process.plates(PlateRole.RUNG)),
        bias_offsets={item.mass: item.offset for item in biases},
        eye_radius=eye_radius(process),
        bias_ends={
            # the slot is as long as the eye slides, and slides by its own length
            item.mass: _up(hub_half + item.leaf.reach + eye_radius(process) + item.leaf.slot[1] - item.leaf.slot[0])
            for item in biases
        },
    )
