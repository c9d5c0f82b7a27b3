"""Cards, colours and search: what is said is what the artefacts hold."""

import numpy as np
import pytest

from mdlcad.errors import UsageError
from mdlcad.view.colours import ColourBy, Painter, rgb
from mdlcad.view.describe import Catalogue
from mdlcad.view.find import find, need
from mdlcad.view.scene import Scene
from tests.view.small import cards_of, small_built

BUILT = small_built()
CARDS = cards_of(BUILT)
NUMBER = {body.name: number for number, body in enumerate(BUILT.bodies)}


def facts(name: str) -> dict[str, str]:
    return dict(CARDS[NUMBER[name]].facts)


def test_a_unit_s_card_has_the_mass_s_numbers_and_its_nets() -> None:
    card = CARDS[NUMBER["unit.m3"]]
    found = dict(card.facts)
    assert card.subject == "unit m3"
    assert (found["phase"], found["k"], found["bias q"]) == ("0", "3.5 - 3 p", "none")
    assert found["polarity"].startswith("+1")
    assert found["from"] == "m0 (+0.25)" and found["to"] == "nothing"
    assert facts("unit.m2")["bias q"] == "+0.5"
    place = next(place for place in BUILT.placement.masses if place.mass == "m3")
    assert found["place"] == f"column 1, row 1, at ({place.x:.1f}, {place.y:.1f}) mm"


def test_a_coupling_s_card_has_sign_and_stiffness() -> None:
    part = next(item for item in BUILT.sizing.couplers if item.coupling == "m1->m4")
    found = facts("rocker.m1->m4")
    assert found["sign"].startswith("negative") and facts("coupler.m0->m3")["sign"].startswith("positive")
    assert found["stiffness"].startswith(f"{part.leaf.coupling:.3f} N/mm")
    assert "-0.3" in found["strength c"]


def test_a_carrier_s_card_is_its_net_s_and_a_clock_plate_s_its_phase_s() -> None:
    assert CARDS[NUMBER["trunk.m0.t"]].subject == CARDS[NUMBER["rung.m0.0"]].subject == "net m0"
    assert facts("clock-1")["clock"] == "phase 1 of 3, drives 2 units"


def test_the_margin_is_what_is_left_of_the_strain_limit() -> None:
    catalogue = Catalogue(BUILT)
    unit = next(unit for unit in BUILT.sizing.units if unit.mass == "m0")
    strain = max(unit.strain, BUILT.sizing.series.strain_settled)
    assert catalogue.margin(BUILT.bodies[NUMBER["unit.m0"]]) == pytest.approx(1.0 - strain / 0.03)
    assert catalogue.margin(BUILT.bodies[NUMBER["trunk.m0.t"]]) is None


def test_a_net_s_card_has_the_stiffness_ratio_of_its_carrier_at_every_coupler(scene: Scene) -> None:
    coupling = scene.built.network.couplings[0]
    ratio = next(item.ratio for item in scene.built.carriers if item.coupling == coupling.name)
    number = next(i for i, card in enumerate(scene.cards) if card.subject == f"net {coupling.source}")
    assert f"{ratio:.1f} to {coupling.target}" in dict(scene.cards[number].facts)["stiffness"]


def test_a_coupling_s_card_has_its_carrier_s_ratio(scene: Scene) -> None:
    ratios = {item.coupling: item.ratio for item in scene.built.carriers}
    number = next(i for i, body in enumerate(scene.built.bodies) if body.name.startswith("coupler."))
    name = scene.built.bodies[number].name.removeprefix("coupler.")
    assert dict(scene.cards[number].facts)["carrier"].startswith(f"{ratios[name]:.1f} times as stiff")


def colours(by: ColourBy, x: list[float], waves: list[float]) -> dict[str, tuple[int, ...]]:
    painter = Painter(BUILT, Catalogue(BUILT))
    found = painter.paint(by, np.array(x), np.array(waves))
    return {body.name: tuple(map(int, found[i])) for i, body in enumerate(BUILT.bodies)}


def test_a_state_is_orange_at_1_blue_at_0_white_between_and_follows_the_carrier() -> None:
    found = colours(ColourBy.STATE, [2.0, -2.0, 0.0, 0.0, 0.0, 0.0], [2.0, 1.0, 0.0])
    one, zero, neither = (tuple(map(int, rgb(c))) for c in ("#dd7a1d", "#2b6cb0", "#f7f7f7"))
    assert found["unit.m0"] == found["trunk.m0.t"] == found["coupler.m0->m3"] == one
    assert found["unit.m1"] == found["rocker.m1->m4"] == zero
    assert found["unit.m3"] == neither
    assert len({found["clock-0"], found["clock-1"], found["clock-2"]}) == 3


def test_every_colouring_has_a_legend_with_the_colours_that_it_uses() -> None:
    painter = Painter(BUILT, Catalogue(BUILT))
    found = colours(ColourBy.PHASE, [0.0] * 6, [1.0] * 3)
    keys = [tuple(map(int, rgb(key.colour))) for key in painter.legend(ColourBy.PHASE)]
    assert [found[f"unit.m{i}"] for i in range(6)] == [keys[i % 3] for i in range(6)]
    assert all(len(painter.legend(by)) >= 2 for by in ColourBy)
    found = colours(ColourBy.MARGIN, [0.0] * 6, [1.0] * 3)
    assert found["unit.m0"] != found["base"]


def names(text: str) -> set[str]:
    return {BUILT.bodies[number].name for number in find(BUILT, CARDS, text)}


def test_a_whole_name_is_all_of_that_thing_and_a_part_of_one_is_everything_with_it() -> None:
    assert {"unit.m0", "rung.m0.0", "trunk.m0.t", "pin.via.m0.t.0"} <= names("M0")
    assert not any("m1" in name for name in names("m0"))
    assert names("m0->m3") == {"coupler.m0->m3"}
    assert names("unit.m4") == {"unit.m4"}
    assert names("trunk.") == {"trunk.m0.t", "trunk.m1.t"}
    assert names("") == names("nowhere") == set()


def test_a_port_is_found_by_its_name(scene: Scene) -> None:
    found = [scene.built.bodies[number].name for number in find(scene.built, scene.cards, "left_vote[0]")]
    mass = next(port.mass for port in scene.built.network.sensors if port.bit == "left_vote[0]")
    assert f"unit.{mass}" in found and any(name.startswith("tab.") for name in found)


def test_a_name_that_is_not_there_is_told_what_is_near() -> None:
    with pytest.raises(UsageError, match=r"--find unit\.m9: nothing in small .* unit\.m"):
        need(BUILT, CARDS, "unit.m9")
