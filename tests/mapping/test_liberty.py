"""The cells of the libraries as people and logic synthesis see them."""

import json
import subprocess
from importlib.util import find_spec
from pathlib import Path

import pytest

from mdlcad.cli import HOLDS, main
from mdlcad.mapping import liberty_view, load_library
from mdlcad.mapping.liberty import gate_function, gate_name, threshold_gates
from mdlcad.mapping.two_phase.function import truth_table


def test_a_gate_s_function_is_the_sign_of_its_weighted_inputs():
    gates = threshold_gates(load_library("parametron"))
    assert len({gate_name(gate) for gate in gates}) == len(gates)
    assert {"BUF", "AND2", "OR2", "AND3", "OR3", "MAJ3", "MAJ5"} <= {gate_name(gate) for gate in gates}
    for gate in gates:
        inputs = len(gate.weights)
        table = truth_table(gate_function(gate), tuple("ABCDE"[:inputs]))
        for minterm in range(1 << inputs):
            total = gate.bias + sum(w if minterm >> i & 1 else -w for i, w in enumerate(gate.weights))
            assert bool(table >> minterm & 1) == (total > 0), (gate, minterm)


@pytest.mark.parametrize("name", ["parametron", "two_phase"])
def test_abc_reads_the_liberty_view(name, tmp_path):
    (tmp_path / "cells.lib").write_text(liberty_view(load_library(name)))
    folder = Path(next(iter(find_spec("pyosys").submodule_search_locations)))
    command = [str(folder / "yosys-abc"), "-q", "read_lib -w cells.lib; write_genlib out.genlib"]
    subprocess.run(command, cwd=tmp_path, capture_output=True, check=True, timeout=60)
    gates = (tmp_path / "out.genlib").read_text()
    assert gates.count("GATE") >= (12 if name == "parametron" else 5)


def test_show_tells_cells_and_options(capsys):
    assert main(["cells", "two_phase"]) == HOLDS
    said = capsys.readouterr().out
    assert "LATCH" in said and "--clock-length N" in said and "robust (of literal, near, robust" in said
    assert main(["cells", "parametron"]) == HOLDS
    assert "MAJ5" in capsys.readouterr().out
    assert main(["cells", "two_phase", "--json"]) == HOLDS
    assert json.loads(capsys.readouterr().out)["options"]["clock_length"] == 60
    assert main(["cells"]) == HOLDS
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == ["parametron", "two_phase"]
