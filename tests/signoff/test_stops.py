"""How far a shuttle can tilt: cases computed by hand, and bodies in a stack."""

from dataclasses import replace

import pytest
from shapely import Point, Polygon, box, union_all
from shapely.affinity import translate

from mdlcad.mechanics.process import load_process
from mdlcad.signoff.lvs import Recovered
from mdlcad.signoff.measure import UnitSeen
from mdlcad.signoff.readback import ReadBody
from mdlcad.signoff.stops import MOST_TILT, Contact, farthest, stops_of, worn
from tests.parts.device import Device

GAP = 0.3


def bar(side: int, way: float, low: float, high: float) -> Contact:
    return Contact(side, way, ((-2.0, low), (2.0, low), (2.0, high), (-2.0, high)))


def test_a_bar_between_two_plates_turns_until_both_ends_touch() -> None:
    both = [bar(1, GAP, -50.0, 50.0), bar(-1, GAP, -50.0, 50.0)]
    assert farthest(both, 1) == pytest.approx(2 * GAP / 100.0)
    assert farthest(both, -1) == pytest.approx(2 * GAP / 100.0)


def test_a_bar_to_one_side_turns_about_the_shuttle_that_it_hangs_on() -> None:
    # the bar's end is 60 mm out; the shuttle, 4 mm to either side, can sink by 0.3 at its near edge
    arm = [bar(1, GAP, 0.0, 60.0), bar(-1, GAP, -4.0, 4.0)]
    assert farthest(arm, 1) == pytest.approx(2 * GAP / 64.0)
    # the other way nothing is under the bar's end: the shuttle's edges alone stop it, up against nothing
    assert farthest(arm, -1) == pytest.approx(2 * GAP / 4.0)


def test_a_roll_is_free_unless_something_stops_it_as_well() -> None:
    # up on the right, down on the left: it can roll out of the way
    away = [Contact(1, GAP, ((10.0, 20.0),)), Contact(-1, GAP, ((-10.0, -20.0),))]
    assert farthest(away, 1) == pytest.approx(MOST_TILT)
    assert farthest([*away, Contact(1, GAP, ((-10.0, 20.0),)), Contact(-1, GAP, ((10.0, -20.0),))], 1) == pytest.approx(
        2 * GAP / 40.0
    )


def test_what_nothing_stops_has_no_stop() -> None:
    assert farthest([], 1) == MOST_TILT


def test_worn_is_what_is_covered_for_all_of_a_motion() -> None:
    assert worn(box(0, 0, 10, 6), 0.0, 2.0).equals_exact(box(0, 2, 10, 4), 1e-3, normalize=True)
    assert worn(box(0, 0, 10, 3), 0.0, 2.0).is_empty
    assert worn(box(0, 0, 10, 6), 1.0, 2.0).area == pytest.approx(8.0 * 2.0, abs=1e-2)
    # of a hole, what passes it is lost: a slit as well as all that lies within 2 mm of it
    slit = union_all([box(0, 0, 10, 10)]).difference(box(4, 4.9, 6, 5.1))
    assert worn(slit, 0.0, 2.0).area == pytest.approx(10 * 6 - 2 * 4.2, abs=1e-2)
    disc = Point(0, 0).buffer(5.0)
    exact = translate(disc, 0, 2).intersection(translate(disc, 0, -2))
    assert worn(disc, 0.0, 2.0).symmetric_difference(exact).area < 0.01


class Bench:
    """One shuttle of 8 x 8 mm at (100, 100), a trunk on it, a base and a cover without holes, and nothing else."""

    def __init__(self, device: Device, z_gap: float = GAP) -> None:
        self.process = replace(load_process("pom_cut"), stack=replace(device.process.stack, z_gap=z_gap))
        self.rules = device.sizing.rules
        unit = next(iter(device_units(device)))
        shift = 4.0 - max(beam.y + beam.wall / 2.0 for beam in unit.left)
        beams = tuple(replace(beam, y=beam.y + (shift if beam.y > 0 else -shift)) for beam in unit.left)
        self.unit = replace(unit, x=100.0, y=100.0, half_hub=4.0, left=beams, right=beams)

    def body(self, name: str, plate: str, section: Polygon) -> ReadBody:
        thickness = self.process.plate(plate).thickness
        return ReadBody(name, section, self.process.z_of(plate), thickness, section.area * thickness)

    def stop(self, trunk: Polygon, *others: ReadBody) -> tuple[float, float]:
        whole = box(0, 0, 200, 200)
        found = (
            self.body("base", "base", whole),
            self.body("cover", "cover", whole),
            self.body("unit.a", "unit", whole),
            self.body("trunk.a", "V", trunk),
            *others,
        )
        recovered = Recovered(("a",), (), (), (), {"a": ("trunk.a",)})
        found_stop = stops_of(found, recovered, {"a": self.unit}, self.process, self.rules)["a"]
        return found_stop.low, found_stop.high


