"""The pictures of a build: the stack, the stack taken apart, and every plate from above."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.plates import plates_of
from mdlcad.view.picture import write_picture

# Exploded by this share of the device's larger side per plate: far enough apart to see between, whatever the size.
_EXPLODE = 0.2


def opened(bodies: Sequence[Body]) -> list[Body]:
    """The device without its cover, which hides all else, and of two decks the lower one alone.

    Screws and posts, which go on through the cover, are shown to where its upper face was.

    Raises:
        ValueError: there is no cover.
    """
    cover = min((body for body in bodies if body.kind is BodyKind.COVER), key=lambda body: body.z)
    top = cover.z + cover.thickness
    below = (body for body in bodies if body.z < cover.z)
    return [replace(body, thickness=min(body.thickness, top - body.z)) for body in below]


def write_views(bodies: Sequence[Body], folder: Path, progress: Callable[[str], None]) -> tuple[str, ...]:
    """Write views/*.png; the paths written, relative to ``folder``."""
    views = folder / "views"
    views.mkdir(parents=True, exist_ok=True)
    plates: dict[str, float] = {}
    for body in bodies:
        plates[body.plate] = min(plates.get(body.plate, body.z), body.z)
    cut = set(plates_of(bodies)) - {"shims"}
    order = sorted(cut, key=lambda plate: plates[plate])
    side = max(body.section.bounds[2] for body in bodies) - min(body.section.bounds[0] for body in bodies)
    lift = {plate: number * _EXPLODE * side for number, plate in enumerate(order)}
    written = []

    def picture(name: str, shown: Sequence[Body], *, from_above: bool, lift_mm: dict[str, float] | None = None) -> None:
        progress(f"view {name}")
        write_picture(shown, views / f"{name}.png", from_above=from_above, lift_mm=lift_mm)
        written.append(f"views/{name}.png")

    picture("stack", opened(bodies), from_above=False)
    # shims and stock would hang between the plates
    apart = [body for body in bodies if body.plate in cut]
    picture("exploded", apart, from_above=False, lift_mm=lift)
    for plate in order:
        picture(f"plate-{plate}", [body for body in bodies if body.plate == plate], from_above=True)
    return tuple(written)
