"""Every example in the docs that is marked as runnable does run, in a folder like a checkout."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.docs.blocks import ROOT, Block, blocks, blocks_of

BLOCKS = blocks()


def run(block: Block, at: Path) -> subprocess.CompletedProcess[str]:
    for name in ("examples", "cells", "geometry"):
        (at / name).symlink_to(ROOT / name)
    (at / "exports").mkdir()
    tools = at / ".tools"
    tools.mkdir()
    for name, module in (("mdlcad", "-m mdlcad.cli"), ("python", "")):
        (tools / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {module} "$@"\n')
        (tools / name).chmod(0o755)
    (at / "run").write_text('#!/bin/sh\nexec "$@"\n')
    (at / "run").chmod(0o755)
    if block.language == "mdl":
        (at / "example.mdl").write_text(block.text)
        command = ["mdlcad", "check", "example.mdl"]
    elif block.language == "python":
        command = ["python", "-c", block.text]
    else:
        assert block.language == "sh", f"{block.name}: no way is known to run {block.language}"
        command = ["bash", "-euc", block.text]
    command[0] = str(tools / command[0]) if (tools / command[0]).exists() else command[0]
    environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT)}
    return subprocess.run(command, cwd=at, env=environment, capture_output=True, text=True, timeout=900)


@pytest.mark.parametrize(
    "block",
    [pytest.param(block, id=block.name, marks=[pytest.mark.long] if block.long else []) for block in BLOCKS],
)
def test_it_runs(block, tmp_path):
    done = run(block, tmp_path)
    assert done.returncode == 0, f"{block.name}\n{done.stdout}\n{done.stderr}"


def test_there_are_examples_of_every_kind():
    assert {"mdl", "sh", "python"} <= {block.language for block in BLOCKS}
    assert len([block for block in BLOCKS if block.page == "extending.md"]) >= 4


@pytest.mark.parametrize(
    ("language", "text"),
    [
        ("sh", "mdlcad check nowhere.mdl\n"),
        ("mdl", "mechanicalmodule m(\n"),
        ("python", "import nothing_of_that_name\n"),
    ],
)
def test_an_example_that_does_not_work_is_noticed(language, text, tmp_path):
    assert run(Block("here", 1, language, text, False), tmp_path).returncode != 0


def test_a_mark_without_a_block_is_noticed():
    with pytest.raises(ValueError, match="1 blocks are marked, 0 can be run"):
        blocks_of("here", "<!-- run -->\nwords\n```sh\ntrue\n```\n")
