"""What every part needs to know: the process, the sizes, the placement, and bodies made from a plate's name."""

from __future__ import annotations

from dataclasses import dataclass

from shapely import Polygon

from mdlcad.errors import UsageError
from mdlcad.mechanics.decks import Deck, deck_of_plate, plate_in
from mdlcad.mechanics.process import Plate, PlateRole, Process
from mdlcad.mechanics.sizing import Sizing
from mdlcad.parts.body import Body, BodyKind
from mdlcad.placement.placement import PlacedMass


@dataclass(frozen=True, slots=True)
class Stack:
    """A deck of a process with the sizes made for it.

    Attributes:
        process: with the plates of both decks, if there are two.
        clock_plates: plate name by phase.
    """

    process: Process
    sizing: Sizing
    clock_plates: tuple[str, ...]
    deck: Deck = Deck.LOWER

    @property
    def plates(self) -> tuple[Plate, ...]:
        """The deck's plates, bottom to top."""
        return tuple(plate for plate in self.process.stack.plates if deck_of_plate(plate.name) is self.deck)

    def _only(self, role: PlateRole) -> str:
        return plate_in(self.deck, self.process.plates(role)[0].name)

    @property
    def unit_plate(self) -> str:
        """Name of the unit plate."""
        return self._only(PlateRole.UNIT)

    @property
    def trunk_plate(self) -> str:
        """Name of the plate of the trunks."""
        return self._only(PlateRole.TRUNK)

    @property
    def base_plate(self) -> str:
        """Name of the base."""
        return self._only(PlateRole.BASE)

    @property
    def cover_plate(self) -> str:
        """Name of the cover."""
        return self._only(PlateRole.COVER)

    def level(self, plate: str) -> int:
        """Place of a plate in the stack, 0 at the deck's base."""
        names = [item.name for item in self.process.stack.plates]
        return (names if self.deck is Deck.LOWER else names[::-1]).index(plate)

    def bottom(self, plate: str) -> float:
        """Bottom face of a plate, mm."""
        return self.process.z_of(plate)

    def top(self, plate: str) -> float:
        """Top face of a plate, mm."""
        return round(self.process.z_of(plate) + self.process.plate(plate).thickness, 6)

    def sheet(
        self,
        name: str,
        kind: BodyKind,
        plate: str,
        section: Polygon,
        throw: tuple[float, float],
        moves_with: tuple[str, ...],
        colour: str,
        assembled: Polygon | None = None,
        envelope: Polygon | None = None,
    ) -> Body:
        """A body cut from a plate."""
        thickness = self.process.plate(plate).thickness
        return Body(
            name, kind, plate, self.bottom(plate), thickness, section, throw, moves_with, colour, assembled, envelope
        )

    def upright(
        self,
        name: str,
        kind: BodyKind,
        near: str,
        far: str,
        section: Polygon,
        throw: tuple[float, float],
        moves_with: str,
        colour: str,
    ) -> Body:
        """A pin or post through two plates and all between, from outer face to outer face."""
        low, high = sorted((near, far), key=self.bottom)
        z = self.bottom(low)
        height = round(self.top(high) - z, 6)
        return Body(name, kind, "pins", z, height, section, throw, (moves_with,), colour)


def make_stack(process: Process, sizing: Sizing, phases: int, deck: Deck = Deck.LOWER) -> Stack:
    """The stack of a deck for a network of that many phases.

    Raises:
        UsageError: the process has too few clock plates.
    """
    clocks = [plate.name for plate in process.plates(PlateRole.CLOCK) if deck_of_plate(plate.name) is Deck.LOWER]
    plates = [plate_in(deck, name) for name in reversed(clocks)]
    if len(plates) < phases:
        raise UsageError(
            f"process {process.name}: stack.plates: {phases} clock plates are needed, it has {len(plates)}"
        )
    return Stack(process, sizing, tuple(plates[:phases]), deck)


def mass_ref(mass: str) -> str:
    """Body of reference of a mass's shuttle."""
    return f"mass:{mass}"


def clock_ref(phase: int) -> str:
    """Body of reference of a clock plate."""
    return f"clock:{phase}"


FRAME_REF = "frame"


@dataclass(frozen=True, slots=True)
class Hub:
    """A placed mass: where its shuttle rests."""

    place: PlacedMass

    @property
    def ref(self) -> str:
        """Body of reference."""
        return mass_ref(self.place.mass)

    @property
    def x(self) -> float:
        """Centre, mm."""
        return self.place.x

    @property
    def y(self) -> float:
        """Centre, mm."""
        return self.place.y
