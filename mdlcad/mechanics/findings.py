"""What of a sizing does not hold: strains, walls, gaps and limits, with value and limit."""

from __future__ import annotations

from dataclasses import dataclass

from mdlcad.mechanics.leaves import strain_allowed
from mdlcad.mechanics.process import PlateRole, Process
from mdlcad.mechanics.rules import LayoutRules
from mdlcad.mechanics.series import SeriesSpring
from mdlcad.mechanics.sizes import BiasSize, CouplerSize, UnitSize
from mdlcad.mechanics.unit import UnitLaw, clock_swing
from mdlcad.network.model import CouplingKind, Network


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that does not hold: ``rule`` (short name), ``subject`` (a part), the value and the limit it misses."""

    rule: str
    subject: str
    value: float
    limit: float
    message: str


def most_preload(network: Network, process: Process, law: UnitLaw, series: SeriesSpring) -> float:
    """The preload, mm, with which the clock's farthest pushes the stems of a series spring to a gap from each other."""
    # the spring takes the share of the clock's motion that the beams leave it
    share = law.axial_stiffness / law.series_stiffness
    return (series.clear - process.machine.min_gap) / share - clock_swing(network, law)


def findings_of(
    network: Network,
    process: Process,
    law: UnitLaw,
    series: SeriesSpring,
    units: tuple[UnitSize, ...],
    couplers: tuple[CouplerSize, ...],
    biases: tuple[BiasSize, ...],
    rules: LayoutRules,
) -> tuple[Finding, ...]:
    """Every limit of the process that the sizes miss."""
    found: list[Finding] = []

    def most(rule: str, subject: str, value: float, limit: float, message: str) -> None:
        if value > limit:
            found.append(Finding(rule, subject, value, limit, message))

    def least(rule: str, subject: str, value: float, limit: float, message: str) -> None:
        if value < limit:
            found.append(Finding(rule, subject, value, limit, message))

    machine, link = process.machine, process.link
    material = process.material(process.plates(PlateRole.UNIT)[0])
    limit = material.strain_limit
    least("min_wall", "unit.beam", process.unit.beam_wall, machine.min_wall, "beams thinner than the machine makes")
    least("min_wall", "unit.series", series.wall, machine.min_wall, "series leaves thinner than the machine makes")
    least("min_gap", "link.gap", link.gap, machine.min_gap, "gap narrower than the machine makes")
    most("strain", "unit.series", series.strain_settled, limit, "series leaves strained with settled shuttles")
    peak = "series leaves strained if a clock peak finds a shuttle held at 0"
    most("strain_peak", "unit.series", series.strain, material.strain_peak, peak)
    for unit in units:
        most("strain", f"unit.{unit.mass}", unit.strain, limit, "beams strained at the largest throw seen")
        least("preload_room", f"unit.{unit.mass}", unit.preload, unit.room[0], "its clock block overruns its slot")
        most("preload_room", f"unit.{unit.mass}", unit.preload, unit.room[1], "its series spring has no room for it")
    room = max(unit.room[1] for unit in units)
    nearer = "stems are pushed nearer to each other than a gap"
    most("preload_room", "unit.series", room, most_preload(network, process, law, series), nearer)
    for mass in network.masses:
        spread = max(abs(other.k1) for other in network.masses) - abs(mass.k1)
        most("gain", f"unit.{mass.name}", spread, 0.0, "clock plates have one stroke: its k1 cannot be smaller")
    for kind, name, leaf in [("coupler", c.coupling, c.leaf) for c in couplers] + [
        ("bias", b.mass, b.leaf) for b in biases
    ]:
        values = {
            "strain": (leaf.strain, strain_allowed(leaf.shape.wall, process)),
            "slope": (leaf.slope, link.slope_limit),
            "clearance": (leaf.clearance, link.leg_gap),
            "quartic": (leaf.quartic * process.unit.throw_unit**2 / law.stiffness_unit, link.quartic_limit),
        }
        for miss in leaf.misses:
            found.append(Finding(miss, f"{kind}.{name}", *values[miss], "no meander of the template keeps this limit"))
    for coupling in network.couplings:
        if coupling.kind is not CouplingKind.LINEAR or coupling.d1 != 0.0:
            found.append(
                Finding(
                    "clocked", f"coupler.{coupling.name}", coupling.d1, 0.0, "a clocked coupling has no passive part"
                )
            )
    half = rules.row_pitch - rules.throw - rules.hub_height / 2.0 - rules.gap - rules.eye_radius
    for bias in biases:
        most("bias_offset", f"bias.{bias.mass}", abs(bias.offset), half, "its post comes too near the neighbouring row")
    return tuple(found)
