"""Filleted walls and a whole coupler against plane stress: what beam theory gets right, and what it does not."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import Polygon

from mdlcad.mechanics.fillet import flat_root, notch_factor, shortening
from mdlcad.mechanics.flexure import deflect, examine, signal_matrix
from mdlcad.mechanics.leaves import LeafKind, chain_of
from tests.mechanics.beam import curves
from tests.mechanics.beam.plane import Found, mesh, pulled

BLOCK = 3.0


def rounded(shape: Polygon, radius: float) -> Polygon:
    return shape.buffer(radius, join_style="mitre").buffer(-radius, quad_segs=16) if radius else shape


def between_blocks(length: float, wall: float, radius: float, sides: int) -> Found:
    """A guided wall, in the middle of its blocks' faces or flush with their edges."""
    top = wall if sides == 1 else wall + BLOCK
    blocks = [shapely.box(x, -BLOCK, x + BLOCK, top) for x in (-BLOCK, length)]
    shape = rounded(shapely.union_all([*blocks, shapely.box(-0.1, 0.0, length + 0.1, wall)]), radius)
    roots = [(x, y) for x in (0.0, length) for y in (0.0, wall)]
    return pulled(*mesh(shape, 0.04, 0.12, roots, 0.6), -BLOCK, length + BLOCK)


def highest(found: Found, length: float) -> float:
    within = (found.places[:, 0] > 0.0) & (found.places[:, 0] < length)
    return float(found.strain[within].max())


def test_the_computation_knows_a_slender_beam() -> None:
    """Of a long one its roots do not matter, nor does shear."""
    found = between_blocks(40.0, 0.5, 0.0, 2)
    assert found.force == pytest.approx(0.5**3 / 40.0**3, rel=0.04)


@pytest.mark.long
@pytest.mark.parametrize(("sides", "give"), [(2, (0.27, 0.36)), (1, (0.48, 0.60))])
@pytest.mark.parametrize("radius", [0.1, 0.2, 0.3])
def test_blocks_give_way_under_a_root(sides: int, give: tuple[float, float], radius: float) -> None:
    """Beam theory takes them as rigid; docs/mechanics.md states by how much of a wall's thickness they are not."""
    length, wall = 12.5, 0.5
    found = between_blocks(length, wall, radius, sides)
    flexing = length - 2.0 * shortening(wall, flat_root(radius, sides))[0]
    longer = ((wall**3 / found.force) ** (1.0 / 3.0) - flexing) / 2.0 / wall
    assert give[0] < longer < give[1]
    at_end = found.force * (length / 2.0 - radius) * 6.0 / wall**2
    assert highest(found, length) / at_end == pytest.approx(notch_factor(wall, radius, sides), rel=0.05)


@pytest.mark.long
@pytest.mark.parametrize("radius", [0.1, 0.2, 0.3])
def test_a_whole_coupler_is_as_stiff_as_its_frame(radius: float) -> None:
    process, sizing = curves.sized("pom_cut")
    leaf = next(item.leaf for item in sizing.couplers if item.leaf.kind is LeafKind.COUPLER)
    shape = replace(leaf.shape, fillet=radius)
    path, wall, length = shape.path(), shape.wall, shape.length
    walls = shapely.LineString(path).buffer(wall / 2.0, cap_style="flat", join_style="mitre")
    blocks = [shapely.box(-BLOCK, -3.75, 0.0, 3.75), shapely.box(length, -3.75, length + BLOCK, 3.75)]
    outline = rounded(shapely.union_all([walls, *blocks]), radius)
    found = pulled(*mesh(outline, 0.06, 0.12, path, 0.9), -BLOCK, length + BLOCK)
    chain = chain_of(leaf.kind, shape, process)
    plate = process.plate("H0")
    stiffness = float(signal_matrix(chain)[0, 0]) / process.material(plate).modulus / plate.thickness
    assert found.force == pytest.approx(stiffness, rel=0.02)
    strain = examine(chain, deflect(chain, 0.0, 1.0)).strain
    assert np.isclose(highest(found, length) / strain, notch_factor(wall, radius), rtol=0.05)
