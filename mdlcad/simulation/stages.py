"""The classical Runge-Kutta step of x' = v, v' = a(x, v, t), in two halves.

The slopes of x are velocities, so with half a step the displacements of the second stage, x + h/2 v, do not depend on
the first acceleration, and those of the fourth, x + h v + h^2/2 a2, not on the third. Masses feel each other only
through their displacements: so the first two accelerations of all masses can be found in one pass over the couplings,
and the other two in a second pass. The result is that of the usual tableau (1/6, 1/3, 1/3, 1/6), for

    y2 = x + h/2 v,  y3 = y2 + h^2/4 a1,  y4 = x + h v + h^2/2 a2,
    x' = x + h v + h^2/6 (a1 + a2 + a3),  v' = v + h/6 (a1 + 2 a2 + 2 a3 + a4).

Both kernels call these functions, each with vectors of its own: that is why their results agree bit for bit.
"""

from __future__ import annotations

from typing import Any

import numba


@numba.njit(inline="always")
def first_half(
    x: Any, y2: Any, v: Any, f1: Any, f2: Any, k1: Any, k2: Any, h: float, damping: float, quartic: float
) -> Any:
    """a1, a2, y3, y4 from the forces f1, f2 of the other masses at x and y2 and the stiffness k1, k2 then."""
    a1 = f1 - damping * v - (k1 + quartic * (x * x)) * x
    a2 = f2 - damping * (v + (0.5 * h) * a1) - (k2 + quartic * (y2 * y2)) * y2
    return a1, a2, y2 + (0.25 * h * h) * a1, (x + h * v) + (0.5 * h * h) * a2


@numba.njit(inline="always")
def second_half(
    x: Any,
    y3: Any,
    y4: Any,
    v: Any,
    a1: Any,
    a2: Any,
    f3: Any,
    f4: Any,
    k3: Any,
    k4: Any,
    h: float,
    damping: float,
    quartic: float,
) -> Any:
    """x, y2 and v of the next step."""
    a3 = f3 - damping * (v + (0.5 * h) * a2) - (k3 + quartic * (y3 * y3)) * y3
    a4 = f4 - damping * (v + h * a3) - (k4 + quartic * (y4 * y4)) * y4
    middle = a2 + a3
    next_x = (x + h * v) + (h * h / 6.0) * (a1 + middle)
    next_v = v + (h / 6.0) * ((a1 + a4) + 2.0 * middle)
    return next_x, next_x + (0.5 * h) * next_v, next_v
