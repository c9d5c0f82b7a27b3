"""How inner loops are compiled: strict arithmetic, no lock, kept on disk."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba


def kernel(function: Callable[..., Any]) -> Any:
    """``function``, compiled at its first call, or read from numba's cache.

    numba looks for a change only in the file that the function is written in, but a kernel takes its arithmetic from
    other files of its stage too; so the name under which it is kept tells the state of them all.
    """
    stage = Path(__file__).parent / function.__module__.split(".")[1]
    sources = b"".join(path.read_bytes() for path in sorted(stage.rglob("*.py")))
    function.__qualname__ = f"{function.__name__}_{hashlib.sha256(sources).hexdigest()[:16]}"
    try:
        return numba.njit(nogil=True, error_model="numpy", cache=True)(function)
    except RuntimeError:  # no place to keep the cache (read-only installation without a home)
        return numba.njit(nogil=True, error_model="numpy")(function)


part = numba.njit(error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True)
"""Decorates what kernels call; it is kept with them."""

inlined = numba.njit(error_model="numpy", forceinline=True, no_cpython_wrapper=True, no_cfunc_wrapper=True)
"""As ``part``, for what is small and called often."""
