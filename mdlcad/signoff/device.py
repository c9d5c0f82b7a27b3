"""A device as its files draw it, proved with all shuttles held from tilting and with all tilting."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mdlcad.mechanics import Process, Sizing
from mdlcad.network.model import Network
from mdlcad.parts.stiffness import CarrierStiffness
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.outcome import Proof
from mdlcad.proof.prove import prove
from mdlcad.signoff.drawn import measure_device
from mdlcad.signoff.extraction import Built, BuiltDevice
from mdlcad.signoff.lvs import Recovered
from mdlcad.signoff.readback import ReadBody
from mdlcad.signoff.sections import read_cut
from mdlcad.signoff.stops import stops_of
from mdlcad.signoff.tilting import TiltingProof, tilting_proof


@dataclass(frozen=True, slots=True, eq=False)
class ProvedDevice:
    """What the files draw, and what was proved of it.

    Attributes:
        built: as measured; loose: the same, its shuttles tilting between their stops.
        extracted: the proof with shuttles held; tilting: that with tilting ones.
    """

    built: BuiltDevice
    loose: Built
    extracted: Proof
    tilting: TiltingProof


def prove_device(
    folder: Path,
    found: Sequence[ReadBody],
    recovered: Recovered,
    network: Network,
    sizing: Sizing,
    carriers: Sequence[CarrierStiffness],
    process: Process,
    reference: Behaviour,
    seed: int,
    workers: int,
) -> ProvedDevice:
    """Measure and prove the device of a build folder.

    Args:
        found: bodies of its STEP file; recovered: who of them moves with whom; process: with the plates of both decks.

    Raises:
        SignoffError: the geometry cannot be measured, lacks a unit, or has a flexure without equilibrium.
    """
    drawn = measure_device(found, read_cut(folder, process), recovered, process)
    built = Built(drawn, network, sizing, carriers, process)
    extracted = prove(built.network, reference, seed=seed, workers=workers, built=built.system)
    stops = stops_of(found, recovered, drawn.units, process, sizing.rules)
    loose = Built(drawn, network, sizing, carriers, process, stops=stops)
    tilting = prove(loose.network, reference, seed=seed, workers=workers, built=loose.system)
    return ProvedDevice(built.record(), loose, extracted, tilting_proof(tilting, stops, process, sizing.law))
