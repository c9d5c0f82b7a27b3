"""What the placers are called."""

from __future__ import annotations

from enum import StrEnum


class PlacerName(StrEnum):
    """ANNEAL: ours. PAPER: force-directed layout, assignment, greedy removal of crossings."""

    ANNEAL = "anneal"
    PAPER = "paper"
