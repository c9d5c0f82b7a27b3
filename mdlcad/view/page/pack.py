"""A scene as the page's scripts read it: a JSON part, and typed arrays (little-endian) in one compressed block.

The device is sent as outlines, not as triangles: the page extrudes them. ``data.js`` reads what is written here.
"""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from mdlcad.scenario.loop import FRAMES_PER_CYCLE
from mdlcad.view.camera import DIRECTIONS, VIEW_ANGLE
from mdlcad.view.colours import STATE_STOPS, WAVE_STOPS, ColourBy, Painter
from mdlcad.view.motion import FRAME, displacements, references_of
from mdlcad.view.playback import Playback, at_rest
from mdlcad.view.scene import Look, Scene

_GRID_MM = 1e-3
"""Points are sent on this grid, mm: ten times finer than any process resolves."""

_STRIDE = 2  # of the simulation's frames, every second is sent
_X_STEPS = 56.0  # steps of a displacement of 1: a byte holds +-2.2


@dataclass(frozen=True, slots=True)
class Packed:
    """``facts``: what goes into the page as JSON; ``block``: the arrays, deflated, in base64."""

    facts: dict[str, Any]
    block: str


def pack(scene: Scene, look: Look, playback: Playback) -> Packed:
    """Everything the page needs."""
    built, outlines = scene.built, scene.model.outlines
    arrays: dict[str, np.ndarray[Any, Any]] = {
        "points": _deltas(np.rint(np.concatenate([o.points for o in outlines]) / _GRID_MM), "<i4"),
        "ends": np.array([end for o in outlines for end in o.ends], dtype="<u4"),
        "rings": np.array([len(o.ends) for o in outlines], dtype="<u4"),
        "caps": np.concatenate([o.caps.ravel() for o in outlines]).astype("<u4"),
        "capCounts": np.array([len(o.caps) for o in outlines], dtype="<u4"),
        "first": np.concatenate([o.follow.first for o in outlines]).astype("<u2"),
        "second": np.concatenate([o.follow.second for o in outlines]).astype("<u2"),
        "share": np.rint(255.0 * np.concatenate([o.follow.share for o in outlines])).astype("u1"),
        "trace": _trace(playback),
        "waves": playback.waves[::_STRIDE].astype("<f4"),
    }
    rest = at_rest(built)
    for by in ColourBy:
        if by is not ColourBy.STATE:
            arrays[by.value] = scene.painter.paint(by, *rest)
    block = b"".join(array.tobytes() for array in arrays.values())
    spans = {name: [array.dtype.str.lstrip("<|"), int(array.size)] for name, array in arrays.items()}
    return Packed(
        _facts(scene, look, playback) | {"arrays": spans}, base64.b64encode(zlib.compress(block, 9)).decode("ascii")
    )


def _facts(scene: Scene, look: Look, playback: Playback) -> dict[str, Any]:
    built, model, painter = scene.built, scene.model, scene.painter
    subjects = list(dict.fromkeys(card.subject for card in scene.cards))
    facts = list(dict.fromkeys(card.facts for card in scene.cards))
    ports = {port.bit: port.mass for port in (*built.network.sensors, *built.network.actuators)}
    return {
        "design": built.report.design,
        "figures": _figures(scene),
        "plates": list(model.plates),
        "apart": model.apart,
        "grid": _GRID_MM,
        "bodies": [
            {
                "name": body.name,
                "plate": model.plates.index(body.plate),
                "z": [outline.low, outline.high],
                "level": [outline.low_level, outline.high_level],
                "subject": subjects.index(card.subject),
                "facts": facts.index(card.facts),
                "mass": int(mass),
                "clock": int(clock),
            }
            for body, outline, card, mass, clock in zip(
                built.bodies, model.outlines, scene.cards, painter.mass_of, painter.clock_of, strict=True
            )
        ],
        "subjects": subjects,
        "facts": facts,
        "masses": [mass.name for mass in built.network.masses],
        "polarity": [mass.polarity for mass in built.network.masses],
        "ports": ports,
        "legends": {by.value: [[key.colour, key.words] for key in painter.legend(by)] for by in ColourBy},
        "state": {"logic": STATE_STOPS, "wave": WAVE_STOPS, "settled": Painter.SETTLED},
        "moves": _moves(scene),
        "run": {
            "scenario": playback.scenario,
            "words": list(playback.words),
            "cycles": playback.cycles,
            "framesPerCycle": FRAMES_PER_CYCLE // _STRIDE,
            "step": 1.0 / _X_STEPS,
        },
        "presets": {preset.value: [list(towards), list(up)] for preset, (towards, up) in DIRECTIONS.items()},
        "viewAngle": VIEW_ANGLE,
        "look": {
            "plates": list(scene.plates(look)),
            "explode": look.explode,
            "colour": look.colour.value,
            "camera": look.camera.value,
            "find": look.find or "",
            "at": look.at,
        },
    }


def _figures(scene: Scene) -> list[list[str]]:
    built = scene.built
    network, size = built.network, built.report.extent_mm
    found = [
        ["units", str(len(network.masses))],
        ["couplings", str(len(network.couplings))],
        ["cycles a decision", str(network.cycles_per_tick)],
        ["process", built.report.process],
    ]
    if size is not None:
        found.append(["size", " x ".join(f"{side:.0f}" for side in size) + " mm"])
    return found


def _moves(scene: Scene) -> dict[str, Any]:
    """mm of y that a displacement of 1 is; mm of x that a clock wave of 1 above its middle moves each clock plate."""
    built = scene.built
    masses, phases = len(built.network.masses), built.network.dynamics.phases
    moved = displacements(built, np.ones(masses), np.full(phases, 2.0))
    names = references_of(built.network).names
    assert names[FRAME] == "frame" and len(names) == 1 + phases + masses
    return {
        "mass": built.process.unit.throw_unit,
        "clocks": [float(value) for value in moved[1 : 1 + phases, 0]],
    }


def _deltas(values: Any, dtype: str) -> np.ndarray[Any, Any]:
    """Each row less the one before it: small numbers, which pack well."""
    found: np.ndarray[Any, Any] = np.diff(values, axis=0, prepend=np.zeros((1, *values.shape[1:]))).astype(dtype)
    return found


def _trace(playback: Playback) -> np.ndarray[Any, Any]:
    """int8[f, n], steps of displacement, each frame less the one before it (modulo 256)."""
    steps = np.clip(np.rint(playback.x[::_STRIDE] * _X_STEPS), -127, 127).astype(np.int64)
    return (np.diff(steps, axis=0, prepend=np.zeros((1, steps.shape[1]), dtype=np.int64)) & 255).astype("u1")
