"""Which masses to use upside down, so that the fewest couplings are negative.

Turning a mass round (x -> -x) changes the sign of all its couplings and of its bias. A negative coupling needs a part
of its own (a rocker), a positive one is a plain spring. Sensors and actuators keep their sign.

A rocker turns on a fixed post and so does a bias leaf; either side of a hub has room for one post, so no mass is to
have more than two of them. That comes before the number of rockers.
"""

from __future__ import annotations

from collections.abc import Iterable

from ortools.sat.python import cp_model

_DETERMINISTIC_TIME = 4.0
_POSTS = 2


def choose_polarity(
    masses: list[str], couplings: list[tuple[str, str, bool]], fixed: Iterable[str], biased: Iterable[str]
) -> dict[str, int]:
    """+1 or -1 for every mass; the fewest negative couplings that were found (the least there are, unless the network
    is too large for the time allowed) among the choices with the fewest posts too many.

    Args:
        couplings: source, target, and whether the coupling is negative while all masses are upright.
        fixed: masses that stay +1.
        biased: masses with a bias leaf.
    """
    model = cp_model.CpModel()
    turned = {name: model.new_bool_var(name) for name in masses}
    for name in sorted(fixed):
        model.add(turned[name] == 0)
    negative = []
    rockers: dict[str, list[cp_model.IntVar]] = {name: [] for name in masses}
    for source, target, inverting in couplings:
        result = model.new_bool_var(f"{source}->{target}")
        # result = inverting xor turned[source] xor turned[target]
        model.add_bool_xor([turned[source], turned[target], result, inverting, True])
        negative.append(result)
        rockers[target].append(result)
    leaves = set(biased)
    crowded = []
    for name in masses:
        room = _POSTS - (name in leaves)
        if len(rockers[name]) > room:
            excess = model.new_int_var(0, len(rockers[name]), f"crowded {name}")
            model.add(excess >= sum(rockers[name]) - room)
            crowded.append(excess)
    model.minimize(sum(negative) + (len(negative) + 1) * sum(crowded))
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
