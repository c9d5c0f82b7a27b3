"""A two-unit device as bare boxes: recovered right, and every seeded fault named."""

from dataclasses import replace

import pytest
from shapely import box

from mdlcad.network.model import Coupling, Dynamics, Mass, MassKind, Network
from mdlcad.signoff.lvs import compare, recover
from mdlcad.signoff.readback import ReadBody


def mass(name: str, bias: float = 0.0) -> Mass:
    return Mass(name, MassKind.GATE, 0, 3.0, -2.75, 0.0, bias, -1.0)


def network(strength: float = 0.3) -> Network:
    return Network(
        design="two",
        cells="parametron",
        dynamics=Dynamics(0.05, 0.25, 1.0, 10.0, 3),
        masses=(mass("a"), mass("b", bias=0.5)),
        couplings=(Coupling("a", "b", strength, abs(strength)),),
        sensors=(),
        actuators=(),
        registers=(),
        tick=None,
        cycles_per_tick=1,
    )


def read(name: str, x0, y0, x1, y1, z=0.0, height=2.0) -> ReadBody:
    section = box(x0, y0, x1, y1)
    return ReadBody(name, section, z, height, section.area * height)


def device() -> dict[str, ReadBody]:
    """Unit a at x = 0, unit b at x = 50; a's rung reaches to x = 30, its coupler from there to b's left block."""
    holed = {
        name: box(x - 5, -3, x + 5, 3).difference(box(x - 3, -1, x - 1, 1)).difference(box(x + 1, -1, x + 3, 1))
        for name, x in (("a", 0), ("b", 50))
    }
    bodies = [ReadBody(f"unit.{name}", holed[name], 0.0, 2.0, holed[name].area * 2) for name in ("a", "b")]
    for name, x in (("a", 0), ("b", 50)):
        bodies.append(read(f"pin.hub.{name}.left", x - 3, -1, x - 1, 1, 0.0, 8.0))
        bodies.append(read(f"pin.hub.{name}.right", x + 1, -1, x + 3, 1, 0.0, 8.0))
    rung = box(0.5, -2, 30, 2).difference(box(1, -1, 3, 1))
    bodies.append(ReadBody("rung.a.1", rung, 5.0, 3.0, rung.area * 3))
    leaf = box(30, -2, 49.5, 2).difference(box(47, -1, 49, 1))
    bodies.append(ReadBody("coupler.a->b", leaf, 5.0, 3.0, leaf.area * 3))
    bias = box(50.5, -2, 70, 2).difference(box(51, -1, 53, 1)).difference(box(66, -1, 68, 1))
    bodies.append(ReadBody("bias.b", bias, 5.0, 3.0, bias.area * 3))
    bodies.append(read("post.b", 66, -1, 68, 1, 5.0, 6.0))
    return {body.name: body for body in bodies}


def differences(bodies, wanted=None) -> str:
    return "\n".join(compare(recover(list(bodies.values())), wanted or network()).differences)


def test_a_good_layout_matches():
    result = compare(recover(list(device().values())), network())
    assert result.matched, result.differences
    assert (result.units, result.connections, result.biases) == (2, 1, 1)


def test_an_empty_layout_does_not_match():
    empty = replace(network(), masses=(), couplings=())
    assert not compare(recover([]), empty).matched


def test_a_rocker_is_told_from_a_plain_coupler_by_its_post():
    assert "positive" in differences(device(), network(strength=-0.3))
    bodies = device()
    leaf = bodies["coupler.a->b"]
    eye = leaf.section.difference(box(39, -1, 41, 1))
    bodies["coupler.a->b"] = replace(leaf, section=eye)
    bodies["post.1"] = read("post.1", 39, -1, 41, 1, 5.0, 6.0)
    assert differences(bodies, network(strength=-0.3)) == ""


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda b: b.pop("coupler.a->b"), "coupling missing: a->b"),
        (lambda b: b.pop("bias.b"), "bias missing: b"),
        (lambda b: b.pop("pin.hub.b.left"), "open: coupler.a->b"),
        (lambda b: b.pop("pin.hub.a.right"), "pinned to no shuttle"),
        (lambda b: b.pop("unit.b"), "unit missing: b"),
        (lambda b: b.__setitem__("rung.x", read("rung.x", 3, -1, 47, 0.5, 0.0, 8.0)), "short"),
        (
            lambda b: b.__setitem__("rung.a.1", replace(b["rung.a.1"], section=box(0.5, -2, 29.9, 2))),
            "open: coupler.a->b",
        ),
        (
            lambda b: b.update(
                {"unit.a": replace(b["unit.b"], name="unit.a"), "unit.b": replace(b["unit.a"], name="unit.b")}
            ),
            "coupling missing: a->b",
        ),
    ],
    ids=["leaf", "bias", "target pin", "source pin", "unit", "short", "cut carrier", "swapped units"],
)
def test_every_fault_is_named(change, words):
    bodies = device()
    change(bodies)
    assert words in differences(bodies)
