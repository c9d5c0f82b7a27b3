"""The same frames in exudyn: geometrically exact (Reissner) beams, its own static solver. Shares no code with ours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import exudyn
from exudyn.itemInterface import (
    MarkerNodeCoordinate,
    NodePointGround,
    NodeRigidBody2D,
    ObjectBeamGeometricallyExact2D,
    ObjectConnectorCoordinate,
    ObjectGround,
    SensorObject,
)

from mdlcad.mechanics.frame import Frame

_SHEAR = 100.0
"""Shear stiffness in multiples of E A, of beams that are taken not to shear."""


def forces(frame: Frame, cuts: Sequence[int], prescribed: Mapping[int, float], steps: int) -> dict[int, float]:
    """Reactions in N (N mm) at every prescribed degree of freedom, all of them grown together in ``steps`` steps."""
    system = exudyn.SystemContainer()
    mbs = system.AddSystem()
    ground = mbs.AddNode(NodePointGround(referenceCoordinates=[0, 0, 0]))
    fixed = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    mbs.AddObject(ObjectGround())
    nodes = [mbs.AddNode(NodeRigidBody2D(referenceCoordinates=[x, y, 0.0])) for x, y in frame.nodes]
    for beam, count in zip(frame.beams, cuts, strict=True):
        start, end = frame.nodes[beam.start], frame.nodes[beam.end]
        length = frame.length(beam)
        # a cut wherever a stiffer stretch begins or ends
        edges = {place for zone in beam.zones for place in (zone.start, zone.stop)}
        places = sorted({0.0, length, *edges, *(length * cut / count for cut in range(1, count))})
        places = [a for a, b in pairwise(places) if b - a > 1e-9] + [length]
        chain = [nodes[beam.start]]
        for place in places[1:-1]:
            x, y = start + (end - start) * place / length
            chain.append(mbs.AddNode(NodeRigidBody2D(referenceCoordinates=[x, y, 0.0])))
        chain.append(nodes[beam.end])
        for (a, b), (low, high) in zip(pairwise(chain), pairwise(places), strict=True):
            zones = [zone for zone in beam.zones if zone.start < (low + high) / 2.0 < zone.stop]
            bend, stretch = (zones[0].bend, zones[0].stretch) if zones else (1.0, 1.0)
            mbs.AddObject(
                ObjectBeamGeometricallyExact2D(
                    nodeNumbers=[a, b],
                    length=high - low,
                    massPerLength=1e-9,
                    crossSectionInertia=1e-12,
                    axialStiffness=beam.axial / stretch,
                    shearStiffness=beam.bending / beam.shear if beam.shear else _SHEAR * beam.axial,
                    bendingStiffness=beam.bending / bend,
                )
            )
    sensors = {}
    for place, value in prescribed.items():
        marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=nodes[place // 3], coordinate=place % 3))
        joint = mbs.AddObject(
            ObjectConnectorCoordinate(
                markerNumbers=[fixed, marker],
                offset=value,
                offsetUserFunction=(lambda mbs, t, item, offset: offset * t) if value else 0,
            )
        )
        sensors[place] = mbs.AddSensor(
            SensorObject(objectNumber=joint, outputVariableType=exudyn.OutputVariableType.Force, storeInternal=True)
        )
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.staticSolver.numberOfLoadSteps = steps
    settings.staticSolver.newton.relativeTolerance = 1e-6
    settings.staticSolver.newton.absoluteTolerance = 1e-7
    settings.staticSolver.newton.maxIterations = 50
    settings.solution.file.write = False
    settings.staticSolver.verboseMode = 0
    settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
    mbs.SolveStatic(settings)
    return {place: float(mbs.GetSensorValues(sensor)) for place, sensor in sensors.items()}
