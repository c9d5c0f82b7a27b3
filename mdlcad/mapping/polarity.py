"""Which masses to use upside down, so that the fewest couplings are negative.

Turning a mass round (x -> -x) changes the sign of all its couplings and of its bias. A negative coupling needs a part
of its own (a rocker), a positive one is a plain spring. Sensors and actuators keep their sign.

A rocker turns on a fixed post and so does a bias leaf; either side of a hub has room for one post, so no mass is to
have more than two of them. That comes before the number of rockers.
"""

from __future__ import annotations

from collections.abc import Iterable

from mdlcad.mapping.frustration import SignedGraph, least_frustration

_POSTS = 2


def choose_polarity(
    masses: list[str], couplings: list[tuple[str, str, bool]], fixed: Iterable[str], biased: Iterable[str]
) -> dict[str, int]:
    """+1 or -1 for every mass; the fewest negative couplings among the choices with the fewest posts too many.

    Args:
        couplings: source, target, and whether the coupling is negative while all masses are upright.
        fixed: masses that stay +1.
        biased: masses with a bias leaf.
    """
    # masses that stay as they are are one node: what joins two of them can not be changed
    held = set(fixed)
    node = {name: index + 1 for index, name in enumerate(name for name in masses if name not in held)}
    ends = tuple((node.get(source, 0), node.get(target, 0)) for source, target, _ in couplings)
    entering: dict[str, list[int]] = {name: [] for name in masses}
    for index, (_, target, _) in enumerate(couplings):
        entering[target].append(index)
    leaves = set(biased)
    rooms = ((tuple(entering[name]), _POSTS - (name in leaves)) for name in masses)
    graph = SignedGraph(
        nodes=len(node) + 1,
        ends=ends,
        negative=tuple(negative for _, _, negative in couplings),
        groups=tuple((group, room) for group, room in rooms if len(group) > room),
    )
    chosen = least_frustration(graph).negative
    turned = _signs(graph, chosen)
    return {name: turned[node.get(name, 0)] for name in masses}


def _signs(graph: SignedGraph, chosen: tuple[bool, ...]) -> list[int]:
    """Signs that make all couplings but ``chosen`` positive, +1 for node 0 and for the first node of every part."""
    beside: list[list[tuple[int, int]]] = [[] for _ in range(graph.nodes)]
    for (a, b), negative, left in zip(graph.ends, graph.negative, chosen, strict=True):
        if not left and a != b:
            sign = -1 if negative else 1
            beside[a].append((b, sign))
            beside[b].append((a, sign))
    signs = [0] * graph.nodes
    for first in range(graph.nodes):
        if signs[first]:
            continue
        signs[first] = 1
        reached = [first]
        while reached:
            at = reached.pop()
            for other, sign in beside[at]:
                if not signs[other]:
                    signs[other] = sign * signs[at]
                    reached.append(other)
    return signs
