"""Keeps NOR gates from being weak on all their inputs at once.

A mass that drives two biased masses (the inner ones of NORs) is held back by both when it falls to 0: it gets there
late and shallow, but it gets there, since the strong other input of each NOR carries it. A NOR *all* of whose inputs
are held back like that can stay undecided between its inputs and its bias for good. Measured with the paper's numbers;
those gates, and no others, were where devices stuck. Pins of one tree can change places at no cost; where that does
not help, a buffer of its own goes before a pin.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

Pin = tuple[str, int]
"""An instance and the number of one of its inputs."""


@dataclass(slots=True)
class Wiring:
    """What drives every pin, and which pins may change places.

    Attributes:
        driver: the net that drives each pin.
        peers: for each pin of a tree that is not a node of it, the tree and the polarity.
        biased: instances whose inner masses have a bias, with the number of their inputs.
    """

    driver: dict[Pin, str]
    peers: dict[Pin, tuple[str, bool]]
    biased: dict[str, int]
    driven: dict[str, set[Pin]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for pin, net in self.driver.items():
            self.driven.setdefault(net, set()).add(pin)

    def rewire(self, pin: Pin, net: str) -> None:
        """Let ``net`` drive ``pin``."""
        if pin in self.driver:
            self.driven[self.driver[pin]].discard(pin)
        self.driver[pin] = net
        self.driven.setdefault(net, set()).add(pin)

    def burdened(self, net: str) -> bool:
        """``net`` drives two biased masses or more."""
        return sum(instance in self.biased for instance, _ in self.driven.get(net, ())) > 1

    def strained(self, instance: str) -> bool:
        """All of its inputs are burdened, and it has several."""
        inputs = self.biased.get(instance, 0)
        return inputs > 1 and all(self.burdened(self.driver[instance, pin]) for pin in range(inputs))

    def strain_near(self, nets: tuple[str, ...]) -> int:
        """How many instances that ``nets`` drive are strained."""
        near = {instance for net in nets for instance, _ in self.driven.get(net, ())}
        return sum(self.strained(instance) for instance in near)


def relieve(wiring: Wiring, add_buffer: Callable[[str, Pin], str]) -> None:
    """Rewire until no instance is strained.

    Args:
        add_buffer: makes a buffer that reads a net and is to drive a pin; returns its net.
    """
    members: dict[tuple[str, bool], list[Pin]] = {}
    for pin in sorted(wiring.peers):
        members.setdefault(wiring.peers[pin], []).append(pin)
    # Every step makes the strained fewer, but may move the strain to another; so until none is left.
    while strained := [instance for instance in sorted(wiring.biased) if wiring.strained(instance)]:
        pins = [(strained[0], pin) for pin in range(wiring.biased[strained[0]])]
        if any(_swap(wiring, pin, members[wiring.peers[pin]]) for pin in pins if pin in wiring.peers):
            continue
        pin = max(pins, key=lambda p: (wiring.strain_near((wiring.driver[p],)), -p[1]))
        net = wiring.driver[pin]
        buffer = add_buffer(net, pin)
        wiring.rewire((buffer, 0), net)
        wiring.rewire(pin, buffer)


def _swap(wiring: Wiring, pin: Pin, candidates: list[Pin]) -> bool:
    """Exchange the drivers of ``pin`` and of the first candidate that makes strain less; False if there is none."""
    for other in candidates:
        here, there = wiring.driver[pin], wiring.driver[other]
        if here == there:
            continue
        before = wiring.strain_near((here, there))
        wiring.rewire(pin, there)
        wiring.rewire(other, here)
        if wiring.strain_near((here, there)) < before and not wiring.strained(pin[0]):
            return True
        wiring.rewire(pin, here)
        wiring.rewire(other, there)
    return False
