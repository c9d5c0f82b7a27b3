"""Processes with other machines."""

from dataclasses import replace

from mdlcad.mechanics import Process


def with_bed(process: Process, bed: tuple[float, float]) -> Process:
    return replace(process, machine=replace(process.machine, bed=bed))
