"""Devices with two unit plates: who is in which deck, both decks legal, and what would not be."""

from dataclasses import replace
from functools import cache

import pytest
from msgspec import UNSET

from mdlcad.artefact import from_json, to_json
from mdlcad.errors import UsageError
from mdlcad.mechanics import load_process
from mdlcad.mechanics.decks import Deck, deck_of_plate, two_decks
from mdlcad.placement.decks import Lean, choose_decks, crossing, network_in
from mdlcad.placement.placement import Placement
from mdlcad.routing.check import check_layout
from mdlcad.routing.deck_search import place_and_route_decks
from mdlcad.routing.decks import bare_hubs, deck_parts, units_of
from mdlcad.routing.drawing import draw_layout
from mdlcad.routing.layout import Layout
from tests.placement.networks import SQUARE, small

SLIGHT = Lean(0.1, 0.2)


@cache
def both():
    network, ports, rules = small()
    leans = {coupling.name: SLIGHT for coupling in network.couplings}
    return network, rules, *place_and_route_decks(network, SQUARE, ports, rules, 1, leans)


def test_both_decks_are_legal_and_together_hold_every_coupling_once():
    network, rules, placement, layout = both()
    assert check_layout(network, placement, layout, rules) == ()
    decks = deck_parts(network, placement, layout, rules)
    assert decks is not None and all(part.layout.couplers for part in decks.values())
    held = sorted(leaf.coupling for part in decks.values() for leaf in part.layout.couplers)
    assert held == sorted(coupling.name for coupling in network.couplings)
    names = [piece.name for piece in (*layout.rungs, *layout.trunks)]
    assert len(names) == len(set(names))


def test_an_unrealised_coupling_is_that_of_one_deck():
    network, rules, placement, layout = both()
    names = [coupling.name for coupling in network.couplings]
    decks = deck_parts(network, placement, replace(layout, unrealised=tuple((name, "why") for name in names)), rules)
    assert decks is not None
    assert sorted(name for part in decks.values() for name, _ in part.layout.unrealised) == sorted(names)


def test_a_crossing_net_has_its_unit_in_one_deck_and_a_bare_hub_in_the_other():
    network, _, placement, layout = both()
    units = units_of(placement)
    assert units is not None
    across = set(crossing(network, units))
    assert across and across == {unit.mass for deck in Deck for unit in bare_hubs(network, placement, deck)}
    for deck in Deck:
        for unit in bare_hubs(network, placement, deck):
            pieces = [rung for rung in layout.rungs if rung.net == unit.mass and deck_of_plate(rung.plate) is deck]
            assert unit.deck is deck.other and pieces


def test_a_bare_hub_without_its_unit_above_it_is_found():
    network, rules, placement, layout = both()
    name = next(unit.mass for deck in Deck for unit in bare_hubs(network, placement, deck))
    taken = {(unit.column, unit.row) for unit in placement.masses}
    column, row = next(slot for slot in placement.slots if slot not in taken)
    moved = replace(
        placement,
        masses=tuple(
            replace(unit, column=column, row=row, x=placement.column_x[column], y=placement.row_y[row])
            if unit.mass == name
            else unit
            for unit in placement.masses
        ),
    )
    assert "carrier" in {finding.rule for finding in check_layout(network, moved, layout, rules)}


def test_a_coupler_in_the_wrong_deck_is_found():
    network, rules, placement, layout = both()
    leaf = layout.couplers[0]
    there = deck_of_plate(leaf.plate).other
    plate = next(item.plate for item in layout.rungs if deck_of_plate(item.plate) is there)
    wrong = replace(layout, couplers=(replace(leaf, plate=plate), *layout.couplers[1:]))
    found = {finding.rule for finding in check_layout(network, placement, wrong, rules)}
    assert "coupler" in found


def test_the_artefacts_survive_their_json_and_one_plate_says_nothing_of_decks():
    _, _, placement, layout = both()
    assert from_json(to_json(placement), Placement) == placement
    assert from_json(to_json(layout), Layout) == layout
    assert b"deck" in to_json(placement)
    plain = replace(placement, masses=(replace(placement.masses[0], deck=UNSET),))
    assert b"deck" not in to_json(plain)


def test_the_drawing_shows_both_decks_with_the_bare_hubs():
    network, rules, placement, layout = both()
    text = draw_layout(network, placement, layout, rules).decode()
    assert "lower deck" in text and "upper deck" in text and "bare hub of" in text


def test_few_nets_cross_and_none_that_would_tilt_its_shuttle_too_far():
    network, _, _ = small()
    easy = choose_decks(network, 20, {coupling.name: SLIGHT for coupling in network.couplings}, 1)
    assert easy is not None and set(easy.values()) == set(Deck)
    barred = {coupling.name: Lean(0.01, 2.0) for coupling in network.couplings}
    stiff = choose_decks(network, 20, barred, 1)
    assert stiff is None or not crossing(network, stiff)


def test_two_decks_that_are_too_small_are_refused():
    network, _, _ = small()
    leans = {coupling.name: SLIGHT for coupling in network.couplings}
    assert choose_decks(network, len(network.masses) // 2 - 1, leans, 1) is None


def test_every_coupling_is_in_the_deck_of_its_target():
    network, _, placement, _ = both()
    units = units_of(placement)
    assert units is not None
    parts = [network_in(network, units, deck) for deck in Deck]
    assert sum(len(part.couplings) for part in parts) == len(network.couplings)
    for deck, part in zip(Deck, parts, strict=True):
        assert all(units[coupling.target] is deck for coupling in part.couplings)
        assert all(mass.bias == 0.0 for mass in part.masses if units[mass.name] is not deck)


def test_the_upper_deck_is_the_lower_one_turned_over():
    single = load_process("pom_cut")
    double = two_decks(single)
    names = [plate.name.removeprefix("upper-") for plate in double.stack.plates]
    assert names == names[::-1] and names[: len(names) // 2] == [plate.name for plate in single.stack.plates]
    top = double.z_of("upper-base") + double.plate("upper-base").thickness
    for plate in single.stack.plates:
        above = double.plate(f"upper-{plate.name}")
        assert double.z_of(above.name) == pytest.approx(top - double.z_of(plate.name) - plate.thickness)


def test_a_process_whose_plates_have_the_names_of_an_upper_deck_is_refused():
    single = load_process("pom_cut")
    first = replace(single.stack.plates[0], name="upper-base")
    named = replace(single, stack=replace(single.stack, plates=(first, *single.stack.plates[1:])))
    with pytest.raises(UsageError, match="upper-base"):
        two_decks(named)
