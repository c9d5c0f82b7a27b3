"""What a person might do to a copy of a build by hand."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest


@contextmanager
def edited(build: Path, name: str) -> Iterator[Any]:
    """The JSON of a file, written back when the block ends."""
    path = build / name
    value = json.loads(path.read_text())
    yield value
    path.write_text(json.dumps(value, indent=2))


def copy_of(build: Path, place: Path) -> Path:
    shutil.copytree(build, place)
    return place


def shifted(rings: list[str], dx: float) -> list[str]:
    return [" ".join(f"{float(x) + dx!r},{y}" for x, y in (p.split(",") for p in ring.split(" "))) for ring in rings]


def move_unit(build: Path, dx: float) -> str:
    """Move a unit in placement and parts; its mass."""
    with edited(build, "placement.json") as placement:
        unit = placement["masses"][1]
        unit["x"] += dx
    with edited(build, "parts.json") as parts:
        body = next(item for item in parts["bodies"] if item["name"] == f"unit.{unit['mass']}")
        for key in ("section", "assembled", "envelope"):
            if body.get(key):
                body[key] = shifted(body[key], dx)
    return unit["mass"]


def remove_link(build: Path) -> str:
    """Take a coupling out of network, layout and parts; its name."""
    with edited(build, "network.json") as network:
        gone = next(item for item in network["couplings"] if item["strength"] > 0)
        network["couplings"].remove(gone)
    name = f"{gone['source']}->{gone['target']}"
    with edited(build, "layout.json") as layout:
        layout["couplers"] = [item for item in layout["couplers"] if item["coupling"] != name]
    with edited(build, "parts.json") as parts:
        parts["bodies"] = [item for item in parts["bodies"] if item["name"] != f"coupler.{name}"]
    return name


def run(capsys: pytest.CaptureFixture[str], *arguments: object) -> tuple[int, str, str]:
    """Exit code, output and errors of a command."""
    from mdlcad.cli import main

    capsys.readouterr()
    code = main([str(item) for item in arguments])
    said = capsys.readouterr()
    return code, said.out, said.err


Edit = Callable[[Path], object]
