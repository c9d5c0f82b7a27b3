"""A fabrication process as typed data: materials, machine limits, plate stack, unit and linkage templates.

Read from a TOML file of the folder ``geometry``; every figure there has its source in a comment beside it.
Lengths in mm, moduli in MPa (N/mm^2), densities in g/cm^3, angles in rad.
"""

from __future__ import annotations

import dataclasses
import tomllib
import typing
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any

import msgspec

from mdlcad.datafolder import find_data, list_data, refuse_non_numbers
from mdlcad.errors import UsageError


class PlateRole(StrEnum):
    """What a plate of the stack is for."""

    BASE = "base"
    CLOCK = "clock"
    UNIT = "unit"
    TRUNK = "trunk"
    RUNG = "rung"
    COVER = "cover"


@dataclass(frozen=True, slots=True)
class Material:
    """modulus: MPa; strain_limit, strain_peak: in repeated use, at rare peaks; density: g/cm^3; creep: a note."""

    modulus: float
    strain_limit: float
    strain_peak: float
    density: float
    creep: str


@dataclass(frozen=True, slots=True)
class Machine:
    """What the machine can make, mm; repeatability is the plus-or-minus of a cut edge.

    ``fillet`` is the radius of every inner corner of a flexing part; files written before it was known have sharp ones.
    """

    min_wall: float
    min_gap: float
    kerf: float
    repeatability: float
    bed: tuple[float, float]
    fillet: float = 0.0


@dataclass(frozen=True, slots=True)
class Plate:
    """One plate of the stack: ``thickness`` in mm, ``material`` a key of ``Process.materials``."""

    name: str
    role: PlateRole
    thickness: float
    material: str


@dataclass(frozen=True, slots=True)
class Stack:
    """Plates bottom to top, the shim gap between them (mm) and the material of pins and posts.

    ``friction`` is the coefficient of dry friction of plates, pins and posts on each other; files written before it was
    known have none, and are read with a value for dry plastics.
    """

    z_gap: float
    pin_material: str
    plates: tuple[Plate, ...]
    friction: float = 0.3


@dataclass(frozen=True, slots=True)
class UnitTemplate:
    """The buckling-beam unit. See ``docs/mechanics.md`` for the symbols.

    Attributes:
        beams: N, beams a side; beam_wall: t; span: l; pair_spacing: h; throw_unit: X0, mm per unit x.
        kappa0: K_b in units of S0; shape: g, shortening coefficient of a guided beam.
        series_leaves: leaves in each bank of the series spring; series_arm: width of its stems and trusses.
        block_width: width of the beams' end block; rib_width: width of the frame rib.
    """

    beams: int
    beam_wall: float
    span: float
    pair_spacing: float
    throw_unit: float
    kappa0: float
    shape: float
    series_leaves: int
    series_arm: float
    block_width: float
    rib_width: float


@dataclass(frozen=True, slots=True)
class PinTemplate:
    """Square pins: side, wall left around the hole, gap between the two blocks of a hub."""

    side: float
    wall: float
    hub_gap: float


@dataclass(frozen=True, slots=True)
class LinkTemplate:
    """Bars, couplers, rockers and bias leaves.

    Attributes:
        gap: clearance of two bodies that move independently.
        wall_step, wall_max, legs: the walls and leg counts of meanders that sizing tries.
        leg_gap: least clearance of neighbouring legs when deflected; slope_limit: largest turn of a leg, rad.
        quartic_limit: quartic of one coupler in units of the mass's own; bias_ratio: bias leaf in units of S0.
        post_radius, post_fit, eye_wall: fixed posts and the eyes that turn on them.
        channel_tracks: trunks side by side that a channel between two columns is made for.
        carrier_ratio: least stiffness of a carrier over that of the coupler it ends in.
    """

    bar_width: float
    gap: float
    wall_step: float
    wall_max: float
    legs: tuple[int, ...]
    leg_gap: float
    slope_limit: float
    quartic_limit: float
    bias_ratio: float
    post_radius: float
    post_fit: float
    eye_wall: float
    channel_tracks: int
    carrier_ratio: float


@dataclass(frozen=True, slots=True)
class FrameTemplate:
    """The rim along the boundary.

    Attributes:
        screw, screw_hole: diameters of the screws that hold the stack together and of their clearance holes.
        screw_pitch: how far apart along the rim they may be.
    """

    width: float
    screw: float
    screw_hole: float
    screw_pitch: float


@dataclass(frozen=True, slots=True)
class Process:
    """A way to make the device."""

    name: str
    summary: str
    materials: dict[str, Material]
    machine: Machine
    stack: Stack
    unit: UnitTemplate
    pin: PinTemplate
    link: LinkTemplate
    frame: FrameTemplate

    def plates(self, role: PlateRole) -> tuple[Plate, ...]:
        """The plates of a role, bottom to top."""
        return tuple(plate for plate in self.stack.plates if plate.role is role)

    def plate(self, name: str) -> Plate:
        """The plate of that name.

        Raises:
            UsageError: the stack has no such plate.
        """
        for plate in self.stack.plates:
            if plate.name == name:
                return plate
        raise UsageError(f"process {self.name}: stack.plates has no plate {name!r}")

    def material(self, plate: Plate) -> Material:
        """What a plate is cut from."""
        return self.materials[plate.material]

    def z_of(self, name: str) -> float:
        """Bottom face of a plate, mm above the bottom of the base.

        Raises:
            UsageError: the stack has no such plate.
        """
        height = 0.0
        for plate in self.stack.plates:
            if plate.name == name:
                return round(height, 6)
            height += plate.thickness + self.stack.z_gap
        raise UsageError(f"process {self.name}: stack.plates has no plate {name!r}")


