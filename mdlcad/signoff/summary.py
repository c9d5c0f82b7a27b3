"""The verdict of the design rules: every rule with its findings, errors apart from warnings."""

from __future__ import annotations

from dataclasses import dataclass

from mdlcad.signoff.drc import Finding


@dataclass(frozen=True, slots=True)
class GuidesFound:
    """The two guides of a clock plate, as drawn.

    Attributes:
        wall_mm, length_mm: of the softer leaf; span_mm: how far they are apart.
        moment_nmm: what turns the plate; load_n: along each leaf; strain: the largest, at the end of the stroke.
        error_mm: by how much the turn moves the clock of the unit farthest from the handle.
    """

    plate: str
    wall_mm: float
    length_mm: float
    span_mm: float
    moment_nmm: float
    load_n: float
    strain: float
    error_mm: float


@dataclass(frozen=True, slots=True)
class DesignRules:
    """All findings.

    Attributes:
        counts: findings by rule; rules that ran and found nothing count 0.
        findings: with place, value and limit.
        warned: rules whose findings are reported but do not fail the build, because a later step of the design (a
            stiffer material) can still mend them in the same layout.
        guides: of every clock plate that has them.
    """

    counts: dict[str, int]
    findings: tuple[Finding, ...]
    warned: tuple[str, ...]
    guides: tuple[GuidesFound, ...] = ()

    @property
    def errors(self) -> tuple[Finding, ...]:
        return tuple(item for item in self.findings if item.rule not in self.warned)
