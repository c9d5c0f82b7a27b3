"""STL of a plate and 3MF of the device: triangle meshes of the sections as cut."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence
from xml.sax.saxutils import quoteattr

import numpy as np
import trimesh
from shapely import Polygon

from mdlcad.errors import SignoffError
from mdlcad.export.solid import plate_section, prism, triangles
from mdlcad.parts.body import Body

VOLUME_TOLERANCE = 1e-6
_XML = '<?xml version="1.0" encoding="UTF-8"?>\n'
# names of the 3MF core specification and of the package convention it builds on
_CORE = "http://schemas.microsoft.com/3dmanufacturing/2013/01"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_STL_RECORD = np.dtype(
    [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")],
)


def stl_plate(plate: str, bodies: Sequence[Body]) -> bytes:
    """Binary STL of all bodies of one plate as cut, lying on z = 0, millimetres.

    The bytes are read back before they are returned.

    Raises:
        SignoffError: the mesh read back is not watertight, or its volume or its holes are not those of its section.
    """
    section = plate_section(bodies)
    thickness = bodies[0].thickness
    vertices, faces = triangles(prism(section, 0.0, thickness))
    corners = vertices[faces].astype(np.float32)
    records = np.zeros(len(faces), dtype=_STL_RECORD)
    records["corners"] = corners
    records["normal"] = _normals(vertices[faces])
    data = f"plate {plate}, mm".encode("ascii", "replace").ljust(80) + np.uint32(len(faces)).tobytes()
    data += records.tobytes()
    check_stl(plate, data, section, thickness)
    return data


def check_stl(plate: str, data: bytes, section: Sequence[Polygon], thickness_mm: float) -> None:
    """Read an STL back with a second reader and hold it against the section it must be a prism over.

    Raises:
        SignoffError: it is not watertight, its volume is off by more than 1e-6, or it has another number of pieces or
            of holes through them (the Euler characteristic of a piece with h holes is 2 - 2 h).
    """
    expected_mm3 = sum(polygon.area for polygon in section) * thickness_mm
    mesh = trimesh.load_mesh(io.BytesIO(data), file_type="stl")
    if not mesh.is_watertight:
        raise SignoffError(f"plate {plate}: the STL is not watertight")
    if abs(mesh.volume - expected_mm3) > VOLUME_TOLERANCE * expected_mm3:
        raise SignoffError(f"plate {plate}: the STL holds {mesh.volume:.4f} mm3, its section {expected_mm3:.4f} mm3")
    holes = sum(len(polygon.interiors) for polygon in section)
    if mesh.body_count != len(section) or mesh.euler_number != 2 * len(section) - 2 * holes:
        raise SignoffError(
            f"plate {plate}: the STL has {mesh.body_count} pieces and the Euler number {mesh.euler_number}, "
            f"its section {len(section)} pieces with {holes} holes"
        )


def _normals(corners: np.ndarray) -> np.ndarray:
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.where(length > 0, normal / np.where(length > 0, length, 1.0), 0.0).astype(np.float32)


def threemf_device(design: str, bodies: Sequence[Body]) -> bytes:
    """3MF of the device as cut: one named, coloured object a body, millimetres, in its place.

    Raises:
        SignoffError: a body does not make a closed solid.
    """
    colours = sorted({body.colour for body in bodies})
    bases = "".join(f'<base name="{colour}" displaycolor="{colour.upper()}FF"/>' for colour in colours)
    objects, items = [], []
    for number, body in enumerate(bodies, start=2):
        vertices, faces = triangles(prism([body.section], body.z, body.thickness))
        points = "".join(f'<vertex x="{x:.4f}" y="{y:.4f}" z="{z:.4f}"/>' for x, y, z in vertices)
        facets = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
        objects.append(
            f'<object id="{number}" name={quoteattr(body.name)} type="model" pid="1" '
            f'pindex="{colours.index(body.colour)}">'
            f"<mesh><vertices>{points}</vertices><triangles>{facets}</triangles></mesh></object>"
        )
        items.append(f'<item objectid="{number}"/>')
    model = (
        f'{_XML}<model unit="millimeter" xml:lang="en-US" xmlns="{_CORE.replace("2013/01", "core/2015/02")}">'
        f'<metadata name="Title">{design}</metadata>'
        f'<resources><basematerials id="1">{bases}</basematerials>{"".join(objects)}</resources>'
        f"<build>{''.join(items)}</build></model>\n"
    )
    return _archive(
        {
            "[Content_Types].xml": f'{_XML}<Types xmlns="{_PACKAGE}/content-types">'
            '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
            '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>'
            "</Types>\n",
            "_rels/.rels": f'{_XML}<Relationships xmlns="{_PACKAGE}/relationships">'
            f'<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="{_CORE}/3dmodel"/></Relationships>\n',
            "3D/3dmodel.model": model,
        }
    )


def _archive(files: dict[str, str]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            # the format's own zero date: an archive must not hold the time it was made
            info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, text)
    return buffer.getvalue()
