"""Filleted walls against ones of many small steps, each of its own thickness."""

import math
from itertools import pairwise

import numpy as np
import pytest

from mdlcad.mechanics import load_process, process_names
from mdlcad.mechanics.beam.large import LargeFrame
from mdlcad.mechanics.fillet import Root, eye_root, flat_root, notch_factor, shortening, zones_of
from mdlcad.mechanics.flexure import Meander, Sheet, coupler_chain, signal_matrix
from mdlcad.mechanics.frame import TURN, Frame, X, Y, dof
from mdlcad.mechanics.unit import flexing_span, unit_law

SHEET = Sheet(2800.0, 3.0, 0.03)
CLAMP = {dof(0, X): 0.0, dof(0, Y): 0.0, dof(0, TURN): 0.0}


def plain(length: float, wall: float, root: Root) -> Frame:
    zones = zones_of(length, wall, root, root)
    return Frame([(0.0, 0.0), (length, 0.0)], [SHEET.beam(0, 1, wall, zones=zones)])


def stepped(length: float, wall: float, root: Root, steps: int = 40) -> Frame:
    """The same in steps: each as thick as the wall with its fillets is in the middle of it."""
    arc = np.linspace(0.0, root.reach, steps + 1)
    places = [*arc, *(length - arc[::-1])]
    beams = []
    for i, (low, high) in enumerate(pairwise(places)):
        middle = (low + high) / 2.0
        far = root.reach - min(middle, length - middle)  # from the fillet's end
        rise = root.radius - math.sqrt(root.radius**2 - far**2) if far > 0.0 else 0.0
        beams.append(SHEET.beam(i, i + 1, wall + root.sides * rise))
    return Frame([(x, 0.0) for x in places], beams)


def seen(frame: Frame) -> tuple[float, float, float]:
    """Stiffness of the far end across, without and with turning, and along."""
    last = len(frame.nodes) - 1
    held = list(CLAMP)
    guided = float(frame.condense([dof(last, Y)], [*held, dof(last, TURN)])[0, 0])
    free = float(frame.condense([dof(last, Y)], held)[0, 0])
    return guided, free, float(frame.condense([dof(last, X)], held)[0, 0])


@pytest.mark.parametrize("root", [flat_root(0.2, 1), flat_root(0.2, 2), flat_root(0.4, 2), eye_root(0.2, 0.7, 2.6)])
@pytest.mark.parametrize("length", [2.0, 12.5])
def test_a_fillet_does_what_its_thickness_does(root: Root, length: float) -> None:
    # its compliance is taken as even over the fillet, which on a short wall is off by a little
    assert seen(plain(length, 0.7, root)) == pytest.approx(seen(stepped(length, 0.7, root)), rel=0.03 / length)


def test_a_filleted_wall_is_one_that_is_shorter() -> None:
    """To first order, as the unit's law has it."""
    root, length, wall = flat_root(0.2, 2), 12.5, 0.5
    bend, stretch = shortening(wall, root)
    assert 0.02 < stretch < bend < 0.2
    guided, _, along = seen(plain(length, wall, root))
    assert guided == pytest.approx(2800.0 * 3.0 * wall**3 / (length - 2.0 * bend) ** 3, rel=1e-3)
    assert along == pytest.approx(2800.0 * 3.0 * wall / (length - 2.0 * stretch), rel=1e-9)


@pytest.mark.parametrize("cuts", [2, 3, 12])
def test_large_displacements_begin_with_the_same_stiffness(cuts: int) -> None:
    """Also where a fillet ends within an element, or beyond the first one."""
    frame = plain(2.0, 0.7, flat_root(0.3, 1, inside=0.35))
    large = LargeFrame(frame, [cuts])
    moved = CLAMP | {dof(1, Y): 1e-5, dof(1, TURN): 0.0, dof(1, X): 0.0}
    force = large.move(large.rest(), moved).reactions[dof(1, Y)]
    assert force == pytest.approx(float(frame.solve(moved).reactions[dof(1, Y)]), rel=1e-6)


def test_strain_is_that_of_the_bare_wall() -> None:
    """Of a guided wall it falls from its ends to its middle: a fillet's end is strained less than a sharp root."""
    length, wall, root = 12.5, 0.5, flat_root(0.2, 2)
    moved = CLAMP | {dof(1, Y): 0.01, dof(1, TURN): 0.0, dof(1, X): 0.0}
    for frame, reach in ((plain(length, wall, flat_root(0.0, 0)), 0.0), (plain(length, wall, root), root.reach)):
        solution = frame.solve(moved)
        moment = frame.wall_moment(frame.beams[0], solution)
        assert moment == pytest.approx(float(solution.reactions[dof(1, Y)]) * (length / 2.0 - reach))
        large = LargeFrame(frame, [12])
        strain = float(large.strains(large.move(large.rest(), moved), [wall]).max())
        assert strain == pytest.approx(moment * wall / (2.0 * frame.beams[0].bending), rel=1e-2)


def test_walls_too_short_for_their_fillets_are_refused() -> None:
    with pytest.raises(ValueError, match="no room for fillets"):
        zones_of(0.35, 0.7, flat_root(0.2, 2), flat_root(0.2, 2))
    with pytest.raises(ValueError, match="no room for fillets"):
        coupler_chain(Meander(wall=0.7, legs=4, pitch=1.0, amplitude=3.0, fillet=0.2), SHEET)


def test_a_meanders_fillets_make_it_stiffer() -> None:
    sharp, blunt = (
        float(signal_matrix(coupler_chain(Meander(0.7, 4, 3.2, 3.4, fillet), SHEET))[0, 0]) for fillet in (0.0, 0.2)
    )
    assert 1.01 < blunt / sharp < 1.1


def test_notch_factor_is_that_of_the_handbook() -> None:
    """Roark's table 17.1, square shoulder with fillet in bending, for a shoulder three times as high as the wall."""
    for ratio, factor in ((0.1, 1.919), (0.2, 1.559), (0.4, 1.292), (0.6, 1.184)):
        assert notch_factor(1.0, ratio) == pytest.approx(factor, rel=0.1)
    assert notch_factor(1.0, 0.0) == math.inf
    radii = [0.01, 0.05, 0.099, 0.101, 0.3, 3.0]
    found = [notch_factor(1.0, radius, 1) for radius in radii]
    assert found == sorted(found, reverse=True)
    assert found[-1] == 1.0


@pytest.mark.parametrize("name", process_names())
def test_every_process_has_fillets_that_fit(name: str) -> None:
    process = load_process(name)
    assert process.machine.kerf / 2.0 <= process.machine.fillet <= process.machine.min_gap / 2.0
    span = flexing_span(process)
    wall = process.unit.beam_wall
    assert 0.98 * process.unit.span < span.out < process.unit.span
    # what blocks give is more than what fillets take: half a wall a root as beams bend, two as they stretch
    assert 0.3 * wall < span.bend - span.out < 1.3 * wall
    assert 3.5 * wall < span.stretch - span.out < 5.0 * wall
    plate = next(plate for plate in process.stack.plates if plate.name == "unit")
    beams = 2.0 * process.unit.beams * process.unit.beam_wall**3 / span.bend**3
    stiffness = process.material(plate).modulus * plate.thickness * beams
    assert unit_law(process).beam_stiffness == pytest.approx(stiffness, rel=1e-12)
