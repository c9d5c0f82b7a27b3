"""The same network stepped by others: vectorised NumPy, SciPy, and JAX with or without diffrax.

Each peer is given its best suit: NumPy the faster of a dense and a sparse product of all couplings, JAX couplings in
padded rows (which XLA fuses with the rest of the step), compiled before the clock runs, doubles everywhere.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
from scipy.integrate import solve_ivp
from scipy.sparse import csr_array, eye_array

from mdlcad.simulation.run import STEPS_PER_PERIOD
from mdlcad.simulation.system import System

Rhs = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]


def waves_at(system: System, t: Any, sin: Callable[[Any], Any] = np.sin) -> Any:
    """All clock waves at time(s) ``t``."""
    turn = 2.0 * np.pi
    return 1.0 + sin(turn * t / system.period - turn * np.arange(system.phases) / system.phases)


def couplings(system: System, sparse: bool) -> tuple[Any, int]:
    """The constant and, if any, the clocked parts of all couplings, one below the other; and the number of parts."""
    n = len(system.names)
    rows = np.repeat(np.arange(n), np.diff(system.row_start))
    parts = [csr_array((system.base, (rows, system.column)), shape=(n, n)).toarray()]
    if system.swing.any():
        for k in range(system.phases):
            swing = np.where(system.wave == k, system.swing, 0.0)
            parts.append(csr_array((swing, (rows, system.column)), shape=(n, n)).toarray())
    stacked = np.concatenate(parts)
    return (csr_array(stacked) if sparse else stacked), len(parts)


def acceleration(system: System, sparse: bool) -> Rhs:
    """a(x, v, waves), vectorised over masses and, with x of two dimensions, over lanes."""
    n = len(system.names)
    springs, parts = couplings(system, sparse)
    scatter = eye_array(n, format="csr")[:, np.concatenate([system.latch_clock, system.latch_mass])].tocsr()
    clock, latch = system.latch_clock, system.latch_mass

    def a(x: np.ndarray, v: np.ndarray, waves: np.ndarray) -> np.ndarray:
        column = (slice(None), *(None,) * (x.ndim - 1))
        stiffness = system.stiffness_base + system.stiffness_swing * waves[system.phase]
        pull = springs @ x
        if parts > 1:
            weights = np.concatenate([[1.0], waves])
            pull = np.tensordot(weights, pull.reshape((parts, *x.shape)), 1)
        if len(clock):
            c = (system.latch_base + system.latch_swing * waves[system.latch_wave])[column]
            pull += scatter @ np.concatenate([c * x[latch] ** 2, 2.0 * c * x[clock] * x[latch]])
        force = pull - system.bias[column] - (stiffness[column] + system.quartic * x * x) * x
        return (force - system.damping * v) / system.inertia

    return a


def numpy_rk4(system: System, steps: int, sparse: bool, lanes: int = 0) -> np.ndarray:
    """Final displacements after ``steps`` RK4 steps, of one run or (lanes > 0) of many equal ones."""
    a = acceleration(system, sparse)
    h = system.period / STEPS_PER_PERIOD
    table = [waves_at(system, 0.5 * h * point) for point in range(2 * STEPS_PER_PERIOD)]
    x = system.initial.copy() if not lanes else np.repeat(system.initial[:, None], lanes, axis=1)
    v = np.zeros_like(x)
    for step in range(steps):
        w0, w1, w2 = (table[(2 * step + half) % len(table)] for half in range(3))
        a1 = a(x, v, w0)
        v2 = v + 0.5 * h * a1
        a2 = a(x + 0.5 * h * v, v2, w1)
        v3 = v + 0.5 * h * a2
        a3 = a(x + 0.5 * h * v2, v3, w1)
        v4 = v + h * a3
        a4 = a(x + h * v3, v4, w2)
        x = x + h / 6 * (v + 2 * v2 + 2 * v3 + v4)
        v = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
    return x


def scipy_solution(system: System, time_end: float, tolerance: float, method: str = "DOP853") -> np.ndarray:
    """Final displacements by ``solve_ivp``."""
    n = len(system.initial)
    a = acceleration(system, sparse=n > 64)

    def slope(t: float, y: np.ndarray) -> np.ndarray:
        return np.concatenate([y[n:], a(y[:n], y[n:], waves_at(system, t))])

    start = np.concatenate([system.initial, np.zeros(n)])
    return solve_ivp(slope, (0, time_end), start, method=method, rtol=tolerance, atol=tolerance).y[:n, -1]


def padded(system: System) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Couplings in rows of equal length: column, base, swing, wave; the padding is 0."""
    n, lengths = len(system.names), np.diff(system.row_start)
    shape = (n, max(1, int(lengths.max())))
    column, base, swing, wave = (np.zeros(shape, kind) for kind in (int, float, float, int))
    for i in range(n):
        row = slice(system.row_start[i], system.row_start[i + 1])
        for into, of in ((column, "column"), (base, "base"), (swing, "swing"), (wave, "wave")):
            into[i, : lengths[i]] = getattr(system, of)[row]
    return column, base, swing, wave


