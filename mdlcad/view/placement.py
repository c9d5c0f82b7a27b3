"""The drawing of a placed network: views/placement.svg, where hovering over a mass tells its name, and .png."""

from __future__ import annotations

from html import escape
from pathlib import Path

from mdlcad.artefact import load, write_atomic
from mdlcad.network.model import Network
from mdlcad.scenario.figures.network import network_figure
from mdlcad.scenario.figures.page import png, svg
from mdlcad.scenario.seats import PlacedSeats, placed_seats

# Wide enough that 216 masses on the paper's grid stay apart.
_INCHES = 12.0


def write_placement_views(network: Network, folder: Path) -> None:
    """Draw the masses, signed couplings, boundary and ports of the build in ``folder`` from its placement.json.

    Raises:
        UsageError: that file is missing or is no placement.
    """
    figure = network_figure(network, placed_seats(load(folder, "placement.json", PlacedSeats)), _INCHES)
    views = folder / "views"
    views.mkdir(exist_ok=True)
    write_atomic(views / "placement.png", png(figure))
    write_atomic(views / "placement.svg", _with_titles(svg(figure).decode(), network).encode())


def _with_titles(text: str, network: Network) -> str:
    """``text`` with a title in the group of every mass, which viewers show beside the pointer."""
    for mass in network.masses:
        group = f'<g id="mass {escape(mass.name)}">'
        words = f"{mass.name}: {mass.kind.value}, clock wave {mass.phase}"
        if mass.bias:
            words += f", bias {-mass.bias:+g}"
        text = text.replace(group, f"{group}<title>{escape(words)}</title>", 1)
    return text
