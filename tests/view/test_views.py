"""Which bodies the pictures of a build show."""

from dataclasses import replace

from mdlcad.parts.body import Body, BodyKind
from mdlcad.view.views import opened
from tests.view.small import small_built


def test_the_device_is_opened_at_its_cover() -> None:
    bodies = small_built().bodies
    cover = next(body for body in bodies if body.kind is BodyKind.COVER)
    # nothing of a single deck is hidden or cut but the cover
    assert opened(bodies) == [body for body in bodies if body is not cover]


def test_of_two_decks_the_lower_one_is_seen_and_nothing_stands_out_of_it() -> None:
    bodies = small_built().bodies
    top = max(body.z + body.thickness for body in bodies)

    def turned(body: Body) -> Body:
        return replace(
            body, name=f"upper-{body.name}", plate=f"upper-{body.plate}", z=2 * top - body.z - body.thickness
        )

    screw = next(body for body in bodies if body.kind is BodyKind.SCREW)
    through = replace(screw, thickness=2 * top - screw.z)
    lower = [through if body is screw else body for body in bodies]
    seen = opened([*(turned(body) for body in bodies if body is not screw), *lower])
    assert sorted(body.name for body in seen) == sorted(body.name for body in opened(bodies))
    assert max(body.z + body.thickness for body in seen) <= top
