import math

import pytest
import shapely

from mdlcad.parts.arcs import rings, true_area, with_arcs
from mdlcad.parts.shapes import box, closed, disc, filleted, join, slits


@pytest.mark.parametrize(("width", "found"), [(0.15, 1), (0.39, 1), (0.41, 0), (2.0, 0)])
def test_a_slit_too_narrow_to_cut_is_found(width: float, found: int) -> None:
    """A bar beside a step of its own carrier: what lies between them is a slit if it is narrower than the gap."""
    bar = box(0.0, 0.0, 4.0, 20.0)
    carrier = box(4.0, 10.0, 30.0, 14.0).union(box(4.0 + width, 8.0, 30.0, 16.0))
    narrow = slits(bar, carrier, 0.4)
    assert len(narrow) == 2 * found
    assert sum(piece.area for piece in narrow) == pytest.approx(found * width * 4.0, rel=0.01)


def beam_between_blocks():
    """A wall of 0.5 between two blocks, flush with the edge of the second."""
    return join([box(0, 0, 2, 6), box(2, 2, 8, 2.5), box(8, 2, 10, 6)])


@pytest.mark.parametrize("rounded", [filleted, closed])
def test_inner_corners_get_arcs_and_outer_ones_stay(rounded) -> None:
    """Two at the first block, one at the second; each takes (1 - pi / 4) r^2 of the void."""
    sharp = beam_between_blocks()
    shape = rounded(sharp, 0.2)
    assert true_area(shape) - sharp.area == pytest.approx(3 * (1 - math.pi / 4) * 0.2**2, rel=2e-3)
    assert shapely.difference(sharp, shape).area < 1e-6
    (ring,) = rings(shape)
    arcs = [vertex for vertex in with_arcs(ring) if vertex[2]]
    assert [4 * math.atan(bulge) for *_, bulge in arcs] == pytest.approx([-math.pi / 2] * 3, rel=1e-2)


def test_the_corners_of_holes_are_inner_corners() -> None:
    shape = filleted(box(0, 0, 10, 10).difference(box(2, 2, 8, 3)), 0.5)
    # as wide as two fillets: its ends are half circles
    assert true_area(shape) == pytest.approx(100 - 5 - math.pi * 0.5**2, rel=1e-5)


def test_a_fillet_at_an_eye_touches_both() -> None:
    shape = closed(join([disc(0, 0, 2.6), box(0, -0.35, 6, 0.35)]), 0.2)
    end = math.sqrt(2.8**2 - 0.55**2)
    assert shape.intersects(shapely.Point(end - 0.05, 0.352))
    assert not shape.intersects(shapely.Point(end + 0.02, 0.352))


def test_gaps_too_narrow_for_fillets_are_refused() -> None:
    fork = join([box(0, 0, 1, 3), box(1, 0, 5, 1), box(1, 1.3, 5, 3)])
    with pytest.raises(ValueError, match=r"no room for a fillet.*\(1\.00, 1\.[03]0\)"):
        filleted(fork, 0.2)
    with pytest.raises(ValueError, match="too narrow for fillets"):
        closed(fork, 0.2)
    assert filleted(fork, 0.15).is_valid
