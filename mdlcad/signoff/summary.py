"""The verdict of the design rules: every rule with its findings, errors apart from warnings."""

from __future__ import annotations

from dataclasses import dataclass

from mdlcad.signoff.drc import Finding


@dataclass(frozen=True, slots=True)
class DesignRules:
    """All findings.

    Attributes:
        counts: findings by rule; rules that ran and found nothing count 0.
        findings: with place, value and limit.
        warned: rules whose findings are reported but do not fail the build, because a later step of the design (a
            stiffer material, a guide) can still mend them in the same layout.
    """

    counts: dict[str, int]
    findings: tuple[Finding, ...]
    warned: tuple[str, ...]

    @property
    def errors(self) -> tuple[Finding, ...]:
        return tuple(item for item in self.findings if item.rule not in self.warned)
