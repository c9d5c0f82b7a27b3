"""The artefact of a scenario: what was felt, what the network answered, what did not hold."""

from __future__ import annotations

from dataclasses import dataclass

from mdlcad.language import Actuator, Sensor
from mdlcad.scenario.loop import Journey
from mdlcad.scenario.ports import Bits, digits_of, label_of
from mdlcad.scenario.registers import RegisterValue, register_values
from mdlcad.scenario.world import Hands, Maze


@dataclass(frozen=True, slots=True)
class PortValue:
    """The value of a sensor or actuator: digits, the highest bit first, "?" where undecided; the program's label."""

    port: str
    digits: str
    label: str


@dataclass(frozen=True, slots=True)
class Decision:
    """One decision of the network.

    Attributes:
        words: what the scenario says of it.
        cell: (row, column) on the map during the decision, from 0; None without a map.
        sensors: what was felt.
        before: the registers before it, as read from the network.
        actuators: the answer at its end, as read from the network.
        wrong: what differs from the program's own reference; "" if nothing does.
    """

    number: int
    words: str
    cell: tuple[int, int] | None
    sensors: tuple[PortValue, ...]
    before: tuple[RegisterValue, ...]
    actuators: tuple[PortValue, ...]
    wrong: str


@dataclass(frozen=True, slots=True)
class ScenarioResult:
    """A run of a scenario.

    Attributes:
        failures: what did not hold, in words; empty is good.
        disagreements: decisions in which network and program differ.
        margin, margin_mass: smallest |x| at a read-out, and its mass (dimensionless).
        period: clock period, dimensionless.
        simulations: how many runs closed the loop (1 if the network does as its program says).
        after: the registers after the last decision.
        end_cell: the cell after the last decision; None without a map.
        files: what was drawn.
    """

    scenario: str
    design: str
    cells: str
    failures: tuple[str, ...]
    disagreements: int
    cycles_per_tick: int
    tick_cycle: int
    period: float
    steps_per_period: int
    simulations: int
    margin: float
    margin_mass: str
    decisions: tuple[Decision, ...]
    after: tuple[RegisterValue, ...]
    end_cell: tuple[int, int] | None
    files: tuple[str, ...]


def decisions_of(journey: Journey) -> tuple[Decision, ...]:
    """Every decision of ``journey``, in order."""
    made = []
    for d, world in enumerate(journey.worlds[:-1]):
        made.append(
            Decision(
                number=d,
                words=world.steps[d].words if isinstance(world, Hands) else "",
                cell=world.cell if isinstance(world, Maze) else None,
                sensors=port_values(world.ports.sensors, world.ports.inputs, journey.inputs[d]),
                before=register_values(journey.register_bits, journey.states[d]),
                actuators=port_values(world.ports.actuators, world.ports.outputs, journey.outputs[d]),
                wrong=_difference(journey, d),
            )
        )
    return tuple(made)


def failures_of(journey: Journey) -> tuple[str, ...]:
    """What did not hold: expectations of a script, an exit that was not found, decisions unlike the program's."""
    found = []
    for d, world in enumerate(journey.worlds[:-1]):
        if not isinstance(world, Hands):
            continue
        for actuator, digits in world.steps[d].expected:
            got = digits_of(actuator, world.ports.outputs, journey.outputs[d])
            if got != digits:
                words = f" ({world.steps[d].words})" if world.steps[d].words else ""
                found.append(
                    f"decision {d}{words}: {actuator.name} should be {value_words(actuator, digits)}, "
                    f"and is {value_words(actuator, got)}"
                )
    end = journey.worlds[-1]
    if isinstance(end, Maze) and end.cell != end.exit:
        found.append(f"the exit was not reached in {journey.decisions} decisions; the device ended at {end.cell}")
    for d in range(journey.decisions):
        difference = _difference(journey, d)
        if difference:
            found.append(f"decision {d}: the network is not as its program: {difference}")
            break  # what follows from a wrong state is not news
    return tuple(found)


def value_words(port: Sensor | Actuator, digits: str) -> str:
    """A value as "label (digits)", or the digits alone if the program has no label for it."""
    label = label_of(port, digits)
    return digits if label == digits else f"{label} ({digits})"


def port_values(
    ports: tuple[Sensor, ...] | tuple[Actuator, ...], names: tuple[str, ...], bits: Bits
) -> tuple[PortValue, ...]:
    """The values of ``ports`` in the vector ``bits`` whose places are called ``names``."""
    values = []
    for port in ports:
        digits = digits_of(port, names, bits)
        values.append(PortValue(port.name, digits, label_of(port, digits)))
    return tuple(values)


def _difference(journey: Journey, d: int) -> str:
    """What differs between network and reference in decision d, in words."""
    said = []
    for o, bit in enumerate(journey.reference.outputs):
        want, got = int(journey.itinerary.outputs[d, 0, o]), int(journey.outputs[d, o])
        if want != got:
            said.append(f"{bit} should be {want}, and reads {'01?'[got]}")
    for r, (bit, place) in enumerate(journey.comparison.registers):
        for moment, words in ((d, "before"), (d + 1, "after")):
            want, got = int(journey.itinerary.states[moment, 0, place]), int(journey.states[moment, r])
            if want != got and (moment > d or d == 0):
                said.append(f"{bit} should be {want} {words} it, and reads {'01?'[got]}")
    if not journey.comparison.ticks[d, 0]:
        said.append("the tick does not come when it should, and only then")
    return "; ".join(said)
