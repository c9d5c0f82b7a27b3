"""``mdlcad cells NAME --characterise``: where the cells of a library work, and whether its numbers are the best."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import matplotlib.style

from mdlcad.artefact import to_json, write_atomic
from mdlcad.characterise.bench import Bench, Setting
from mdlcad.characterise.circuits import renumbered, threshold_circuits
from mdlcad.characterise.measure import (
    LoadCount,
    Runner,
    Trial,
    borne_limits,
    borne_spread,
    compete,
    count_spreads,
    map_window,
)
from mdlcad.characterise.nor_benches import cell_benches, reference_bench
from mdlcad.characterise.plan import NOR_SWEEP, THRESHOLD_SWEEP, Sweep, quick
from mdlcad.characterise.result import CharacterisationResult, conclude, differences, toml_table
from mdlcad.characterise.threshold_benches import GATES, gate_bench, gate_benches, many_targets
from mdlcad.characterise.window_figure import window_picture
from mdlcad.mapping import Library, MappingRequest, load_library
from mdlcad.mapping.cell_library import Library as ThresholdLibrary
from mdlcad.mapping.characterisation import Choice
from mdlcad.mapping.two_phase import TwoPhaseLibrary, load_two_phase

RESULT = "characterisation.json"
TABLE = "characterisation.toml"
PICTURE = "characterisation.png"

_LOADED_GATES = ("copy", "and of 2")


@dataclass(frozen=True, slots=True)
class Task:
    """What the command line asks for; ``whole`` False: the quick slice."""

    name: str
    place: Path
    seed: int
    workers: int
    whole: bool


def characterise(task: Task, say: Callable[[str], None], progress: Callable[[str], None]) -> list[str]:
    """Measure, write three files to ``task.place``, and tell; where the library's file differs, in words.

    Raises:
        UsageError: there is no such library, or it cannot be used.
    """
    library = load_library(task.name)
    runner = Runner(task.seed, task.workers, progress)
    if isinstance(library, TwoPhaseLibrary):
        result = _of_two_phase(task, library, runner, say)
    else:
        result = _of_threshold(task, library, runner, say)
    with matplotlib.style.context("default"):
        picture = window_picture(library.name, result)
    task.place.mkdir(parents=True, exist_ok=True)
    write_atomic(task.place / PICTURE, picture)
    write_atomic(task.place / TABLE, toml_table(result.found, library.name).encode())
    write_atomic(task.place / RESULT, to_json(result))
    say(f"written to {task.place}: {PICTURE}, {TABLE}, {RESULT}")
    return list(result.differences)


def _of_threshold(
    task: Task, library: ThresholdLibrary, runner: Runner, say: Callable[[str], None]
) -> CharacterisationResult:
    own = library.dynamics
    sweep = THRESHOLD_SWEEP if task.whole else quick(THRESHOLD_SWEEP, library.characterisation, own.period)
    circuits = threshold_circuits(library, task.seed)
    benches = [*gate_benches(library, task.seed), *circuits]
    choices, standing = [], []
    for key, values in sweep.candidates:
        number = _number(library, key)
        entries = []
        for value in sorted({number, *(float(v) for v in values)}):
            other = _with_number(library, key, value)
            cells = [*gate_benches(other, task.seed), renumbered(circuits[0], library, other)]
            entries.append((value, cells, other.dynamics.period, other.dynamics.damping))
        choices.append(compete(key, entries, sweep, runner))
        standing.append(number)
        _tell_choice(choices[-1], number, say)
    loads = _loads(library, sweep, task.seed, runner)
    limits = (library.gates.load_limit, library.gates.echo_limit) if loads else (0, 0)
    at = (own.period, own.damping)
    return _finish(task, library, benches, sweep, at, (choices, standing), loads, limits, runner, say)


def _of_two_phase(
    task: Task, library: TwoPhaseLibrary, runner: Runner, say: Callable[[str], None]
) -> CharacterisationResult:
    own = library.dynamics
    sweep = NOR_SWEEP if task.whole else quick(NOR_SWEEP, library.characterisation, own.period)
    choices, standing = [], []
    for key, names in sweep.candidates:
        entries = []
        for name in names:
            other = load_two_phase(task.name, MappingRequest(parameters=str(name)))
            cells = list(cell_benches(other, task.seed))
            entries.append((name, cells, other.dynamics.period, other.dynamics.damping))
        choices.append(compete(key, entries, sweep, runner))
        standing.append(library.parameters)
        _tell_choice(choices[-1], library.parameters, say)
    benches = [*cell_benches(library, task.seed), reference_bench(library, task.seed)]
    return _finish(
        task, library, benches, sweep, (own.period, own.damping), (choices, standing), (), (0, 0), runner, say
    )


def _finish(
    task: Task,
    library: Library,
    benches: Sequence[Bench],
    sweep: Sweep,
    at: tuple[float, float],
    choice: tuple[list[Choice], Sequence[float | str]],
    loads: tuple[LoadCount, ...],
    limits: tuple[int, int],
    runner: Runner,
    say: Callable[[str], None],
) -> CharacterisationResult:
    """The window and the spreads of ``benches``, and all of it together."""
    points = map_window(benches, sweep, runner)
    spreads = count_spreads(benches, *at, sweep, runner)
    fan_out, echo = borne_limits(loads, *limits)
    found = replace(conclude(points, borne_spread(spreads)), choice=tuple(choice[0]), fan_out=fan_out, echo=echo)
    standing = tuple(choice[1])
    for period, least, greatest in zip(found.periods, found.least_damping, found.greatest_damping, strict=True):
        say(f"T = {period:g}: all {len(benches)} cells and circuits right from b = {least:g} to {greatest:g}")
    if loads:
        say(f"fan-out {fan_out}, echo {echo}: every device right up to these (limits: {limits[0]}, {limits[1]})")
    say(f"spread {found.spread:g}: at least nine in ten devices of every cell right at T = {at[0]:g}, b = {at[1]:g}")
    return CharacterisationResult(
        library=library.name,
        seed=task.seed,
        sweep=sweep,
        period=at[0],
        damping=at[1],
        cells=tuple(bench.cell for bench in benches),
        points=points,
        spreads=spreads,
        loads=loads,
        found=found,
        standing=standing,
        differences=differences(found, library.characterisation, standing, sweep, limits),
    )


def _tell_choice(choice: Choice, standing: float | str, say: Callable[[str], None]) -> None:
    shown = [
        f"{value}{' (stands)' if value == standing else ''}: {right}"
        for value, right in zip(choice.candidates, choice.right, strict=True)
    ]
    say(f"{choice.key}, right of {choice.devices} devices: {', '.join(shown)}")


def _loads(library: ThresholdLibrary, sweep: Sweep, seed: int, runner: Runner) -> tuple[LoadCount, ...]:
    """Two gates with every fan-out and echo of the sweep."""
    groups = [(cell, load, echo) for cell in _LOADED_GATES for load in sweep.loads for echo in sweep.echoes]
    trials: list[Trial] = []
    for cell, load, echo in groups:
        bench = gate_bench(library, cell, GATES[cell], many_targets(load, echo), seed)
        trials += [
            (bench, Setting(library.dynamics.period, library.dynamics.damping, sweep.load_spread, sample))
            for sample in range(sweep.load_samples)
        ]
    found = runner.run("fan-out and echo", trials)
    n = sweep.load_samples
    return tuple(
        LoadCount(cell, load, echo, sum(found[g * n : (g + 1) * n]), n) for g, (cell, load, echo) in enumerate(groups)
    )


def _number(library: ThresholdLibrary, key: str) -> float:
    table, name = key.split(".")
    return float(getattr(getattr(library, table), name))


def _with_number(library: ThresholdLibrary, key: str, value: float) -> ThresholdLibrary:
    """The library with another number; k0 takes k1 along, so that the mass is as bistable as before."""
    match key:
        case "coupling.strength":
            return replace(library, coupling=replace(library.coupling, strength=value))
        case "bias.force":
            return replace(library, bias=replace(library.bias, force=value))
        case "mass.k0":
            k1 = library.mass.k1 + (library.mass.k0 - value) / 2
            return replace(library, mass=replace(library.mass, k0=value, k1=k1))
        case "dynamics.period":
            return replace(library, dynamics=replace(library.dynamics, period=value))
        case "dynamics.damping":
            return replace(library, dynamics=replace(library.dynamics, damping=value))
    raise ValueError(f"no candidates are known for {key}")
