"""Whole circuits as benches: a register with its tick, and the reference circuit of ``cells/reference.mdl``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from mdlcad.characterise.bench import Bench, make_bench
from mdlcad.datafolder import find_data
from mdlcad.language import Device, parse_device, read_device
from mdlcad.mapping.cell_library import Library as ThresholdLibrary
from mdlcad.mapping.mapper import Effort, map_netlist
from mdlcad.network.model import Network
from mdlcad.proof.reference import build_reference
from mdlcad.synthesis import synthesise

REFERENCE = "reference circuit"
REGISTER = "register and tick"

# how long the mapper looks for fewer masses; the circuit is to try cells, not to be small
_EFFORT = Effort(masses_made=20_000, deterministic_time=0.0)

_REGISTER = """\
mechanicalmodule register();
boundary { line a {(0, 0), (0, 9)}, line b {(0, 9), (9, 9)}, line c {(9, 9), (9, 0)}, line d {(9, 0), (0, 0)} };
sensor take { location = {(a, 0.3)}, values = {"0b0": "keep", "0b1": "take"} };
sensor data { location = {(a, 0.7)}, values = {"0b0": "zero", "0b1": "one"} };
actuator kept { location = {(c, 0.5)}, values = {"0b0": "zero", "0b1": "one"} };
module register(input clk, input take, input data, output reg kept);
  always @(posedge clk) if (take) kept <= data;
endmodule
endmechanicalmodule
"""


def register_device() -> Device:
    """A register bit with an enable."""
    return parse_device(_REGISTER, "register")


def reference_device() -> Device:
    """The reference circuit."""
    return read_device(Path(find_data("cells", "reference", ".mdl")))


def threshold_circuits(library: ThresholdLibrary, seed: int) -> tuple[Bench, ...]:
    """Both circuits, mapped with a library of kind ``parametron``."""
    made = []
    for cell, device in ((REGISTER, register_device()), (REFERENCE, reference_device())):
        network = map_netlist(synthesise(device), library, _EFFORT)
        made.append(make_bench(cell, network, build_reference(device), seed))
    return tuple(made)


def renumbered(bench: Bench, old: ThresholdLibrary, new: ThresholdLibrary) -> Bench:
    """A bench mapped with ``old`` as ``new``, of the same limits but other forces, would have made it."""
    stronger, forced = new.coupling.strength / old.coupling.strength, new.bias.force / old.bias.force
    network = bench.network
    couplings = tuple(
        replace(c, strength=c.strength * stronger, self_stiffness=c.self_stiffness * stronger)
        for c in network.couplings
    )
    masses = tuple(
        replace(
            mass,
            k0=new.mass.k0,
            k1=new.mass.k1,
            compensation=mass.compensation * stronger,
            bias=mass.bias * forced,
        )
        for mass in network.masses
    )
    made: Network = replace(network, masses=masses, couplings=couplings)
    return replace(bench, network=made)
