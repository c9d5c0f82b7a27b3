"""The Liberty view of a library: what logic synthesis sees of it."""

from __future__ import annotations

from mdlcad.mapping.two_phase.cell_library import Cell, TwoPhaseLibrary


def liberty(library: TwoPhaseLibrary) -> str:
    """Liberty text of ``library``: a cell's area is the number of masses it adds; its delay, not said, is one cycle."""
    cells = "".join(_cell(cell) for cell in library.cells)
    return (
        f"library({library.name}) {{\n"
        '  delay_model : table_lookup;\n  time_unit : "1ns";\n  capacitive_load_unit(1, pf);\n'
        f"  default_max_fanout : {library.fan_out};\n{cells}}}\n"
    )


def _cell(cell: Cell) -> str:
    lines = [f"  cell({cell.name}) {{", f"    area : {len(cell.masses)};"]
    value = cell.text
    if cell.function is None:
        lines.append('    ff(state, inverse) { clocked_on : "C"; next_state : "D"; }')
        value = "state"
    lines += [f"    pin({pin}) {{ direction : input; }}" for pin in cell.inputs]
    lines.append(f'    pin({cell.output}) {{ direction : output; function : "{value}"; }}')
    return "\n".join(lines) + "\n  }\n"
