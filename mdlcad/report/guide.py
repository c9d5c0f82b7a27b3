"""guide.html: how to make and assemble a device, one page to print that needs no other file."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import shapely
from markupsafe import Markup
from shapely import Polygon
from shapely.affinity import scale

from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.decks import Deck
from mdlcad.mechanics.drive import DriveLoads
from mdlcad.network.model import Network
from mdlcad.parts.assembly import AssemblyStep, StepKind, assembly_of, decks_of, turned
from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.bom import bill_of_materials
from mdlcad.parts.plates import STOCK, plates_of
from mdlcad.parts.tiles import joint_of, tiles_of
from mdlcad.parts.windows import held_at_start, with_tab
from mdlcad.placement.placement import Placement
from mdlcad.report.guide_drawing import Mark, Push, draw_start, draw_step
from mdlcad.report.guide_words import TITLES, Fit, fits_of, words_of
from mdlcad.report.tables import stock_words
from mdlcad.report.templates import environment

GUIDE = "guide.html"


@dataclass(frozen=True, slots=True)
class Piece:
    """A piece with a number in the step's drawing, what hangs together in it, and what is to be done with it."""

    number: int
    names: tuple[str, ...]
    note: str


@dataclass(frozen=True, slots=True)
class StepPage:
    """One step of the guide."""

    number: int
    title: str
    words: tuple[str, ...]
    stock: str
    drawing: Markup
    pieces: tuple[Piece, ...]


@dataclass(frozen=True, slots=True)
class Setting:
    """How one shuttle is put into its starting place: which way, how far in mm, and by what."""

    number: int
    mass: str
    phase: int
    side: str
    millimetres: float
    by: str


@dataclass(frozen=True, slots=True)
class PlateFiles:
    """What is cut from one sheet."""

    plate: str
    about: str
    files: str


def guide(
    network: Network,
    sizing: Sizing,
    placement: Placement,
    process: Process,
    bodies: Sequence[Body],
    drive: DriveLoads,
) -> str:
    """The page's text."""
    boundary = Polygon(placement.boundary)
    steps = assembly_of(bodies, process)
    bom = bill_of_materials(bodies, process)
    settings, drawing = _start(network, sizing, process, placement, bodies, boundary)
    templates = environment("mdlcad.report", "template")
    phases = network.dynamics.phases
    x0, y0, x1, y1 = boundary.bounds
    fits: tuple[Fit, ...] = fits_of(process, sizing)
    return templates.get_template("guide.html.j2").render(
        design=network.design,
        process=process,
        size=(x1 - x0, y1 - y0, max(b.z + b.thickness for b in bodies) - min(b.z for b in bodies)),
        units=len(network.masses),
        plates=[_plate_files(plate, members, process) for plate, members in plates_of(bodies).items()],
        stock=stock_words(bom),
        fits=fits,
        steps=_pages(steps, sizing, process, boundary),
        decks=2 if any(step.kind is StepKind.JOIN for step in steps) else 1,
        settings=settings,
        start=Markup(drawing),
        phases=phases,
        clock_start=[
            (plate.phase, _clock_start(plate.stroke_mm, plate.phase, phases), plate.stroke_mm, plate.force_most_n)
            for plate in drive.plates
        ],
        drive=drive,
    )


def _clock_start(stroke_mm: float, phase: int, phases: int) -> float:
    """Where a clock plate stands at power-up, mm from its middle towards the shuttles, which is to the left."""
    return round(stroke_mm / 2.0 * math.sin(-2.0 * math.pi * phase / phases), 2) + 0.0


def _plate_files(plate: str, members: Sequence[Body], process: Process) -> PlateFiles:
    tiles = tiles_of(plate, members, process).tiles
    material = next((item.material for item in process.stack.plates if item.name == plate), "shim stock")
    heights = sorted({round(body.thickness, 4) for body in members})
    layers = len({round(body.z, 4) for body in members})
    about = f"{material}, {' and '.join(f'{height:g}' for height in heights)} mm"
    if layers > 1:
        about += f", {layers} times"
    if len(tiles) > 1:
        joint = joint_of(process)
        return PlateFiles(
            plate,
            f"{about}, {len(tiles)} tiles joined by dovetails of {joint.head:g} mm with {joint.clearance:g} mm of play",
            ", ".join(f"tiles/{tile.name}" for tile in tiles),
        )
    return PlateFiles(plate, about, f"plates/{plate}")


