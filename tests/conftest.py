"""Builds that tests of several packages look at, made once. They are read-only: copy before changing."""

import fcntl
import os
from pathlib import Path

import pytest

from mdlcad.cli import HOLDS, main

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def voter_build(tmp_path_factory) -> Path:
    """examples/voter.mdl, built whole: by the first test process that wants it, for all of them."""
    place = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        place = place.parent  # each process has a folder of its own in that of the run
    folder = place / "voter-build" / "voter"
    folder.parent.mkdir(exist_ok=True)
    with (folder.parent / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        # a build is there as a whole or not at all
        if not folder.is_dir():
            assert main(["build", str(ROOT / "examples" / "voter.mdl"), "-o", str(folder)]) == HOLDS
    return folder
