import pytest

from mdlcad.parts.shapes import box, slits


@pytest.mark.parametrize(("width", "found"), [(0.15, 1), (0.39, 1), (0.41, 0), (2.0, 0)])
def test_a_slit_too_narrow_to_cut_is_found(width: float, found: int) -> None:
    """A bar beside a step of its own carrier: what lies between them is a slit if it is narrower than the gap."""
    bar = box(0.0, 0.0, 4.0, 20.0)
    carrier = box(4.0, 10.0, 30.0, 14.0).union(box(4.0 + width, 8.0, 30.0, 16.0))
    narrow = slits(bar, carrier, 0.4)
    assert len(narrow) == 2 * found
    assert sum(piece.area for piece in narrow) == pytest.approx(found * width * 4.0, rel=0.01)
