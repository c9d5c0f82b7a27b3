"""The report of a build, from what it made."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from mdlcad.artefact import checksum
from mdlcad.mechanics import Sizing
from mdlcad.mechanics.compensation import Compensation
from mdlcad.mechanics.leaves import trim
from mdlcad.parts.body import Body
from mdlcad.parts.stiffness import CarrierStiffness
from mdlcad.proof.outcome import Proof
from mdlcad.report.report import Behaviour, Mechanics, TiltReport
from mdlcad.signoff.tilting import TiltingProof

PAGE = "report.html"
"""The report for people. It shows how long the stages took, so it has no hash among the files, like report.json."""


def behaviour_of(proof: Proof | None) -> Behaviour | None:
    """The figures of a proof that the report shows."""
    if proof is None:
        return None
    return Behaviour(proof.transitions_total, proof.transitions_checked, proof.mismatches, proof.exhaustive)


def mechanics_of(
    sizing: Sizing | None, carriers: Sequence[CarrierStiffness], compensation: Compensation | None = None
) -> Mechanics | None:
    """The figures of the sizing that decide whether the parts can work."""
    if sizing is None:
        return None
    strains = [unit.strain for unit in sizing.units]
    strains += [coupler.leaf.strain for coupler in sizing.couplers] + [bias.leaf.strain for bias in sizing.biases]
    return Mechanics(
        strain_worst=max(strains),
        carrier_stiffness_ratio_worst=min((item.ratio for item in carriers), default=None),
        throw_mm=sizing.rules.throw,
        clock_stroke_mm=sizing.rules.clock_throw,
        compensation_difference_worst=max(abs(u.compensation - u.compensation_network) for u in sizing.units),
        warnings=tuple(
            f"{item.subject}: {item.message}: {item.value:.4g}, limit {item.limit:.4g}" for item in sizing.findings
        ),
        compensation_left=None if compensation is None else _left(compensation),
        lean_worst=max((item.leaned for item in carriers), default=None),
    )


def tilts_of(found: TiltingProof | None) -> TiltReport | None:
    """The figures of the proof with tilting shuttles."""
    if found is None or not found.shuttles:
        return None
    worst = max(found.shuttles, key=lambda item: (item.largest, item.mass))
    return TiltReport(
        largest_rad=worst.largest,
        mass=worst.mass,
        stopped=sum(item.stopped for item in found.shuttles),
        shuttles=len(found.shuttles),
        friction_most=max(item.rub for item in found.shuttles),
        friction_mean=trim(sum(item.rub for item in found.shuttles) / len(found.shuttles)),
    )


def _left(compensation: Compensation) -> tuple[float, float, float]:
    first, middle, last = (max(abs(unit.left[p]) for unit in compensation.units) for p in range(3))
    return first, middle, last


def extent_of(bodies: Sequence[Body]) -> tuple[float, float, float]:
    """Size of the device in x, y and z, mm, tabs included."""
    bounds = [body.section.bounds for body in bodies]
    low, high = min(body.z for body in bodies), max(body.z + body.thickness for body in bodies)
    return (
        round(max(b[2] for b in bounds) - min(b[0] for b in bounds), 4),
        round(max(b[3] for b in bounds) - min(b[1] for b in bounds), 4),
        round(high - low, 4),
    )


def hashes_of(folder: Path) -> dict[str, str]:
    """SHA-256 of every file of a build folder but its reports, by path relative to the folder, sorted."""
    return {
        path.relative_to(folder).as_posix(): checksum(path.read_bytes())
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path not in (folder / "report.json", folder / PAGE)
    }
