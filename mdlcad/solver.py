"""CP-SAT as this project uses it: one worker, a seed, and a limit that counts work: always the same result."""

from __future__ import annotations

from ortools.sat.python import cp_model


def solver_with(seed: int, limit: float) -> cp_model.CpSolver:
    """A solver of one worker with that deterministic time."""
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    solver.parameters.random_seed = seed
    solver.parameters.max_deterministic_time = limit
    return solver
