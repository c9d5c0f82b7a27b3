"""The rules on guides: each catches what it is for, on bodies, and passes the device as built."""

from dataclasses import replace

import pytest
from shapely.affinity import affine_transform, translate

from mdlcad.parts.body import Body, BodyKind
from mdlcad.signoff.guides import check_guides, measured
from tests.parts.device import Device

MOMENTS = {"clock-0": 500.0, "clock-1": 500.0, "clock-2": 500.0}


def rules(found: list[Body], device: Device, moments: dict[str, float] = MOMENTS) -> dict[str, str]:
    findings, _ = check_guides(found, moments, device.process)
    assert all(item.limit != item.value for item in findings)
    return {item.rule: item.bodies[0] for item in findings}


def test_the_device_as_built_keeps_them(device: Device, bodies: dict[str, Body]) -> None:
    found, guides = check_guides(list(bodies.values()), MOMENTS, device.process)
    assert found == [] and [item.plate for item in guides] == ["clock-2", "clock-1", "clock-0"]
    for item in guides:
        assert item.load_n == pytest.approx(500.0 / item.span_mm, rel=0.2)
        assert 0.0 < item.error_mm < device.process.machine.repeatability


def test_a_guide_left_out(device: Device, bodies: dict[str, Body]) -> None:
    found = [body for name, body in bodies.items() if name != "guide.clock-1.0"]
    assert rules(found, device) == {"guide_missing": "clock-1"}


def test_a_moment_too_large(device: Device, bodies: dict[str, Body]) -> None:
    found = rules(list(bodies.values()), device, MOMENTS | {"clock-2": 8000.0})
    assert set(found) == {"guide_strain", "guide_buckling"}


def test_a_leaf_drawn_too_short(device: Device, bodies: dict[str, Body]) -> None:
    guide = bodies["guide.clock-0.0"]
    short = replace(guide, section=affine_transform(guide.section, [1, 0, 0, 0.5, 0, 4.0]))
    assert rules([*(bodies | {guide.name: short}).values()], device) == {"guide_strain": guide.name}


def test_guides_drawn_side_by_side(device: Device, bodies: dict[str, Body]) -> None:
    left, right = bodies["guide.clock-0.0"], bodies["guide.clock-0.1"]
    apart = right.section.centroid.x - left.section.centroid.x
    near = replace(right, section=translate(right.section, 6.0 - apart))
    assert "guide_turn" in rules([*(bodies | {right.name: near}).values()], device)


def test_what_is_measured_is_what_was_drawn(device: Device, bodies: dict[str, Body]) -> None:
    for body in bodies.values():
        if body.kind is BodyKind.GUIDE:
            leaf = measured(body, device.process)
            low, bottom, high, top = body.section.bounds
            fillet = device.process.machine.fillet
            assert leaf.fillet == pytest.approx(fillet, abs=2e-3)
            assert (leaf.wall, leaf.length) == pytest.approx((high - low - 2.0 * fillet, top - bottom), abs=1e-3)
            assert leaf.depth == device.process.plate(body.plate).thickness
