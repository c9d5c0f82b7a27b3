"""From the laws of parts to the numbers of the network's model, in units of X0, S0 and F0 = S0 X0 of the process.

Lengths in mm, forces in N on the one side; k, c and s of ``network.model`` on the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.optimize import brentq

from mdlcad.mechanics.reduced import UnitNumbers, force_of


@dataclass(frozen=True, slots=True)
class Scale:
    """Units of the network: ``stiffness`` S0 in N/mm, ``length`` X0 in mm."""

    stiffness: float
    length: float

    @property
    def force(self) -> float:
        """F0, N."""
        return self.stiffness * self.length


@dataclass(frozen=True, slots=True)
class UnitFit:
    """k = base + swing p and the quartic that come nearest to a unit's law over what its shuttle does."""

    base: float
    swing: float
    quartic: float


_POINTS = 9


def fit_unit(numbers: UnitNumbers, preload: float, swing: float, reaches: Sequence[float], scale: Scale) -> UnitFit:
    """Fit the network's potential to a unit's law by least squares of the force.

    Args:
        preload: of the clock block with the clock in its middle, mm; swing: half stroke of the clock, mm.
        reaches: how far shuttles go at p = 0, 1 and 2, mm.
    """
    rows, forces = [], []
    for p, reach in enumerate(reaches):
        at = np.linspace(reach / _POINTS, reach, _POINTS)
        x = at / scale.length
        rows.append(np.stack([x, p * x, x**3], axis=1))
        forces.append(force_of(numbers, preload + (p - 1) * swing, at) / scale.force)
    found = np.linalg.lstsq(np.concatenate(rows), np.concatenate(forces), rcond=None)[0]
    return UnitFit(*map(float, found))


_DEGREE = 6
"""Of the polynomials through ``fit_unit``: within 1e-5 of it (a test says so) over any range that units span."""


class UnitCurve:
    """``fit_unit`` as a function of the preload: all units of a device have one law, and differ in their preload."""

    def __init__(
        self,
        numbers: UnitNumbers,
        swing: float,
        reaches: Sequence[float],
        scale: Scale,
        least: float,
        most: float,
    ) -> None:
        """Tabulate the fit for preloads from ``least`` to ``most``, mm; the rest as ``fit_unit``.

        Raises:
            ArithmeticError: the law finds no equilibrium at one of them.
        """
        self.least, self.most = least, most
        nodes = (least + most) / 2.0 + (most - least) / 2.0 * np.cos(
            np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1)
        )
        fits = [fit_unit(numbers, float(node), swing, reaches, scale) for node in nodes]
        self._base, self._swing, self._quartic = (
            Chebyshev.fit(nodes, [getattr(fit, name) for fit in fits], _DEGREE, domain=[least, most])
            for name in ("base", "swing", "quartic")
        )

    def at(self, preload: float) -> UnitFit:
        """What a unit with that preload (mm) is."""
        return UnitFit(float(self._base(preload)), float(self._swing(preload)), float(self._quartic(preload)))

    def preload_for(self, own: float) -> float:
        """The preload, mm, with which a unit's k at p = 1 is ``own``; k falls as it grows.

        The fit is linear in p, so this is also the preload that comes nearest to the k asked for at p = 0, 1 and 2
        together, the swing being what the stroke that all units share makes it.

        Raises:
            ArithmeticError: none between ``least`` and ``most`` does that.
        """

        def excess(preload: float) -> float:
            fit = self.at(preload)
            return fit.base + fit.swing - own

        if excess(self.least) < 0.0 or excess(self.most) > 0.0:
            raise ArithmeticError(
                f"no preload from {self.least:.3f} to {self.most:.3f} mm makes a unit of k = {own:.2f}"
            )
        return float(brentq(excess, self.least, self.most, xtol=1e-7))


@dataclass(frozen=True, slots=True)
class InRow:
    """What a coupler or rocker in a row with its carrier does to its two masses.

    Attributes:
        share: of a motion of the source, what reaches the flexure; strength: between the two, of the sign of
            ``across``; source, target: what it adds to them.
    """

    share: float
    strength: float
    source: float
    target: float


def in_row(own: float, across: float, far: float, carrier: float) -> InRow:
    """Put a carrier under a flexure's far end, the source's. Stiffnesses in one unit; exact for what is linear.

    Args:
        own, far: of the flexure at its hub's end and at its far end; across: between the two, as in a matrix.
    """
    share = carrier / (carrier + far)
    return InRow(share, across * share, far * share, own - across**2 / (carrier + far))
