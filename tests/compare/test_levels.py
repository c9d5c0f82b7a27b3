"""The levels' own logic, on small artefacts made by hand."""

from dataclasses import replace
from pathlib import Path

import pytest
import shapely
from shapely import Polygon, affinity

from mdlcad.compare import sections
from mdlcad.compare.equivalence import compare_behaviour
from mdlcad.compare.program import tokens
from mdlcad.compare.sections import check_agreement, difference
from mdlcad.errors import UsageError
from mdlcad.language import Device, read_device
from mdlcad.mapping import load_library, map_netlist
from mdlcad.network.matching import changed_masses, renamed_masses
from mdlcad.network.model import Network
from mdlcad.synthesis import synthesise

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@pytest.fixture(scope="module")
def maze() -> Device:
    return read_device(EXAMPLES / "mazerobot.mdl")


@pytest.fixture(scope="module")
def network() -> Network:
    device = read_device(EXAMPLES / "traffic_light.mdl")
    return map_netlist(synthesise(device), load_library("parametron"))


def test_comments_and_spaces_are_no_tokens():
    assert tokens("assign a = b; // no\n/* nor\nthis */") == tokens("assign\n\ta=b ;")
    assert tokens('x = "// kept";') != tokens('x = "";')
    assert tokens("a <= b") != tokens("a < b")


def test_other_words_for_the_same_behaviour_are_the_same(maze):
    # De Morgan on a condition, and a module with another order of statements would do as well
    text = maze.verilog.replace("endmodule", "wire unused_here = 1'b0;\nendmodule", 1)
    found = compare_behaviour(maze, replace(maze, verilog=text))
    assert not found.differs
    assert "all that can be reached" in found.words


def test_other_behaviour_comes_with_inputs_that_show_it():
    voter = read_device(EXAMPLES / "voter.mdl")
    assert "&" in voter.verilog
    found = compare_behaviour(voter, replace(voter, verilog=voter.verilog.replace("&", "|", 1)))
    assert found.differs
    assert "verdict[0] is" in found.words
    assert "left_vote[0]=" in found.words


def rename(network: Network, names: dict[str, str]) -> Network:
    def new(name: str) -> str:
        return names.get(name, name)

    return replace(
        network,
        masses=tuple(replace(mass, name=new(mass.name)) for mass in network.masses),
        couplings=tuple(replace(c, source=new(c.source), target=new(c.target)) for c in network.couplings),
    )


def test_renamed_masses_are_matched_by_what_they_are_joined_to(network):
    names = {mass.name: f"other{index}" for index, mass in enumerate(network.masses) if index % 3 == 0}
    found = renamed_masses(network, rename(network, names))
    assert found == names


def test_all_masses_renamed_still_match_but_for_twins_that_nothing_tells_apart(network):
    names = {mass.name: f"m{index:03}" for index, mass in enumerate(network.masses)}
    other = rename(network, names)
    found = renamed_masses(network, other)
    assert len(found) >= len(names) - 2
    edges = {(c.source, c.target, c.strength) for c in other.couplings}
    mapped = [(found.get(c.source), found.get(c.target), c.strength) for c in network.couplings]
    assert sum(edge in edges for edge in mapped) >= len(mapped) - 4


def test_a_mass_renamed_and_rewired_is_still_the_same(network):
    name = next(m.name for m in network.masses if sum(m.name in (c.source, c.target) for c in network.couplings) >= 4)
    cut = next(c for c in network.couplings if name in (c.source, c.target))
    other = rename(replace(network, couplings=tuple(c for c in network.couplings if c != cut)), {name: "new"})
    assert renamed_masses(network, other) == {name: "new"}


def test_a_mass_has_changed_if_it_computes_otherwise_and_not_if_it_is_turned_over(network):
    turned = network.masses[-1].name
    over = replace(
        network,
        masses=tuple(replace(m, polarity=-m.polarity, bias=-m.bias) if m.name == turned else m for m in network.masses),
        couplings=tuple(
            replace(c, strength=-c.strength) if turned in (c.source, c.target) else c for c in network.couplings
        ),
    )
    assert changed_masses(network, over) == frozenset()
    cut = network.couplings[0]
    assert changed_masses(network, replace(network, couplings=network.couplings[1:])) == {cut.target}
    later = replace(network.masses[0], phase=(network.masses[0].phase + 1) % 3)
    assert changed_masses(network, replace(network, masses=(later, *network.masses[1:]))) == {later.name}


def test_an_unrelated_mass_is_not_a_renamed_one(network):
    lone = replace(network.masses[0], name="lone")
    gone = network.masses[-1].name
    other = replace(
        network,
        masses=(*network.masses[:-1], lone),
        couplings=tuple(c for c in network.couplings if gone not in (c.source, c.target)),
    )
    assert renamed_masses(network, other) == {}


PLATE = Polygon([(0, 0), (100, 0), (100, 60), (50, 93), (0, 60)], [[(10, 10), (20, 10), (20, 20), (10, 20)]])


def test_the_area_of_a_difference_and_its_place():
    grown = PLATE.union(shapely.box(100, 20, 100.5, 22))
    found = difference("plate", PLATE, grown, 1e-3)
    assert (found.only_a, found.only_b) == (0.0, pytest.approx(1.0, abs=1e-6))
    assert found.patches[0].box == pytest.approx((100, 20, 100.5, 22), abs=1e-3)


def test_patches_come_largest_first_and_far_ones_apart():
    other = PLATE.union(shapely.box(100, 20, 100.5, 22)).difference(shapely.box(40, 40, 44, 44))
    found = difference("plate", PLATE, other, 1e-3)
    assert [round(patch.area, 6) for patch in found.patches] == [16.0, 1.0]


@pytest.mark.parametrize("shift", [0.0004, 0.01, 0.3, 7.0])
def test_both_engines_agree_on_slanted_edges_and_holes(shift):
    moved = affinity.rotate(affinity.translate(PLATE, shift, shift / 3), shift)
    found = difference("plate", PLATE, moved, 0.0)
    exact = PLATE.symmetric_difference(moved)
    assert found.raw == pytest.approx(exact.area, abs=2e-4 * exact.length + 1e-3)


def test_slivers_below_the_tolerance_are_none_and_wider_ones_are():
    sliver = PLATE.union(shapely.box(100, 0, 100.02, 60))
    assert difference("plate", PLATE, sliver, 0.03).area == 0.0
    assert difference("plate", PLATE, sliver, 0.01).area == pytest.approx(1.2, abs=1e-6)


def test_engines_that_disagree_are_trouble(monkeypatch):
    square = shapely.box(0, 0, 10, 10)
    check_agreement("plate", 100.0, square)
    with pytest.raises(UsageError, match="neither can be trusted"):
        check_agreement("plate", 100.1, square)
    real = sections._area
    monkeypatch.setattr(sections, "_area", lambda region: 1.01 * real(region))
    with pytest.raises(UsageError, match="KLayout finds"):
        difference("plate", PLATE, affinity.translate(PLATE, 5, 0), 0.0)