def _pages(steps: Sequence[AssemblyStep], sizing: Sizing, process: Process, boundary: Polygon) -> list[StepPage]:
    """The steps as they lie on the bench: the upper deck of two is put together upside down."""
    if all(step.deck is Deck.LOWER for step in steps):
        return [_page(number, steps, sizing, process, boundary) for number in range(1, len(steps) + 1)]
    top = max(body.z + body.thickness for step in steps for body in step.bodies)
    middle = (boundary.bounds[0] + boundary.bounds[2]) / 2.0
    laid = [
        replace(step, bodies=tuple(_turned_over(body, top, middle) for body in step.bodies))
        if step.deck is Deck.UPPER
        else step
        for step in steps
    ]
    over = scale(boundary, -1.0, 1.0, origin=(middle, 0.0))
    return [
        _page(number, laid, sizing, process, over if step.deck is Deck.UPPER else boundary)
        for number, step in enumerate(laid, start=1)
    ]


def _turned_over(body: Body, top: float, middle: float) -> Body:
    """The body after the stack of height ``top`` is turned over, left to right about x = ``middle``."""

    def mirrored(shape: Polygon | None) -> Polygon | None:
        return None if shape is None else scale(shape, -1.0, 1.0, origin=(middle, 0.0))

    return replace(
        turned(body, top),
        section=scale(body.section, -1.0, 1.0, origin=(middle, 0.0)),
        assembled=mirrored(body.assembled),
        envelope=mirrored(body.envelope),
    )


def _page(number: int, steps: Sequence[AssemblyStep], sizing: Sizing, process: Process, boundary: Polygon) -> StepPage:
    step = steps[number - 1]
    mine = [earlier for earlier in steps[: number - 1] if earlier.deck is step.deck]
    before = _seen(step, [body for earlier in mine for body in earlier.bodies])
    marks, pieces = _pieces(step, sizing)
    title = TITLES[step.kind].format(plate=step.plate)
    if any(other.deck is Deck.UPPER for other in steps) and step.kind not in (StepKind.JOIN, StepKind.SCREWS):
        title += f", {step.deck} deck"
    counts: dict[tuple[str, float], int] = {}
    for body in step.bodies:
        if body.kind in STOCK:
            key = (body.kind.value, round(body.thickness, 3))
            counts[key] = counts.get(key, 0) + 1
    stock = ", ".join(
        f"{count} {kind}{'s' if count > 1 else ''} of {length:g} mm" for (kind, length), count in sorted(counts.items())
    )
    # the shim under a plate would hide nothing but look like a part of it
    shown = [body for body in step.bodies if body.plate != "shims"]
    drawing = draw_step(boundary, before, shown, marks, f"step {number}: {title}")
    return StepPage(number, title, words_of(step, process, sizing), stock, Markup(drawing), pieces)


def _seen(step: AssemblyStep, before: Sequence[Body]) -> list[Body]:
    """Of what is there before a step, what helps to find the place: pins that come up, or the cover with its holes."""
    if step.plate is None:
        return [body for body in before if body.kind is BodyKind.COVER]
    level = min(body.z for body in step.bodies)
    return [body for body in before if body.kind in STOCK and body.z + body.thickness > level]


