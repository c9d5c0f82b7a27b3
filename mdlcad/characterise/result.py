"""The artefact of a characterisation, and how it is held against what a library's file says."""

from __future__ import annotations

from dataclasses import dataclass

from mdlcad.characterise.measure import LoadCount, MapPoint, SpreadCount, chosen, rows_of
from mdlcad.characterise.plan import Sweep
from mdlcad.mapping.characterisation import Characterisation


@dataclass(frozen=True, slots=True)
class CharacterisationResult:
    """What ``mdlcad cells NAME --characterise`` found.

    Attributes:
        library, seed, sweep: what was tried.
        period, damping: the library's own.
        cells: benches, in order.
        points, spreads, loads: the measurements.
        found: the conclusion, as it is to stand in the library's file.
        standing: the library's numbers under the keys of ``found.choice``.
        differences: where the library's file is not as measured, in words.
    """

    library: str
    seed: int
    sweep: Sweep
    period: float
    damping: float
    cells: tuple[str, ...]
    points: tuple[MapPoint, ...]
    spreads: tuple[SpreadCount, ...]
    loads: tuple[LoadCount, ...]
    found: Characterisation
    standing: tuple[float | str, ...]
    differences: tuple[str, ...]


def conclude(points: tuple[MapPoint, ...], spread: float) -> Characterisation:
    """The window of ``points``, without choices."""
    rows = rows_of(points)
    return Characterisation(
        periods=tuple(row[0] for row in rows),
        least_damping=tuple(row[1] for row in rows),
        greatest_damping=tuple(row[2] for row in rows),
        spread=spread,
    )


def differences(
    found: Characterisation,
    standing: Characterisation | None,
    numbers: tuple[float | str, ...],
    sweep: Sweep,
    limits: tuple[int, int] = (0, 0),
) -> tuple[str, ...]:
    """Where the file is not as measured: its windows at the periods that were tried, its spread, numbers and limits.

    Args:
        standing: the file's table, None if it has none.
        numbers: the file's numbers under the keys of ``found.choice``.
        limits: the file's limits of fan-out and echo, where these were tried.
    """
    said = []
    for choice, number in zip(found.choice, numbers, strict=True):
        best = chosen(choice, number)
        if best != number:
            rights = dict(zip(choice.candidates, choice.right, strict=True))
            said.append(
                f"{choice.key} is {number}, with which {rights[number]} of {choice.devices} devices are right; "
                f"choose {best}, with which {rights[best]} are"
            )
    for what, limit, borne in (("fan-out", limits[0], found.fan_out), ("echo", limits[1], found.echo)):
        if limit > borne:
            said.append(f"the limit of {what} is {limit}; choose {borne}, the greatest at which all devices were right")
    if standing is None:
        return (*said, "the library has no table [characterisation]; add the one that is written here")
    for period in sweep.periods:
        was, now = _row(standing, period), _row(found, period)
        if was != now:
            said.append(f"[characterisation] says of T = {period:g}: {_words(was)}; measured: {_words(now)}")
    if standing.spread != found.spread:
        said.append(f"[characterisation] says spread {standing.spread:g}; measured: {found.spread:g}")
    for what, was_borne, borne in (("fan_out", standing.fan_out, found.fan_out), ("echo", standing.echo, found.echo)):
        if sweep.loads and was_borne != borne:
            said.append(f"[characterisation] says {what} {was_borne}; measured: {borne}")
    return tuple(said)


def _row(table: Characterisation, period: float) -> tuple[float, float] | None:
    if period not in table.periods:
        return None
    place = table.periods.index(period)
    return table.least_damping[place], table.greatest_damping[place]


def _words(row: tuple[float, float] | None) -> str:
    return "works at no damping" if row is None else f"works from b = {row[0]:g} to {row[1]:g}"


def toml_table(found: Characterisation, library: str) -> str:
    """The table as it is to stand in the library's file."""

    def numbers(values: tuple[float | int | str, ...]) -> str:
        return "[" + ", ".join(f'"{v}"' if isinstance(v, str) else repr(v) for v in values) + "]"

    lines = [
        f"[characterisation]  # as `mdlcad cells {library} --characterise` measures it, which fails if it is otherwise",
        f"spread = {found.spread!r}",
        f"periods = {numbers(found.periods)}",
        f"least_damping = {numbers(found.least_damping)}",
        f"greatest_damping = {numbers(found.greatest_damping)}",
    ]
    if found.fan_out or found.echo:
        lines += [f"fan_out = {found.fan_out}", f"echo = {found.echo}"]
    for choice in found.choice:
        lines += [
            "",
            "[[characterisation.choice]]",
            f'key = "{choice.key}"',
            f"candidates = {numbers(choice.candidates)}",
            f"right = {numbers(choice.right)}",
            f"devices = {choice.devices}",
        ]
    return "\n".join(lines) + "\n"
