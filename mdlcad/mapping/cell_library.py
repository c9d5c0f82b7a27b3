"""A cell library: the numbers that make a threshold gate out of a mass and its springs, read from ``cells/``."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Literal

import msgspec

from mdlcad.datafolder import find_data, refuse_non_numbers
from mdlcad.errors import UsageError
from mdlcad.mapping.characterisation import Characterisation
from mdlcad.network.model import Dynamics


@dataclass(frozen=True, slots=True)
class DynamicsTable:
    """Table ``dynamics``: inertia m, damping b, quartic lambda, period T and the number of phases."""

    phases: int
    inertia: float
    damping: float
    quartic: float
    period: float


@dataclass(frozen=True, slots=True)
class MassTable:
    """Table ``mass``: stiffness k0 + k1 p."""

    k0: float
    k1: float


@dataclass(frozen=True, slots=True)
class CouplingTable:
    """Table ``coupling``: strength of an input of weight one; self stiffness by sign, as a multiple of the strength."""

    strength: float
    self_stiffness_positive: float
    self_stiffness_negative: float
    compensated: bool


@dataclass(frozen=True, slots=True)
class BiasTable:
    """Table ``bias``: force q of a bias of weight one."""

    force: float


@dataclass(frozen=True, slots=True)
class GatesTable:
    """Table ``gates``: greatest total weight of the inputs and the bias of a mass; greatest total weight of the
    couplings from a mass; greatest echo (see ``relieve``) of a mass."""

    weight_limit: int
    load_limit: int
    echo_limit: int


@dataclass(frozen=True, slots=True)
class PowerUpTable:
    """Table ``power_up``: displacement at t = 0 of a mass that holds a bit."""

    well: float


@dataclass(frozen=True, slots=True)
class Library:
    """One library, the tables of its ``library.toml``. All quantities are dimensionless."""

    name: str
    title: str
    dynamics: DynamicsTable
    mass: MassTable
    coupling: CouplingTable
    bias: BiasTable
    gates: GatesTable
    power_up: PowerUpTable
    characterisation: Characterisation | None = None
    kind: Literal["parametron"] = "parametron"

    def network_dynamics(self) -> Dynamics:
        """The dynamics of a network made of this library."""
        d = self.dynamics
        return Dynamics(d.inertia, d.damping, d.quartic, d.period, d.phases)


def load_library(name_or_path: str) -> Library:
    """The library of that name in ``cells/``, or the one in the folder or TOML file at that path.

    Raises:
        UsageError: no such library, or its file is not a valid library; names the file and the key.
    """
    found = find_data("cells", name_or_path, "")
    path = found / "library.toml" if found.is_dir() else found
    label = f"{path.parent.name}/{path.name}"
    try:
        table = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as trouble:
        raise UsageError(f"{label}: cannot be read: {trouble.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as trouble:
        raise UsageError(f"{label}: not TOML: {trouble}") from None
    refuse_non_numbers(label, table)
    unknown = _unknown_keys(table)
    if unknown:
        raise UsageError(f"{label}: unknown key '{unknown[0]}'; remove it")
    try:
        library = msgspec.convert(table, Library)
    except msgspec.ValidationError as trouble:
        raise UsageError(f"{label}: {trouble}") from None
    _check_values(label, library)
    return library


def _unknown_keys(table: dict[str, object]) -> list[str]:
    tables = {
        "dynamics": DynamicsTable,
        "mass": MassTable,
        "coupling": CouplingTable,
        "bias": BiasTable,
        "gates": GatesTable,
        "power_up": PowerUpTable,
        "characterisation": Characterisation,
    }
    unknown = []
    for key, value in table.items():
        if key in tables and isinstance(value, dict):
            unknown += [
                f"{key}.{inner}" for inner in value if inner not in {field.name for field in fields(tables[key])}
            ]
        elif key not in ("kind", "name", "title", *tables):
            unknown.append(key)
    return unknown


def _check_values(label: str, library: Library) -> None:
    rules = (
        ("dynamics.phases", library.dynamics.phases == 3, "must be 3"),
        ("dynamics.inertia", library.dynamics.inertia > 0, "must be positive"),
        ("dynamics.damping", library.dynamics.damping > 0, "must be positive"),
        ("dynamics.quartic", library.dynamics.quartic > 0, "must be positive"),
        ("dynamics.period", library.dynamics.period > 0, "must be positive"),
        ("mass.k0", library.mass.k0 > 0, "must be positive: the mass is monostable at p = 0"),
        ("mass.k1", library.mass.k0 + 2 * library.mass.k1 < 0, "k0 + 2 k1 must be negative: bistable at p = 2"),
        ("coupling.strength", library.coupling.strength > 0, "must be positive"),
        ("coupling.self_stiffness_positive", library.coupling.self_stiffness_positive >= 0, "must not be negative"),
        ("coupling.self_stiffness_negative", library.coupling.self_stiffness_negative >= 0, "must not be negative"),
        ("bias.force", library.bias.force > 0, "must be positive"),
        ("gates.weight_limit", 3 <= library.gates.weight_limit <= 9, "must be 3 to 9"),
        ("gates.load_limit", library.gates.load_limit >= 3, "must be at least 3"),
        ("gates.echo_limit", library.gates.echo_limit >= 4, "must be at least 4"),
        ("power_up.well", library.power_up.well > 0, "must be positive"),
    )
    for key, holds, text in rules:
        if not holds:
            raise UsageError(f"{label}: {key} {text}")
