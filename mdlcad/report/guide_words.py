"""The words of the assembly guide: what each step asks of the hands, and which fits matter."""

from __future__ import annotations

from dataclasses import dataclass

from mdlcad.mechanics import Process, Sizing
from mdlcad.parts.assembly import AssemblyStep, StepKind
from mdlcad.parts.body import BodyKind

TITLES = {
    StepKind.BASE: "Lay the base",
    StepKind.CLOCK: "Lay the clock plate {plate}",
    StepKind.UNITS: "Lower the unit plate",
    StepKind.TRUNKS: "Lay the trunks, plate {plate}",
    StepKind.RUNGS: "Lay the rung plate {plate}",
    StepKind.COVER: "Put the cover on",
    StepKind.POSTS: "Push the posts in",
    StepKind.JOIN: "Lay the upper deck on the lower one",
    StepKind.SCREWS: "Screw the stack together",
}


@dataclass(frozen=True, slots=True)
class Fit:
    """A clearance or a fit: what it is between, its size in words, and how to tell that it is right."""

    what: str
    size: str
    test: str


def fits_of(process: Process, sizing: Sizing) -> tuple[Fit, ...]:
    """The fits of a process that decide whether the device moves."""
    rules, machine, link, frame = sizing.rules, process.machine, process.link, process.frame
    kerf = f"{machine.kerf:g} mm" if machine.kerf else "none"
    return (
        Fit("pins in their holes", f"{rules.pin:g} mm square, no clearance", "pressed in by hand, must not fall out"),
        Fit("eyes on their posts", f"{link.post_fit:g} mm all round", "turns freely, does not rattle"),
        Fit("neighbours in a plate", f"{rules.gap:g} mm at the worst of their strokes", "no touching anywhere"),
        Fit("plate to plate", f"{process.stack.z_gap:g} mm, by shims at the rim", "a slip of paper passes"),
        Fit("screws in the rim", f"{frame.screw:g} mm in {frame.screw_hole:g} mm", "drops in"),
        Fit(
            "what the machine takes away",
            f"kerf {kerf}, edges within {machine.repeatability:g} mm",
            "files are as designed unless built with --kerf: let the machine's program allow for it",
        ),
    )


def words_of(step: AssemblyStep, process: Process, sizing: Sizing) -> tuple[str, ...]:
    """What is to be done in a step, sentence by sentence."""
    below = _shim(step, process)
    if step.kind is StepKind.BASE:
        return ("Lay it flat, as drawn.", "Press the rib posts into their holes; they stand square to the base.")
    if step.kind is StepKind.CLOCK:
        return (
            f"{below}Lay its spacer on the rim, and the plate within it, the handle out to the right.",
            # a phase without masses has a plate without pins
            f"{'Press its pins into the plate first. ' if _new_pins(step) else ''}It must slide to and fro by "
            f"{2.0 * sizing.rules.clock_throw:.2f} mm without touching a pin of the plates below.",
        )
    if step.kind is StepKind.UNITS:
        return (
            f"{below}Lower the plate over the rib posts. The clock blocks do not meet their pins yet.",
            "Hold the clock plates in their middle and push each clock block, with flat pliers, by the length in the "
            "table onto its pin. This is the preload: the beams of the unit are set by it.",
            "Press the hub pins into the shuttles from above; every shuttle still moves up and down the page.",
        )
    if step.kind in (StepKind.TRUNKS, StepKind.RUNGS):
        what = "each trunk" if step.kind is StepKind.TRUNKS else "each numbered piece"
        words = [
            f"{below}Lay the rim, then {what} where it is drawn, and press it down onto the pins that come up there.",
        ]
        kinds = {body.kind for body in step.bodies}
        if _new_pins(step):
            words.append("Press in the new pins, which join it to the plates above.")
        if BodyKind.BIAS in kinds or BodyKind.ROCKER in kinds:
            words.append("Eyes of rockers and bias leaves stay empty until their posts come, through the cover.")
        words.append("Move every shuttle through its stroke: nothing may rub, nothing may lift.")
        return tuple(words)
    if step.kind is StepKind.COVER:
        return (f"{below}Lay the cover on the rim. Its windows show the hub pins that the starting state needs.",)
    if step.kind is StepKind.JOIN:
        return (
            "Set the starting state of both decks first, as described at the end, and leave their clock plates there.",
            f"{below}Turn the upper deck over, left to right, and lower it cover on cover.",
            "Long hub pins stand out of both covers: guide each through the slots of the other cover and press it into "
            "the blocks that wait for it on the other deck's rung plates.",
            "Couple the two clock plates of every phase by their handles: they move as one.",
        )
    if step.kind is StepKind.POSTS:
        return (
            "Push each post through its hole in the cover down into the eye below, flush with the cover.",
            "Bias leaves are cut straight: bend each by the length in the table until its eye lies under its hole.",
        )
    return (
        f"Drop the screws in, M{process.frame.screw:g}, as long as the stack is high and a nut more.",
        "Tighten crosswise, by hand, until the shims do not move.",
    )


def _new_pins(step: AssemblyStep) -> bool:
    return any(body.kind is BodyKind.PIN for body in step.bodies)


def _shim(step: AssemblyStep, process: Process) -> str:
    if not any(body.plate == "shims" for body in step.bodies):
        return ""
    return f"Lay a shim of {process.stack.z_gap:g} mm on the rim. "
