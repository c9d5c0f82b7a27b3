import pytest

from mdlcad.routing import horizon, route
from mdlcad.routing.check import check_layout
from mdlcad.routing.jam import JamError
from tests.routing.made import good


def test_a_channel_routed_in_windows_is_legal_too(monkeypatch: pytest.MonkeyPatch) -> None:
    network, rules, placement, whole = good()
    monkeypatch.setattr(horizon, "MOST_TRUNKS", 0)
    monkeypatch.setattr(horizon, "ROWS", (3,))  # with two it sees too little to leave room for what comes
    solved: list[int] = []
    solve = horizon.solve

    def counted(channel, rules, seed):
        solved.append(channel.index)
        return solve(channel, rules, seed)

    monkeypatch.setattr(horizon, "solve", counted)
    layout = route(network, placement, rules, 1)
    assert len(solved) > len(placement.column_x) + 1  # a channel took several windows
    assert check_layout(network, placement, layout, rules) == ()
    assert {leaf.coupling for leaf in layout.couplers} == {leaf.coupling for leaf in whole.couplers}


def test_what_a_small_window_leaves_no_way_for_a_larger_may(monkeypatch: pytest.MonkeyPatch) -> None:
    network, rules, placement, _ = good()
    monkeypatch.setattr(horizon, "MOST_TRUNKS", 0)
    monkeypatch.setattr(horizon, "ROWS", (1,))
    with pytest.raises(JamError):
        route(network, placement, rules, 1)
    monkeypatch.setattr(horizon, "ROWS", (1, 3))
    assert check_layout(network, placement, route(network, placement, rules, 1), rules) == ()
