"""A whole device, built once for all tests of the viewer (the voter: seconds, up to its drawings)."""

import shutil
from pathlib import Path

import pytest

from mdlcad.cli import HOLDS, main
from mdlcad.view.scene import Scene, open_scene

VOTER = Path(__file__).parents[2] / "examples" / "voter.mdl"


@pytest.fixture(scope="session")
def voter(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("view") / "voter"
    assert main(["build", str(VOTER), "--to", "drc", "-o", str(folder)]) == HOLDS
    return folder


@pytest.fixture(scope="session")
def scene(voter: Path) -> Scene:
    return open_scene(voter)


@pytest.fixture
def copy(voter: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(voter, tmp_path / "copy"))
