"""Which masses to use upside down, so that the fewest couplings are negative.

Turning a mass round (x -> -x) changes the sign of all its couplings and of its bias. A negative coupling needs a part
of its own (a rocker), a positive one is a plain spring. Sensors and actuators keep their sign.
"""

from __future__ import annotations

from collections.abc import Iterable

from ortools.sat.python import cp_model

_DETERMINISTIC_TIME = 4.0


def choose_polarity(masses: list[str], couplings: list[tuple[str, str, bool]], fixed: Iterable[str]) -> dict[str, int]:
    """+1 or -1 for every mass; the fewest negative couplings that were found (the least there are, unless the network
    is too large for the time allowed).

    Args:
        couplings: source, target, and whether the coupling is negative while all masses are upright.
        fixed: masses that stay +1.
    """
    model = cp_model.CpModel()
    turned = {name: model.new_bool_var(name) for name in masses}
    for name in sorted(fixed):
        model.add(turned[name] == 0)
    negative = []
    for source, target, inverting in couplings:
        result = model.new_bool_var(f"{source}->{target}")
        # result = inverting xor turned[source] xor turned[target]
        model.add_bool_xor([turned[source], turned[target], result, inverting, True])
        negative.append(result)
    model.minimize(sum(negative))
    for name in masses:
        model.add_hint(turned[name], 0)
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    solver.parameters.random_seed = 1
    solver.parameters.max_deterministic_time = _DETERMINISTIC_TIME
    status = solver.solve(model)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        raise RuntimeError("no choice of polarity was found in the time allowed")
    return {name: -1 if solver.value(turned[name]) else 1 for name in masses}
