"""Numbers of a device's flexures over errors of their walls, as polynomials through a grid of errors.

The reduced models of ``numbers`` are slow beside these, from which hundreds of devices with errors of their own take
their numbers. Flexures whose dimensions are the same share theirs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import astuple

import numpy as np
from numpy.typing import NDArray

from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.fit import Scale, fit_unit
from mdlcad.mechanics.flexure import signal_matrix
from mdlcad.mechanics.leaves import LeafKind
from mdlcad.mechanics.preload import RIGID_CARRIER
from mdlcad.mechanics.reduced import UnitNumbers
from mdlcad.mechanics.strains import reach_at
from mdlcad.mechanics.unit import clock_swing
from mdlcad.network.model import Network
from mdlcad.signoff.drawn import BiasDrawn, CouplerDrawn, Drawn
from mdlcad.signoff.measure import UnitSeen
from mdlcad.signoff.measure_leaf import chain_of_leaf, thickened
from mdlcad.signoff.numbers import (
    BiasNumbers,
    Bound,
    LeafLaw,
    bias_numbers,
    leaf_law,
    post_rub,
    spring_numbers,
    unit_numbers,
)

Floats = NDArray[np.float64]


class FlexureTables:
    """Tables of a device as drawn.

    Attributes:
        units: by mass, (base, swing, quartic) over errors of beams, of leaves and of the preload.
        couplers: for each coupler of ``drawn``, the fields of ``SpringNumbers`` over errors of its walls; rubs: R of
            ``simulation.devices``, the friction of its eye on its post, 0 of those that have none.
        biases: for each bias leaf, its q, stiffness, and terms of third and fourth order over errors of its walls;
            slides: by mass, what presses its eye on its post over x.
    """

    units: dict[str, tuple[Floats, Floats, Floats]]
    couplers: list[Floats]
    rubs: list[float]
    biases: list[Floats]
    slides: dict[str, Bound]

    def __init__(
        self,
        drawn: Drawn,
        network: Network,
        sizing: Sizing,
        carriers: Mapping[str, float],
        process: Process,
        grid: Sequence[float],
    ) -> None:
        """``carriers``: N/mm, by coupling; ``grid``: errors (mm) at which it is tabulated.

        Raises:
            ArithmeticError: a flexure finds no equilibrium at its farthest.
        """
        self._drawn, self._stiff, self._grid, self._mu = drawn, carriers, np.array(grid), process.stack.friction
        self._scale = Scale(sizing.law.stiffness_unit, process.unit.throw_unit)
        self._throw = sizing.rules.throw
        self._swing = clock_swing(network, sizing.law)
        peaks = {unit.mass: unit.amplitude / process.unit.throw_unit for unit in sizing.units}
        self._reaches = [process.unit.throw_unit * max(reach_at(network, peaks, p).values()) for p in (0.0, 1.0, 2.0)]
        self._names = [mass.name for mass in network.masses]
        self.units = self._unit_tables()
        self.couplers, self.rubs = self._coupler_tables()
        self.biases, self.slides = self._bias_tables()

    def _polynomials(self, values: Sequence[Sequence[float] | Floats]) -> Floats:
        """float[degree + 1, numbers]: coefficients, highest power first."""
        rows = np.array(values, dtype=np.float64)
        return np.asarray(np.linalg.solve(np.vander(self._grid), rows), dtype=np.float64)

    def _unit_tables(self) -> dict[str, tuple[Floats, Floats, Floats]]:
        known: dict[object, tuple[Floats, Floats, Floats]] = {}
        laws: dict[object, UnitNumbers] = {}
        tables = {}

        def fit(seen: UnitSeen, alike: object, beams: float, leaves: float, preload: float) -> list[float]:
            key = (alike, beams, leaves)
            if key not in laws:
                laws[key] = unit_numbers(seen, self._drawn.unit_sheet, beams, leaves)
            found = fit_unit(laws[key], preload, self._swing, self._reaches, self._scale)
            return [found.base, found.swing, found.quartic]

        for name in self._names:
            seen = self._drawn.units[name]
            alike = _rounded((seen.left, seen.right, seen.plan))
            key = (alike, round(seen.preload, 3))
            if key not in known:
                known[key] = (
                    self._polynomials([fit(seen, alike, error, 0.0, seen.preload) for error in self._grid]),
                    self._polynomials([fit(seen, alike, 0.0, error, seen.preload) for error in self._grid]),
                    self._polynomials([fit(seen, alike, 0.0, 0.0, seen.preload + error) for error in self._grid]),
                )
            tables[name] = known[key]
        return tables

    def _coupler_tables(self) -> tuple[list[Floats], list[float]]:
        known: dict[object, list[LeafLaw]] = {}
        rubs: dict[object, float] = {}
        tables, found = [], []
        for item in self._drawn.couplers:
            key = (item.kind, *_leaf_key(item))
            if key not in known:
                chain = chain_of_leaf(item.leaf, item.sheet)
                nominal = leaf_law(chain, item.kind, self._throw)
                known[key] = [_scaled(nominal, factor) for factor in self._factors(item)]
                turns = item.kind is LeafKind.ROCKER
                rubs[key] = self._mu * post_rub(chain, nominal, self._scale, self._drawn.post_radius) if turns else 0.0
            found.append(rubs[key])
            # a coupling that is not the network's has no carrier that was ever computed: take that as rigid
            carrier = min(self._stiff.get(item.name, RIGID_CARRIER), RIGID_CARRIER)
            rows = []
            for law in known[key]:
                rows.append(astuple(spring_numbers(law, carrier, self._scale)))
            tables.append(self._polynomials(rows))
        return tables, found

    def _factors(self, item: CouplerDrawn | BiasDrawn) -> list[float]:
        """Over the grid of errors, the flexure's stiffness over that of the drawn one.

        It bends as it did, at other forces: what is of higher order goes with the same factor.
        """
        chains = [chain_of_leaf(thickened(item.leaf, error), item.sheet) for error in (0.0, *self._grid)]
        nominal, *others = [float(signal_matrix(chain)[0, 0]) for chain in chains]
        return [other / nominal for other in others]

    def _bias_tables(self) -> tuple[list[Floats], dict[str, Bound]]:
        known: dict[object, tuple[Floats, BiasNumbers]] = {}
        tables, slides = [], dict[str, Bound]()
        for item in self._drawn.biases:
            key = (*_leaf_key(item), round(item.offset, 3))
            if key not in known:
                chain = chain_of_leaf(item.leaf, item.sheet)
                found = bias_numbers(chain, item.offset, self._throw, self._scale, self._drawn.post_radius)
                nominal = np.array([found.bias, found.stiffness, found.cubic, found.quartic])
                known[key] = self._polynomials([nominal * factor for factor in self._factors(item)]), found
            table, numbers = known[key]
            slides[item.mass] = numbers.rub
            tables.append(table)
        return tables, slides


def values_at(polynomials: Floats, errors: Floats) -> Floats:
    """float[numbers, L] of polynomials float[degree + 1, numbers] at ``errors`` float[L]."""
    value = np.zeros((polynomials.shape[1], len(errors)))
    for row in polynomials:
        value = value * errors + row[:, None]
    return value


def _scaled(law: LeafLaw, factor: float) -> LeafLaw:
    return LeafLaw(*(factor * value for value in astuple(law)))


def _leaf_key(item: CouplerDrawn | BiasDrawn) -> tuple[object, ...]:
    return _rounded(item.leaf), item.sheet


def _rounded(value: object) -> object:
    """Nested numbers rounded to a micrometre: dimensions nearer than that are one, drawn on a grid of a tenth."""
    if isinstance(value, float):
        return round(value, 3) + 0.0
    if isinstance(value, tuple):
        return tuple(_rounded(item) for item in value)
    fields = getattr(value, "__dataclass_fields__", None)
    # where a part stands is not what it is
    return tuple(_rounded(getattr(value, name)) for name in fields if name not in _PLACES) if fields else value


_PLACES = ("face", "row", "out")
