"""Search by name."""

from __future__ import annotations

import difflib

from mdlcad.errors import UsageError
from mdlcad.view.built import Built
from mdlcad.view.describe import Card


def find(built: Built, cards: tuple[Card, ...], text: str) -> tuple[int, ...]:
    """Numbers of the bodies that ``text`` names, in any case.

    A whole name is all of that thing: of a port or a mass its unit, bias and carrier, of a coupling its flexure, of
    a body that body alone. Failing that, all bodies whose names, or the names of what they belong to, contain the text.
    """
    wanted = text.strip().lower()
    if not wanted:
        return ()
    ports = {port.bit.lower(): port.mass for port in (*built.network.sensors, *built.network.actuators)}
    mass = ports.get(wanted, text.strip()).lower()
    whole = tuple(
        number
        for number, (body, card) in enumerate(zip(built.bodies, cards, strict=True))
        if wanted == body.name.lower()
        or card.subject.lower() in (wanted, f"unit {mass}", f"net {mass}", f"coupling {wanted}", f"plate {wanted}")
    )
    if whole:
        return whole
    return tuple(
        number
        for number, (body, card) in enumerate(zip(built.bodies, cards, strict=True))
        if wanted in body.name.lower() or wanted in card.subject.lower()
    )


def need(built: Built, cards: tuple[Card, ...], text: str) -> tuple[int, ...]:
    """``find``, for whom finding nothing is an error.

    Raises:
        UsageError: nothing of that name; the message has names that are near to it.
    """
    found = find(built, cards, text)
    if found:
        return found
    names = sorted({mass.name for mass in built.network.masses} | {body.name for body in built.bodies})
    near = difflib.get_close_matches(text, names, n=3, cutoff=0.4)
    hint = f"; near to it: {', '.join(near)}" if near else ""
    raise UsageError(f"--find {text}: nothing in {built.report.design} has a name with that in it{hint}")
