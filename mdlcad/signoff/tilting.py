"""The second proof of a device as drawn: its shuttles tilt as far as their beams and the plates let them.

Of how plates hold shuttles from tilting there are two ends. With plates that lie against everything none tilts: that is
the first proof, ``extracted``. With the gaps as drawn, a shuttle tilts freely up to the angle at which it surely meets
something (``stops``): that is this one. Wherever it meets a plate before, that brakes it. A lever of L meets one at an
angle of g / L or more, g the gap, and of the moment M the beams then hold K g / L, so what is left presses with
N = (M - K g / L) / L, which is at most M^2 / (4 K g), whatever L. Times the coefficient of friction that bounds what
plates can brake it with; the proof has it act all the time.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from msgspec import UNSET

from mdlcad.mechanics.leaves import trim
from mdlcad.mechanics.process import Process
from mdlcad.mechanics.unit import UnitLaw
from mdlcad.proof.outcome import Proof
from mdlcad.signoff.stops import Stop

TILTING = "tilting.json"
"""Artefact of this proof."""


@dataclass(frozen=True, slots=True)
class ShuttleTilt:
    """A shuttle in this proof.

    Attributes:
        low, high: the angles about x that it cannot pass, rad.
        largest: the largest that it would have without them, rad.
        rub: bound of what plates brake it with there, in F0.
    """

    mass: str
    low: float
    high: float
    largest: float
    rub: float

    @property
    def stopped(self) -> bool:
        """Whether it surely meets a plate."""
        return self.largest > min(-self.low, self.high)


@dataclass(frozen=True, slots=True)
class TiltingProof:
    """The artefact tilting.json: the proof with tilting shuttles, and how far they tilt in it."""

    proof: Proof
    shuttles: tuple[ShuttleTilt, ...]


def rubbing(process: Process, law: UnitLaw) -> float:
    """Bound of the plates' friction on a shuttle, in F0 over the square of the angle that its beams would allow."""
    return process.stack.friction * law.shuttle_tilt / (4.0 * process.stack.z_gap) / law.force_unit


def stops_found(found: TiltingProof) -> dict[str, Stop]:
    """The stops of every shuttle, by mass, as they were found for this proof."""
    return {item.mass: Stop(item.low, item.high) for item in found.shuttles}


def tilting_proof(proof: Proof, stops: Mapping[str, Stop], process: Process, law: UnitLaw) -> TiltingProof:
    """What is kept of ``proof``, in which shuttles tilted until they met their ``stops``."""
    if proof.tilts is UNSET:
        raise ValueError("the shuttles of this proof were held")
    rub = rubbing(process, law)
    shuttles = tuple(
        ShuttleTilt(mass, stops[mass].low, stops[mass].high, trim(angle), trim(rub * angle**2))
        for mass, angle in proof.tilts.items()
    )
    return TiltingProof(proof, shuttles)
