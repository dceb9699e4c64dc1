"""Patterns of bars and mixes of their lengths against trying all."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from isomould.nesting import bar_bound
from isomould.nesting.bar_bound import Demand, least_bars
from isomould.nesting.bar_ladder import RUNGS, Ladder, exact_ladder, grid
from isomould.nesting.bar_pricing import Values, most_worth, price
from isomould.nesting.bar_rack import ENDLESS, BarRack, Need


def ladders(rack: BarRack, need: Need) -> list[Ladder]:
    exact = exact_ladder(rack, need.counts)
    assert exact is not None
    return [exact, grid(rack, 1)]


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.integers(20, 90), min_size=1, max_size=4, unique=True),
    st.lists(st.integers(90, 200), min_size=1, max_size=2, unique=True),
    st.lists(st.tuples(st.integers(1, 3), st.integers(0, 9)), min_size=4, max_size=4),
)
def test_nothing_is_worth_more_than_the_best_pattern(
    sizes: list[int], rooms: list[int], rows: list[tuple[int, int]]
) -> None:
    sizes, rooms = sorted(sizes, reverse=True), sorted(rooms, reverse=True)
    counts, worth = (np.array(column[: len(sizes)]) for column in zip(*rows, strict=True))
    rack = BarRack(np.array(sizes), np.array(rooms), np.ones(len(rooms)))
    need = Need(counts, np.full(len(rooms), ENDLESS))
    takes = np.array(list(product(*(range(count + 1) for count in counts))))
    most = np.array([(takes[takes @ rack.sizes <= room] @ worth).max() for room in rooms], dtype=float)
    for ladder in ladders(rack, need):
        assert (most_worth(rack, need, worth.astype(float), ladder) == most).all()
        values = Values(worth.astype(float), worth.astype(float), np.zeros(len(rooms)))
        found, priced = price(rack, need, values, ladder)
        assert (priced == most).all()
        for kind, room in enumerate(rooms):
            mine = [pattern.takes for pattern in found if pattern.kind == kind]
            assert max((float(taken @ worth) for taken in mine), default=0.0) == most[kind]
            assert all(taken @ rack.sizes <= room and (taken <= counts).all() for taken in mine)


def test_too_many_sums_have_no_ladder() -> None:
    sizes = 2 ** np.arange(20)[::-1]
    assert 2 ** len(sizes) > RUNGS
    rack = BarRack(sizes, np.array([2**20]), np.ones(1))
    assert exact_ladder(rack, np.ones(len(sizes), dtype=np.int64)) is None


def test_listed_mixes_are_those_that_are_searched(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = np.array([[1.0, 0.8, 0.45], [1.0, 0.7, 0.5]])
    demand = Demand(rows, np.array([5.31, 5.02]), np.array([6, 3, 9]))
    costs, listed, searched = np.array([100.0, 75.0, 44.0]), list[float](), list[float]()
    for limit, found in ((bar_bound.MIXES, listed), (0, searched)):
        monkeypatch.setattr(bar_bound, "MIXES", limit)
        numbers = None
        for _ in range(6):
            cost, numbers = least_bars(demand, costs, numbers)
            assert numbers is not None
            assert (demand.rows @ numbers >= demand.asked).all()
            found.append(cost)
    assert listed == searched == sorted(listed)
