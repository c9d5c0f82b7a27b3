"""The mass-spring network that the geometry is, every number computed from the drawn outlines.

Measured: walls, spans, heights and legs of every flexure, how far series springs are pushed together, where posts stand
(``measure``). Through the reduced models of ``mechanics`` they become stiffnesses, self terms, biases and what is
beyond them. A coupler is in a row with its carrier. Taken as given: moduli (process), the clock's stroke (sizing).

Errors of fabrication go the same way: numbers of walls that are thinner or thicker than drawn are from
``flexure_tables``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mdlcad.errors import SignoffError
from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.fit import Scale
from mdlcad.mechanics.leaves import trim
from mdlcad.network.model import Coupling, Network
from mdlcad.parts.stiffness import CarrierStiffness
from mdlcad.signoff.drawn import Drawn
from mdlcad.signoff.flexure_tables import FlexureTables, values_at
from mdlcad.signoff.numbers import (
    Bound,
    SpringNumbers,
)
from mdlcad.signoff.stops import Stop
from mdlcad.signoff.tilting import rubbing
from mdlcad.simulation.devices import Devices
from mdlcad.simulation.system import System, system_of
from mdlcad.simulation.tilting import Tilts

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Errors:
    """Errors of L devices, mm; of each kind float[items, L].

    Attributes:
        beams, leaves: thickness of the walls of every unit's beams and series spring; pins: of its preload.
        couplers, biases: thickness of the walls of every coupler (or rocker) and bias leaf; posts: of their offset.
    """

    beams: Floats
    leaves: Floats
    pins: Floats
    couplers: Floats
    biases: Floats
    posts: Floats


@dataclass(frozen=True, slots=True)
class MassBuilt:
    """What a mass of the device has beyond ``network.model``, in units of the network.

    Attributes:
        quartic, cubic: lambda and beta of ``simulation.devices``.
        friction: bound of dry friction over x, in F0: f, f' and f'' of ``simulation.devices``, without rockers' posts.
        preload_mm: by how much its series spring is pushed together.
    """

    mass: str
    quartic: float
    cubic: float
    friction: Bound
    preload_mm: float


@dataclass(frozen=True, slots=True)
class CouplerBuilt:
    """A coupler or rocker of the device: its numbers, and the stiffness of its carrier, N/mm (0: it has none).

    ``rub``: R of ``simulation.devices``, the friction of a rocker's eye on its post.
    """

    coupling: str
    carrier: float
    numbers: SpringNumbers
    rub: float


@dataclass(frozen=True, slots=True)
class BuiltDevice:
    """The artefact built.json: what was measured, and the network that it is.

    Attributes:
        network: k0 holds the self terms of all springs at a mass, so that couplings have none.
    """

    drawn: Drawn
    network: Network
    masses: tuple[MassBuilt, ...]
    couplers: tuple[CouplerBuilt, ...]


class Built:
    """A device as drawn, and its like with errors.

    Attributes:
        network: masses of the network, couplings as found, with the numbers of the device as drawn.
        system: that, with all that the network's model leaves out, ready to be simulated.
        friction: by mass, bound of dry friction over x in units of F0; rubs: of every coupler found, R.
    """

    def __init__(
        self,
        drawn: Drawn,
        network: Network,
        sizing: Sizing,
        carriers: Sequence[CarrierStiffness],
        process: Process,
        grid: Sequence[float] = (0.0,),
        stops: Mapping[str, Stop] | None = None,
    ) -> None:
        """Evaluate ``drawn``; ``grid``: errors of walls (mm) at which it is tabulated for ``devices``.

        Shuttles are held from tilting, or tilt until they meet their ``stops``.

        Raises:
            SignoffError: the geometry lacks a unit, or a flexure finds no equilibrium at its farthest.
        """
        self._scale = Scale(sizing.law.stiffness_unit, process.unit.throw_unit)
        self._mu = process.stack.friction
        self._drawn = drawn
        self._names = [mass.name for mass in network.masses]
        missing = sorted(set(self._names) - set(drawn.units))
        if missing:
            raise SignoffError(f"the geometry has no units for {', '.join(missing)}")
        self._stiff = {item.coupling: item.stiffness for item in carriers}
        self._stops, self._shuttle_tilt, self._rubbing = stops, sizing.law.shuttle_tilt, rubbing(process, sizing.law)
        try:
            tables = FlexureTables(drawn, network, sizing, self._stiff, process, grid)
        except ArithmeticError as error:
            raise SignoffError(f"a flexure as drawn cannot be bent as far as it must: {error}") from error
        self._units, self._couplers, self._biases = tables.units, tables.couplers, tables.biases
        self.rubs, self._slides = tables.rubs, tables.slides
        self.friction = self._friction()
        self._shape(network)

    def record(self) -> BuiltDevice:
        """The device as drawn, to be kept."""
        devices, none = self.system.devices, np.zeros(1)
        if devices is None:
            raise AssertionError("the system of a device has the device's numbers")
        masses = tuple(
            MassBuilt(
                name,
                trim(float(devices.quartic[at, 0])),
                trim(float(devices.cubic[at, 0])),
                _trimmed(self.friction[name]),
                trim(self._drawn.units[name].preload),
            )
            for at, name in enumerate(self.system.names)
        )
        couplers = tuple(
            CouplerBuilt(
                item.name,
                self._stiff.get(item.name, 0.0),
                SpringNumbers(*(trim(float(v)) for v in values_at(table, none)[:, 0])),
                trim(rub),
            )
            for item, table, rub in zip(self._drawn.couplers, self._couplers, self.rubs, strict=True)
        )
        return BuiltDevice(self._drawn, self.network, masses, couplers)

    def errors(self, lanes: int) -> Errors:
        """No errors at all, in ``lanes`` devices."""
        units, couplers, biases = len(self._names), len(self._drawn.couplers), len(self._drawn.biases)
        counts = (units, units, units, couplers, biases, biases)
        return Errors(*(np.zeros((count, lanes)) for count in counts))

    def with_errors(self, errors: Errors) -> System:
        """Devices like this one, each with its errors."""
        return replace(self.system, devices=self._devices(errors))

    def _shape(self, network: Network) -> None:
        """The network as found: its masses, and the couplings of the geometry."""
        none = self.errors(1)
        couplings, self_terms = [], {mass.name: 0.0 for mass in network.masses}
        for item, table in zip(self._drawn.couplers, self._couplers, strict=True):
            c, source, target, *_ = values_at(table, none.couplers[0][:1])[:, 0]
            couplings.append(Coupling(item.source, item.target, trim(float(c)), 0.0))
            self_terms[item.source] += float(source)
            self_terms[item.target] += float(target)
        masses = []
        leaves = {item.mass: table for item, table in zip(self._drawn.biases, self._biases, strict=True)}
        for mass in network.masses:
            q, stiffness = values_at(leaves[mass.name], np.zeros(1))[:2, 0] if mass.name in leaves else (0.0, 0.0)
            base, swing, _ = values_at(self._units[mass.name][0], np.zeros(1))[:, 0]
            k0 = float(base + self_terms[mass.name] + stiffness)
            masses.append(replace(mass, k0=trim(k0), k1=trim(float(swing)), compensation=0.0, bias=trim(float(q))))
        self.network = replace(network, masses=tuple(masses), couplings=tuple(couplings))
        plain = system_of(self.network)
        # in the order in which system_of lists them
        rows: list[list[int]] = [[] for _ in plain.names]
        for index, item in enumerate(self._drawn.couplers):
            rows[plain.index(item.source)].append(index)
            rows[plain.index(item.target)].append(index)
        self._entries = [index for row in rows for index in row]
        self._structure = plain
        self.system = replace(plain, devices=self._devices(none))

    def _devices(self, errors: Errors) -> Devices:
        place = {name: index for index, name in enumerate(self._structure.names)}
        lanes = errors.beams.shape[1]
        masses = np.zeros((8, len(place), lanes))  # base, swing, bias, quartic, cubic, friction and how it goes with x
        for index, name in enumerate(self._names):
            beams, leaves, pins = self._units[name]
            drawn = values_at(beams, np.zeros(1))
            numbers = values_at(beams, errors.beams[index]) - drawn
            numbers = numbers + values_at(leaves, errors.leaves[index]) + values_at(pins, errors.pins[index]) - drawn
            at = place[name]
            masses[0, at], masses[1, at], masses[3, at] = numbers
            masses[5:, at] = np.array(self.friction[name])[:, None]
        entries = np.zeros((5, len(self._drawn.couplers), lanes))  # c, Q, C, B, R of each coupler
        for index, (item, table) in enumerate(zip(self._drawn.couplers, self._couplers, strict=True)):
            c, source, target, *higher = values_at(table, errors.couplers[index])
            masses[0, place[item.source]] += source
            masses[0, place[item.target]] += target
            entries[:4, index] = [c, *higher]
            entries[4, index] = self.rubs[index]
        for index, (leaf, table) in enumerate(zip(self._drawn.biases, self._biases, strict=True)):
            q, stiffness, cubic, quartic = values_at(table, errors.biases[index])
            at = place[leaf.mass]
            masses[2, at] += q - stiffness * errors.posts[index] / self._scale.length
            masses[0, at] += stiffness
            masses[4, at] += cubic
            masses[3, at] += quartic
        springs = entries[:, self._entries]
        devices = Devices(*masses, *springs)
        return devices if self._stops is None else replace(devices, tilts=self._tilts(self._stops))

    def _tilts(self, stops: Mapping[str, Stop]) -> Tilts:
        """How the shuttles of the device as drawn tilt; its errors do not change that."""
        place, length = {name: index for index, name in enumerate(self._structure.names)}, self._scale.length
        masses, none = np.zeros((5, len(place))), np.zeros(1)  # K, height and stiffness of the bias, tab, rub
        stop = np.array([(stops[name].low, stops[name].high) for name in place]).T[:, :, None]
        masses[0] = self._shuttle_tilt / (self._scale.stiffness * length**2)
        for name, at in place.items():
            masses[3, at] = self._drawn.tabs.get(name, 0.0) / length
        masses[4] = self._rubbing
        for leaf, table in zip(self._drawn.biases, self._biases, strict=True):
            masses[1:3, place[leaf.mass]] = leaf.lift / length, values_at(table, none)[1, 0]
        entries = np.zeros((3, len(self._entries)))
        owners = np.repeat(np.arange(len(place)), np.diff(self._structure.row_start))
        for entry, (index, owner) in enumerate(zip(self._entries, owners, strict=True)):
            item = self._drawn.couplers[index]
            _, source, target, *_ = values_at(self._couplers[index], none)[:, 0]
            low, high = (lift / length for lift in item.lifts)
            ends = (low, high, source) if place[item.source] == owner else (high, low, target)
            entries[:, entry] = ends
        return Tilts(masses[0], *stop, *masses[1:], *entries)

    def _friction(self) -> dict[str, Bound]:
        """Bound of dry friction (Coulomb) over x, by mass, in units of F0.

        The weight of what moves with the shuttle, and the pull of a bias leaf where its eye slides on its post. What
        a rocker's post takes depends on both its ends: ``rubs``.
        """
        mu, found = self._mu, {}
        for name in self._names:
            lying = mu * self._drawn.weights[name] / self._scale.force
            least, slope, curve = self._slides.get(name, (0.0, 0.0, 0.0))
            found[name] = (lying + mu * least, mu * slope, mu * curve)
        return found


def _trimmed(bound: Bound) -> Bound:
    least, slope, curve = bound
    return trim(least), trim(slope), trim(curve)
