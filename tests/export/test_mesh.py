import io
import zipfile
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
import trimesh
from shapely import box

from mdlcad.errors import SignoffError
from mdlcad.export.mesh import check_stl, stl_plate, threemf_device
from mdlcad.export.solid import plate_section
from tests.export.bodies import body, few_bodies


def test_stl_is_watertight_and_holds_the_volume_of_its_section():
    bodies = [item for item in few_bodies() if item.plate == "unit"]
    mesh = trimesh.load_mesh(io.BytesIO(stl_plate("unit", bodies)), file_type="stl")
    area = sum(polygon.area for polygon in plate_section(bodies))
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(area * 2.0, rel=1e-6)
    # two pieces, each with one hole through it
    assert mesh.body_count == 2
    assert mesh.euler_number == 0


def test_bodies_that_share_an_edge_become_one_piece():
    section = plate_section(few_bodies()[::2])
    assert len(section) == 1


def test_stl_check_catches_a_missing_triangle_and_a_wrong_volume():
    ring = few_bodies()[:1]
    data, section = stl_plate("unit", ring), plate_section(ring)
    count = int(np.frombuffer(data[80:84], "<u4")[0])
    holed = data[:80] + np.uint32(count - 1).tobytes() + data[84:-50]
    with pytest.raises(SignoffError, match="watertight"):
        check_stl("unit", holed, section, 2.0)
    check_stl("unit", data, section, 2.0)
    with pytest.raises(SignoffError, match="mm3"):
        check_stl("unit", data, section, 2.0001)


def test_stl_check_catches_a_hole_that_is_filled_and_a_piece_too_many():
    ring = few_bodies()[0].section
    plain = box(0, 0, 10, ring.area / 10.0)
    with pytest.raises(SignoffError, match="1 pieces and the Euler number 2, its section 1 pieces with 1 holes"):
        check_stl("unit", stl_plate("unit", [body("plain", plain)]), [ring], 2.0)
    halves = [body("a", box(0, 0, 4, 5)), body("b", box(5, 0, 9, 5))]
    with pytest.raises(SignoffError, match="2 pieces"):
        check_stl("unit", stl_plate("unit", halves), [box(0, 0, 8, 5)], 2.0)


def test_sections_that_touch_in_one_point_are_refused_not_written():
    pair = [body("a", box(0, 0, 1, 1)), body("b", box(1, 1, 2, 2))]
    with pytest.raises(SignoffError):
        stl_plate("unit", pair)


def test_3mf_has_one_named_object_a_body_in_millimetres():
    data = threemf_device("device", few_bodies())
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        model = ElementTree.fromstring(archive.read("3D/3dmodel.model"))
    space = {"m": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"}
    assert model.get("unit") == "millimeter"
    names = [item.get("name") for item in model.findall(".//m:object", space)]
    assert names == [item.name for item in few_bodies()]
    scene = trimesh.load(io.BytesIO(data), file_type="3mf")
    volumes = sorted(round(abs(mesh.volume), 4) for mesh in scene.geometry.values())
    assert volumes == sorted(round(item.section.area * item.thickness, 4) for item in few_bodies())
    assert data == threemf_device("device", [replace(item) for item in few_bodies()])
