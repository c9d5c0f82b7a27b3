"""The routing: which nets take another way, which only moved, and how long they are; couplers, bias leaves, tabs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import hypot

from mdlcad.compare.change import Change, FieldChange, Sort, Spot
from mdlcad.compare.fields import counted, keyed_changes, largest_first, same_number
from mdlcad.compare.pair import Findings, Pair
from mdlcad.mechanics.decks import Deck, plate_in
from mdlcad.routing.layout import BiasLeaf, CouplerLeaf, Layout, RungEnd

Box = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class _Piece:
    """A bar of a net: ``way`` is what does not change when it only moves; ``box`` its centre line's ends in mm."""

    way: str
    plate: str
    box: Box

    @property
    def length(self) -> float:
        return (self.box[2] - self.box[0]) + (self.box[3] - self.box[1])


@dataclass(slots=True)
class _Net:
    """The bars of one carrier, by kind and number."""

    pieces: list[_Piece] = field(default_factory=list)

    @property
    def length(self) -> float:
        return sum(piece.length for piece in self.pieces)

    @property
    def way(self) -> list[str]:
        return [piece.way for piece in self.pieces]


def routing_changes(pair: Pair) -> Findings:
    """Changes of the routing, and remarks."""
    a, b = pair.both("layout.json", Layout)
    a = _renamed(pair, a)
    nets_a, nets_b = _nets(a), _nets(b)
    changes = [_whole(name, Sort.REMOVED, nets_a[name]) for name in nets_a if name not in nets_b]
    changes += [_whole(name, Sort.ADDED, nets_b[name]) for name in nets_b if name not in nets_a]
    for name, before in nets_a.items():
        after = nets_b.get(name)
        if after is not None:
            changes += _net_change(name, before, after, pair.tolerance_mm)
    changes += _leaves(
        "coupler", {c.coupling: c for c in a.couplers}, {c.coupling: c for c in b.couplers}, pair.tolerance_mm
    )
    changes += _leaves("bias leaf", {c.mass: c for c in a.biases}, {c.mass: c for c in b.biases}, pair.tolerance_mm)
    changes += keyed_changes("unrealised coupling", dict(a.unrealised), dict(b.unrealised))
    total_a, total_b = sum(net.length for net in nets_a.values()), sum(net.length for net in nets_b.values())
    notes = []
    if not same_number(total_a, total_b, pair.tolerance_mm):
        notes.append(f"carriers are {total_a:.1f} -> {total_b:.1f} mm long altogether")
    return Findings(largest_first(changes), notes)


def _renamed(pair: Pair, layout: Layout) -> Layout:
    """The layout of A in the names of B."""

    def end(item: RungEnd) -> RungEnd:
        return replace(item, ref=pair.coupling(pair.mass(item.ref)))

    return replace(
        layout,
        rungs=tuple(replace(r, net=pair.mass(r.net), left=end(r.left), right=end(r.right)) for r in layout.rungs),
        trunks=tuple(replace(t, net=pair.mass(t.net)) for t in layout.trunks),
        couplers=tuple(replace(c, coupling=pair.coupling(c.coupling)) for c in layout.couplers),
        biases=tuple(replace(c, mass=pair.mass(c.mass)) for c in layout.biases),
        tabs=tuple(replace(t, net=pair.mass(t.net)) for t in layout.tabs),
        unrealised=tuple((pair.coupling(name), why) for name, why in layout.unrealised),
    )


def _nets(layout: Layout) -> dict[str, _Net]:
    nets: dict[str, _Net] = {}
    # pieces in an order that their numbering does not decide, so that a re-numbered net is the same net
    for trunk in sorted(layout.trunks, key=lambda item: (item.net, item.x, item.y_low)):
        plate = plate_in(Deck.UPPER if trunk.deck is Deck.UPPER else Deck.LOWER, "V")
        piece = _Piece("trunk", plate, (trunk.x, trunk.y_low, trunk.x, trunk.y_high))
        nets.setdefault(trunk.net, _Net()).pieces.append(piece)
    for rung in sorted(layout.rungs, key=lambda item: (item.net, item.y, item.left.x)):
        ends = " to ".join(_end_words(item) for item in (rung.left, rung.right))
        piece = _Piece(f"rung {rung.plate} {ends}", rung.plate, (rung.left.x, rung.y, rung.right.x, rung.y))
        nets.setdefault(rung.net, _Net()).pieces.append(piece)
    for tab in sorted(layout.tabs, key=lambda item: (item.net, item.bit)):
        for number, (start, stop) in enumerate(pairwise(tab.path)):
            low, high = (
                (min(start[0], stop[0]), min(start[1], stop[1])),
                (max(start[0], stop[0]), max(start[1], stop[1])),
            )
            piece = _Piece(f"tab {tab.bit} {tab.plate} {number}", tab.plate, (*low, *high))
            nets.setdefault(tab.net, _Net()).pieces.append(piece)
    return nets


