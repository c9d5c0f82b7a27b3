import io
import subprocess
import sys
from xml.etree import ElementTree

import ezdxf
import pytest
from shapely import Polygon

from mdlcad.export.drawing import dxf_plate, svg_plate
from mdlcad.export.solid import plate_section
from tests.export.bodies import few_bodies


def test_svg_shows_every_body_by_name_and_colour():
    root = ElementTree.fromstring(svg_plate("unit", few_bodies()))
    space = {"s": "http://www.w3.org/2000/svg"}
    paths = root.findall(".//s:path", space)
    assert [path.find("s:title", space).text for path in paths] == [item.name for item in few_bodies()]
    assert [path.get("fill") for path in paths] == [item.colour for item in few_bodies()]
    assert root.get("width").endswith("mm")


def test_dxf_is_closed_polylines_in_millimetres_with_the_area_of_the_section():
    bodies = [item for item in few_bodies() if item.plate == "unit"]
    document = ezdxf.read(io.StringIO(dxf_plate(bodies).decode()))
    assert document.units == ezdxf.units.MM
    area = 0.0
    for line in document.modelspace():
        assert line.closed
        size = Polygon([(x, y) for x, y, *_ in line.get_points()]).area
        area += size if line.dxf.layer == "OUTER" else -size
    assert area == pytest.approx(sum(polygon.area for polygon in plate_section(bodies)))


def test_the_same_dxf_in_a_fresh_process_with_other_hashes():
    program = (
        "import hashlib; from tests.export.bodies import few_bodies; from mdlcad.export.drawing import dxf_plate;"
        "print(hashlib.sha256(dxf_plate(few_bodies()[:3])).hexdigest())"
    )
    seen = {
        subprocess.run(
            [sys.executable, "-c", program], env={"PYTHONHASHSEED": seed}, capture_output=True, text=True, check=True
        ).stdout
        for seed in ("1", "2")
    }
    assert len(seen) == 1
