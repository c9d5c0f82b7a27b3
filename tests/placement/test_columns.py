"""Columns are chosen once for a question, however often and by however many it is asked."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest

from mdlcad.placement import columns
from mdlcad.placement.columns import Answers, Question, choose_columns, question_of
from mdlcad.placement.lattice import lattices, place_ports
from mdlcad.placement.problem import build
from tests.placement.networks import SQUARE, small

SCALE = 3.9


def question() -> Question:
    network, ports, rules = small()
    lattice = lattices(SQUARE, place_ports(network, ports, SCALE), rules, SCALE, 18)[0]
    return question_of(build(network, lattice, rules), lattice)


def test_a_question_is_answered_once_and_as_by_asking_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[Question, int]] = []

    def counted(what: Question, seed: int) -> tuple[int, ...] | None:
        asked.append((what, seed))
        return choose_columns(what, seed)

    monkeypatch.setattr(columns, "choose_columns", counted)
    answers, what = Answers(), question()
    first = answers.choose(what, 0)
    assert first == choose_columns(what, 0)
    assert answers.choose(question(), 0) == first
    assert len(asked) == 1
    tight = replace(what, rooms=(what.masses, *(0 for _ in what.rooms[1:])))
    assert set(answers.choose(tight, 0) or ()) <= {0}
    answers.choose(what, 1)
    assert asked == [(what, 0), (tight, 0), (what, 1)]


def test_who_asks_while_it_is_being_answered_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    begun, go, asked = threading.Event(), threading.Event(), []

    def slow(what: Question, seed: int) -> tuple[int, ...]:
        asked.append(seed)
        begun.set()
        assert go.wait(10)
        return (seed,) * what.masses

    monkeypatch.setattr(columns, "choose_columns", slow)
    answers, what = Answers(), question()
    with ThreadPoolExecutor(2) as pool:
        one = pool.submit(answers.choose, what, 7)
        assert begun.wait(10)
        other = pool.submit(answers.choose, what, 7)
        go.set()
        assert one.result(10) == other.result(10) == (7,) * what.masses
    assert asked == [7]


def test_an_error_reaches_all_who_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(what: Question, seed: int) -> tuple[int, ...]:
        raise ArithmeticError("no solver")

    monkeypatch.setattr(columns, "choose_columns", broken)
    answers = Answers()
    for _ in range(2):
        with pytest.raises(ArithmeticError, match="no solver"):
            answers.choose(question(), 0)
