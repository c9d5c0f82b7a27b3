"""How the kernels are compiled: strict arithmetic, no lock, kept on disk."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba


def kernel(function: Callable[..., None]) -> Any:
    """``function``, compiled at its first call, or read from numba's cache.

    numba looks for a change only in the file that the function is written in, but a kernel takes its arithmetic from
    other files of this folder too; so the name under which it is kept tells the state of them all.
    """
    sources = b"".join(path.read_bytes() for path in sorted(Path(__file__).parent.glob("*.py")))
    function.__qualname__ = f"{function.__name__}_{hashlib.sha256(sources).hexdigest()[:16]}"
    try:
        return numba.njit(nogil=True, error_model="numpy", cache=True)(function)
    except RuntimeError:  # no place to keep the cache (read-only installation without a home)
        return numba.njit(nogil=True, error_model="numpy")(function)
