"""Colours of bodies, by what is asked of them. The scales can be told apart with any colour vision."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from mdlcad.parts import palette
from mdlcad.parts.body import Body, BodyKind
from mdlcad.view.built import Built
from mdlcad.view.describe import Catalogue
from mdlcad.view.motion import Floats

Colours = NDArray[np.uint8]


class ColourBy(StrEnum):
    """What a colour stands for."""

    PART = "part"
    PHASE = "phase"
    POLARITY = "polarity"
    STATE = "state"
    MARGIN = "margin"


# what the question is not about
_QUIET = "#d3d7dd"
_FRAME = "#dfe3e8"
_DARK = "#8a9099"

_POLARITY = {1: "#1b7f79", -1: "#c2571a"}
# logic 0 blue, neither white, logic 1 orange: as in the scenarios' animations
STATE_STOPS = ("#2b6cb0", "#f7f7f7", "#dd7a1d")
WAVE_STOPS = ("#ffffff", _DARK)
# no strain left to the limit: rust; half of it and more: blue; beyond the limit: black
_MARGIN = ("#a63603", "#f0a03c", "#7fb8b4", "#3f86b5", "#1f4f80")
_BROKEN = "#111111"

_NAMES = {
    BodyKind.UNIT: "unit",
    BodyKind.COUPLER: "coupler (passes on)",
    BodyKind.ROCKER: "rocker (turns over)",
    BodyKind.BIAS: "bias leaf",
    BodyKind.RUNG: "rung",
    BodyKind.TRUNK: "trunk",
    BodyKind.TAB: "tab",
    BodyKind.CLOCK: "clock plate",
    BodyKind.GUIDE: "guide of a clock plate",
}


@dataclass(frozen=True, slots=True)
class Key:
    """One line of a legend: a colour and what it stands for."""

    colour: str
    words: str


def rgb(colour: str) -> Colours:
    """ "#rrggbb" as uint8[3]."""
    return np.array([int(colour[start : start + 2], 16) for start in (1, 3, 5)], dtype=np.uint8)


def ramp(stops: Sequence[str], values: Floats) -> Colours:
    """uint8[n, 3]: colours of ``values``, float[n] from 0 to 1, on a line through ``stops``."""
    anchors = np.array([rgb(stop) for stop in stops], dtype=np.float64)
    at = np.linspace(0.0, 1.0, len(stops))
    mixed = np.column_stack([np.interp(values, at, anchors[:, channel]) for channel in range(3)])
    found: Colours = np.round(mixed).astype(np.uint8)
    return found


class Painter:
    """Paints the bodies of one device.

    Attributes:
        mass_of, clock_of: int[b], number of the mass and of the clock whose state a body shows, -1 if none.
    """

    SETTLED = 1.3
    """Where a settled mass stands, in units of x: deeper is no clearer."""

    def __init__(self, built: Built, catalogue: Catalogue) -> None:
        self._built = built
        bodies = built.bodies
        place = {mass.name: number for number, mass in enumerate(built.network.masses)}
        masses = [catalogue.mass(body) for body in bodies]
        self.mass_of = np.array([-1 if mass is None else place[mass.name] for mass in masses], dtype=np.int64)
        self.clock_of = np.array([_clock(body) for body in bodies], dtype=np.int64)
        self._margins = [catalogue.margin(body) for body in bodies]
        self._part = np.array([rgb(body.colour) for body in bodies])
        self._polarity = np.array([mass.polarity for mass in built.network.masses], dtype=np.int64)
        self._phases = built.network.dynamics.phases

    def paint(self, by: ColourBy, x: Floats, waves: Floats) -> Colours:
        """uint8[b, 3], a colour a body.

        Args:
            x: float[n], displacements of the masses; waves: float[P], the clock waves. Only a state needs them.
        """
        if by is ColourBy.PART:
            return self._part
        quiet = np.array([rgb(_quiet(body)) for body in self._built.bodies])
        if by is ColourBy.PHASE:
            phases = np.array([mass.phase for mass in self._built.network.masses], dtype=np.int64)
            units = np.array([rgb(palette.unit(phase)) for phase in range(self._phases)])
            clocks = np.array([rgb(palette.clock(phase)) for phase in range(self._phases)])
            return self._paint(quiet, units[phases], clocks)
        if by is ColourBy.POLARITY:
            return self._paint(quiet, np.array([rgb(_POLARITY[1 if p > 0 else -1]) for p in self._polarity]), None)
        if by is ColourBy.STATE:
            logic = np.clip(0.5 + 0.5 * x * self._polarity / self.SETTLED, 0.0, 1.0)
            wave = np.clip(waves / 2.0, 0.0, 1.0)
            return self._paint(quiet, ramp(STATE_STOPS, logic), ramp(WAVE_STOPS, wave))
        for number, margin in enumerate(self._margins):
            if margin is not None:
                quiet[number] = rgb(_BROKEN) if margin < 0.0 else ramp(_MARGIN, np.array([margin]))[0]
        return quiet

    def _paint(self, quiet: Colours, masses: Colours, clocks: Colours | None) -> Colours:
        own = self.mass_of >= 0
        quiet[own] = masses[self.mass_of[own]]
        if clocks is not None:
            driven = self.clock_of >= 0
            quiet[driven] = clocks[self.clock_of[driven]]
        return quiet

    def legend(self, by: ColourBy) -> tuple[Key, ...]:
        """What the colours stand for."""
        if by is ColourBy.PART:
            seen = {body.kind: body.colour for body in self._built.bodies if body.kind is not BodyKind.UNIT}
            units = [Key(palette.unit(phase), f"unit, phase {phase}") for phase in range(self._phases)]
            return (*units, *(Key(seen[kind], words) for kind, words in _NAMES.items() if kind in seen))
        if by is ColourBy.PHASE:
            return tuple(Key(palette.unit(phase), f"phase {phase}") for phase in range(self._phases))
        if by is ColourBy.POLARITY:
            return (Key(_POLARITY[1], "+1: logic 1 is at +y"), Key(_POLARITY[-1], "-1: logic 1 is at -y"))
        if by is ColourBy.STATE:
            words = ("logic 0", "neither", "logic 1")
            return (
                *(Key(colour, word) for colour, word in zip(STATE_STOPS, words, strict=True)),
                Key(_DARK, "clock at 2"),
            )
        steps = np.linspace(0.0, 1.0, 5)
        found = [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in ramp(_MARGIN, steps)]
        keys = [Key(colour, f"{100 * step:.0f} % of strain left") for colour, step in zip(found, steps, strict=True)]
        return (Key(_BROKEN, "beyond the limit"), *keys)


def _clock(body: Body) -> int:
    ref = body.moves_with[0]
    return int(ref.partition(":")[2]) if ref.startswith("clock:") else -1


def _quiet(body: Body) -> str:
    return _FRAME if body.kind in (BodyKind.FRAME, BodyKind.BASE, BodyKind.COVER) else _QUIET
