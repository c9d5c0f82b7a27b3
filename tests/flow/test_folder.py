"""A build folder is whole or is not there."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace

import pytest

from mdlcad.artefact import load, write_atomic
from mdlcad.errors import UsageError
from mdlcad.flow.folder import REPORT, new_folder
from mdlcad.flow.step import check_order
from mdlcad.flow.steps import STEPS
from mdlcad.report.report import Report


def fill(folder, words):
    (folder / REPORT).write_text(words)


def test_a_folder_takes_its_place_when_it_is_whole(tmp_path):
    with new_folder(tmp_path / "maze") as folder:
        fill(folder, "one")
        assert not (tmp_path / "maze").exists()
    assert (tmp_path / "maze" / REPORT).read_text() == "one"
    with new_folder(tmp_path / "maze") as folder:
        fill(folder, "two")
        assert (tmp_path / "maze" / REPORT).read_text() == "one"
    assert (tmp_path / "maze" / REPORT).read_text() == "two"
    assert [path.name for path in tmp_path.iterdir()] == ["maze"]


def test_a_failed_build_leaves_the_old_folder_and_nothing_else(tmp_path):
    with new_folder(tmp_path / "maze") as folder:
        fill(folder, "one")
    with pytest.raises(RuntimeError), new_folder(tmp_path / "maze") as folder:
        fill(folder, "two")
        raise RuntimeError
    assert (tmp_path / "maze" / REPORT).read_text() == "one"
    assert [path.name for path in tmp_path.iterdir()] == ["maze"]


def test_a_killed_build_leaves_the_old_folder_and_the_next_cleans_up(tmp_path):
    with new_folder(tmp_path / "maze") as folder:
        fill(folder, "one")
    program = (
        "import sys, time; from pathlib import Path; from mdlcad.flow.folder import new_folder\n"
        "with new_folder(Path(sys.argv[1])) as folder:\n"
        "    (folder / 'report.json').write_text('two'); print('filled', flush=True); time.sleep(60)\n"
    )
    child = subprocess.Popen([sys.executable, "-c", program, str(tmp_path / "maze")], stdout=subprocess.PIPE)
    assert child.stdout.readline() == b"filled\n"
    os.kill(child.pid, signal.SIGKILL)
    child.wait()
    assert (tmp_path / "maze" / REPORT).read_text() == "one"
    assert len(list(tmp_path.iterdir())) == 2
    time.sleep(0.05)
    with new_folder(tmp_path / "maze") as folder:
        fill(folder, "three")
    assert [path.name for path in tmp_path.iterdir()] == ["maze"]
    assert (tmp_path / "maze" / REPORT).read_text() == "three"


def test_a_folder_that_is_no_build_is_never_replaced(tmp_path):
    precious = tmp_path / "photos"
    precious.mkdir()
    (precious / "cat.png").write_text("cat")
    with pytest.raises(UsageError, match="holds no build"), new_folder(precious):
        pass
    with pytest.raises(UsageError, match="is a file"), new_folder(precious / "cat.png"):
        pass
    assert (precious / "cat.png").read_text() == "cat"
    (tmp_path / "link").symlink_to(tmp_path / "gone")
    with pytest.raises(UsageError, match="link that leads nowhere"), new_folder(tmp_path / "link"):
        pass


def test_a_file_that_cannot_be_written_leaves_nothing(tmp_path):
    (tmp_path / "folder").mkdir()
    with pytest.raises(OSError, match="directory"):
        write_atomic(tmp_path / "folder", b"page")
    assert [path.name for path in tmp_path.iterdir()] == ["folder"]


@pytest.mark.parametrize("place", ["file/maze", "file/deeper/maze", "x" * 300])
def test_a_place_where_no_folder_can_be_made_is_refused(tmp_path, place):
    (tmp_path / "file").write_text("mine")
    with (
        pytest.raises(UsageError, match=r"no folder can be made there: .*; give another with -o"),
        new_folder(tmp_path / place),
    ):
        pass
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize(
    ("content", "words"), [(None, "missing"), ("{", "not whole JSON"), ("[]", "shape"), ("{}", "shape")]
)
def test_a_broken_artefact_is_named(tmp_path, content, words):
    if content is not None:
        (tmp_path / REPORT).write_text(content)
    with pytest.raises(UsageError, match=words) as problem:
        load(tmp_path, REPORT, Report)
    assert REPORT in str(problem.value)


def test_every_step_is_given_what_it_needs():
    check_order(STEPS)
    with pytest.raises(ValueError, match="needs"):
        check_order(tuple(reversed(STEPS)))
    # what runs beside another cannot need what that one makes
    with pytest.raises(ValueError, match="extraction needs"):
        check_order([replace(step, beside="files") if step.name == "extraction" else step for step in STEPS])
