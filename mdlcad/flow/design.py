"""What the first steps run: from the program to a proven network and the sizes of its parts."""

from __future__ import annotations

from dataclasses import replace

from mdlcad.errors import SignoffError, UsageError
from mdlcad.flow.outline import outline_of
from mdlcad.flow.state import Job, State, need
from mdlcad.flow.step import Progress
from mdlcad.language import Device, read_device
from mdlcad.mapping import map_netlist
from mdlcad.mechanics import size
from mdlcad.network.model import CouplingKind
from mdlcad.proof.prove import prove
from mdlcad.proof.reference import build_reference
from mdlcad.synthesis import synthesise


def read(job: Job, state: State, progress: Progress) -> State:
    """The device that the program describes."""
    if job.source is None:
        raise SignoffError("there is no program to read")
    return with_device(state, read_device(job.source))


def with_device(state: State, device: Device) -> State:
    """``state`` with a device and what follows from it."""
    return replace(state, device=device, outline=outline_of(device))


def gates(job: Job, state: State, progress: Progress) -> State:
    """The behaviour as gates and registers."""
    return replace(state, netlist=synthesise(need(state.device)))


def masses(job: Job, state: State, progress: Progress) -> State:
    """The network of masses, like an earlier one if there is one to be like."""
    like, netlist = job.like, need(state.netlist)
    if like is not None and like.netlist == netlist:
        return replace(state, network=like.network)
    before = None if like is None else like.before()
    return replace(state, network=map_netlist(netlist, job.cells, before=before))


def proved(job: Job, state: State, progress: Progress) -> State:
    """The network, simulated against the program."""
    proof = prove(need(state.network), build_reference(need(state.device)), seed=job.seed, workers=job.workers)
    return replace(state, proof=proof)


def refuted(state: State) -> str | None:
    """Why nothing can be made of a network: that it does not behave as the program says; None if it does."""
    proof = need(state.proof)
    if proof.holds:
        return None
    words = "; ".join(str(item) for item in proof.first_mismatches[:3]) or "nothing was checked"
    return f"the network does not behave as the program says: {words}"


def behaviour_words(state: State) -> str:
    """What was proved, in words."""
    proof = need(state.proof)
    kind = "exhaustive" if proof.exhaustive else "sampled"
    return (
        f"{proof.transitions_checked} of {proof.transitions_total} transitions right ({kind}), "
        f"{proof.decisions} decisions, margin {proof.margin:.2f}"
    )


def sized(job: Job, state: State, progress: Progress) -> State:
    """Sizes of units, couplers, rockers and bias leaves, and the rules that follow for the layout."""
    network = need(state.network)
    clocked = [item.name for item in network.couplings if item.kind is not CouplingKind.LINEAR or item.d1]
    if clocked:
        raise UsageError(
            f"the cell library {network.cells} couples {len(clocked)} pairs of masses by clocked or latching springs "
            f"(the first is {clocked[0]}), for which there are no parts yet; build with --to proof, or with --cells "
            "parametron"
        )
    return replace(state, sizing=size(network, job.process, need(state.proof).peaks))