def _end_words(item: RungEnd) -> str:
    return str(item.kind) if item.kind == "via" else f"{item.kind} {item.ref}"


def _whole(name: str, sort: Sort, net: _Net) -> Change:
    words = f"{counted(len(net.pieces), 'bar')}, {net.length:.1f} mm"
    return Change("net", name, sort, words, size=net.length, unit="mm", spots=_spots(net.pieces))


def _net_change(name: str, before: _Net, after: _Net, tolerance: float) -> Iterable[Change]:
    length = FieldChange("length", round(before.length, 6), round(after.length, 6))
    lengths = f"length {before.length:.2f} -> {after.length:.2f} mm"
    if before.way != after.way:
        gone = [piece for piece in before.pieces if piece.way not in after.way]
        fresh = [piece for piece in after.pieces if piece.way not in before.way]
        size = max(abs(after.length - before.length), sum(piece.length for piece in fresh))
        words = f"{counted(len(gone), 'bar')} gone, {len(fresh)} new, {lengths}"
        yield Change("net", name, Sort.REROUTED, words, (length,), size, "mm", _spots(fresh or gone or after.pieces))
        return
    shifts = [
        tuple(new - old for old, new in zip(one.box, other.box, strict=True))
        for one, other in zip(before.pieces, after.pieces, strict=True)
    ]
    moved = [
        (hypot(max(s[0], s[2], key=abs), max(s[1], s[3], key=abs)), piece)
        for s, piece in zip(shifts, after.pieces, strict=True)
        if any(not same_number(part, 0.0, tolerance) for part in s)
    ]
    if not moved:
        return
    farthest = max(distance for distance, _ in moved)
    same_way = "all of it" if len(moved) == len(shifts) and _rigid(shifts, tolerance) else counted(len(moved), "bar")
    words = f"{same_way} by up to {farthest:.3f} mm, {lengths}"
    yield Change("net", name, Sort.MOVED, words, (length,), farthest, "mm", _spots([piece for _, piece in moved]))


def _rigid(shifts: list[tuple[float, ...]], tolerance: float) -> bool:
    first = shifts[0]
    return all(
        same_number(s[0], first[0], tolerance)
        and same_number(s[1], first[1], tolerance)
        and same_number(s[2], first[0], tolerance)
        and same_number(s[3], first[1], tolerance)
        for s in shifts
    )


def _spots(pieces: Iterable[_Piece], margin: float = 3.0) -> tuple[Spot, ...]:
    ordered = sorted(pieces, key=lambda piece: -piece.length)
    return tuple(
        Spot(p.plate, (p.box[0] - margin, p.box[1] - margin, p.box[2] + margin, p.box[3] + margin)) for p in ordered
    )


def _leaves(
    what: str,
    a: Mapping[str, CouplerLeaf | BiasLeaf],
    b: Mapping[str, CouplerLeaf | BiasLeaf],
    tolerance: float,
) -> Iterable[Change]:
    for change in keyed_changes(what, a, b, _leaf_words, tolerance):
        leaf = b.get(change.name) or a[change.name]
        x = leaf.start_x if isinstance(leaf, CouplerLeaf) else leaf.post_x
        y = leaf.y if isinstance(leaf, CouplerLeaf) else leaf.post_y
        yield replace(change, spots=(Spot(leaf.plate, (x - 8, y - 8, x + 8, y + 8)),))


def _leaf_words(leaf: CouplerLeaf | BiasLeaf) -> str:
    return f"on {leaf.plate}, {leaf.side} of its hub"
