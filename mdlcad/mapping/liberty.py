"""The Liberty view of a threshold library: every gate that is one mass, but for order and inversion of its inputs."""

from __future__ import annotations

from itertools import combinations
from string import ascii_uppercase

from mdlcad.mapping.cell_library import Library
from mdlcad.mapping.threshold import MOST_INPUTS, Threshold, threshold_functions

# masses of a register's ring with one set term
REGISTER_MASSES = 4


def threshold_gates(library: Library) -> tuple[Threshold, ...]:
    """The gates of one mass: weights falling and positive, for an inversion is free; lightest first, by inputs."""
    found = []
    for inputs in range(1, MOST_INPUTS + 1):
        for _, function in threshold_functions(inputs, library.gates.weight_limit):
            weights = function.weights
            if all(w > 0 for w in weights) and list(weights) == sorted(weights, reverse=True):
                found.append(function)
    return tuple(found)


def gate_name(function: Threshold) -> str:
    """What a gate is called in the view, by what it computes or else by its weights."""
    inputs, plain = len(function.weights), set(function.weights) == {1}
    if plain and inputs == 1:
        return "BUF"
    if plain and function.bias == 1 - inputs:
        return f"AND{inputs}"
    if plain and function.bias == inputs - 1:
        return f"OR{inputs}"
    if plain and function.bias == 0:
        return f"MAJ{inputs}"
    sign = "" if function.bias == 0 else f"_{'P' if function.bias > 0 else 'N'}{abs(function.bias)}"
    return f"T{''.join(map(str, function.weights))}{sign}"


def gate_function(function: Threshold) -> str:
    """The function as Liberty writes it: the smallest sets of inputs that together make it 1 (it is monotone)."""
    weights, total = function.weights, sum(function.weights)
    least: list[tuple[int, ...]] = []
    for size in range(1, len(weights) + 1):
        for chosen in combinations(range(len(weights)), size):
            on = 2 * sum(weights[i] for i in chosen) - total + function.bias > 0
            if on and not any(set(smaller) <= set(chosen) for smaller in least):
                least.append(chosen)
    return "|".join("&".join(ascii_uppercase[i] for i in chosen) for chosen in least)


def threshold_liberty(library: Library) -> str:
    """Liberty text of ``library``: area is in masses; any input of a gate may also be wanted inverted, at no cost."""
    cells = []
    for function in threshold_gates(library):
        pins = "".join(
            f"    pin({ascii_uppercase[i]}) {{ direction : input; }}\n" for i in range(len(function.weights))
        )
        cells.append(
            f"  cell({gate_name(function)}) {{\n    area : 1;\n{pins}"
            f'    pin(Y) {{ direction : output; function : "{gate_function(function)}"; }}\n  }}\n'
        )
    cells.append(
        f"  cell(REGISTER) {{\n    area : {REGISTER_MASSES};\n"
        '    ff(state, inverse) { clocked_on : "C"; next_state : "D"; }\n'
        "    pin(C) { direction : input; }\n    pin(D) { direction : input; }\n"
        '    pin(Q) { direction : output; function : "state"; }\n  }\n'
    )
    return (
        f"library({library.name}) {{\n"
        '  delay_model : table_lookup;\n  time_unit : "1ns";\n  capacitive_load_unit(1, pf);\n'
        f"  default_max_fanout : {library.gates.load_limit};\n{''.join(cells)}}}\n"
    )
