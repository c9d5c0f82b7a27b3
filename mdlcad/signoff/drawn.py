"""All flexures of a device as its files draw them: measured, and who carries what."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from shapely import Polygon

from mdlcad.errors import SignoffError
from mdlcad.mechanics.flexure import Sheet
from mdlcad.mechanics.leaves import LeafKind, trim
from mdlcad.mechanics.process import Plate, PlateRole, Process
from mdlcad.signoff.lvs import Recovered
from mdlcad.signoff.measure import UnitSeen, measure_unit
from mdlcad.signoff.measure_leaf import LeafSeen, measure_leaf
from mdlcad.signoff.readback import ReadBody

_GRAVITY = 9.81


@dataclass(frozen=True, slots=True)
class CouplerDrawn:
    """A coupler or rocker: whom it joins, what it is, its outline's dimensions and its sheet.

    ``lifts``: how far it lies above the middles of the source's and the target's shuttle, mm.
    """

    source: str
    target: str
    kind: LeafKind
    leaf: LeafSeen
    sheet: Sheet
    lifts: tuple[float, float]

    @property
    def name(self) -> str:
        """Of the coupling, as the network has it."""
        return f"{self.source}->{self.target}"


@dataclass(frozen=True, slots=True)
class BiasDrawn:
    """A bias leaf, how far its post stands above the row and it itself above the shuttle's middle, mm."""

    mass: str
    leaf: LeafSeen
    offset: float
    sheet: Sheet
    lift: float


@dataclass(frozen=True, slots=True)
class Drawn:
    """A device as drawn.

    Attributes:
        units: by mass; unit_sheet: what they are cut from.
        weights: by mass, of all that moves with its shuttle, N.
        tabs: by mass, how far its tab lies above its shuttle's middle, mm.
        post_radius: of the posts that rockers and bias leaves turn on, mm.
    """

    units: dict[str, UnitSeen]
    unit_sheet: Sheet
    couplers: tuple[CouplerDrawn, ...]
    biases: tuple[BiasDrawn, ...]
    weights: dict[str, float]
    tabs: dict[str, float]
    post_radius: float


def measure_device(
    found: Sequence[ReadBody], cut: Mapping[str, Polygon], recovered: Recovered, process: Process
) -> Drawn:
    """Measure every flexure.

    Args:
        found: the bodies of the STEP file; cut: outlines as cut by name, for bias leaves, which the device holds bent.

    Raises:
        SignoffError: a body has not the outline of what it is, or stands in no plate of the process.
    """
    bodies = {body.name: body for body in found}
    units, sheets = {}, {}
    for mass in recovered.units:
        body = bodies[f"unit.{mass}"]
        units[mass] = measure_unit(body.name, body.section)
        sheets[mass] = _sheet(body, process)
    couplers = []
    for item in recovered.connections:
        body = bodies[item.body]
        post = None if item.post is None else bodies[item.post].section.centroid.x
        leaf = measure_leaf(body.name, body.section, units[item.target].x, post)
        kind = LeafKind.ROCKER if item.negative else LeafKind.COUPLER
        lifts = tuple(trim(_middle(body) - _middle(bodies[f"unit.{mass}"])) for mass in (item.source, item.target))
        couplers.append(CouplerDrawn(item.source, item.target, kind, leaf, _sheet(body, process), (lifts[0], lifts[1])))
    biases = []
    for bias in recovered.biases:
        if bias.body not in cut:
            raise SignoffError(f"{bias.body}: is in no drawing of a plate")
        post_at = bodies[bias.post].section.centroid
        leaf = measure_leaf(bias.body, cut[bias.body], units[bias.mass].x, post_at.x)
        offset = post_at.y - units[bias.mass].y
        lift = trim(_middle(bodies[bias.body]) - _middle(bodies[f"unit.{bias.mass}"]))
        biases.append(BiasDrawn(bias.mass, leaf, offset, _sheet(bodies[bias.body], process), lift))
    weights = {
        mass: sum(_weight(bodies[name], process) for name in (f"unit.{mass}", *recovered.carriers.get(mass, ())))
        for mass in recovered.units
    }
    tabs = {
        mass: trim(_middle(bodies[name]) - _middle(bodies[f"unit.{mass}"]))
        for mass in recovered.units
        for name in recovered.carriers.get(mass, ())
        if name.startswith("tab.")
    }
    pivots = [item.post for item in recovered.connections] + [item.post for item in recovered.biases]
    posts = [bodies[name].section for name in pivots if name is not None]
    radius = max((math.sqrt(post.area / math.pi) for post in posts), default=0.0)
    return Drawn(units, next(iter(sheets.values())), tuple(couplers), tuple(biases), weights, tabs, radius)


def _middle(body: ReadBody) -> float:
    return body.z + body.thickness / 2.0


def _plate(body: ReadBody, process: Process) -> Plate:
    for plate in process.stack.plates:
        if abs(process.z_of(plate.name) - body.z) < 1e-3:
            return plate
    raise SignoffError(f"{body.name}: stands at z = {body.z:.3f} mm, where the process has no plate")


def _sheet(body: ReadBody, process: Process) -> Sheet:
    plate = _plate(body, process)
    if plate.role not in (PlateRole.UNIT, PlateRole.RUNG):
        raise SignoffError(f"{body.name}: is a flexure on the {plate.role.value} plate {plate.name}")
    material = process.material(plate)
    return Sheet(material.modulus, body.thickness, material.strain_limit)


def _weight(body: ReadBody, process: Process) -> float:
    """Weight in N, of what is neither pin nor post in the material of its plate."""
    pinned = body.name.startswith("pin.")
    material = process.materials[process.stack.pin_material] if pinned else process.material(_plate(body, process))
    return body.volume * material.density * 1e-6 * _GRAVITY
