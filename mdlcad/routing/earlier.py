"""An earlier build's layout under the names of today."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from mdlcad.network.matching import changed_masses, renamed, renamed_masses
from mdlcad.network.model import Network
from mdlcad.placement.keep import Kept
from mdlcad.placement.placement import Placement
from mdlcad.routing.layout import EndKind, Layout, RungEnd, Side


@dataclass(frozen=True, slots=True)
class Earlier:
    """What an earlier build placed and routed."""

    network: Network
    placement: Placement
    layout: Layout


def under_new_names(earlier: Earlier, network: Network) -> Earlier:
    """The earlier build as if its masses had always been called what they are in ``network``.

    A mass keeps its name if there is still one of that name; else it is found by what it is joined to. The
    couplings of the result are those of the old network; a mass that has gone keeps its name.
    """
    names = renamed_masses(earlier.network, network)
    if not names:
        return earlier
    couplings = {
        item.name: f"{names.get(item.source, item.source)}->{names.get(item.target, item.target)}"
        for item in earlier.network.couplings
    }
    return Earlier(
        renamed(earlier.network, names),
        replace(
            earlier.placement,
            masses=tuple(replace(unit, mass=names.get(unit.mass, unit.mass)) for unit in earlier.placement.masses),
        ),
        _layout(earlier.layout, names, couplings),
    )


def _layout(layout: Layout, names: Mapping[str, str], couplings: Mapping[str, str]) -> Layout:
    def called(piece: str, net: str) -> str:
        """A piece's name, which begins with that of its net."""
        return names.get(net, net) + piece.removeprefix(net)

    trunks = {trunk.name: called(trunk.name, trunk.net) for trunk in layout.trunks}
    known = {EndKind.HUB: names, EndKind.VIA: trunks, EndKind.COUPLER: couplings}

    def end(of: RungEnd) -> RungEnd:
        return replace(of, ref=known.get(of.kind, {}).get(of.ref, of.ref))

    return replace(
        layout,
        rungs=tuple(
            replace(
                rung,
                name=called(rung.name, rung.net),
                net=names.get(rung.net, rung.net),
                left=end(rung.left),
                right=end(rung.right),
            )
            for rung in layout.rungs
        ),
        trunks=tuple(
            replace(trunk, name=trunks[trunk.name], net=names.get(trunk.net, trunk.net)) for trunk in layout.trunks
        ),
        couplers=tuple(replace(leaf, coupling=couplings.get(leaf.coupling, leaf.coupling)) for leaf in layout.couplers),
        biases=tuple(replace(leaf, mass=names.get(leaf.mass, leaf.mass)) for leaf in layout.biases),
        tabs=tuple(replace(tab, net=names.get(tab.net, tab.net)) for tab in layout.tabs),
    )


def kept_of(earlier: Earlier, network: Network, slots: Mapping[str, tuple[int, int]]) -> Kept:
    """What ``network`` can keep of ``earlier`` (under its names), with the masses' ``slots`` on the new lattice."""
    now = {mass.name for mass in network.masses}
    columns = {unit.mass: unit.column for unit in earlier.placement.masses}
    ends = {item.name: (item.source, item.target) for item in earlier.network.couplings}
    couplings = {}
    for leaf in earlier.layout.couplers:
        source, target = ends[leaf.coupling]
        if columns[source] == columns[target]:
            couplings[leaf.coupling] = int(leaf.side is Side.RIGHT)
    return Kept(
        {mass: slot for mass, slot in slots.items() if mass in now},
        couplings,
        {leaf.mass: int(leaf.side is Side.RIGHT) for leaf in earlier.layout.biases},
        changed_masses(earlier.network, network),
    )
