"""Builds that tests of several packages look at, made once. They are read-only: copy before changing."""

from pathlib import Path

import pytest

from mdlcad.cli import HOLDS, main

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def voter_build(tmp_path_factory) -> Path:
    """examples/voter.mdl, built whole."""
    folder = tmp_path_factory.mktemp("build") / "voter"
    assert main(["build", str(ROOT / "examples" / "voter.mdl"), "-o", str(folder)]) == HOLDS
    return folder
