"""The window of a library: how it is found, and that it is the one that stands in the library's file."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from mdlcad.artefact import from_json
from mdlcad.characterise.bench import Setting, is_right
from mdlcad.characterise.circuits import threshold_circuits
from mdlcad.characterise.measure import (
    LoadCount,
    MapPoint,
    Runner,
    SpreadCount,
    borne_limits,
    borne_spread,
    chosen,
    count_spreads,
    map_window,
    rows_of,
)
from mdlcad.characterise.nor_benches import gate_bench as nor_bench
from mdlcad.characterise.plan import NOR_SWEEP, THRESHOLD_SWEEP
from mdlcad.characterise.result import CharacterisationResult, conclude, differences, toml_table
from mdlcad.characterise.threshold_benches import GATES, gate_bench, gate_benches, heavy_targets, many_targets
from mdlcad.cli import main
from mdlcad.mapping.cell_library import load_library
from mdlcad.mapping.characterisation import Characterisation, Choice
from mdlcad.mapping.two_phase import load_two_phase


def quiet(words: str) -> None:
    assert words


def runner() -> Runner:
    return Runner(0, 2, quiet)


def test_a_row_is_the_longest_run_of_dampings_at_which_nothing_is_wrong() -> None:
    wrong = {(1.0, 0.1), (1.0, 0.4), (2.0, 0.1), (2.0, 0.2), (2.0, 0.3), (2.0, 0.4)}
    points = [MapPoint(t, b, ("x",) if (t, b) in wrong else ()) for t in (1.0, 2.0) for b in (0.1, 0.2, 0.3, 0.4)]
    assert rows_of(points) == ((1.0, 0.2, 0.3),)


def test_a_spread_is_borne_if_every_cell_bears_it_and_all_smaller_ones() -> None:
    def counts(*rights: tuple[int, int]) -> list[SpreadCount]:
        return [
            SpreadCount(cell, 0.1 * (place + 1), right, 10)
            for place, pair in enumerate(rights)
            for cell, right in zip("ab", pair, strict=True)
        ]

    assert borne_spread(counts((10, 10), (9, 10), (10, 8))) == pytest.approx(0.2)
    assert borne_spread(counts((10, 8), (10, 10))) == 0.0
    assert borne_spread([]) == 0.0


def test_a_limit_is_borne_if_every_device_is_right_up_to_it() -> None:
    def count(load: int, echo: int, right: int) -> LoadCount:
        return LoadCount("x", load, echo, right, 3)

    counts = [count(4, 6, 3), count(4, 10, 3), count(4, 16, 2), count(8, 6, 3), count(8, 10, 3), count(8, 16, 0)]
    assert borne_limits(counts, 8, 10) == (8, 10)
    assert borne_limits([*counts, count(12, 6, 3), count(12, 10, 2), count(16, 6, 3)], 8, 10) == (8, 10)
    assert borne_limits([*counts, count(12, 16, 0)], 8, 16) == (0, 10)
    assert borne_limits([], 8, 10) == (0, 0)


def test_a_limit_beyond_what_is_borne_is_told() -> None:
    found = Characterisation((2.0,), (0.1,), (0.5,), 0.1, (), 4, 6)
    said = differences(found, found, (), THRESHOLD_SWEEP, (8, 6))
    assert said == ("the limit of fan-out is 8; choose 4, the greatest at which all devices were right",)
    assert "says echo 10; measured: 6" in differences(found, replace(found, echo=10), (), THRESHOLD_SWEEP, (4, 6))[0]


def test_a_number_stands_unless_another_is_surely_better() -> None:
    """Of 100 devices, 50 against 60 is within twice the standard error (2 x 7.0), 50 against 70 is not."""
    assert chosen(Choice("c", (1.0, 2.0), (50, 60), 100), 1.0) == 1.0
    assert chosen(Choice("c", (1.0, 2.0, 3.0), (50, 60, 70), 100), 1.0) == 3.0
    assert chosen(Choice("c", (1.0, 2.0), (70, 50), 100), 1.0) == 1.0
    assert chosen(Choice("default", ("a", "b"), (0, 10), 10), "a") == "b"


def test_a_file_that_says_otherwise_is_told_so() -> None:
    sweep = replace(THRESHOLD_SWEEP, periods=(1.0, 2.0))
    found = Characterisation((1.0, 2.0), (0.1, 0.1), (0.5, 0.5), 0.1, (Choice("c.x", (1.0, 2.0), (5, 95), 100),))
    assert differences(found, found, (2.0,), sweep) == ()
    said = differences(found, replace(found, periods=(2.0,), least_damping=(0.2,), spread=0.2), (1.0,), sweep)
    assert [words.split(";")[0] for words in said] == [
        "c.x is 1.0, with which 5 of 100 devices are right",
        "[characterisation] says of T = 1: works at no damping",
        "[characterisation] says of T = 2: works from b = 0.2 to 0.5",
        "[characterisation] says spread 0.2",
    ]
    assert "add the one that is written here" in differences(found, None, (2.0,), sweep)[0]


def test_the_table_that_is_written_is_the_one_that_is_read() -> None:
    found = Characterisation((1.0,), (0.1,), (0.5,), 0.1, (Choice("default", ("a", "b"), (5, 95), 100),))
    table = tomllib.loads(toml_table(found, "x"))["characterisation"]
    assert msgspec.convert(table, Characterisation) == found


def test_targets_have_the_load_and_the_echo_asked_for() -> None:
    for echo in range(2, 20, 2):
        heavy = heavy_targets(echo, 5)
        assert sum(weight * others for weight, others in heavy) == echo
        assert all(weight + min(others - 1, 3) <= 5 for weight, others in heavy)
        many = many_targets(8, echo)
        assert (sum(weight for weight, _ in many), sum(w * o for w, o in many)) == (8, echo)


@pytest.mark.parametrize("cell", ["and of 2", "majority of 5"])
def test_a_bench_knows_a_bad_cell(cell: str) -> None:
    library = load_library("parametron")
    here = Setting(library.dynamics.period, library.dynamics.damping)
    bench = gate_bench(library, cell, GATES[cell], heavy_targets(10, 5), 0)
    assert is_right(bench, here, 0)
    network = bench.network
    into = next(i for i, c in enumerate(network.couplings) if c.target == "gate")
    couplings = list(network.couplings)
    couplings[into] = replace(couplings[into], strength=-couplings[into].strength)
    assert not is_right(replace(bench, network=replace(network, couplings=tuple(couplings))), here, 0)
    softer = tuple(replace(mass, k1=-1.0) for mass in network.masses)  # never bistable
    assert not is_right(replace(bench, network=replace(network, masses=softer)), here, 0)
    stiff = replace(library, coupling=replace(library.coupling, strength=1.5))
    assert not is_right(gate_bench(stiff, cell, GATES[cell], heavy_targets(10, 5), 0), here, 0)


def test_the_parametron_file_says_what_a_slice_measures() -> None:
    """The whole column of its own period, and its spread; all else is measured by the long test."""
    library = load_library("parametron")
    standing, own = library.characterisation, library.dynamics
    assert standing is not None
    sweep = replace(THRESHOLD_SWEEP, periods=(own.period,), spreads=(standing.spread,), loads=())
    benches = [*gate_benches(library, 0), *threshold_circuits(library, 0)]
    spreads = count_spreads(benches, own.period, own.damping, sweep, runner())
    found = conclude(map_window(benches, sweep, runner()), borne_spread(spreads))
    assert differences(found, standing, (), sweep) == ()
    assert own.period in standing.periods


def test_the_library_numbers_are_what_the_rule_chooses_of_the_stated_counts() -> None:
    library = load_library("parametron")
    assert library.characterisation is not None
    numbers = {
        "coupling.strength": library.coupling.strength,
        "bias.force": library.bias.force,
        "mass.k0": library.mass.k0,
        "dynamics.period": library.dynamics.period,
    }
    assert {choice.key for choice in library.characterisation.choice} == set(numbers)
    for choice in library.characterisation.choice:
        assert chosen(choice, numbers[choice.key]) == numbers[choice.key]
    two_phase = load_two_phase("two_phase")
    assert two_phase.characterisation is not None
    (choice,) = two_phase.characterisation.choice
    assert chosen(choice, two_phase.parameters) == two_phase.parameters


def test_a_gate_of_the_two_phase_library_works_where_its_file_says() -> None:
    library = load_two_phase("two_phase")
    standing = library.characterisation
    assert standing is not None
    bench = nor_bench(library, library.cell("NOR"), library.fan_out, 0)
    assert set(standing.periods) <= set(NOR_SWEEP.periods)
    for t, least, greatest in zip(standing.periods, standing.least_damping, standing.greatest_damping, strict=True):
        assert is_right(bench, Setting(t, least), 0) and is_right(bench, Setting(t, greatest), 0)
    broken = replace(library, cells=tuple(cell for cell in library.cells))
    nor = broken.cell("NOR")
    pull = replace(nor, couplings=tuple(replace(c, strength=abs(c.strength)) for c in nor.couplings))
    other = replace(bench, network=nor_bench(library, pull, library.fan_out, 0).network)
    assert not is_right(other, Setting(library.dynamics.period, library.dynamics.damping), 0)


@pytest.mark.long
@pytest.mark.parametrize("name", ["parametron", "two_phase"])
def test_the_file_says_what_the_command_measures(name: str, tmp_path: Path) -> None:
    assert main(["cells", name, "--characterise", "-o", str(tmp_path)]) == 0
    result = from_json((tmp_path / "characterisation.json").read_bytes(), CharacterisationResult)
    assert result.differences == () and len(result.points) == len(result.sweep.periods) * len(result.sweep.dampings)
    table = tomllib.loads((tmp_path / "characterisation.toml").read_text())["characterisation"]
    library = load_library(name) if name == "parametron" else load_two_phase(name)
    assert msgspec.convert(table, Characterisation) == library.characterisation
    assert (tmp_path / "characterisation.png").stat().st_size > 20_000


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["cells", "--characterise"], "needs the name of a library"),
        (["cells", "parametron", "--quick"], "give --characterise"),
        (["cells", "no_such_library", "--characterise"], "no entry 'no_such_library'"),
    ],
)
def test_arguments_that_make_no_sense(arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 2
    assert words in capsys.readouterr().err
