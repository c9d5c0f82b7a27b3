"""Work begun ahead: taken in turn, whatever ends first, and the same for any number of workers."""

from __future__ import annotations

import threading

import pytest

from mdlcad.routing.ahead import Ahead


@pytest.mark.parametrize("workers", [1, 2, 5])
def test_results_come_in_the_order_of_the_items(workers: int) -> None:
    gates = [threading.Event() for _ in range(6)]

    def work(item: int) -> int:
        gates[item].set()
        if item % workers < workers - 1 and item + 1 < len(gates):
            assert gates[item + 1].wait(10)  # ends after the one behind it has begun
        return item * item

    with Ahead(workers) as ahead:
        assert list(ahead.each(range(6), work)) == [(i, i * i) for i in range(6)]


@pytest.mark.parametrize("workers", [1, 2, 3, 7])
def test_what_is_no_longer_wanted_is_left_out_for_any_number_of_workers(workers: int) -> None:
    wanted, seen = {0, 1, 2}, []
    with Ahead(workers) as ahead:
        for (kind, turn), result in ahead.each(
            [(kind, turn) for turn in range(3) for kind in range(3)],
            lambda item: item[0] + item[1],
            lambda i: i[0] in wanted,
        ):
            seen.append((kind, turn))
            assert result == kind + turn
            if kind == 1 or turn == 1:
                wanted.discard(kind)
    assert seen == [(0, 0), (1, 0), (2, 0), (0, 1), (2, 1)]


def test_no_more_is_begun_than_there_are_workers_ahead() -> None:
    begun = []
    with Ahead(2) as ahead:
        results = ahead.each(range(100), begun.append)
        next(results)
        results.close()
    assert len(begun) <= 2


def test_an_error_is_raised_when_its_turn_comes() -> None:
    def work(item: int) -> int:
        if item == 2:
            raise ArithmeticError("no such thing")
        return item

    seen = []
    with pytest.raises(ArithmeticError, match="no such thing"), Ahead(3) as ahead:
        for item, _ in ahead.each(range(5), work):
            seen.append(item)
    assert seen == [0, 1]
