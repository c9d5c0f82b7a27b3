"""The notebook runs, and is kept without outputs."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from typing import Any

import pytest

NOTEBOOK = Path(__file__).parents[2] / "examples" / "design_flow.ipynb"

# cells that make the whole device take minutes
SLOW = "build"


def cells() -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(NOTEBOOK.read_text())["cells"]
    return [cell for cell in found if cell["cell_type"] == "code"]


def run(chosen: list[dict[str, Any]]) -> dict[str, Any]:
    """Execute cells in order, in one namespace and the current folder."""
    names: dict[str, Any] = {"__name__": "__main__"}
    for cell in chosen:
        exec(compile("".join(cell["source"]), f"cell {cell['id']}", "exec"), names)
    return names


def test_it_is_kept_as_written() -> None:
    text = NOTEBOOK.read_text()
    assert text == json.dumps(json.loads(text), indent=1, ensure_ascii=False) + "\n"
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in cells())
    names = [cell["id"] for cell in json.loads(text)["cells"]]
    assert len(set(names)) == len(names)


def test_every_cell_is_python() -> None:
    for cell in cells():
        ast.parse("".join(cell["source"]))


def test_it_runs_from_the_program_to_the_simulated_network(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = run([cell for cell in cells() if SLOW not in cell["metadata"].get("tags", ())])
    assert names["proof"].exhaustive
    assert (tmp_path / "draft" / "scenarios" / "corridor" / "run.gif").exists()


@pytest.mark.long
def test_it_runs_to_the_finished_device(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = run(cells())
    assert names["report"]["extracted"]["mismatches"] == 0
    assert (tmp_path / "build" / "scenarios" / "corridor" / "network.png").exists()
