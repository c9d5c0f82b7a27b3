"""Build folders with as much in them as a scenario needs."""

from __future__ import annotations

from pathlib import Path

from mdlcad.artefact import from_json, to_json
from mdlcad.language import read_device
from mdlcad.mapping import Effort, load_library, map_netlist
from mdlcad.network.model import Network
from mdlcad.synthesis import synthesise

EXAMPLES = Path(__file__).parents[2] / "examples"


# enough for a network that behaves; it need not be small
QUICKLY = Effort(masses_made=10_000, deterministic_time=0.0)


def make_build(name: str, folder: Path, effort: Effort | None = None) -> Path:
    """device.json and network.json of an example in ``folder``/``name``."""
    device = read_device(EXAMPLES / f"{name}.mdl")
    place = folder / name
    place.mkdir()
    (place / "device.json").write_bytes(to_json(device))
    network = map_netlist(synthesise(device), load_library("parametron"), effort)
    (place / "network.json").write_bytes(to_json(network))
    return place


def network_of(build: Path) -> Network:
    return from_json((build / "network.json").read_bytes(), Network)
