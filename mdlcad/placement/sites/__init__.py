"""Placement of points: every mass one site, every coupling a straight line; length and crossings count.

This is the problem that the paper states. The placers here solve it on any set of sites: the 1 x 1 footprints of a
schematic, or the slots of a lattice. What real parts need beyond it (channels, posts, tracks) is not known here.
"""

from mdlcad.placement.sites.paper import PaperOptions, place_like_the_paper
from mdlcad.placement.sites.problem import Sited, SiteProblem, measure
from mdlcad.placement.sites.straight import StraightOptions, place_straight

__all__ = [
    "PaperOptions",
    "SiteProblem",
    "Sited",
    "StraightOptions",
    "measure",
    "place_like_the_paper",
    "place_straight",
]
