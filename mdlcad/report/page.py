"""report.html: the build folder as one page that needs no other file and no network to be read.

It is made from the files of the folder, so an older build's page can be written again.
"""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TypeVar

from markupsafe import Markup

from mdlcad.artefact import load, write_atomic
from mdlcad.language import Device
from mdlcad.mechanics import Process
from mdlcad.mechanics.compensation import COMPENSATION_FILE, Compensation, final_sizing
from mdlcad.network.model import Network
from mdlcad.proof.outcome import Proof
from mdlcad.report.make import PAGE
from mdlcad.report.margins import margin_rows
from mdlcad.report.pictures import drawing, photo
from mdlcad.report.report import Report
from mdlcad.report.tables import (
    flexure_rows,
    kinds_of_masses,
    port_rows,
    rule_rows,
    size_rows,
    stock_words,
)
from mdlcad.report.templates import environment
from mdlcad.signoff.lvs import LvsResult
from mdlcad.signoff.summary import DesignRules

T = TypeVar("T")

PICTURES = {
    "stack": "the device without its cover (and without what lies on that), seen from a corner",
    "exploded": "the plates of the device, drawn apart",
    "placement": "the network of masses and springs, where it is placed",
}


@dataclass(frozen=True, slots=True)
class Verdict:
    """The first thing the page says: ``tone`` is good, partial or bad."""

    tone: str
    words: str
    more: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class PlateDrawing:
    """A plate, its drawing as SVG, and its files."""

    plate: str
    about: str
    svg: Markup
    files: tuple[str, ...]


def write_page(folder: Path) -> None:
    """Write report.html from the other files of the build folder.

    Raises:
        UsageError: a file is truncated or of another shape; the message names it.
    """
    write_atomic(folder / PAGE, page(folder).encode())


def page(folder: Path) -> str:
    """The page's text."""
    report = load(folder, "report.json", Report)

    def made(name: str, kind: type[T]) -> T | None:
        return load(folder, name, kind) if (folder / name).is_file() else None

    device, network = made("device.json", Device), made("network.json", Network)
    process, compensation = made("process.json", Process), made(COMPENSATION_FILE, Compensation)
    sizing = final_sizing(folder) if (folder / "sizing.json").is_file() else None
    proof, rules = made("proof.json", Proof), made("drc.json", DesignRules)
    extraction = made("extraction.json", tuple[LvsResult, Proof])
    proofs = [("network", proof)] if proof else []
    if extraction is not None:
        proofs.append(("device as drawn", extraction[1]))
    templates = environment("mdlcad.report", "template")
    layout = drawing(folder / "views" / "layout.svg", f"placement and routing of {escape(report.design)}")
    longest = max((stage.seconds for stage in report.stages), default=0.0)
    return templates.get_template("report.html.j2").render(
        report=report,
        verdict=verdict_of(report),
        device=device,
        network=network,
        masses=kinds_of_masses(network) if network else "",
        ports=port_rows(device) if device else [],
        proofs=proofs,
        margins=margin_rows(report, process, sizing, proofs),
        rules=rule_rows(rules, report, process) if rules else [],
        guides=rules.guides if rules else (),
        sizes=size_rows(sizing, process) if sizing and process else [],
        flexures=flexure_rows(sizing) if sizing else [],
        compensation=compensation,
        bom=report.bom,
        stock=stock_words(report.bom) if report.bom else [],
        pictures=[
            (name, words, Markup(data))
            for name, words in PICTURES.items()
            # where there is a layout, its drawing shows more
            if not (name == "placement" and layout) and (data := photo(folder / "views" / f"{name}.png")) is not None
        ],
        layout=Markup(layout) if layout else None,
        plates=plate_drawings(folder, report),
        seconds=round(sum(stage.seconds for stage in report.stages), 1),
        longest=longest or 1.0,
        sizes_of_files={name: (folder / name).stat().st_size for name in report.files if (folder / name).is_file()},
    )


def verdict_of(report: Report) -> Verdict:
    """What the build comes to, in one line and, where something does not hold, what."""
    if report.stopped is not None:
        words = f"Does not hold: the build ended at its stage “{report.stopped.stage}”"
        return Verdict("bad", words, report.failures)
    if report.failures:
        count = len(report.failures)
        return Verdict("bad", f"Does not hold: {count} finding{'s' if count > 1 else ''}", report.failures)
    if report.extracted is None:
        last = report.stages[-1].name if report.stages else "nothing"
        lacking = [
            words
            for words, known in (
                ("the behaviour of the network is not proved", report.behaviour),
                ("the design rules have not been checked", report.drc),
                ("the drawn device has not been read back and proved", report.extracted),
            )
            if known is None
        ]
        return Verdict("partial", f"Stopped after its stage “{last}”, as asked", tuple(lacking))
    between, mixtures = "", report.mixtures
    if mixtures is not None and mixtures.wrong:
        between = f", but {mixtures.wrong} of {mixtures.tried} mixtures of held and tilting shuttles are wrong"
    warned = sum((report.drc or {}).values())
    more: tuple[str, ...] = ()
    if mixtures is not None and between:
        more += (f"right with all shuttles held by plates and with all tilting, but between: {mixtures.words()}",)
    if warned:
        more += (f"{warned} warning{'s' if warned > 1 else ''} of the design rules, see below",)
    if report.margins is not None and not report.margins.machine_holds:
        more += (f"as drawn it works, but fabrication may spoil it: {report.margins.words()}",)
    return Verdict("partial" if between else "good", f"All of it holds{between}", more)


def plate_drawings(folder: Path, report: Report) -> list[PlateDrawing]:
    """The plates that have a drawing, bottom first."""
    sheets = {line.plate: line for line in report.bom.sheets} if report.bom else {}
    found = []
    for plate in report.plates:
        svg = drawing(folder / "plates" / f"{plate}.svg", f"plate {escape(plate)} from above")
        if svg is None:
            continue
        line = sheets.get(plate)
        about = ""
        if line is not None:
            about = (
                f"{line.material or 'material not named by the process'}, {line.thickness_mm:g} mm, "
                f"{line.size_mm[0]:g} × {line.size_mm[1]:g} mm, {line.pieces} piece{'s' if line.pieces > 1 else ''}"
            )
        names = [f"plates/{plate}.{kind}" for kind in ("step", "stl", "dxf", "svg")]
        files = tuple(name for name in names if name in report.files)
        found.append(PlateDrawing(plate, about, Markup(svg), files))
    return found
