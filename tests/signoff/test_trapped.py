"""Orders of assembly in which something is in the way, and the order of a real device."""

from shapely import box

from mdlcad.parts.assembly import StepKind, assembly_of
from mdlcad.parts.body import BodyKind
from mdlcad.signoff.trapped import check_assembly
from tests.export.bodies import body
from tests.parts.device import small_device

PIN = body("pin.a", box(4, 4, 6, 6), z=0.0, thickness=8.0, kind=BodyKind.PIN)
BAR = body("rung.a", box(0, 0, 20, 10), z=9.0, thickness=3.0, kind=BodyKind.RUNG)
EYE = body("rung.b", box(0, 0, 20, 10).difference(box(4, 4, 6, 6)), z=4.0, thickness=3.0, kind=BodyKind.RUNG)


def test_a_bar_over_a_pin_goes_on_after_it_and_not_before():
    assert check_assembly([PIN, EYE, BAR]) == []
    found = check_assembly([EYE, BAR, PIN])
    assert [(item.rule, item.bodies) for item in found] == [("trapped", ("pin.a", "rung.a"))]
    assert found[0].value == 12.0 and 4.0 <= found[0].x <= 6.0


def test_a_part_without_the_hole_that_its_pin_needs_cannot_come_down():
    solid = body("rung.b", box(0, 0, 20, 10), z=4.0, thickness=3.0, kind=BodyKind.RUNG)
    assert [item.bodies for item in check_assembly([PIN, solid])] == [("rung.b", "pin.a")]


def test_a_part_that_reaches_under_another_is_trapped_in_either_order():
    """Two hooks: each has a bar that lies over a foot of the other."""
    left = [body("a.foot", box(0, 0, 10, 4)), body("a.bar", box(0, 10, 10, 14), z=5.0)]
    right = [body("b.foot", box(2, 10, 12, 14)), body("b.bar", box(2, 0, 12, 4), z=5.0)]
    assert check_assembly([*left, *right]) and check_assembly([*right, *left])


def test_the_order_of_a_device_holds_every_body_once_and_traps_none():
    device = small_device()
    bodies = device.bodies()
    steps = assembly_of(bodies, device.process)
    order = [item for step in steps for item in step.bodies]
    assert sorted(item.name for item in order) == sorted(item.name for item in bodies)
    assert check_assembly(order) == []
    assert [step.kind for step in steps][:2] == [StepKind.BASE, StepKind.CLOCK]
    assert [step.kind for step in steps][-3:] == [StepKind.COVER, StepKind.POSTS, StepKind.SCREWS]


def test_upside_down_most_of_it_cannot_be_put_together():
    device = small_device()
    order = [item for step in assembly_of(device.bodies(), device.process) for item in step.bodies]
    assert len(check_assembly(list(reversed(order)))) > len(order) / 2
