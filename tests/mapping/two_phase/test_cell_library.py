"""The library's data, and what is said about data that cannot be used."""

from __future__ import annotations

import subprocess
import tomllib
from importlib.util import find_spec
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mdlcad.errors import UsageError
from mdlcad.mapping.request import MappingRequest
from mdlcad.mapping.two_phase import liberty, load_two_phase
from mdlcad.mapping.two_phase.function import truth_table
from mdlcad.network.model import CouplingKind
from tests.mapping.two_phase.programs import ROOT

FILE = ROOT / "cells" / "two_phase" / "library.toml"


def spoilt(folder: Path, before: str, after: str) -> str:
    text = FILE.read_text(encoding="utf-8")
    assert before in text
    path = folder / "library.toml"
    path.write_text(text.replace(before, after, 1), encoding="utf-8")
    return str(path)


def test_the_literal_numbers_are_the_papers() -> None:
    cells = load_two_phase("two_phase", MappingRequest(parameters="literal"))
    dynamics = cells.dynamics
    assert (dynamics.inertia, dynamics.damping, dynamics.quartic, dynamics.phases) == (0.05, 0.25, 1.0, 2)
    for cell in cells.cells:
        for mass in cell.masses:
            # k_l + gamma (a0 + a1 x_p) is 1.5 - 2 p of the mass's own wave, in phase (0, 1) and out of phase (2, -1)
            assert (mass.k0, mass.k1) == (1.5, -2.0)
            assert mass.bias in (0.0, 1.0, -1.0)
        for coupling in cell.couplings:
            assert abs(coupling.strength) == 0.5
            if coupling.kind is CouplingKind.LATCH:
                assert coupling.strength == -0.5


def numbers(parameters: str) -> dict[str, float]:
    return tomllib.loads(FILE.read_text(encoding="utf-8"))["parameters"][parameters]


@pytest.mark.parametrize(
    ("parameters", "changed"),
    [
        ("near", {"period", "nor_bias", "latch_a1", "latch_data", "latch_clock"}),
        ("robust", {"period", "linear", "coupling", "nor_bias", "latch_a1", "latch_data", "latch_clock"}),
    ],
)
def test_the_other_sets_differ_from_the_papers_where_the_page_says(parameters: str, changed: set[str]) -> None:
    literal, other = numbers("literal"), numbers(parameters)
    assert {key for key in literal | other if literal.get(key) != other.get(key)} == changed
    page = (ROOT / "docs" / "two_phase.md").read_text(encoding="utf-8")
    for key in changed:
        assert f"| `{key}` |" in page
        assert f"{other[key]:g}" in page


def test_robust_is_the_default() -> None:
    assert load_two_phase("two_phase").parameters == "robust"


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ('kind = "two_phase"', 'kind = "three_phase"', "kind"),
        ('default = "robust"', 'default = "mighty"', "no parameter set 'mighty'"),
        ("clock_length = 60", "clock_length = 1", "clock_length"),
        ("clock_length = 60", 'clock_length = "long"', "clock_length"),
        ('buffer = "BUF"', 'buffer = "NOT"', "not a buffer"),
        ('buffer = "BUF"', 'buffer = "BUFX"', "BUFX"),
        ('join = "NOR"', 'join = "BUF"', "roles.join"),
        ('latch = "LATCH"', 'latch = "BUF"', "roles.latch"),
        ("fan_out = 2", "fan_out = 1", "fan_out"),
        ('function = "!(A|B)"', 'function = "!(A|C)"', "'C'"),
        ('function = "!(A|B)"', 'function = "!(A|B"', "')'"),
        ('bias = "nor_bias"', 'bias = "nor_force"', "nor_force"),
        ('bias = "nor_bias"', 'weight = "nor_bias"', "weight"),
        ('{ from = "B", to = "M"', '{ from = "A", to = "M"', "nothing is coupled to its input 'B'"),
        ('{ from = "B", to = "M"', '{ from = "B", to = "Y"', "from a phase to the other"),
        ('{ from = "B", to = "M"', '{ from = "B", to = "Z"', "'Z'"),
        ('clocking = "out"', 'clocking = "up"', "'up'"),
        ('name = "NOT"', 'name = "NOR"', "share a name"),
        ('state = "M"', 'state = "Q"', "state"),
        ("inertia = 0.05         # m\n", "inertia = -1\n", "inertia"),
        ("inertia = 0.05         # m\n", "inertia = nan\n", "inertia: must be a number, not nan"),
        ("[roles]", "[roles", "not TOML"),
    ],
)
def test_what_is_wrong_is_said(tmp_path: Path, before: str, after: str, words: str) -> None:
    path = spoilt(tmp_path, before, after)
    with pytest.raises(UsageError, match=words.replace("(", r"\(").replace(")", r"\)")) as caught:
        load_two_phase(path, MappingRequest(parameters="literal" if "inertia" in before else None))
    assert "library.toml" in str(caught.value)


def test_abc_reads_the_liberty_view(tmp_path: Path) -> None:
    cells = load_two_phase("two_phase")
    (tmp_path / "x.lib").write_text(liberty(cells), encoding="ascii")
    spec = find_spec("pyosys")
    assert spec is not None and spec.submodule_search_locations
    abc = Path(spec.submodule_search_locations[0]) / "yosys-abc"
    done = subprocess.run(
        [str(abc), "-q", "read_lib x.lib; print_genlib"], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    found = {line.split()[1] for line in done.stdout.splitlines() if line.startswith("GATE")}
    assert {"NOR", "NOT", "BUF"} <= found
    assert "LATCH" not in found


@given(st.integers(0, 7))
def test_functions(m: int) -> None:
    a, b, c = m & 1, m >> 1 & 1, m >> 2 & 1
    pins = ("A", "B", "C")
    cases = {
        "!(A|B)": not (a or b),
        "A & B | C": (a and b) or c,
        "A ^ B & C": a ^ (b & c),
        "!A | !(B ^ C)": (not a) or (b == c),
        "(A|1)&!0": 1,
    }
    for text, value in cases.items():
        assert truth_table(text, pins) >> m & 1 == int(bool(value)), text


@pytest.mark.parametrize("text", ["", "A B", "A|", "(A", "A)", "A+B", "D", "!"])
def test_functions_that_are_none(text: str) -> None:
    with pytest.raises(ValueError, match=r".+"):
        truth_table(text, ("A", "B", "C"))
