"""Calls in processes of their own: their results, their errors, and that none is left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from mdlcad.aside import Aside
from mdlcad.errors import SignoffError


def gone(pid: int, within: float = 10.0) -> bool:
    """Whether the process ends in time; one that has ended and waits to be collected is gone."""
    until = time.monotonic() + within
    while time.monotonic() < until:
        try:
            state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            return True
        if state == "Z":
            return True
        time.sleep(0.05)
    return False


def joined(left: bytes, right: bytes) -> bytes:
    return left + right


def refused(reason: str) -> None:
    raise SignoffError(reason)


def test_results_and_errors_come_back_whatever_their_size() -> None:
    half = bytes(3_000_000)
    with Aside(joined, half, half) as sum_of, Aside(refused, "too long by 3 mm") as none:
        assert sum_of.result() == half + half
        with pytest.raises(SignoffError, match="too long by 3 mm"):
            none.result()


def test_a_child_that_is_killed_is_told_of_and_one_not_waited_for_is_ended() -> None:
    with Aside(os._exit, 7) as lost, pytest.raises(RuntimeError, match="ended with code 7"):
        lost.result()
    with Aside(time.sleep, 60.0) as slow:
        child = slow._process.pid
        assert child is not None
    assert gone(child, 1.0)


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_no_child_outlives_its_parent_however_that_ends(end: signal.Signals, tmp_path: Path) -> None:
    program = tmp_path / "parent.py"
    program.write_text(
        "import time\n"
        "from mdlcad.aside import Aside\n"
        "if __name__ == '__main__':\n"
        "    with Aside(time.sleep, 60.0) as slow:\n"
        "        print(slow._process.pid, flush=True)\n"
        "        slow.result()\n"
    )
    with subprocess.Popen(
        [sys.executable, program], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as parent:
        assert parent.stdout is not None
        child = int(parent.stdout.readline())
        time.sleep(0.5)
        parent.send_signal(end)
        parent.wait(10)
    assert gone(child)
