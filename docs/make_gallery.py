"""Renders docs/gallery.md and its pictures from finished builds: ./run python docs/make_gallery.py BUILD..."""

from __future__ import annotations

import sys
from pathlib import Path

from PIL import Image

from mdlcad.artefact import load
from mdlcad.language import Device
from mdlcad.mechanics import Sizing
from mdlcad.network.model import Network
from mdlcad.placement.placement import Placement
from mdlcad.report.report import Report
from mdlcad.routing.drawing import draw_layout
from mdlcad.routing.layout import Layout

DOCS = Path(__file__).resolve().parent
PICTURES = DOCS / "images" / "gallery"
WIDTH = 760

HEAD = """# Gallery

Devices as built, rendered by `docs/make_gallery.py` from their build folders. Each drawing of placement and routing
opens by itself; hover over a piece for its name and its net.
"""


def main(folders: list[str]) -> None:
    """Write the page and its pictures."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    (DOCS / "gallery.md").write_text(HEAD + "".join(entry(Path(folder)) for folder in folders), encoding="utf-8")


def entry(folder: Path) -> str:
    """One device: its pictures made, its part of the page."""
    report, device = load(folder, "report.json", Report), load(folder, "device.json", Device)
    network, sizing = load(folder, "network.json", Network), load(folder, "sizing.json", Sizing)
    placement, layout = load(folder, "placement.json", Placement), load(folder, "layout.json", Layout)
    name = report.design
    for view in ("stack", "exploded"):
        with Image.open(folder / "views" / f"{view}.png") as picture:
            small = picture.convert("RGB").resize((WIDTH, round(picture.height * WIDTH / picture.width)))
        small.save(PICTURES / f"{name}-{view}.jpg", quality=82, optimize=True)
    (PICTURES / f"{name}-layout.svg").write_bytes(draw_layout(network, placement, layout, sizing.rules))
    proof, size = report.extracted, report.extent_mm
    proved = f"{proof.transitions_checked} of {proof.transitions_total} transitions right as drawn" if proof else ""
    extent = " x ".join(f"{side:.0f}" for side in size) + " mm" if size else ""
    facts = [
        f"{_count(report.masses, 'mass', 'masses')}, {_count(report.couplings, 'coupling')}",
        f"{_count(report.cycles_per_tick, 'clock cycle')} a decision",
        extent,
        f"process {report.process}, seed {report.seed}",
        proved,
    ]
    ports = [_count(len(device.sensors), "sensor"), _count(len(device.actuators), "actuator")]
    return f"""
## {name}

{"; ".join(fact for fact in [*ports, *facts] if fact)}.

<div class="gallery" markdown>
![{name}: the device without its cover](images/gallery/{name}-stack.jpg)

![{name}: its plates, drawn apart](images/gallery/{name}-exploded.jpg)
</div>

[![{name}: placement and routing](images/gallery/{name}-layout.svg)](images/gallery/{name}-layout.svg)
"""


def _count(number: int, what: str, many: str = "") -> str:
    return f"{number} {what if number == 1 else many or what + 's'}"


if __name__ == "__main__":
    main(sys.argv[1:])
