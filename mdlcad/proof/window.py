"""The window of clock periods and dampings in which a device behaves."""

from __future__ import annotations

from dataclasses import dataclass, replace

from mdlcad.network.model import Network
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.prove import prove


@dataclass(frozen=True, slots=True)
class WindowPoint:
    """One setting of the dynamics, and whether the proof held there.

    ``margin`` is the smallest |x| at a read-out, 0 where the device did not even tick.
    """

    period: float
    damping: float
    holds: bool
    margin: float


def find_window(
    network: Network,
    reference: Behaviour,
    periods: tuple[float, ...],
    dampings: tuple[float, ...],
    *,
    decisions: int = 20_000,
    seed: int = 0,
    workers: int = 2,
) -> tuple[WindowPoint, ...]:
    """Prove ``network`` at every period T and damping b, all else equal; periods outermost.

    The time step follows the period (``steps_for``), so slow clocks take longer.
    """
    points = []
    for period in periods:
        for damping in dampings:
            setting = replace(network, dynamics=replace(network.dynamics, period=period, damping=damping))
            proof = prove(setting, reference, decisions=decisions, seed=seed, workers=workers)
            points.append(WindowPoint(period, damping, proof.holds, proof.margin))
    return tuple(points)
