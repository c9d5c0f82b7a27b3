"""The recipe of docs/compare.md, run as it stands there."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.compare.edits import copy_of, move_unit, remove_link

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.skipif(shutil.which("git") is None, reason="NO GIT: the recipe for git was not tried")
def test_the_git_recipe_of_the_manual_works(voter_build, tmp_path):
    manual = (ROOT / "docs" / "compare.md").read_text()
    recipe, compare = re.findall(r"```sh\n(.*?)```", manual[manual.index("## In git") :], re.S)
    tools = tmp_path / "tools"
    tools.mkdir()
    for name, words in (("mdlcad", "-m mdlcad.cli "), ("python", "")):
        (tools / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {words}"$@"\n')
        (tools / name).chmod(0o755)
    repository = tmp_path / "repository"
    (repository / "exports").mkdir(parents=True)
    build = copy_of(voter_build, repository / "exports" / "voter")
    environment = os.environ | {
        "PATH": f"{tools}:{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "GIT_CONFIG_GLOBAL": "/dev/null",
        "GIT_CONFIG_SYSTEM": "/dev/null",
        **{f"GIT_{who}_{what}": "nobody@nowhere" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")},
    }

    def shell(words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["sh", "-c", words], cwd=repository, env=environment, capture_output=True, text=True, timeout=120
        )

    done = shell(
        "git init -q . && " + recipe.replace("\n", " && ").rstrip(" &") + " && git add -A && git commit -qm one"
    )
    assert done.returncode == 0, done.stderr
    same = shell(compare)
    assert (same.returncode, same.stderr) == (0, "")
    mass, link = move_unit(build, 0.05), remove_link(build)
    told = shell("git diff --no-ext-diff exports/voter/network.json").stdout
    changed = [line for line in told.splitlines() if re.match(r"[-+](?![-+])", line)]
    assert [line.startswith(f"-couplings {link}: ") for line in changed] == [True]
    different = shell(compare)
    assert different.returncode == 1
    assert f"> unit {mass}: by 0.050 mm" in different.stdout
    assert f"- coupling {link}" in different.stdout
