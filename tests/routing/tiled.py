"""A large layout: copies of a routed one, side by side, every name its own."""

from dataclasses import replace

from mdlcad.mechanics.rules import LayoutRules
from mdlcad.network.model import Network
from mdlcad.placement.placement import Placement
from mdlcad.routing.layout import Layout


def tiled(
    network: Network, placement: Placement, layout: Layout, rules: LayoutRules, side: int
) -> tuple[Network, Placement, Layout, LayoutRules]:
    """``side`` x ``side`` copies; ports only on the first."""
    xs, ys = [x for x, _ in placement.boundary], [y for _, y in placement.boundary]
    # without the rims between them
    width, height = max(xs) - min(xs) - 16.0, max(ys) - min(ys) - 16.0
    copies = [(i, j) for i in range(side) for j in range(side)]
    parts = [
        _one(network, placement, layout, rules, i, j, i * width, j * height) for i in range(side) for j in range(side)
    ]
    nets, places, layouts, all_rules = zip(*parts, strict=True)
    columns, rows = len(placement.column_x), len(placement.row_y)
    far_x, far_y = max(xs) + (side - 1) * width, max(ys) + (side - 1) * height
    return (
        replace(
            network,
            masses=tuple(mass for item in nets for mass in item.masses),
            couplings=tuple(coupling for item in nets for coupling in item.couplings),
        ),
        replace(
            placement,
            boundary=((min(xs), min(ys)), (min(xs), far_y), (far_x, far_y), (far_x, min(ys))),
            column_x=tuple(x + i * width for i in range(side) for x in placement.column_x),
            row_y=tuple(y + j * height for j in range(side) for y in placement.row_y),
            slots=tuple((c + i * columns, r + j * rows) for i, j in copies for c, r in placement.slots),
            masses=tuple(mass for item in places for mass in item.masses),
        ),
        replace(
            layout,
            rungs=tuple(rung for item in layouts for rung in item.rungs),
            trunks=tuple(trunk for item in layouts for trunk in item.trunks),
            couplers=tuple(leaf for item in layouts for leaf in item.couplers),
            biases=tuple(leaf for item in layouts for leaf in item.biases),
            tabs=layout.tabs,
        ),
        replace(rules, bias_offsets={name: y for item in all_rules for name, y in item.bias_offsets.items()}),
    )  # fmt: skip


def _one(
    network: Network, placement: Placement, layout: Layout, rules: LayoutRules, i: int, j: int, x: float, y: float
) -> tuple[Network, Placement, Layout, LayoutRules]:
    def named(name: str) -> str:
        return name if i == j == 0 else f"{name}~{i}.{j}"

    def coupling(name: str) -> str:
        source, _, target = name.rpartition("->")
        return f"{named(source)}->{named(target)}"

    def end(old):
        ref = coupling(old.ref) if "->" in old.ref else named(old.ref)
        return replace(old, x=old.x + x, ref=ref)

    columns, rows = len(placement.column_x), len(placement.row_y)
    return (
        replace(
            network,
            masses=tuple(replace(mass, name=named(mass.name)) for mass in network.masses),
            couplings=tuple(replace(c, source=named(c.source), target=named(c.target)) for c in network.couplings),
        ),
        replace(
            placement,
            masses=tuple(
                replace(
                    m, mass=named(m.mass), x=m.x + x, y=m.y + y, column=m.column + i * columns, row=m.row + j * rows
                )
                for m in placement.masses
            ),
        ),
        replace(
            layout,
            rungs=tuple(
                replace(
                    r, name=named(r.name), net=named(r.net), y=r.y + y, left=end(r.left), right=end(r.right)
                )
                for r in layout.rungs
            ),
            trunks=tuple(
                replace(t, name=named(t.name), net=named(t.net), x=t.x + x, y_low=t.y_low + y, y_high=t.y_high + y)
                for t in layout.trunks
            ),
            couplers=tuple(
                replace(
                    leaf,
                    coupling=coupling(leaf.coupling),
                    start_x=leaf.start_x + x,
                    y=leaf.y + y,
                    post_x=None if leaf.post_x is None else leaf.post_x + x,
                )
                for leaf in layout.couplers
            ),
            biases=tuple(
                replace(b, mass=named(b.mass), post_x=b.post_x + x, post_y=b.post_y + y) for b in layout.biases
            ),
            tabs=(),
        ),
        replace(rules, bias_offsets={named(name): value for name, value in rules.bias_offsets.items()}),
    )  # fmt: skip
