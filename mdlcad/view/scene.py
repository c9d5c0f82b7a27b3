"""Everything there is to see of a build, and a way to look at it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from mdlcad.errors import UsageError
from mdlcad.view.built import Built, Trust, read_build
from mdlcad.view.camera import Preset
from mdlcad.view.colours import ColourBy, Painter
from mdlcad.view.describe import Card, Catalogue
from mdlcad.view.find import need
from mdlcad.view.mesh import LOOSE, Model, make_model


@dataclass(frozen=True, slots=True)
class Look:
    """A way to look at a device.

    Attributes:
        plates: those shown; None: all that do not hide the rest.
        explode: how far the plates are taken apart, 0 to 1.
        size: width and height, pixels.
        find: a name to search for, to be marked and filled the picture with.
        at: time in clock cycles of the simulation; None: as drawn (a state is then that at the end of decision 0).
        scenario: what is simulated, if anything is; None: the design's own.
    """

    plates: tuple[str, ...] | None = None
    explode: float = 0.0
    colour: ColourBy = ColourBy.PART
    camera: Preset = Preset.ISO
    size: tuple[int, int] = (1600, 1200)
    find: str | None = None
    at: float | None = None
    scenario: str | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A build with its meshes, its cards (one a body) and its colours."""

    built: Built
    model: Model
    cards: tuple[Card, ...]
    painter: Painter

    def plates(self, look: Look) -> tuple[str, ...]:
        """The plates that a look shows.

        Raises:
            UsageError: it asks for a plate that the device has not.
        """
        if look.plates is None:
            # what is on top hides what is under it; shims and pins hang loose between plates that are apart
            top = max(self.built.bodies, key=lambda body: (body.plate not in LOOSE, body.z)).plate
            hidden = {top} | (set(LOOSE) if look.explode > 0.0 else set())
            return tuple(plate for plate in self.model.plates if plate not in hidden)
        for plate in look.plates:
            if plate not in self.model.plates:
                raise UsageError(
                    f"--plates {plate}: {self.built.report.design} has no such plate; it has "
                    f"{', '.join(self.model.plates)}"
                )
        return tuple(plate for plate in self.model.plates if plate in look.plates)

    def found(self, look: Look) -> tuple[int, ...]:
        """Numbers of the bodies that a look searches for.

        Raises:
            UsageError: it searches, and there are none.
        """
        return need(self.built, self.cards, look.find) if look.find is not None else ()


def open_scene(folder: Path, trust: Trust = Trust.BUILT) -> Scene:
    """Read the build in ``folder``; see ``read_build`` for what it raises."""
    built = read_build(folder, trust)
    catalogue = Catalogue(built)
    cards = tuple(catalogue.card(body) for body in built.bodies)
    return Scene(built, make_model(built), cards, Painter(built, catalogue))
