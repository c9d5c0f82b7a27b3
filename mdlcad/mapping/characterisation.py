"""Table ``characterisation`` of a library: where it was measured to work, and what its numbers were chosen among.

``mdlcad cells NAME --characterise`` measures it. Where the table and the measurement differ the measurement is right,
the command says so and fails, and the table is to be replaced by the one that it writes.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Choice:
    """A number of the library and what it was chosen among, all else as it stands.

    Attributes:
        key: where it stands, as "coupling.strength".
        candidates: what was tried.
        right: sampled devices that were right with each candidate, over the cells and corners of the choice.
        devices: sampled devices with each.
    """

    key: str
    candidates: tuple[float | str, ...]
    right: tuple[int, ...]
    devices: int


@dataclass(frozen=True, slots=True)
class Characterisation:
    """The windows of a library.

    Attributes:
        periods: clock periods T at which every cell and the reference circuit were right.
        least_damping, greatest_damping: at each of them, the damping b from and to which they were (of those tried).
        spread: greatest spread tried at which at least nine in ten of the sampled devices of every cell, and of the
            reference circuit, were right, at the library's own T and b.
        choice: what the library's numbers were chosen among.
        fan_out, echo: greatest fan-out tried (at echoes up to the library's limit) and greatest echo tried (at
            fan-outs up to the library's limit) at which, as at all smaller ones, every sampled device was right; 0 if
            none was tried.
    """

    periods: tuple[float, ...]
    least_damping: tuple[float, ...]
    greatest_damping: tuple[float, ...]
    spread: float
    choice: tuple[Choice, ...] = ()
    fan_out: int = 0
    echo: int = 0
