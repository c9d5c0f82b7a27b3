"""All design rules on one device, and which of them fail a build."""

from __future__ import annotations

from collections.abc import Sequence

from shapely import Polygon

from mdlcad.parts.plates import plates_of
from mdlcad.mechanics import Process, Sizing
from mdlcad.mechanics.carrier import CarrierStiffness
from mdlcad.network.model import Network
from mdlcad.parts.body import Body
from mdlcad.placement.placement import Placement
from mdlcad.routing.check import check_layout
from mdlcad.routing.layout import Layout
from mdlcad.signoff.drc import Finding, check_bed, check_containment, check_cut, check_motion
from mdlcad.signoff.summary import DesignRules
