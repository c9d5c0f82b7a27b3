"""Which bodies are cut from which plate."""

from __future__ import annotations

from collections.abc import Sequence

from mdlcad.parts.body import Body, BodyKind

STOCK = (BodyKind.PIN, BodyKind.POST, BodyKind.SCREW)
"""Bought, or cut to length, not cut from a plate."""


def plates_of(bodies: Sequence[Body]) -> dict[str, list[Body]]:
    """The bodies of every plate that is cut, bottom plate first."""
    plates: dict[str, list[Body]] = {}
    for body in sorted(bodies, key=lambda item: item.z):
        if body.kind not in STOCK:
            plates.setdefault(body.plate, []).append(body)
    return plates
