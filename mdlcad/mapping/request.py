"""What a build asks of its cell library beyond the library's own file."""

from __future__ import annotations

from dataclasses import dataclass, fields


@dataclass(frozen=True, slots=True)
class MappingRequest:
    """The synthesis options of one build; None leaves what the library's file says.

    Attributes:
        parameters: name of one of the library's parameter sets.
        clock_length: power-clock cycles from tick to tick.
        clock: make the clock, or leave the tick to be driven from outside.
        branching: keep outputs at their fan-out limit by trees of buffers.
        io_gates: give each sensor and actuator a gate of its own.
        buffer: the library's cell that serves as a buffer.
    """

    parameters: str | None = None
    clock_length: int | None = None
    clock: bool | None = None
    branching: bool | None = None
    io_gates: bool | None = None
    buffer: str | None = None

    def stated(self) -> dict[str, str]:
        """What is asked for, by the name it has on the command line, in words."""
        return {
            f"--{'no-' if value is False else ''}{field.name.replace('_', '-')}": str(value)
            for field in fields(self)
            if (value := getattr(self, field.name)) is not None
        }


AS_WRITTEN = MappingRequest()
"""Nothing asked for: all is as the library's file says."""
