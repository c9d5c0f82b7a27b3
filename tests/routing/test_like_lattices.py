"""The lattices that a device is laid out on like an earlier one."""

from mdlcad.placement.lattice import lattices, place_ports
from mdlcad.placement.placer import place
from mdlcad.routing.driver import SMALLEST, STEP, Size
from mdlcad.routing.layout import Layout, Trunk
from mdlcad.routing.like_lattices import MOST_LARGER, sites
from tests.placement.networks import SQUARE, small

SCALE = 3.9
TRUNK = Trunk("a.left", "a", 30.0, 40.0, 60.0)


def test_the_earlier_lattice_first_then_ones_that_hold_it_at_its_own_pitch() -> None:
    network, ports, rules = small()
    grid = lattices(SQUARE, place_ports(network, ports, SCALE), rules, SCALE, 18)[0]
    earlier = place(network, grid, rules, 3).placement
    layout = Layout((), (TRUNK,), (), (), (), (), 0)
    found = list(sites(network, SQUARE, ports, rules, earlier, layout, SMALLEST))
    first, *others = found
    assert first.lattice == grid and first.layout == layout
    assert first.slots == {unit.mass: (unit.column, unit.row) for unit in earlier.masses}
    scales = [site.lattice.mm_per_grid for site in others]
    assert scales == sorted(scales) and scales[-1] > SCALE * STEP ** (MOST_LARGER - 0.1)
    held = [site for site in others if site.layout.trunks]
    # one to three a scale (the old rows in the middle, lowest or highest); the rest have channels of another width
    assert len({site.lattice.mm_per_grid for site in held}) == MOST_LARGER
    stand = {
        (site.lattice.mm_per_grid, min(row for _, row in site.slots.values()), site.lattice.row_y) for site in held
    }
    assert len(stand) == len(held)
    roomy = [site for site in held if site.lattice.mm_per_grid == scales[-1]]
    lowest = [min(row for _, row in site.slots.values()) for site in roomy]
    assert len(roomy) == 3 and min(lowest) == min(row for _, row in first.slots.values())
    for site in held:
        # all masses stand as they stood among each other, in mm too, and the trunk stood by them
        across = [site.lattice.column_x[site.slots[unit.mass][0]] - unit.x for unit in earlier.masses]
        upwards = [site.lattice.row_y[site.slots[unit.mass][1]] - unit.y for unit in earlier.masses]
        assert max(across) - min(across) < 1e-5 and max(upwards) - min(upwards) < 1e-5
        assert abs(site.layout.trunks[0].x - TRUNK.x - across[0]) < 1e-5
    fixed = sites(network, SQUARE, ports, rules, earlier, layout, Size(pitch=SCALE))
    assert next(iter(fixed)).lattice == grid