def jax_slope(system: System) -> Callable[[Any, Any], Any]:
    """slope(t, (x, v)) in JAX."""
    import jax

    jax.config.update("jax_enable_x64", True)
    import jax.numpy as jnp

    column, base, swing, wave = padded(system)
    clocked = bool(system.swing.any())
    clock, latch = system.latch_clock, system.latch_mass

    def slope(t: Any, y: Any) -> Any:
        x, v = y
        p = waves_at(system, t, jnp.sin)
        strength = base + swing * p[wave] if clocked else base
        force = (strength * x[column]).sum(axis=1) - system.bias
        if len(clock):
            c = system.latch_base + system.latch_swing * p[system.latch_wave]
            force = force.at[clock].add(c * x[latch] ** 2).at[latch].add(2.0 * c * x[clock] * x[latch])
        stiffness = system.stiffness_base + system.stiffness_swing * p[system.phase]
        force = force - (stiffness + system.quartic * x * x) * x - system.damping * v
        return v, force / system.inertia

    return slope


def jax_rk4(system: System, steps: int, lanes: int = 0) -> Callable[[], np.ndarray]:
    """A compiled RK4 loop in plain JAX, to be called again and again."""
    import jax
    import jax.numpy as jnp

    slope = jax_slope(system)
    h = system.period / STEPS_PER_PERIOD

    def step(index: Any, y: Any) -> Any:
        t = h * index
        x, v = y
        x1, v1 = slope(t, y)
        x2, v2 = slope(t + 0.5 * h, (x + 0.5 * h * x1, v + 0.5 * h * v1))
        x3, v3 = slope(t + 0.5 * h, (x + 0.5 * h * x2, v + 0.5 * h * v2))
        x4, v4 = slope(t + h, (x + h * x3, v + h * v3))
        return x + h / 6 * (x1 + 2 * x2 + 2 * x3 + x4), v + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4)

    def whole(x: Any) -> Any:
        return jax.lax.fori_loop(0, steps, step, (x, jnp.zeros_like(x)))[0]

    return _compiled(system, whole, lanes)


def diffrax_solution(system: System, steps: int, solver: str, lanes: int = 0) -> Callable[[], np.ndarray]:
    """A compiled diffrax solve with a constant step; ``solver`` is RK4 (the classical tableau) or one of diffrax's."""
    import diffrax
    import jax.numpy as jnp

    slope = jax_slope(system)

    class RK4(diffrax.AbstractERK):
        tableau: ClassVar[Any] = diffrax.ButcherTableau(
            c=np.array([0.5, 0.5, 1.0]),
            a_lower=(np.array([0.5]), np.array([0.0, 0.5]), np.array([0.0, 0.0, 1.0])),
            b_sol=np.array([1.0, 2.0, 2.0, 1.0]) / 6.0,
            b_error=np.zeros(4),
        )
        interpolation_cls: ClassVar[Any] = diffrax.ThirdOrderHermitePolynomialInterpolation.from_k

        def order(self, terms: Any) -> int:
            return 4

    method = RK4() if solver == "RK4" else getattr(diffrax, solver)()
    term = diffrax.ODETerm(lambda t, y, _: slope(t, y))

    def whole(x: Any) -> Any:
        return diffrax.diffeqsolve(
            term,
            method,
            t0=0.0,
            t1=steps / STEPS_PER_PERIOD * system.period,
            dt0=system.period / STEPS_PER_PERIOD,
            y0=(x, jnp.zeros_like(x)),
            max_steps=None,  # nothing kept for derivatives
            throw=False,
        ).ys[0][0]

    return _compiled(system, whole, lanes)


def _compiled(system: System, whole: Callable[[Any], Any], lanes: int) -> Callable[[], np.ndarray]:
    import jax
    import jax.numpy as jnp

    if lanes:
        start = jnp.asarray(np.repeat(system.initial[None, :], lanes, axis=0))
        solve = jax.jit(jax.vmap(whole)).lower(start).compile()
        return lambda: np.asarray(solve(start)).T
    start = jnp.asarray(system.initial)
    solve = jax.jit(whole).lower(start).compile()
    return lambda: np.asarray(solve(start))
