"""A cell library in words, for ``mdlcad cells NAME``."""

from __future__ import annotations

from mdlcad.mapping.cell_library import Library as ParametronLibrary
from mdlcad.mapping.characterisation import Characterisation
from mdlcad.mapping.dispatch import Library
from mdlcad.mapping.liberty import REGISTER_MASSES, gate_function, gate_name, threshold_gates
from mdlcad.mapping.two_phase import TwoPhaseLibrary
from mdlcad.network.model import Dynamics


def describe(library: Library) -> str:
    """Lines on the library's clock, its cells and its limits; all numbers as in its file, dimensionless."""
    if isinstance(library, TwoPhaseLibrary):
        lines = _two_phase(library)
    else:
        lines = _parametron(library)
    return "\n".join(lines)


def _head(name: str, title: str, kind: str, dynamics: Dynamics) -> list[str]:
    return [
        f"{name}: {title}",
        f"  kind       {kind}",
        f"  clock      {dynamics.phases} waves p = 1 + sin, period T = {dynamics.period:g}",
        f"  mass       m = {dynamics.inertia:g}, b = {dynamics.damping:g}, lambda = {dynamics.quartic:g}",
    ]


def _window(found: Characterisation | None) -> list[str]:
    """Where every cell was measured to work."""
    if found is None:
        return []
    rows = zip(found.periods, found.least_damping, found.greatest_damping, strict=True)
    words = [f"T = {period:g} with b = {least:g} to {greatest:g}" for period, least, greatest in rows]
    return [
        *(f"  {'works for' if place == 0 else '':<9}  {line}" for place, line in enumerate(words)),
        f"  spread     every cell bears {found.spread:g}",
        *([f"  bears      fan-out {found.fan_out}, echo {found.echo}"] if found.fan_out else []),
    ]


def _parametron(library: ParametronLibrary) -> list[str]:
    mass, spring = library.mass, library.coupling
    lines = [
        *_head(library.name, library.title, library.kind, library.network_dynamics()),
        f"  stiffness  k = {mass.k0:g} {mass.k1:+g} p",
        f"  spring     c = {spring.strength:g} per weight, constant; bias q = {library.bias.force:g} per weight",
        f"  limits     weights of a mass {library.gates.weight_limit}, load {library.gates.load_limit}, "
        f"echo {library.gates.echo_limit}",
        *_window(library.characterisation),
        "",
        "  gates of one mass (any input may be inverted, at no cost)",
        f"    {'cell':<10} {'weights':<12} {'bias':>4}  function",
    ]
    for gate in threshold_gates(library):
        weights = " ".join(map(str, gate.weights))
        lines.append(f"    {gate_name(gate):<10} {weights:<12} {gate.bias:>4}  {gate_function(gate)}")
    lines.append(f"    {'REGISTER':<10} a ring of three masses and a set term: {REGISTER_MASSES} masses")
    return lines


def _two_phase(library: TwoPhaseLibrary) -> list[str]:
    options = library.options
    on = {True: "yes", False: "no"}
    lines = [
        *_head(library.name, library.title, library.kind, library.dynamics),
        f"  parameters {library.parameters} (of {', '.join(library.parameter_sets)}; --parameters)",
        f"  fan-out    {library.fan_out} inputs on an output",
        *_window(library.characterisation),
        "",
        "  synthesis options (each can be set in the file, and by the build's option)",
        f"    clock_length {options.clock_length:<6} --clock-length N",
        f"    clock        {on[options.clock]:<6} --no-clock",
        f"    branching    {on[options.branching]:<6} --no-branching",
        f"    io_gates     {on[options.io_gates]:<6} --no-io-gates",
        f"    buffer       {options.buffer:<6} --buffer CELL",
        "",
        "  cells, one clock cycle each",
        f"    {'cell':<8} {'masses':>6} {'springs':>7}  {'inputs':<8} function",
    ]
    for cell in library.cells:
        function = cell.text or "takes D at a tick C, keeps it otherwise"
        lines.append(
            f"    {cell.name:<8} {len(cell.masses):>6} {len(cell.couplings):>7}  {' '.join(cell.inputs):<8} {function}"
        )
    return lines
