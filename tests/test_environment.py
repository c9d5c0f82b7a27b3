"""The two CAD libraries share one kernel; only some pairs of versions import together."""


def test_build123d_and_cadquery_live_together() -> None:
    import build123d
    import cadquery

    box = build123d.Box(1.0, 2.0, 3.0)
    same = cadquery.Workplane().box(1.0, 2.0, 3.0).val()
    assert abs(box.volume - same.Volume()) < 1e-9
    # the very shape of one is a shape of the other
    assert abs(cadquery.Shape.cast(box.wrapped).Volume() - 6.0) < 1e-9