def device_units(device: Device) -> list[UnitSeen]:
    from mdlcad.signoff.measure import measure_unit

    bodies = [body for body in device.bodies() if body.name.startswith("unit.")]
    return [measure_unit(b.name, b.assembled if b.assembled is not None else b.section) for b in bodies]


TRUNK = box(96.0, 96.0, 104.0, 160.0)


def test_voids_count_as_way_and_what_lies_between_takes_them(device: Device) -> None:
    bench = Bench(device)
    # over the trunk three empty plates of 3 mm and four gaps; under the shuttle three clock plates are missing
    up, down = 3 * 3.0 + 4 * GAP, 3 * 2.0 + 4 * GAP
    assert bench.stop(TRUNK)[1] == pytest.approx(min((up + down) / 64.0, MOST_TILT))
    # a rib in the unit plate is 0.3 under the whole trunk: nothing sinks there
    rib = bench.body("frame.unit", "unit", box(94.0, 0.0, 106.0, 200.0))
    assert bench.stop(TRUNK, rib)[1] == pytest.approx((up + GAP) / 64.0)
    # a plate of the rim in H0 reaches over the trunk's last 20 mm: 0.3 there, of what is over it for all of its motion
    rim = bench.body("frame.H0", "H0", box(94.0, 140.0, 106.0, 200.0))
    assert bench.stop(TRUNK, rib, rim)[1] == pytest.approx(2 * GAP / 64.0)
    # the other way the same 20 mm are held between rib and rim, less a throw
    assert bench.stop(TRUNK, rib, rim)[0] == pytest.approx(-2 * GAP / (20.0 - bench.rules.throw))


def test_larger_gaps_let_it_tilt_farther(device: Device) -> None:
    found = []
    for z_gap in (GAP, 4 * GAP):
        bench = Bench(device, z_gap)
        rib = bench.body("frame.unit", "unit", box(94.0, 0.0, 106.0, 200.0))
        rim = bench.body("frame.H0", "H0", box(94.0, 140.0, 106.0, 200.0))
        found.append(bench.stop(TRUNK, rib, rim)[1])
    assert found[1] == pytest.approx(4 * found[0])


def test_another_net_between_takes_its_plate_where_it_always_is(device: Device) -> None:
    bench = Bench(device)
    rib = bench.body("frame.unit", "unit", box(94.0, 0.0, 106.0, 200.0))
    alone = bench.stop(TRUNK, rib)[1]
    throw = bench.rules.throw
    small = bench.body("trunk.b", "H0", box(90.0, 150.0, 110.0, 150.0 + 1.9 * throw))
    large = bench.body("trunk.b", "H0", box(90.0, 130.0, 110.0, 200.0))
    other = replace(bench.unit, x=30.0, y=30.0)
    for body, less in ((small, 0.0), (large, 3.0)):
        found = (
            bench.body("base", "base", box(0, 0, 200, 200)),
            bench.body("cover", "cover", box(0, 0, 200, 200)),
            bench.body("unit.a", "unit", box(0, 0, 1, 1)),
            bench.body("unit.b", "unit", box(0, 0, 1, 1)),
            bench.body("trunk.a", "V", TRUNK),
            rib,
            body,
        )
        recovered = Recovered(("a", "b"), (), (), (), {"a": ("trunk.a",), "b": ("trunk.b",)})
        stops = stops_of(found, recovered, {"a": bench.unit, "b": other}, bench.process, bench.rules)
        assert stops["a"].high == pytest.approx(alone - less / 64.0)
