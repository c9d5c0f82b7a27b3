"""The network: masses by clock wave and bias, couplings by sign, in the device's boundary."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import FancyArrowPatch
from scipy.spatial import cKDTree

from mdlcad.network.model import CouplingKind, MassKind, Network
from mdlcad.scenario.figures.page import FAINT, INK, LATCH, NEGATIVE, PAPER, PHASES, POSITIVE, bare, new_figure, png
from mdlcad.scenario.seats import Seats

_INCHES = 8.0


def picture(network: Network, seats: Seats) -> bytes:
    """PNG of the network."""
    return png(network_figure(network, seats, _INCHES))


def network_figure(network: Network, seats: Seats, inches: float) -> Figure:
    """The network on a page whose larger side is ``inches``; every mass is a group "mass NAME" in it."""
    figure, axes = framed(seats, inches)
    outline(axes, seats)
    # smaller masses in larger networks, down to where they are dots; and room for a coupling between any two
    side = float(np.clip(150.0 / np.sqrt(len(network.masses)), 4.0, 19.0))
    side = max(2.5, min(side, 0.6 * _closest(seats) * _points_a_unit(figure, axes)))
    couplings(axes, network, seats, side)
    ports = {port.mass for port in (*network.sensors, *network.actuators)}
    registers = {register.mass for register in network.registers}
    for mass in network.masses:
        x, y = seats.masses[mass.name]
        marker = "s" if mass.name in ports else "D" if mass.kind is MassKind.TICK else "o"
        edge = 2.4 if mass.name in registers else 0.9
        colour = PHASES[mass.phase % len(PHASES)]
        axes.plot(
            x,
            y,
            marker,
            ms=side * (0.8 if marker == "D" else 1.0),
            mfc=colour,
            mec=INK,
            mew=edge,
            zorder=3,
            gid=f"mass {mass.name}",
        )
        if mass.bias and side > 5.0:
            # the bias force is -q
            axes.text(
                x,
                y,
                "−" if mass.bias > 0 else "+",
                ha="center",
                va="center_baseline",
                fontsize=0.75 * side,
                fontweight="bold",
                color="white",
                zorder=4,
            )
    for port in (*network.sensors, *network.actuators):
        axes.plot(*zip(seats.ports[port.bit], seats.masses[port.mass], strict=True), ":", color=INK, lw=0.8, zorder=1)
    _port_names(axes, seats)
    _legend(axes, network)
    negative = sum(coupling.strength < 0 for coupling in network.couplings)
    placed = "where they are placed" + (", those of the upper deck half a row to the right" if seats.aside else "")
    where = placed if seats.placed else "not placed yet: spread for the eye"
    axes.set_title(
        f"{network.design}: {len(network.masses)} masses ({where}), {len(network.couplings)} couplings, "
        f"{negative} negative",
        fontsize=10.5,
        color=INK,
    )
    return figure


def _closest(seats: Seats) -> float:
    """Least distance of two masses, in units of the seats."""
    spots = np.array(list(seats.masses.values()))
    if len(spots) < 2:
        return float("inf")
    distance, _ = cKDTree(spots).query(spots, k=2)
    return float(distance[:, 1].min())


def _points_a_unit(figure: Figure, axes: Axes) -> float:
    """Typographic points that a unit of the seats takes on the page."""
    low, high = axes.get_xlim()
    return float(figure.get_figwidth()) * 72.0 / (high - low)


def framed(seats: Seats, inches: float) -> tuple[Figure, Axes]:
    """A figure whose larger side is ``inches``, with axes to scale around the boundary."""
    points = np.array([*seats.boundary, *seats.masses.values()])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.06 * float((high - low).max())
    size = (high - low + 2 * margin) * inches / float((high - low + 2 * margin).max())
    figure = new_figure(float(size[0]), float(size[1]))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal")
    bare(axes)
    return figure, axes


def outline(axes: Axes, seats: Seats) -> None:
    """The boundary, behind everything."""
    axes.fill(*zip(*seats.boundary, strict=True), fc=PAPER, ec=FAINT, lw=1.5, zorder=0)


def couplings(axes: Axes, network: Network, seats: Seats, side: float, *, arrows: bool = True) -> None:
    """Couplings as arcs between masses ``side`` points wide, source to target; negative ones red, those of latches
    (whose source acts on the target's stiffness) dashed in a colour of their own."""
    strongest = max((abs(coupling.strength) for coupling in network.couplings), default=1.0)
    thin = 1.0 if len(network.couplings) < 300 else 0.5
    for coupling in network.couplings:
        latch = coupling.kind is CouplingKind.LATCH
        red = coupling.strength < 0 and not latch
        axes.add_patch(
            FancyArrowPatch(
                seats.masses[coupling.source],
                seats.masses[coupling.target],
                # bent, so that couplings along one column do not cover each other
                connectionstyle="arc3,rad=0.14",
                arrowstyle="-|>" if arrows else "-",
                mutation_scale=min(8.0, 1.0 + 0.5 * side),
                shrinkA=0.25 * side,
                shrinkB=(0.48 if arrows else 0.25) * side,
                color=LATCH if latch else NEGATIVE if red else POSITIVE,
                lw=thin * (1.6 if latch else 0.5 + 1.1 * abs(coupling.strength) / strongest),
                ls=(0, (2.5, 1.2)) if latch else "-",
                alpha=0.95 if red or latch else 0.8,
                zorder=2 if red or latch else 1,
            )
        )


def _port_names(axes: Axes, seats: Seats) -> None:
    """Every bit's name beside its place, outside the boundary."""
    corners = np.array(seats.boundary)
    reach = 0.02 * float(np.ptp(corners, axis=0).max())
    following = np.roll(corners, -1, axis=0)
    for bit, spot in seats.ports.items():
        here = np.array(spot)
        # the normal of the nearest side
        along = following - corners
        share = np.clip(((here - corners) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
        nearest = int(np.argmin(((corners + share[:, None] * along - here) ** 2).sum(axis=1)))
        normal = np.array([-along[nearest, 1], along[nearest, 0]]) / np.hypot(*along[nearest])
        x, y = here + reach * normal
        sideways = abs(normal[0]) > 0.7
        axes.text(
            x,
            y,
            bit,
            fontsize=8,
            color=INK,
            ha=("left" if normal[0] > 0 else "right") if sideways else "center",
            va="center" if sideways else ("bottom" if normal[1] > 0 else "top"),
        )
        axes.plot(*spot, marker="o", ms=3.5, color=INK, zorder=3)


def _legend(axes: Axes, network: Network) -> None:
    def dot(colour: str, marker: str, edge: float, label: str) -> Line2D:
        return Line2D([], [], ls="", marker=marker, mfc=colour, mec=INK, mew=edge, ms=8, label=label)

    handles = [
        dot(PHASES[phase % len(PHASES)], "o", 0.9, f"clock wave {phase}") for phase in range(network.dynamics.phases)
    ]
    latches = (
        [Line2D([], [], color=LATCH, lw=1.6, ls=(0, (2.5, 1.2)), label="latch coupling")]
        if any(coupling.kind is CouplingKind.LATCH for coupling in network.couplings)
        else []
    )
    handles += [
        dot("white", "s", 0.9, "of a sensor or actuator"),
        dot("white", "o", 2.4, "register"),
        dot("white", "D", 0.9, "tick ring"),
        Line2D([], [], color=POSITIVE, lw=1.6, label="coupling"),
        Line2D([], [], color=NEGATIVE, lw=1.6, label="negative coupling"),
        *latches,
        Line2D([], [], ls="", marker="$\\pm$", color=INK, ms=8, label="sign of the bias force"),
    ]
    axes.legend(
        handles=handles,
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        ncols=5,
        fontsize=8,
        frameon=False,
        handletextpad=0.4,
        columnspacing=1.2,
    )
