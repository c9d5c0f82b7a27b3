"""Colours of bodies. Units and what drives them by phase; flexures by what they do to a signal.

==================  ==========================================
units, clock        phase 0 blue, 1 green, 2 purple, then grey
couplers            dark teal (pass a signal on)
rockers             red (turn it over)
bias leaves         orange
guides              navy (bend with their plate)
rungs, trunks       warm greys, tabs gold (they are touched)
frame, base, cover  light greys; pins, posts and screws near black
==================  ==========================================
"""

from __future__ import annotations

FRAME = "#c9ced6"
BASE = "#9aa3af"
COVER = "#dfe5ec"
SPACER = "#b4bcc8"
RUNG = "#b8a58c"
TRUNK = "#8c7b66"
TAB = "#e0b21b"
COUPLER = "#1f7a7a"
ROCKER = "#d62f2f"
BIAS = "#f08c1e"
GUIDE = "#1b2a6b"
PIN = "#3a3f47"
POST = "#22262c"
SCREW = "#5b626c"

_UNITS = ("#2f6fd6", "#2f9e44", "#8a4fd1")
_CLOCKS = ("#8fb3ee", "#8fd3a0", "#c3a3ea")
_OTHER = "#7d8590"


def unit(phase: int) -> str:
    """Colour of a unit of a phase."""
    return _UNITS[phase] if phase < len(_UNITS) else _OTHER


def clock(phase: int) -> str:
    """Colour of a clock plate and its pins."""
    return _CLOCKS[phase] if phase < len(_CLOCKS) else _OTHER
