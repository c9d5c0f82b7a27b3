"""A handful of bodies that touch, share shapes and have holes."""

from shapely import Polygon, box

from mdlcad.parts.body import Body, BodyKind


def body(name: str, section: Polygon, z: float = 0.0, thickness: float = 2.0, plate: str = "unit", **more) -> Body:
    values = {
        "kind": BodyKind.UNIT,
        "throw": (0.0, 3.0),
        "moves_with": ("frame",),
        "colour": "#4060c0",
    }
    return Body(name=name, plate=plate, z=z, thickness=thickness, section=section, **{**values, **more})


def few_bodies() -> list[Body]:
    ring = box(0, 0, 10, 6).difference(box(2, 2, 4, 4))
    twin = box(20, 0, 30, 6).difference(box(22, 2, 24, 4))
    touching = box(10, 1, 14, 3)
    upper = box(0.5, 0.25, 3.75, 9.125)
    return [
        body("unit.a[0]", ring),
        body("unit.b[0] 'x;#3'", twin, colour="#c04040"),
        body("rung.a[0].1", touching, colour="#40c040"),
        body("rung.c", upper, z=2.3, thickness=3.0, plate="H0"),
    ]
