"""One picture of a build, without a screen."""

from __future__ import annotations

import io
from dataclasses import dataclass

from PIL import Image

from mdlcad.view.camera import pose
from mdlcad.view.caption import caption
from mdlcad.view.colours import ColourBy
from mdlcad.view.describe import Card
from mdlcad.view.motion import Floats, displacements
from mdlcad.view.playback import Playback, at_rest, play
from mdlcad.view.scene import Look, Scene
from mdlcad.view.stage import Stage, hidden_stage

# share of a picture's width that is kept free for the card of what was found
_PANEL = 0.34


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """Where everything stands and what it means.

    Attributes:
        x, waves: float[n] and float[P], displacements and clock waves that the colours show.
        moved: float[r, 2], displacements of the references in mm; None: as drawn.
    """

    title: str
    x: Floats
    waves: Floats
    moved: Floats | None


def moment(scene: Scene, look: Look) -> Moment:
    """The moment that a look is of; nothing is simulated if nothing of it is seen."""
    if look.at is None and look.colour is not ColourBy.STATE:
        return Moment(_name(scene), *at_rest(scene.built), None)
    playback = play(scene.built, look.scenario)
    if look.at is not None:
        return moment_of(scene, playback, playback.frame(look.at))
    # the last frame of the first decision: every mass has been told something
    return moment_of(scene, playback, playback.frame(float(playback.cycles)) - 1)


def moment_of(scene: Scene, playback: Playback, frame: int) -> Moment:
    """A frame of a simulation."""
    x, waves = playback.at(frame)
    return Moment(
        f"{scene.built.report.design}: {playback.title(frame)}", x, waves, displacements(scene.built, x, waves)
    )


def arrange(stage: Stage, scene: Scene, look: Look, now: Moment) -> None:
    """Set everything on ``stage`` as the look has it."""
    stage.show(scene.plates(look))
    stage.stand(explode=look.explode, displacements=now.moved)
    stage.paint(scene.painter.paint(look.colour, now.x, now.waves))
    found = scene.found(look)
    stage.mark(found)
    stage.look(pose(look.camera, stage.points(found or None), stage.aspect))


def still(scene: Scene, look: Look) -> bytes:
    """PNG of a look.

    Raises:
        UsageError: the look asks for a plate, a name or a scenario that there is not.
    """
    scene.plates(look), scene.found(look)  # asked for first: a slip of the hand costs no simulation
    now = moment(scene, look)
    card = _card(scene, look)
    panel = round(_PANEL * look.size[0]) if card is not None else 0
    words = caption(look.size, [now.title], scene.painter.legend(look.colour), panel)
    # what is found shines through many translucent bodies, which smoothing by oversampling would draw four times
    stage = hidden_stage(scene.model, words.room, smooth="msaa" if panel else "ssaa")
    try:
        arrange(stage, scene, look, now)
        image = stage.picture()
    finally:
        stage.plotter.close()
    return png(words.around(image, now.title, card))


def png(picture: Image.Image) -> bytes:
    """The picture's file."""
    stream = io.BytesIO()
    picture.save(stream, "PNG", optimize=True)
    return stream.getvalue()


def _card(scene: Scene, look: Look) -> Card | None:
    """The card of what was found: of a unit or a flexure, if that is among it."""
    found = scene.found(look)
    if not found:
        return None
    best = min(found, key=lambda number: (_rank(scene, number), number))
    return scene.cards[best]


def _rank(scene: Scene, number: int) -> int:
    subject = scene.cards[number].subject
    if scene.built.bodies[number].kind.value == "unit":
        return 0
    return 1 if subject.startswith("coupling ") else 2


def _name(scene: Scene) -> str:
    built = scene.built
    size = built.report.extent_mm
    words = f"{built.report.design}: {len(built.network.masses)} units, {len(built.network.couplings)} couplings"
    return words + (f", {size[0]:.0f} x {size[1]:.0f} x {size[2]:.0f} mm" if size else "")