def process_names() -> tuple[str, ...]:
    """Names of the processes that ship with mdlcad."""
    return tuple(list_data("geometry", ".toml"))


def load_process(name_or_path: str | Path) -> Process:
    """Read a process by name (of the folder ``geometry``) or by path.

    Raises:
        UsageError: no such file, not to be read, not TOML, a key missing, unknown, of the wrong type or out of range;
            the message names the file and the key.
    """
    path = find_data("geometry", str(name_or_path), ".toml")
    where = path.name
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise UsageError(f"{where}: cannot be read: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise UsageError(f"{where}: not a TOML file: {error}") from error
    refuse_non_numbers(where, data)
    try:
        process = msgspec.convert(data, Process)
    except msgspec.ValidationError as error:
        raise UsageError(f"{where}: {str(error).replace('$.', '').replace(' - at', ', at')}") from error
    _refuse_unknown_keys(where, "", data, Process)
    for key, message in _faults(process):
        raise UsageError(f"{where}: {key}: {message}")
    return process


def _refuse_unknown_keys(where: str, prefix: str, data: Any, kind: Any) -> None:
    if dataclasses.is_dataclass(kind):
        hints = typing.get_type_hints(kind)
        for key, value in data.items():
            if key not in hints:
                raise UsageError(f"{where}: {prefix}{key}: unknown key; known are {', '.join(hints)}")
            _refuse_unknown_keys(where, f"{prefix}{key}.", value, hints[key])
    elif typing.get_origin(kind) is dict:
        for key, value in data.items():
            _refuse_unknown_keys(where, f"{prefix}{key}.", value, typing.get_args(kind)[1])
    elif typing.get_origin(kind) is tuple:
        for index, value in enumerate(data):
            _refuse_unknown_keys(where, f"{prefix}{index}.", value, typing.get_args(kind)[0])


def _faults(process: Process) -> list[tuple[str, str]]:
    """Every fault as (key, message); the types are right already."""
    faults = [
        (f"{section.name}.{entry.name}", "must be greater than 0")
        for section in dataclasses.fields(process)
        if dataclasses.is_dataclass(getattr(process, section.name))
        for entry in dataclasses.fields(getattr(process, section.name))
        if isinstance(value := getattr(getattr(process, section.name), entry.name), float | int)
        and (value < 0.0 or (value == 0.0 and entry.name not in ("kerf", "fillet")))  # a printer has no kerf
    ]
    for name, material in process.materials.items():
        for key in ("modulus", "strain_limit", "strain_peak", "density"):
            if getattr(material, key) <= 0.0:
                faults.append((f"materials.{name}.{key}", "must be greater than 0"))
    for plate in process.stack.plates:
        if plate.thickness <= 0.0:
            faults.append((f"stack.plates.{plate.name}.thickness", "must be greater than 0"))
        if plate.material not in process.materials:
            faults.append((f"stack.plates.{plate.name}.material", f"no material {plate.material!r}"))
    if process.stack.pin_material not in process.materials:
        faults.append(("stack.pin_material", f"no material {process.stack.pin_material!r}"))
    names = [plate.name for plate in process.stack.plates]
    if len(set(names)) != len(names):
        faults.append(("stack.plates", "two plates have one name"))
    order = [PlateRole.BASE, PlateRole.CLOCK, PlateRole.UNIT, PlateRole.TRUNK, PlateRole.RUNG, PlateRole.COVER]
    ranks = [order.index(plate.role) for plate in process.stack.plates]
    if ranks != sorted(ranks) or any(ranks.count(order.index(role)) != 1 for role in order if role not in _MANY):
        faults.append(("stack.plates", "must be, bottom to top: base, clock(s), unit, trunk, rung(s), cover"))
    if any(not process.plates(role) for role in sorted(_MANY)):
        faults.append(("stack.plates", "needs a clock plate and a rung plate at least"))
    least, most = process.machine.kerf / 2.0, min(process.machine.min_gap, process.link.leg_gap) / 2.0
    if process.machine.fillet and not least <= process.machine.fillet <= most + 1e-9:
        faults.append(
            ("machine.fillet", f"must be from {least:g} (half the kerf) to {most:g} (two of them in the least gap)")
        )
    if any(legs < 2 or legs % 2 for legs in process.link.legs) or not process.link.legs:
        faults.append(("link.legs", "must be even numbers, 2 or more (a meander is symmetric about its middle)"))
    if process.unit.series_leaves < 2:
        faults.append(("unit.series_leaves", "must be 2 or more, or the trusses can turn"))
    if process.unit.rib_width < process.pin.side + 2.0 * process.pin.wall:
        faults.append(("unit.rib_width", "must hold a pin with its two walls"))
    if process.frame.screw_hole <= process.frame.screw:
        faults.append(("frame.screw_hole", "must be wider than the screw"))
    if process.frame.width < process.frame.screw_hole + 2.0 * process.pin.wall:
        faults.append(("frame.width", "must hold a screw's hole with the wall of a pin on either side"))
    return faults


_MANY = frozenset({PlateRole.CLOCK, PlateRole.RUNG})