def _pieces(step: AssemblyStep, sizing: Sizing) -> tuple[list[Mark], tuple[Piece, ...]]:
    """The numbered pieces of a step: units on the unit plate, loose pieces on the plates above it, posts."""
    offsets = {item.mass: item.offset for item in sizing.biases}
    if step.kind is StepKind.UNITS:
        preloads = {f"unit.{unit.mass}": unit.preload for unit in sizing.units}
        found = [[body] for body in step.bodies if body.kind is BodyKind.UNIT]
        sign = 1.0 if step.deck is Deck.LOWER else -1.0
        notes = [_direction(sign * preloads[group[0].name]) for group in found]
    elif step.kind in (StepKind.TRUNKS, StepKind.RUNGS):
        loose = [body for body in step.bodies if body.kind not in (*STOCK, BodyKind.FRAME, BodyKind.SPACER)]
        found = _touching(loose)
        notes = ["" for _ in found]
    elif step.kind is StepKind.POSTS:
        found = [[body] for body in step.bodies]
        notes = []
        for group in found:
            mass = group[0].name.removeprefix("post.bias.")
            bent = offsets.get(mass) if group[0].name.startswith("post.bias.") else None
            notes.append("" if bent is None else f"first bend its leaf by {abs(bent):.2f} mm {_side(bent)}")
    else:
        return [], ()
    # from the top left of the page, as one reads
    order = sorted(range(len(found)), key=lambda i: (-round(_top(found[i]), 1), found[i][0].section.bounds[0]))
    marks, pieces = [], []
    for number, index in enumerate(order, start=1):
        group = found[index]
        place = max((body.section for body in group), key=lambda section: section.area).representative_point()
        # beside a post, not on it
        aside = 2.0 * (place.x - group[0].section.bounds[0]) if step.kind is StepKind.POSTS else 0.0
        marks.append(Mark(number, place.x + aside, place.y))
        pieces.append(Piece(number, tuple(body.name for body in group), notes[index]))
    return marks, tuple(pieces)


def _top(group: Sequence[Body]) -> float:
    return float(max(body.section.bounds[3] for body in group))


def _direction(preload: float) -> str:
    # the clock block is to the right of its shuttle, and is pushed to the left by a positive preload
    return f"{abs(preload):.2f} mm {'left' if preload >= 0 else 'right'}"


def _side(y: float) -> str:
    return "up the page" if y > 0 else "down the page"


def _touching(bodies: Sequence[Body]) -> list[list[Body]]:
    """Bodies that are cut as one piece, together."""
    whole = shapely.union_all([body.section for body in bodies], grid_size=1e-4)
    groups = []
    for piece in getattr(whole, "geoms", [whole]):
        groups.append([body for body in bodies if shapely.dwithin(piece, body.section.representative_point(), 1e-3)])
    return groups


def _start(
    network: Network,
    sizing: Sizing,
    process: Process,
    placement: Placement,
    bodies: Sequence[Body],
    boundary: Polygon,
) -> tuple[list[Setting], str]:
    """The shuttles that hold the starting state, top of the page first, and the drawing of them."""
    held, tabs = held_at_start(network), with_tab(network)
    places = {place.mass: place for place in placement.masses}
    phases = {mass.name: mass.phase for mass in network.masses}
    decks = decks_of(bodies, process)
    covers = {
        deck: shapely.union_all([body.section for body in own if body.kind is BodyKind.COVER])
        for deck, own in decks.items()
    }
    two = bool(decks[Deck.UPPER])
    tab_at = {
        body.moves_with[0].partition(":")[2]: body.section.representative_point()
        for body in bodies
        if body.kind is BodyKind.TAB and body.moves_with[0].startswith("mass:")
    }
    open_pins = {
        body.moves_with[0].partition(":")[2]: body.section.centroid
        for deck, own in decks.items()
        for body in own
        if body.name.startswith("pin.hub.") and not covers[deck].intersects(body.section)
    }
    settings, pushes = [], []
    for number, mass in enumerate(sorted(held, key=lambda name: (-places[name].y, places[name].x)), start=1):
        place, by = (places[mass].x, places[mass].y), "its hub pin, before the cover goes on"
        if mass in tabs and mass in tab_at:
            place, by = (tab_at[mass].x, tab_at[mass].y), f"the tab of {tabs[mass]}"
        elif mass in open_pins:
            place, by = (
                (open_pins[mass].x, open_pins[mass].y),
                "the head of its hub pin, through the window in the cover",
            )
            if two:
                by = f"its hub pin, in the window or slot of the cover of the {places[mass].deck} deck"
        away = math.copysign(sizing.rules.throw, held[mass])
        side = _side(away)
        settings.append(
            Setting(number, mass, phases[mass], side, round(abs(held[mass]) * process.unit.throw_unit, 2), by)
        )
        pushes.append(Push(number, place[0], place[1], away))
    shown = [body for body in bodies if body.kind in (BodyKind.COVER, BodyKind.TAB)]
    return settings, draw_start(boundary, shown, pushes, "which shuttles are pushed to which side")
