"""Devices some of whose shuttles are held by plates: sampled, and one that is right at both ends and wrong between."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mdlcad.artefact import load
from mdlcad.language import Device
from mdlcad.mechanics import Process, Sizing
from mdlcad.network.model import Network
from mdlcad.parts.store import Parts
from mdlcad.proof.prove import prove
from mdlcad.proof.reference import build_reference
from mdlcad.report.margins import margin_rows
from mdlcad.report.page import verdict_of
from mdlcad.report.report import Report
from mdlcad.signoff.extraction import Built, BuiltDevice
from mdlcad.signoff.mixtures import (
    MIXTURES,
    SAMPLES,
    Mixtures,
    WrongMixture,
    bounded_walks,
    drawn_mixtures,
    find_mixtures,
    mixed,
)
from mdlcad.signoff.stops import Stop
from mdlcad.simulation.system import system_of
from tests.parts.device import small_network


def soft(folder: Path, tilting: frozenset[str] | None = None) -> Built:
    """The device on beams 20 times as soft, without friction, where shuttles of ``tilting`` (None: all) tilt."""
    network, sizing = load(folder, "network.json", Network), load(folder, "sizing.json", Sizing)
    carriers, process = load(folder, "parts.json", Parts).carriers, load(folder, "process.json", Process)
    process = replace(process, stack=replace(process.stack, friction=0.0))
    sizing = replace(sizing, law=replace(sizing.law, shuttle_tilt=sizing.law.shuttle_tilt / 20.0))
    drawn = load(folder, "built.json", BuiltDevice).drawn
    names = {mass.name for mass in network.masses}
    stops = {
        name: Stop(-1.0, 1.0) if name in (tilting if tilting is not None else names) else Stop(0, 0) for name in names
    }
    return Built(drawn, network, sizing, carriers, process, stops=stops)


def test_they_are_in_the_build(voter_build: Path) -> None:
    found, report = load(voter_build, MIXTURES, Mixtures), load(voter_build, "report.json", Report)
    assert report.mixtures == found
    assert found.exhaustive and found.tried == 16 and found.wrong == 0  # four shuttles
    assert found.transitions_checked == found.transitions_total == 8
    (row,) = (row for row in margin_rows(report, None, None, ()) if row.name == "mixtures")
    assert row.holds and row.value == "16 of 16"


def test_a_device_that_is_right_at_both_ends_and_wrong_between_is_caught(voter_build: Path) -> None:
    reference = build_reference(load(voter_build, "device.json", Device))
    found = find_mixtures(soft(voter_build), reference, 0, 1)
    assert found.wrong > 0
    assert all(item.held and item.tilting for item in found.found)
    assert found.weakest == "verdict[0]" and found.weakest_words.startswith("it is held, ")
    # the proof itself, which knows nothing of mixtures, says the same of the first wrong one and of both ends
    for tilting, right in ((frozenset(found.found[0].tilting), False), (frozenset(), True), (None, True)):
        built = soft(voter_build, tilting)
        assert prove(built.network, reference, built=built.system, workers=1).holds is right


def test_a_report_with_a_wrong_mixture_says_so_first(voter_build: Path) -> None:
    report = load(voter_build, "report.json", Report)
    assert verdict_of(report).words == "All of it holds"
    found = load(voter_build, MIXTURES, Mixtures)
    wrong = replace(found, found=(WrongMixture(3, "m", ("m",), ("a",)),), weakest="m", weakest_count=1)
    said = verdict_of(replace(report, mixtures=wrong))
    assert said.tone == "partial"
    assert said.words == "All of it holds, but 1 of 16 mixtures of held and tilting shuttles are wrong"
    assert "m is the first to read wrong in 1" in said.more[0]
    (row,) = (row for row in margin_rows(replace(report, mixtures=wrong), None, None, ()) if row.name == "mixtures")
    assert row.holds is False and row.value == "15 of 16"


def test_of_many_shuttles_the_first_mixtures_go_by_phase() -> None:
    system = system_of(small_network())
    tilting = drawn_mixtures(system, 0)
    assert len(system.names) > 5 and tilting.shape == (len(system.names), SAMPLES)
    for phase in range(system.phases):
        assert (tilting[:, 2 * phase] == (system.phase != phase)).all()
        assert (tilting[:, 2 * phase + 1] == (system.phase == phase)).all()
    by_chance = tilting[:, 2 * system.phases :]
    assert 0.35 < by_chance.mean() < 0.65
    assert len(np.unique(by_chance, axis=1).T) > 25  # of the 64 that there are
    assert (drawn_mixtures(system, 1) != tilting).any()
    with pytest.raises(ValueError, match="no stops to tilt between"):
        mixed(system, tilting)


def test_walks_of_large_devices_are_cut_off(voter_build: Path) -> None:
    reference = build_reference(load(voter_build, "device.json", Device))
    whole, cut = bounded_walks(reference, 4, 0), bounded_walks(reference, 300, 0)
    assert whole.inputs.shape[0] * whole.inputs.shape[1] > 300
    assert cut.inputs.shape[0] * cut.inputs.shape[1] <= 10_000 // 300
    assert (cut.inputs == whole.inputs[: cut.inputs.shape[0], : cut.inputs.shape[1]]).all()
    assert cut.states.shape[0] == cut.inputs.shape[0] + 1
