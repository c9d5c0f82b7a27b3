"""Every kind of part: its reduced model against the beam computation, and that against exudyn."""

from dataclasses import replace

import numpy as np
import pytest

from mdlcad.mechanics import Process, Sizing, process_names
from mdlcad.mechanics.beam.curves import unit_curve
from mdlcad.mechanics.beam.large import LargeFrame
from mdlcad.mechanics.beam.unit import held, unit_model
from mdlcad.mechanics.flexure import driven
from mdlcad.mechanics.frame import TURN, Frame, X, Y, dof
from mdlcad.mechanics.leaves import LeafKind, LeafSize, chain_of
from mdlcad.mechanics.series import spring_frame
from tests.mechanics.beam import curves, oracle

# the law is one for all processes: the others are held against it in the long tests
PROCESSES = [name if name == "pom_cut" else pytest.param(name, marks=pytest.mark.long) for name in process_names()]
BAR = 0.05


@pytest.fixture(scope="module", params=PROCESSES)
def made(request: pytest.FixtureRequest) -> tuple[Process, Sizing]:
    return curves.sized(request.param)


def test_units_follow_their_law_at_three_clock_positions(made: tuple[Process, Sizing]) -> None:
    process, _ = made
    idle, middle, peak = curves.units(*made)
    assert [curve.error < BAR for curve in (idle, middle, peak)] == [True, True, True]
    assert idle.rests() == pytest.approx([0.0], abs=1e-6)  # monostable
    low, high = peak.rests()  # bistable
    assert high == pytest.approx(-low, rel=1e-3)
    assert high == pytest.approx(np.sqrt(2.5) * process.unit.throw_unit, rel=0.03)


def test_the_series_spring_follows_its_law(made: tuple[Process, Sizing]) -> None:
    curve = curves.spring(*made)
    assert curve.error < BAR
    assert curve.strain.max() < curve.limit


def test_leaves_follow_their_law(made: tuple[Process, Sizing]) -> None:
    found = curves.leaves(*made)
    assert {curve.part for curve in found} == set(LeafKind)
    assert {(curve.part, curve.state): curve.error for curve in found if curve.error >= BAR} == {}


def test_a_reduced_model_off_by_a_tenth_is_noticed() -> None:
    """The comparison can fail."""
    process, sizing = curves.sized("pom_cut")
    for curve in curves.leaves(process, sizing):
        assert replace(curve, reduced=1.1 * curve.reduced).error > BAR


def test_a_wall_off_by_a_tenth_is_noticed() -> None:
    process, sizing = curves.sized("pom_cut")
    thin = replace(process, unit=replace(process.unit, beam_wall=0.45))
    true = unit_curve(thin, sizing.law, sizing.series, 3.5, 0.8)
    right = unit_curve(process, sizing.law, sizing.series, 3.5, 0.8)
    assert np.abs(true.force / right.force)[0] < 0.9


# ---- exudyn


def assert_same(frame: Frame, cuts: list[int], prescribed: dict[int, float], place: int, steps: int = 10) -> None:
    large = LargeFrame(frame, cuts)
    ours = large.move(large.rest(), prescribed).reactions[place]
    assert ours == pytest.approx(oracle.forces(frame, cuts, prescribed, steps)[place], rel=0.01)


@pytest.mark.parametrize(("k", "reach"), curves.WORKING)
def test_exudyn_agrees_on_a_unit(k: float, reach: float) -> None:
    process, sizing = curves.sized("pom_cut")
    model = unit_model(process, sizing.series)
    cuts = [2 * count if count > 1 else 1 for count in model.cuts]
    stroke = sizing.law.stroke_per_k * (process.unit.kappa0 - k)
    assert_same(model.frame, cuts, held(model, stroke, reach * process.unit.throw_unit), dof(model.hub, Y))


def leaf_of(sizing: Sizing, kind: LeafKind) -> LeafSize:
    return next(item.leaf for item in (*sizing.couplers, *sizing.biases) if item.leaf.kind is kind)


@pytest.mark.parametrize(
    ("kind", "left", "right"),
    [
        (LeafKind.COUPLER, 2.7, -2.7),
        (LeafKind.ROCKER, 2.7, 2.7),
        (LeafKind.ROCKER, 2.7, 0.0),
        (LeafKind.BIAS, 4.2, 0.0),
    ],
)
def test_exudyn_agrees_on_a_leaf(kind: LeafKind, left: float, right: float) -> None:
    process, sizing = curves.sized("pom_cut")
    chain = chain_of(kind, leaf_of(sizing, kind).shape, process)
    cuts = [10] * chain.flexible + [1] * (len(chain.frame.beams) - chain.flexible)
    assert_same(chain.frame, cuts, driven(chain, left, right), dof(chain.left, Y))


def test_exudyn_agrees_on_the_series_spring() -> None:
    process, sizing = curves.sized("pom_cut")
    series = sizing.series
    spring = spring_frame(process, series.wall, series.height, series.clear)
    rest = dict.fromkeys([dof(spring.pin, i) for i in (X, Y, TURN)] + [dof(0, Y), dof(0, TURN)], 0.0)
    cuts = [10] * len(spring.widths) + [1] * (len(spring.beams) - len(spring.widths))
    assert_same(Frame(spring.nodes, spring.beams), cuts, rest | {dof(0, X): series.travel}, dof(0, X))
