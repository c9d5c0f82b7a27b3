"""The masses of the tick ring, as planned masses."""

from __future__ import annotations

from mdlcad.mapping.plan import Key, PlannedMass, Role
from mdlcad.mapping.threshold import COPY, Threshold
from mdlcad.mapping.tickring import RingPlan

_NOR = Threshold((-1, -1), -1)
_RISE = Threshold((1, -1), -1)


def tick_sources(ring: RingPlan, early: bool) -> dict[Key, Key]:
    """Which mass stands for the tick in phase 2 and in phase 0; ``early``: the one in phase 2 is used."""
    tick2, tick0 = Key(Role.TICK, (), 2), Key(Role.TICK, (), 0)
    if ring.decoded:
        return {tick2: tick2, tick0: tick0} if early else {tick0: tick0}
    return {tick2: _stage(2), tick0: _stage(3 % (3 * ring.stages))}


def ring_masses(ring: RingPlan, early: bool) -> tuple[PlannedMass, ...]:
    """The ring, and the gates that find the pulse; position j has phase j mod 3 and copies position j - 1."""
    length = 3 * ring.stages
    masses = []
    for place in range(length):
        source, function = _stage((place - 1) % length), COPY
        sources: tuple[Key, ...] = (source,)
        if place == 0 and ring.nor:
            sources, function = (_stage(length - 1), _stage(length - 4)), _NOR
        elif place == 0 and ring.stages > 1:
            function = COPY.negated()
        elif place == 1 and ring.stages == 1:
            # one stage alternates; inverted here, so that phase 0 still copies phase 2 as in the longer rings
            function = COPY.negated()
        masses.append(PlannedMass(_stage(place), sources, function))
    tick2, tick0 = Key(Role.TICK, (), 2), Key(Role.TICK, (), 0)
    if ring.decoded and early:
        masses.append(PlannedMass(tick2, (_stage(1), _stage(4)), _RISE))
        masses.append(PlannedMass(tick0, (tick2,), COPY))
    elif ring.decoded:
        masses.append(PlannedMass(tick0, (_stage(2), _stage(5)), _RISE))
    return tuple(masses)


def _stage(place: int) -> Key:
    return Key(Role.STAGE, (place,), place % 3)
