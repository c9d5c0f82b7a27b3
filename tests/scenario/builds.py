"""Build folders with as much in them as a scenario needs."""

from __future__ import annotations

from pathlib import Path

from mdlcad.artefact import from_json, to_json
from mdlcad.language import read_device
from mdlcad.mapping import load_library, map_netlist
from mdlcad.network.model import Network
from mdlcad.synthesis import synthesise

EXAMPLES = Path(__file__).parents[2] / "examples"


def make_build(name: str, folder: Path) -> Path:
    """device.json and network.json of an example in ``folder``/``name``."""
    device = read_device(EXAMPLES / f"{name}.mdl")
    place = folder / name
    place.mkdir()
    (place / "device.json").write_bytes(to_json(device))
    (place / "network.json").write_bytes(to_json(map_netlist(synthesise(device), load_library("parametron"))))
    return place


def network_of(build: Path) -> Network:
    return from_json((build / "network.json").read_bytes(), Network)
