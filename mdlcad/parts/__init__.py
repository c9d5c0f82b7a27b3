"""Every body of the device as a polygon on its plate."""

from mdlcad.parts.body import Body, BodyKind
from mdlcad.parts.build import build_parts

__all__ = ["Body", "BodyKind", "build_parts"]
