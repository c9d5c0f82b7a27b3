"""All design rules on one device, and which of them fail a build."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from shapely import Polygon

from mdlcad.errors import SignoffError
from mdlcad.mechanics import Finding as SizeFinding
from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.strains import check_strain
from mdlcad.network.model import Network
from mdlcad.parts.body import Body
from mdlcad.parts.plates import plates_of
from mdlcad.parts.stiffness import CarrierStiffness, carrier_faults
from mdlcad.parts.tiles import tiles_of
from mdlcad.placement.placement import Placement
from mdlcad.routing.check import check_layout
from mdlcad.routing.layout import Layout
from mdlcad.signoff.drc import RULES, Finding, check_containment, check_cut, check_motion
from mdlcad.signoff.guides import GUIDE_RULES, check_guides
from mdlcad.signoff.seams import check_tiles
from mdlcad.signoff.summary import DesignRules
from mdlcad.signoff.trapped import check_order

CARRIER_RULES = ("carrier_stiffness", "shuttle_tilt")
STRAIN_RULES = ("strain", "strain_peak", "strain_root")


def check_geometry(
    network: Network,
    sizing: Sizing,
    placement: Placement,
    layout: Layout,
    bodies: Sequence[Body],
    carriers: Sequence[CarrierStiffness],
    process: Process,
    moments: Mapping[str, float],
) -> DesignRules:
    """Run every rule; the findings of all.

    Args:
        moments: what turns each clock plate about its handle, N mm, by plate.

    Raises:
        SignoffError: there is nothing to check.
    """
    if not bodies or not network.masses:
        raise SignoffError("there are no bodies to check")
    rules = sizing.rules
    findings = check_motion(bodies, rules.gap)
    findings += check_containment(bodies, Polygon(placement.boundary))
    for plate, members in plates_of(bodies).items():
        findings += check_cut(plate, members, process.machine.min_wall, process.machine.min_gap)
        findings += check_tiles(members, tiles_of(plate, members, process), process.machine.bed, process.pin.wall)
    findings += check_order(bodies, process)
    of_guides, guides = check_guides(bodies, moments, process)
    findings += of_guides
    where = {mass.mass: (mass.x, mass.y) for mass in placement.masses}
    findings += [
        Finding(item.rule, item.names, item.x, item.y, 0.0, 0.0, item.message)
        for item in check_layout(network, placement, layout, rules)
    ]
    findings += _of_sizing(sizing.findings, where)
    findings += _strains(network, sizing, process, where)
    targets = {coupling.name: coupling.target for coupling in network.couplings}
    for fault in carrier_faults(carriers, sizing, process):
        names, place = (f"coupler.{fault.coupling}",), where[targets[fault.coupling]]
        findings.append(Finding(fault.rule, names, *place, fault.value, fault.limit, fault.message))
    findings += [
        Finding("unrealised_coupling", (name,), *where[targets.get(name, name)], 1.0, 0.0, reason)
        for name, reason in layout.unrealised
    ]
    ran = sorted({*RULES, *CARRIER_RULES, *STRAIN_RULES, *GUIDE_RULES, *(item.rule for item in findings)})
    counts = {rule: sum(item.rule == rule for item in findings) for rule in ran}
    return DesignRules(counts, tuple(findings), (), tuple(guides))


def _strains(
    network: Network, sizing: Sizing, process: Process, where: dict[str, tuple[float, float]]
) -> list[Finding]:
    """Rules ``strain``, ``strain_peak`` and ``strain_root``, computed anew, whatever the sizing says."""
    found = check_strain(
        network,
        process,
        sizing.law,
        sizing.series,
        {unit.mass: unit.preload for unit in sizing.units},
        {unit.mass: unit.amplitude / process.unit.throw_unit for unit in sizing.units},
        sizing.couplers,
        sizing.biases,
        sizing.rules.throw,
    )
    return _placed(found, where)


def _of_sizing(found: Sequence[SizeFinding], where: dict[str, tuple[float, float]]) -> list[Finding]:
    return _placed([item for item in found if item.rule not in STRAIN_RULES], where)


def _placed(found: Sequence[SizeFinding], where: dict[str, tuple[float, float]]) -> list[Finding]:
    placed = []
    for item in found:
        subject = item.subject.partition(".")[2]
        place = where.get(subject.rpartition("->")[2], (0.0, 0.0))
        placed.append(Finding(item.rule, (item.subject,), *place, item.value, item.limit, item.message))
    return placed
