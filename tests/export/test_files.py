import pytest
from shapely import box

from mdlcad.export.files import laid_out
from mdlcad.parts import Body, BodyKind
from mdlcad.parts.frame import STILL


def shim(name: str, z: float, low: float, high: float) -> Body:
    return Body(name, BodyKind.SPACER, "shims", z, 0.3, box(low, 0.0, high, 20.0), STILL, ("frame",), "#b4bcc8")


def test_shims_of_many_heights_lie_side_by_side() -> None:
    lower, left, right = shim("a", 5.0, 0.0, 50.0), shim("b", 9.0, 0.0, 20.0), shim("b.1", 9.0, 30.0, 50.0)
    flat = laid_out([lower, left, right], 2.0)
    assert flat[0] is lower
    assert [body.section.bounds for body in flat[1:]] == [
        pytest.approx((52.0, 0.0, 72.0, 20.0)),
        pytest.approx((82.0, 0.0, 102.0, 20.0)),
    ]


def test_bodies_of_one_height_stay_where_they_are() -> None:
    bodies = [shim("a", 5.0, 0.0, 20.0), shim("b", 5.0, 30.0, 50.0)]
    assert laid_out(bodies, 2.0) == bodies
