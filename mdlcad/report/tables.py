"""The rows of the report page's tables: from artefacts to words and numbers with units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mdlcad.language import Actuator, Device, Sensor
from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.leaves import LeafSize
from mdlcad.network.model import Network
from mdlcad.parts.bom import Bom, Profile
from mdlcad.report.report import Report
from mdlcad.signoff.drc import Finding
from mdlcad.signoff.summary import DesignRules

# What a rule of the design rules asks, and the unit of its value. A rule that is not here is shown by its name alone.
_RULES = {
    "overlap": ("no two bodies share volume as assembled", "mm²"),
    "swept_clearance": ("what moves by itself keeps the gap to all else, at the worst of both motions", "mm"),
    "containment": ("nothing but tabs reaches outside the boundary", "mm²"),
    "min_wall": ("no wall is thinner than the machine makes", "mm"),
    "min_gap": ("no gap is narrower than the machine makes", "mm"),
    "bed": ("every plate or tile fits the machine's bed", "mm"),
    "trapped": ("every part comes straight down to its place past all that is there before it", "mm"),
    "seam": ("no seam between tiles crosses or comes near a flexure or a carrier", ""),
    "unrealised_coupling": ("every coupling of the network has its part", ""),
    "carrier_stiffness": ("a carrier is stiff enough for the couplers it drives", "times"),
    "guide_missing": ("every clock plate has its two guides", "guides"),
    "guide_strain": ("no guide is strained beyond its limit at the end of its stroke", ""),
    "guide_buckling": ("no guide bears more than half of the load that buckles it", "N"),
    "guide_turn": ("a clock plate turns no unit's clock by more than the machine's repeatability", "mm"),
    "shuttle_tilt": ("no net's couplings tilt its shuttle into the plates above and below", "rad"),
    "strain_root": ("no fillet is strained beyond what its material bears at rare peaks", ""),
    "strain": ("no flexure is strained beyond its limit in repeated use", ""),
    "strain_peak": ("no flexure is strained beyond its limit at rare peaks", ""),
    "preload_room": ("every solved preload stays within the room that its slot was sized for", "mm"),
    "slope": ("no leg of a flexure turns too far", "rad"),
    "clearance": ("neighbouring legs of a flexure stay apart", "mm"),
    "quartic": ("no coupler stiffens too much at its extremes", ""),
}


@dataclass(frozen=True, slots=True)
class RuleRow:
    """A design rule: what it asks, how often it is missed, the worst miss in words, and whether that fails a build."""

    rule: str
    asks: str
    count: int
    worst: str
    verdict: str


@dataclass(frozen=True, slots=True)
class PortRow:
    """A port, the places it stands at, and what its values are called."""

    name: str
    kind: str
    places: str
    values: str


@dataclass(frozen=True, slots=True)
class SizeRow:
    """A dimension or stiffness with its unit."""

    name: str
    value: str
    about: str


@dataclass(frozen=True, slots=True)
class FlexureRow:
    """Flexures that are alike."""

    kind: str
    nominal: str
    count: int
    wall_mm: float
    legs: int
    reach_mm: float
    stiffness: float
    strain_percent: float


def rule_rows(rules: DesignRules, report: Report, process: Process | None) -> list[RuleRow]:
    """One row a rule, those that are missed first; of a rule that holds, the worst that there is where it is known."""
    rows = []
    nearest = _nearest(report, process) | _nearest_guide(rules, process) if process else {}
    for rule, count in rules.counts.items():
        found = [item for item in rules.findings if item.rule == rule]
        asks, unit = _RULES.get(rule, (rule.replace("_", " "), ""))
        verdict = "holds" if count == 0 else "warning" if rule in rules.warned else "fails"
        worst = _worst(found, unit) if found else nearest.get(rule, "none found")
        rows.append(RuleRow(rule, asks, count, worst, verdict))
    order = {"fails": 0, "warning": 1, "holds": 2}
    return sorted(rows, key=lambda row: (order[row.verdict], row.rule))


def _nearest(report: Report, process: Process) -> dict[str, str]:
    """What comes nearest to the limit of a rule that holds, where the report has it."""
    found = {}
    mechanics, bom = report.mechanics, report.bom
    if mechanics is not None and mechanics.carrier_stiffness_ratio_worst is not None:
        ratio = mechanics.carrier_stiffness_ratio_worst
        found["carrier_stiffness"] = f"{ratio:.4g} times (limit {process.link.carrier_ratio:g})"
    if bom is not None and bom.sheets:
        widest = max(bom.sheets, key=lambda line: (max(line.size_mm), line.plate))
        bed = process.machine.bed
        size = f"{widest.size_mm[0]:g} × {widest.size_mm[1]:g} mm"
        tiled = f", {report.tiles} tiles" if report.tiles and report.tiles > len(report.plates) else ""
        found["bed"] = f"{size} (bed {bed[0]:g} × {bed[1]:g}): {widest.plate}{tiled}"
    return found


def _nearest_guide(rules: DesignRules, process: Process) -> dict[str, str]:
    """Of the guides that keep the limit of ``guide_turn``, those that come nearest to it."""
    if not rules.guides:
        return {}
    worst = max(rules.guides, key=lambda item: item.error_mm)
    limit = process.machine.repeatability
    return {"guide_turn": f"{worst.error_mm:.3f} mm (limit {limit:g}): {worst.plate}, {worst.moment_nmm:.0f} N mm"}


def _worst(found: Sequence[Finding], unit: str) -> str:
    worst = max(found, key=lambda item: (abs(item.value - item.limit), item.bodies))
    who = ", ".join(worst.bodies)
    if worst.value == worst.limit:
        return f"{who}: {worst.message}"
    return f"{worst.value:.4g} {unit}".rstrip() + f" (limit {worst.limit:.4g}): {who}"


def port_rows(device: Device) -> list[PortRow]:
    """Sensors first."""
    ports: list[tuple[Sensor | Actuator, str]] = [(port, "sensor") for port in device.sensors]
    ports += [(port, "actuator") for port in device.actuators]
    return [
        PortRow(
            name=port.name,
            kind=kind,
            places=", ".join(f"{place.line} at {place.position:g}" for place in port.places),
            values=", ".join(f"{value.bits} {value.label}" for value in port.values),
        )
        for port, kind in ports
    ]


def size_rows(sizing: Sizing, process: Process) -> list[SizeRow]:
    """The dimensions that units have in common."""
    rules, law, unit, series = sizing.rules, sizing.law, process.unit, sizing.series
    preloads = [item.preload for item in sizing.units]
    return [
        SizeRow("unit", f"{rules.unit_left + rules.unit_right:.1f} × {rules.row_pitch:.2f} mm", "its slot in x and y"),
        SizeRow("beams", f"{unit.span:g} × {unit.beam_wall:g} mm", f"span and wall; {unit.beams} a side"),
        SizeRow("throw", f"±{rules.throw:.2f} mm", "of shuttles and carriers in y"),
        SizeRow("clock plates", f"±{rules.clock_throw:.2f} mm", "in x"),
        SizeRow("S0", f"{law.stiffness_unit:.3f} N/mm", "stiffness of 1 in the network"),
        SizeRow("F0", f"{law.force_unit:.3f} N", "force of 1 in the network"),
        SizeRow("series springs", f"{series.length:.2f} × {series.wall:.2f} mm", f"{series.leaves} leaves a bank"),
        SizeRow("preload", f"{min(preloads):.2f} to {max(preloads):.2f} mm", "of clock blocks, least to most"),
        SizeRow("pins", f"{rules.pin:g} mm square", ""),
        SizeRow("posts", f"{2 * rules.post_radius:g} mm round", ""),
        SizeRow("gap", f"{rules.gap:.2f} mm", "between what moves independently"),
        SizeRow("rim", f"{rules.frame_width:g} mm", "along the boundary"),
    ]


def flexure_rows(sizing: Sizing) -> list[FlexureRow]:
    """Couplers, rockers and bias leaves, those of one size together."""
    leaves: list[tuple[str, str, LeafSize]] = []
    for coupler in sizing.couplers:
        leaves.append((coupler.leaf.kind.value, f"c = {coupler.strength:.2f}", coupler.leaf))
    for bias in sizing.biases:
        leaves.append((bias.leaf.kind.value, f"|q| = {abs(bias.bias):.2f}", bias.leaf))
    groups: dict[tuple[str, str, float, float], list[LeafSize]] = {}
    for kind, nominal, leaf in leaves:
        groups.setdefault((kind, nominal, leaf.shape.wall, leaf.reach), []).append(leaf)
    return [
        FlexureRow(
            kind=kind,
            nominal=nominal,
            count=len(group),
            wall_mm=wall,
            legs=group[0].shape.legs,
            reach_mm=round(reach, 2),
            stiffness=round(group[0].coupling, 3),
            strain_percent=round(100 * max(leaf.strain for leaf in group), 2),
        )
        for (kind, nominal, wall, reach), group in sorted(groups.items())
    ]


def stock_words(bom: Bom) -> list[tuple[str, str, str, int, float]]:
    """What, profile, length, count and mass in g of each line of stock."""
    return [
        (
            line.kind.value,
            f"{line.size_mm:g} mm {'square' if line.profile is Profile.SQUARE else 'round'}, {line.material}",
            f"{line.length_mm:g} mm",
            line.count,
            line.mass_g,
        )
        for line in bom.stock
    ]


def kinds_of_masses(network: Network) -> str:
    """How many masses of each kind, in words."""
    kinds: dict[str, int] = {}
    for mass in network.masses:
        kinds[mass.kind.value] = kinds.get(mass.kind.value, 0) + 1
    return ", ".join(f"{count} {kind}" for kind, count in kinds.items())
