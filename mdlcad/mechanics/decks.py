"""Decks: one plate stack, or two of them face to face.

The upper deck is the lower one turned over: its cover lies on the lower deck's cover, its base is on top. So the rungs
of both lie next to the covers, and what passes from one deck to the other has the shortest way.
"""

from __future__ import annotations

from dataclasses import replace
from enum import StrEnum

from mdlcad.errors import UsageError
from mdlcad.mechanics.process import Process


class Deck(StrEnum):
    """The two halves of a device with two unit plates; a device with one has the lower alone."""

    LOWER = "lower"
    UPPER = "upper"

    @property
    def other(self) -> Deck:
        """The deck that faces it."""
        return Deck.UPPER if self is Deck.LOWER else Deck.LOWER


_UPPER = f"{Deck.UPPER}-"


def plate_in(deck: Deck, plate: str) -> str:
    """What the process's plate ``plate`` is called in a deck."""
    return plate if deck is Deck.LOWER else _UPPER + plate


def deck_of_plate(plate: str) -> Deck:
    """The deck that a plate belongs to, by its name."""
    return Deck.UPPER if plate.startswith(_UPPER) else Deck.LOWER


def two_decks(process: Process) -> Process:
    """The process with a second stack of the same plates on the first, turned over.

    Raises:
        UsageError: a plate of the process already has the name of a plate of an upper deck.
    """
    below = process.stack.plates
    for plate in below:
        if plate.name.startswith(_UPPER):
            words = f'plate {plate.name!r}: names that begin with "{_UPPER}" are those of a second unit plate\'s deck'
            raise UsageError(f"process {process.name}: stack.plates: {words}; rename it")
    above = tuple(replace(plate, name=plate_in(Deck.UPPER, plate.name)) for plate in reversed(below))
    return replace(process, stack=replace(process.stack, plates=(*below, *above)))
