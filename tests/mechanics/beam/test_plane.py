"""Filleted walls and a whole coupler against plane stress: what beam theory gets right, and what it does not."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from shapely import Polygon

from mdlcad.mechanics import Process, Sizing, process_names
from mdlcad.mechanics.fillet import Seat, flat_root, notch_factor, shear_length, shortening
from mdlcad.mechanics.flexure import deflect, examine, signal_matrix
from mdlcad.mechanics.leaves import LeafKind, chain_of
from mdlcad.mechanics.reduced import unit_force
from mdlcad.mechanics.sizing import turn_stiffness
from mdlcad.mechanics.unit import beam_heights, flexing_span
from mdlcad.parts.shapes import box, filleted, strip
from tests.mechanics.beam import curves
from tests.mechanics.beam.plane import Found, Grip, gripped, mesh, pulled

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
@pytest.mark.parametrize("sides", [1, 2])
@pytest.mark.parametrize("radius", [0.0, 0.1, 0.2, 0.3, 0.4])
@pytest.mark.parametrize("length", [6.0, 12.5])
def test_blocks_give_way_under_a_root_as_the_law_says(sides: int, radius: float, length: float) -> None:
    """Fillets, what blocks give and shear together: the wall is as stiff as one of the length that it seems to have."""
    wall = 0.5
    found = between_blocks(length, wall, radius, sides)
    root = flat_root(radius, sides, seat=Seat.BLOCK)
    seems = length - 2.0 * shortening(wall, root)[0] + shear_length(wall, length)
    assert found.force == pytest.approx((wall / seems) ** 3, rel=0.01 if length > 10.0 else 0.03)
    rigid = length - 2.0 * shortening(wall, flat_root(radius, sides))[0]
    assert found.force < 0.95 * (wall / rigid) ** 3  # it could not be left out


@pytest.mark.long
@pytest.mark.parametrize("sides", [1, 2])
@pytest.mark.parametrize("radius", [0.1, 0.2, 0.3])
def test_strain_in_a_fillet_is_the_notch_factors(sides: int, radius: float) -> None:
    length, wall = 12.5, 0.5
    found = between_blocks(length, wall, radius, sides)
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


@pytest.mark.long
@pytest.mark.parametrize("name", process_names())
def test_a_whole_unit_is_as_stiff_as_its_law(name: str) -> None:
    """Rib, shuttle, end block, series spring and clock block as cut, in one outline: y, x and turning.

    The rib is held at its back and the clock block as a whole; the shuttle is held in its middle.
    """
    process, sizing = curves.sized(name)
    unit, law, series, rules = process.unit, sizing.law, sizing.series, sizing.rules
    half, high, arm, fillet = unit.block_width / 2.0, law.shuttle_height / 2.0, series.arm / 2.0, process.machine.fillet
    wall, block = series.wall / 2.0, process.pin.side / 2.0 + process.pin.wall
    near = [half + series.clear_block + wall + i * series.pitch for i in range(series.leaves)]
    far = [near[-1] + series.wall + series.clear + i * series.pitch for i in range(series.leaves)]
    clock, face = far[-1] + wall + series.clear_block, series.height - series.arm
    hub = -half - unit.span - rules.hub_half
    rib = hub - rules.hub_half - unit.span
    parts = [box(-half, -high, half, high), box(half, -arm, near[-1] + wall, arm)]
    parts += [box(far[0] - wall, -arm, clock, arm), box(clock, -block, clock + 2.0 * block, block)]
    parts += [box(hub - rules.hub_half, -high, hub + rules.hub_half, high)]
    parts += [box(rib - unit.rib_width, -high - BLOCK, rib, high + BLOCK)]
    for side in (1.0, -1.0):
        low, top = sorted((side * face, side * series.height))
        parts.append(box(near[0] - wall, low, far[-1] + wall, top))
        parts += [strip([(x, 0.0), (x, side * (face + 0.1))], series.wall) for x in near + far]
    heights = beam_heights(process)
    ends = ((rib, hub - rules.hub_half), (hub + rules.hub_half, -half))
    parts += [strip([(a - 0.1, y), (b + 0.1, y)], unit.beam_wall) for y in heights for a, b in ends]
    outline = filleted(shapely.union_all(parts), fillet)
    scale = unit.beam_wall / 0.5
    roots = [(x, side * y) for x in near + far for side in (1, -1) for y in (arm, face)]
    roots += [(x, y) for y in heights for x in (*ends[0], *ends[1])]
    grips = (
        Grip(lambda at: np.hypot(at[:, 0] - hub, at[:, 1]) < 0.35 * rules.hub_half, (hub, 0.0)),
        Grip(lambda at: at[:, 0] >= clock - 1e-9, (clock, 0.0)),
        Grip(lambda at: at[:, 0] <= rib - unit.rib_width + 1e-9, (rib, 0.0)),
    )
    meshed = mesh(outline, 0.07 * scale, 0.16 * scale, roots, 0.6 * scale)
    plate = process.plate("unit")
    matrix = gripped(*meshed, grips) * process.material(plate).modulus * plate.thickness

    def seen(at: int, *free: int) -> float:
        """Stiffness of one motion with others free and the rest held."""
        inner = np.linalg.solve(matrix[np.ix_(free, free)], matrix[list(free), at])
        return float(matrix[at, at] - matrix[at, list(free)] @ inner)

    across = float(unit_force(process, law, series, 0.0, np.array([1e-4]))[0]) / 1e-4
    assert seen(1, 0, 2) == pytest.approx(across, rel=0.05)
    assert seen(1, 0, 2) < 0.93 * across * (law_of_rigid_blocks(sizing, process) / law.beam_stiffness)
    assert seen(3, 0) == pytest.approx(law.axial_stiffness, rel=0.05)
    assert seen(2, 0, 1) == pytest.approx(turn_stiffness(law, series), rel=0.07)


def law_of_rigid_blocks(sizing: Sizing, process: Process) -> float:
    """K_b of the same beams if nothing that they are rooted in gave way."""
    span = flexing_span(process)
    return sizing.law.beam_stiffness * (span.bend / span.out) ** 3
