"""Every rule against a body that breaks it and one that just keeps it."""

import pytest
from shapely import box
from shapely.affinity import translate

from mdlcad.parts.body import BodyKind
from mdlcad.signoff.drc import check_containment, check_cut, check_motion, swept
from tests.export.bodies import body

GAP = 0.6
THROW = 3.0


def bar(name: str, dy: float, **more):
    return body(name, box(0, dy, 20, dy + 4), kind=BodyKind.RUNG, moves_with=(f"mass:{name}",), **more)


def rules(findings):
    return sorted({finding.rule for finding in findings})


def test_swept_region_of_a_bar_is_the_bar_and_its_stroke():
    assert swept(bar("a", 0.0)).area == pytest.approx(20 * (4 + 2 * THROW))
    assert swept(bar("a", 0.0)).bounds == (0, -THROW, 20, 4 + THROW)


def test_swept_region_keeps_a_hole_that_is_longer_than_the_stroke():
    frame = box(0, 0, 20, 20).difference(box(5, 5, 15, 15))
    region = swept(body("a", frame))
    assert region.area == pytest.approx(20 * 26 - 10 * (10 - 2 * THROW))


def test_two_bars_need_both_strokes_between_them():
    # 4 + 3 + 3 + 0.6: edges 6.6 apart at rest
    assert check_motion([bar("a", 0.0), bar("b", 4 + 2 * THROW + GAP)], GAP) == []
    found = check_motion([bar("a", 0.0), bar("b", 4 + 2 * THROW + GAP - 0.01)], GAP)
    assert rules(found) == ["swept_clearance"]
    assert found[0].value == pytest.approx(GAP - 0.01)
    assert found[0].bodies == ("a", "b")


def test_one_stroke_is_not_enough_where_both_move():
    assert rules(check_motion([bar("a", 0.0), bar("b", 4 + THROW + GAP)], GAP)) == ["swept_clearance"]


def test_bodies_of_one_shuttle_may_stand_close_but_not_overlap():
    left = body("left", box(0, 0, 4, 4), moves_with=("mass:m",))
    near = body("near", box(4.2, 0, 8, 4), moves_with=("mass:m",))
    into = body("into", box(3.9, 0, 8, 4), moves_with=("mass:m",))
    assert check_motion([left, near], GAP) == []
    assert rules(check_motion([left, into], GAP)) == ["overlap"]


def test_a_coupler_through_its_own_bar_is_seen():
    carrier = body("rung.a.1", box(0, 0, 20, 4), moves_with=("mass:a",))
    coupler = body("coupler.a->b", box(19, 0, 30, 5), moves_with=("mass:a", "mass:b"))
    assert rules(check_motion([carrier, coupler], GAP)) == ["overlap"]


def test_two_flexures_anchored_in_the_frame_are_checked_against_each_other():
    lower = body("unit.a", box(0, 0, 10, 6), moves_with=("frame", "mass:a", "clock:0"))
    upper = body("unit.b", translate(box(0, 0, 10, 6), 0, 9), moves_with=("frame", "mass:b", "clock:0"))
    assert rules(check_motion([lower, upper], GAP)) == ["swept_clearance"]


def test_bodies_at_different_heights_do_not_meet():
    assert check_motion([bar("a", 0.0), bar("b", 1.0, z=2.3)], GAP) == []


def test_the_assembled_shape_counts_not_the_cut_one():
    post = body("post.x", box(30, 0, 31, 1), kind=BodyKind.POST, throw=(0.0, 0.0))
    cut = box(0, 0, 20, 1)
    leaf = body("bias.a", cut, assembled=box(0, 0, 30.5, 1), moves_with=("mass:a", "frame"))
    assert rules(check_motion([post, leaf], GAP)) == ["overlap"]


def test_nothing_but_a_tab_may_leave_the_boundary():
    boundary = box(-1, -THROW, 21, 4 + THROW)
    assert check_containment([bar("a", 0.0)], boundary) == []
    found = check_containment([bar("a", 0.5)], boundary)
    assert rules(found) == ["containment"]
    tab = body("tab.a", box(15, 0, 40, 4), kind=BodyKind.TAB, moves_with=("mass:a",))
    assert check_containment([tab], boundary) == []


@pytest.mark.parametrize(("width", "expected"), [(0.5, []), (0.45, ["min_wall"])])
def test_walls_thinner_than_the_machine_makes(width, expected):
    dumbbell = box(0, 0, 5, 5).union(box(5, 2, 15, 2 + width)).union(box(15, 0, 20, 5))
    assert rules(check_cut("unit", [body("a", dumbbell)], 0.5, 0.4)) == expected


@pytest.mark.parametrize(("gap", "expected"), [(0.4, []), (0.35, ["min_gap"])])
def test_gaps_narrower_than_the_machine_makes(gap, expected):
    pair = [body("a", box(0, 0, 5, 5)), body("b", box(5 + gap, 0, 10, 5))]
    assert rules(check_cut("unit", pair, 0.5, 0.4)) == expected
