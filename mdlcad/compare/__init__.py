"""Builds held against each other: two in every respect (``diff``), or many in figures (``history``)."""
