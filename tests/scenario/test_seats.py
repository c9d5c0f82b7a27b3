import msgspec
import pytest

from mdlcad.scenario.seats import PlacedSeats, placed_seats


def placed(*masses: tuple[str, float, float, str | None]) -> PlacedSeats:
    return msgspec.convert(
        {
            "boundary": [(0, 0), (0, 50), (50, 50), (50, 0)],
            "masses": [
                {"mass": name, "x": x, "y": y, **({"deck": deck} if deck else {})} for name, x, y, deck in masses
            ],
            "ports": [{"bit": "a[0]", "x": 0, "y": 10}],
        },
        PlacedSeats,
    )


def test_masses_of_one_deck_are_drawn_where_they_are() -> None:
    seats = placed_seats(placed(("a", 10.0, 10.0, None), ("b", 10.0, 22.0, None)))
    assert seats.aside == 0.0
    assert seats.masses == {"a": (10.0, 10.0), "b": (10.0, 22.0)}


def test_masses_above_one_another_are_drawn_apart() -> None:
    seats = placed_seats(
        placed(
            ("a", 10.0, 10.0, "lower"),
            ("b", 10.0, 10.0, "upper"),
            ("c", 10.0, 22.0, "upper"),
            ("d", 40.0, 22.0, "lower"),
        )
    )
    assert seats.aside == pytest.approx(6.0)
    assert seats.masses["a"] == (10.0, 10.0)
    assert seats.masses["b"] == (16.0, 10.0)
    assert seats.masses["c"] == (16.0, 22.0)
    assert len(set(seats.masses.values())) == 4
