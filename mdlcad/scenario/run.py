"""Run a scenario on a build and leave its pictures and its result there."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import matplotlib.style
import msgspec

from mdlcad.artefact import checksum, load, to_json, write_atomic
from mdlcad.errors import UsageError
from mdlcad.language import Device
from mdlcad.network.model import Network
from mdlcad.proof.behaviour import Behaviour
from mdlcad.proof.machine import explore
from mdlcad.proof.reference import build_reference
from mdlcad.proof.timing import NoTick
from mdlcad.scenario.figures.animation import animation
from mdlcad.scenario.figures.maze import trajectory
from mdlcad.scenario.figures.network import picture
from mdlcad.scenario.figures.states import machine
from mdlcad.scenario.figures.traces import traces
from mdlcad.scenario.file import find_scenario, load_scenario, own_scenario
from mdlcad.scenario.loop import Journey, trace, travel
from mdlcad.scenario.registers import register_values
from mdlcad.scenario.result import ScenarioResult, decisions_of, failures_of
from mdlcad.scenario.seats import PlacedSeats, Seats, free_seats, placed_seats
from mdlcad.scenario.world import Hands, Maze, each_sensor, make_world

RESULT = "result.json"
_EACH_SENSOR = "each-sensor"


def run_scenario(folder: Path, scenario: str | None, say: Callable[[str], None]) -> list[str]:
    """Run ``scenario`` (a name or a path) on the build in ``folder``; write ``folder``/scenarios/NAME/.

    Without a scenario, the one written for the design is run, or if there is none each sensor bit is pressed once.
    Written are result.json (``ScenarioResult``), network.png, traces.png, run.gif, states.png (if the device has
    registers) and trajectory.png (if it walked on a map). The build needs device.json and network.json; with
    placement.json the masses are drawn in their slots.

    Returns:
        What did not hold, in words; empty if all holds. Files edited since the build are among it.

    Raises:
        UsageError: the build or the scenario cannot be used; nothing was written.
    """
    device, network = load(folder, "device.json", Device), load(folder, "network.json", Network)
    edited = _edited(folder)
    name, world = chosen_world(scenario, device)
    seats = _seats(folder, device, network)
    reference = build_reference(device)
    try:
        journey = travel(network, reference, world)
    except NoTick as problem:
        with matplotlib.style.context("default"):
            _write(folder, name, {"network.png": picture(network, seats)})
        return [*edited, str(problem)]
    result = _result(name, network, journey)
    for line in _telling(result):
        say(line)
    with matplotlib.style.context("default"):
        files = dict(_draw(network, reference, seats, journey, result))
    result = replace(result, files=tuple(files))
    place = _write(folder, name, {**files, RESULT: to_json(result)})
    say(f"written to {place}: {', '.join((*files, RESULT))}")
    return [*edited, *result.failures]


def chosen_world(scenario: str | None, device: Device) -> tuple[str, Maze | Hands]:
    """Name and world of a scenario (a name or a path); without one, of that written for the device, or each sensor.

    Raises:
        UsageError: there is no such scenario, or it does not fit the device.
    """
    path = own_scenario(device.name) if scenario is None else find_scenario(scenario)
    if path is None:
        return _EACH_SENSOR, each_sensor(device)
    return path.stem, make_world(load_scenario(path), device, str(path))


def _result(name: str, network: Network, journey: Journey) -> ScenarioResult:
    decisions = decisions_of(journey)
    end = journey.worlds[-1]
    return ScenarioResult(
        scenario=name,
        design=network.design,
        cells=network.cells,
        failures=failures_of(journey),
        disagreements=sum(bool(decision.wrong) for decision in decisions),
        cycles_per_tick=network.cycles_per_tick,
        tick_cycle=journey.timing.tick_cycle,
        period=network.dynamics.period,
        steps_per_period=journey.steps_per_period,
        simulations=journey.runs,
        margin=journey.comparison.margin,
        margin_mass=journey.comparison.margin_mass,
        decisions=decisions,
        after=register_values(journey.register_bits, journey.states[-1]),
        end_cell=end.cell if isinstance(end, Maze) else None,
        files=(),
    )


def _telling(result: ScenarioResult) -> Iterator[str]:
    """A line a decision if somebody wrote words for it, and what came of it all."""
    for decision in result.decisions:
        if decision.words:
            felt = " ".join(f"{value.port}={value.label}" for value in decision.sensors)
            answer = " ".join(f"{value.port}={value.label}" for value in decision.actuators)
            yield f"  {decision.number}  {decision.words}: {felt} -> {answer}{'  WRONG' if decision.wrong else ''}"
    where = "" if result.end_cell is None else f"ended at row {result.end_cell[0]}, column {result.end_cell[1]}; "
    yield (
        f"scenario {result.scenario}: {len(result.decisions)} decisions, {where}{result.disagreements} unlike the "
        f"program; least margin {result.margin:.2f} ({result.margin_mass})"
    )


def _draw(
    network: Network, reference: Behaviour, seats: Seats, journey: Journey, result: ScenarioResult
) -> Iterator[tuple[str, bytes]]:
    """Name and bytes of every picture."""
    steps, x = trace(network, journey)
    yield "network.png", picture(network, seats)
    yield "traces.png", traces(network, journey, steps, x, result.decisions)
    worlds = tuple(world for world in journey.worlds if isinstance(world, Maze))
    if worlds:
        reached = worlds[-1].cell == worlds[-1].exit
        end = "the exit is reached" if reached else "the exit was not reached"
        yield "trajectory.png", trajectory(worlds, f"{result.scenario}: {end} after {journey.decisions} decisions")
    if network.registers:
        graph = explore(reference, 0)
        yield "states.png", machine(result, f"{'' if graph.complete else 'at least '}{len(graph.states)}")
    yield "run.gif", animation(network, seats, journey, steps, x, result.decisions)


class _Vouched(msgspec.Struct):
    """What the report of a build says of its files: SHA-256 by path."""

    files: dict[str, str]


def _edited(folder: Path) -> list[str]:
    """Files read here that are not the ones the build's report vouches for, in words; a folder may have no report.

    Raises:
        UsageError: one that the report vouches for is not there.
    """
    if not (folder / "report.json").exists():
        return []
    vouched = load(folder, "report.json", _Vouched).files
    found = []
    for name in ("device.json", "network.json", "placement.json"):
        if name in vouched and not (folder / name).is_file():
            raise UsageError(f"{folder / name}: is missing from the build; build it again")
        if name in vouched and checksum((folder / name).read_bytes()) != vouched[name]:
            found.append(f"{name}: is not the file that was built (its SHA-256 differs from report.json)")
    return found


def _seats(folder: Path, device: Device, network: Network) -> Seats:
    path = folder / "placement.json"
    if not path.exists():
        return free_seats(device, network)
    found = placed_seats(load(folder, path.name, PlacedSeats))
    missing = [mass.name for mass in network.masses if mass.name not in found.masses]
    missing += [port.bit for port in (*network.sensors, *network.actuators) if port.bit not in found.ports]
    if missing:
        raise UsageError(f"{path}: has no place for {missing[0]!r} of network.json; build it again")
    return found


def _write(folder: Path, name: str, files: dict[str, bytes]) -> Path:
    """Write ``files`` into the scenario's folder, in the place of what an earlier run left there."""
    place = folder / "scenarios" / name
    if place.is_dir():
        shutil.rmtree(place)
    place.mkdir(parents=True)
    for file, data in files.items():
        write_atomic(place / file, data)
    return place
