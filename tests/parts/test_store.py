from dataclasses import replace

import msgspec
import pytest

from mdlcad.artefact import from_json, to_json
from mdlcad.parts.store import Parts, bodies_of, records_of
from tests.parts.device import small_device


def test_bodies_come_back_bit_for_bit() -> None:
    bodies = small_device().bodies()
    data = to_json(Parts(records_of(bodies), ()))
    again = bodies_of(from_json(data, Parts).bodies)
    assert [body.name for body in again] == [body.name for body in bodies]
    for one, other in zip(bodies, again, strict=True):
        assert one.section.equals_exact(other.section, 0.0)
        assert (one.assembled is None) == (other.assembled is None)
        assert (one.envelope is None) == (other.envelope is None)
    assert to_json(Parts(records_of(again), ())) == data


@pytest.mark.parametrize("ring", ["", "1,2", "1,2 3,4 x,5", "1,2 3,4 5", "nan,0 1,0 1,1", "0,0 1,1 1,0 0,1"])
def test_a_ring_that_is_none_names_its_body(ring: str) -> None:
    record = records_of(small_device().bodies())[0]
    with pytest.raises(msgspec.ValidationError, match=record.name.split("[")[0]):
        bodies_of([replace(record, section=(ring,))])
