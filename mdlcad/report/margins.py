"""The rows of the report page's table of margins: how far the figures that decide stand from their limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.process import PlateRole
from mdlcad.proof.outcome import Proof
from mdlcad.report.report import Report
from mdlcad.signoff.margins import Margins
from mdlcad.signoff.mixtures import Mixtures


@dataclass(frozen=True, slots=True)
class Margin:
    """How far a figure stands from its limit; ``holds`` is None where no limit is set."""

    name: str
    value: str
    limit: str
    about: str
    holds: bool | None


def margin_rows(
    report: Report, process: Process | None, sizing: Sizing | None, proofs: Sequence[tuple[str, Proof]]
) -> list[Margin]:
    """Signal, strain and stiffness against their limits."""
    rows = [
        Margin(
            f"read-out, {name}",
            f"{proof.margin:.2f}",
            "",
            f"smallest |x| of any mass at a read-out: {proof.margin_mass or 'none was read'}; 0 would be undecided",
            None,
        )
        for name, proof in proofs
    ]
    rows += _fabrication_rows(report.margins)
    if report.tilting is not None:
        found = report.tilting
        about = "transitions right of those checked, as drawn, shuttles tilting until they meet a plate"
        tilts = report.tilts
        if tilts is not None:
            about += (
                f": by {tilts.largest_rad:.3f} rad at the most ({tilts.mass}); {tilts.stopped} of {tilts.shuttles} "
                f"meet one; plates brake them with up to {tilts.friction_most:.2f} F0, "
                f"{tilts.friction_mean:.2f} on average"
            )
        right = f"{found.transitions_checked - found.mismatches} of {found.transitions_checked}"
        rows.append(Margin("tilting", right, "all", about, found.mismatches == 0))
    rows += _mixture_rows(report.mixtures)
    mechanics = report.mechanics
    if mechanics is None or process is None or sizing is None:
        return rows
    material = process.material(process.plates(PlateRole.UNIT)[0])
    # the worst of all flexures stands beside the smallest limit of their sheets
    limit = min([material.strain_limit, process.material(process.plates(PlateRole.RUNG)[0]).strain_limit])
    worst = mechanics.strain_worst
    about = "largest in units, couplers and bias leaves over the motion seen in simulation"
    rows.append(Margin("strain", f"{100 * worst:.2f} %", f"at most {100 * limit:.2f} %", about, worst <= limit))
    ratio = mechanics.carrier_stiffness_ratio_worst
    if ratio is not None:
        least = process.link.carrier_ratio
        about = "the softest carrier over the coupler that it drives"
        rows.append(Margin("carrier", f"{ratio:.1f} times", f"at least {least:g} times", about, ratio >= least))
    if mechanics.lean_worst is not None:
        about = "most of a coupling that its two shuttles would take by tilting freely, if no plate held them"
        rows.append(Margin("lean", f"{100 * mechanics.lean_worst:.0f} %", "", about, None))
    about = (
        "largest change, in units of k, that the parts as built make to a unit's compensation; it is in the preloads"
    )
    rows.append(Margin("compensation", f"{mechanics.compensation_difference_worst:.2f}", "", about, None))
    if mechanics.compensation_left is not None:
        first, middle, last = mechanics.compensation_left
        about = (
            "largest k by which a unit with its springs misses the network's, once its preload is solved: at p = 0, 1 "
            "and 2; at the ends it is the stroke, which all units share"
        )
        rows.append(Margin("k left", f"{first:.2f}, {middle:.3f}, {last:.2f}", "", about, None))
    return rows


def _mixture_rows(mixtures: Mixtures | None) -> list[Margin]:
    """What becomes of the device where plates hold some shuttles only."""
    if mixtures is None:
        return []
    drawn = "all there are" if mixtures.exhaustive else f"{mixtures.by_phase} by phase, the others by chance"
    about = (
        "mixtures right of those tried, in which plates hold some shuttles from tilting and others tilt: "
        f"{drawn}; {mixtures.transitions_checked} of "
        f"{mixtures.transitions_total} transitions each"
    )
    if mixtures.weakest:
        about += (
            f"; {mixtures.weakest} is the first to read wrong in {mixtures.weakest_count}: {mixtures.weakest_words}"
        )
    right = f"{mixtures.tried - mixtures.wrong} of {mixtures.tried}"
    return [Margin("mixtures", right, "all", about, mixtures.wrong == 0)]


def _fabrication_rows(margins: Margins | None) -> list[Margin]:
    """What dimensions may be off by, against what the machine repeats to."""
    if margins is None:
        return []
    limit = f"machine: ±{margins.repeatability_um:g} µm"
    checked = f"{margins.decisions} decisions of {margins.samples} devices a run"
    weak = f"; {margins.weakest} gives way first" if margins.weakest else ""
    size = ""
    if not margins.machine_holds and margins.throw_unit_mm:
        size = f"; throw_unit {margins.throw_unit_mm:g} mm, all of the unit scaled alike, would do"
    return [
        Margin(
            "walls, all alike",
            f"+{margins.thicker_um:g} −{margins.thinner_um:g} µm",
            limit,
            f"largest error of all walls at which the device as drawn still proves right; {checked}",
            margins.repeatability_um <= margins.uniform_um,
        ),
        Margin(
            "dimensions, at random",
            f"±{margins.random_um:g} µm",
            limit,
            f"every wall, pin and post off by its own amount; {checked}{weak}{size}",
            margins.repeatability_um <= margins.random_um,
        ),
    ]
