"""The name that a kernel is kept under follows every file of its stage, and no other."""

from pathlib import Path

import pytest

from mdlcad import compiled


def kept_as(monkeypatch: pytest.MonkeyPatch, root: Path) -> str:
    def twice(x: float) -> float:
        return 2.0 * x

    monkeypatch.setattr(compiled, "__file__", str(root / "compiled.py"))
    twice.__module__ = "mdlcad.placement.sites.kernels"
    made = compiled.kernel(twice)
    assert made(2.0) == 4.0
    return str(made.py_func.__qualname__)


def test_a_change_in_the_stage_makes_a_kernel_anew(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("placement/costs.py", "placement/sites/kernels.py", "routing/check.py"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("x = 1\n")
    first = kept_as(monkeypatch, tmp_path)
    (tmp_path / "routing" / "check.py").write_text("x = 2\n")
    assert kept_as(monkeypatch, tmp_path) == first
    (tmp_path / "placement" / "costs.py").write_text("x = 2\n")
    second = kept_as(monkeypatch, tmp_path)
    (tmp_path / "placement" / "sites" / "kernels.py").write_text("x = 2\n")
    assert len({first, second, kept_as(monkeypatch, tmp_path)}) == 3
