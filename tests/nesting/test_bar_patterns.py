"""Many pieces by patterns and numbers, and whole numbers among all patterns that can be part of the best."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from isomould.nesting.bar_columns import generate, make_programme, whole
from isomould.nesting.bar_greedy import first_fit, largest_first
from isomould.nesting.bar_ladder import Ladders, exact_ladder
from isomould.nesting.bar_near import near_patterns
from isomould.nesting.bar_rack import ENDLESS, BarRack, Need, bars_in, one_by_one, sum_of
from isomould.nesting.bars import nest_bars
from isomould.nesting.layout import Member
from isomould.nesting.settings import BarStock, StockSettings

racks = st.lists(st.integers(8, 60), min_size=1, max_size=5, unique=True)
rooms = st.lists(st.integers(60, 110), min_size=1, max_size=2, unique=True)
counts = st.lists(st.integers(1, 9), min_size=5, max_size=5)


def make(sizes, lengths, many, limit=ENDLESS):
    ordered = np.array(sorted(sizes, reverse=True), dtype=np.int64)
    bars = np.array(sorted(lengths, reverse=True), dtype=np.int64)
    rack = BarRack(ordered, bars, bars.astype(np.float64))
    return rack, Need(np.array(many[: len(sizes)]), np.full(len(bars), limit, dtype=np.int64))


def first_fit_piece_by_piece(rack, need):
    """First fit decreasing as the textbooks have it."""
    limits, bars = need.limits.tolist(), []
    for number, (size, many) in enumerate(zip(rack.sizes.tolist(), need.counts.tolist(), strict=True)):
        for _ in range(many):
            home = next((bar for bar in bars if bar[1] >= size), None)
            if home is None:
                kind = next((k for k, room in enumerate(rack.rooms) if limits[k] > 0 and room >= size), None)
                if kind is None:
                    continue
                limits[kind] -= 1
                home = [kind, int(rack.rooms[kind]), [0] * len(rack.sizes)]
                bars.append(home)
            home[1] -= size
            home[2][number] += 1
    return [(kind, takes) for kind, _, takes in bars]


@given(racks, rooms, counts, st.sampled_from([2, 5, ENDLESS]))
@settings(max_examples=60, deadline=None)
def test_first_fit_of_many_alike_is_first_fit_of_each(sizes, lengths, many, limit):
    rack, need = make(sizes, lengths, many, limit)
    found = [(bar.kind, bar.takes.tolist()) for bar in one_by_one(first_fit(rack, need))]
    assert found == first_fit_piece_by_piece(rack, need)


@given(racks, rooms, counts, st.sampled_from([2, 5, ENDLESS]))
@settings(max_examples=60, deadline=None)
def test_bars_filled_together_hold_what_is_asked(sizes, lengths, many, limit):
    rack, need = make(sizes, lengths, many, limit)
    bars = largest_first(rack, need)
    assert (sum_of(rack, bars) <= need.counts).all()
    assert all(bar.takes @ rack.sizes <= rack.rooms[bar.kind] for bar in bars)
    used = np.bincount([bar.kind for bar in one_by_one(bars)], minlength=len(rack.rooms))
    assert (used <= need.limits).all()
    assert (sum_of(rack, bars) == need.counts).all() or limit != ENDLESS


@given(racks, rooms, counts)
@settings(max_examples=40, deadline=None)
def test_near_patterns_are_all_that_are_worth_enough(sizes, lengths, many):
    """Against every pattern that there is, listed by trying all numbers of pieces."""
    rack, need = make(sizes, lengths, many)
    programme = make_programme(rack, rack.costs, first_fit(rack, need))
    ladder = Ladders(rack, exact_ladder(rack, need.counts), (1,))(need.counts, 1)
    shares = generate(programme, need, 60, ladder)
    lack = whole(programme.top * shares.cost) / programme.top - shares.cost
    near = {(p.kind, tuple(p.takes.tolist())) for p in near_patterns(programme, need, shares)}
    for kind, room in enumerate(rack.rooms.tolist()):
        for takes in product(*(range(count + 1) for count in need.counts)):
            rest = room - int(np.dot(takes, rack.sizes))
            full = rest >= 0 and not any(
                rest >= size and took < count for size, took, count in zip(rack.sizes, takes, need.counts, strict=True)
            )
            worth = float(np.dot(takes, shares.worth)) - programme.costs[kind] - shares.tolls[kind]
            if full and worth >= -lack:
                assert (kind, takes) in near


@pytest.mark.parametrize("seed", [3, 4])
def test_triplets_meet_their_bound(seed):
    """Falkenauer's triplets (1996, Journal of Heuristics 2, 5-30): every bar holds three pieces and nothing is left."""
    chance = np.random.default_rng(seed)
    first = chance.integers(380, 490, 20)
    second = np.array([chance.integers(250, (1000 - one) // 2 + 1) for one in first])
    sizes = np.concatenate([first, second, 1000 - first - second])
    members = [Member(k, "P", float(size)) for k, size in enumerate(sizes.tolist())]
    layout = nest_bars(members, StockSettings(bars=(BarStock(section="P", length=1000),), bar_kerf=0))
    assert (len(layout.bars), layout.bound) == (20, 20)


def test_ten_times_the_pieces_fill_ten_times_the_bars():
    """Equal bars are patterns with a number: as many patterns for ten times the pieces."""
    rack, need = make([17, 23, 31, 44], [100], [40, 30, 20, 10])
    more = Need(need.counts * 10, need.limits)
    few, many = largest_first(rack, need), largest_first(rack, more)
    assert len(many) <= 2 * len(few)
    assert bars_in(many) <= 10 * bars_in(few)
