"""Slanted ends of flat bars: the best order against all orders, layouts through the checker."""

from dataclasses import replace
from itertools import permutations, product

import numpy as np
import pytest
import shapely
from bar_examples import DEPTH, plate
from hypothesis import given, settings
from hypothesis import strategies as st

from isomould.nesting.bar_checker import check_bars
from isomould.nesting.bar_ends import Blank, blank, lay, runs_lost, square
from isomould.nesting.bars import nest_bars
from isomould.nesting.layout import BarLayout, Member
from isomould.nesting.settings import BarStock, StockSettings

STOCK = StockSettings(
    bars=(BarStock(section="FL200*12", length=6000),), bar_kerf=3, bar_trim=10, bar_ends="head-to-tail"
)


def member(mark: int | str, outline: tuple[tuple[float, float], ...], quantity: int = 1) -> Member:
    length = round(max(x for x, _ in outline), 3)
    return Member(mark, "FL200*12", length, quantity, outline=outline)


def test_regular_trapezoids_lose_one_wedge_at_each_end_of_a_bar() -> None:
    """Three of 1500 mm, 20 mm shorter at the bottom: 4440 + two kerfs of 3.015 mm + 20, where boxes take 4506."""
    layout = nest_bars([member("M", plate(1500, -20, 20), 3)], STOCK)
    cut = 3 * np.hypot(1, 0.1)
    assert layout.bars[0].rest == pytest.approx(5980 - 3 * 1480 - 2 * cut - 20, abs=2e-3)
    assert [piece.turned for piece in layout.bars[0].cuts] in (
        ["none", "upside_down", "none"],
        ["none", "both", "none"],
    )


def test_slants_save_a_bar() -> None:
    members = [member("M", plate(1500, -40, 40), 8)]
    square_cut = STOCK.model_copy(update={"bar_ends": "square"})
    assert (len(nest_bars(members, STOCK).bars), len(nest_bars(members, square_cut).bars)) == (2, 3)


def test_member_as_long_as_the_bar_is_cut() -> None:
    layout = nest_bars([member("M", plate(5980, 30, 30))], STOCK)
    assert layout.bars[0].rest == 0


RUNS = st.integers(-3, 3).map(lambda k: 4000 * k)


@st.composite
def blanks(draw: st.DrawFn) -> Blank:
    left, right, length = draw(RUNS), draw(RUNS), draw(st.integers(50, 150)) * 4000
    return Blank(length, abs(left) // 2, length - abs(right) // 2, (left, right), 200_000)


def shortest(pieces: list[Blank]) -> int:
    """Try all orders and turnings, without a kerf: x at the top and at the bottom of every end."""
    best = 2**60
    for order in permutations(pieces):
        for ways in product(product((1, -1), (False, True)), repeat=len(order)):
            lows, highs, at = list[int](), list[int](), None
            for piece, (sign, swap) in zip(order, ways, strict=True):
                left, right = (sign * run for run in (piece.runs[::-1] if swap else piece.runs))
                middle = 0 if at is None else at[0] + abs(at[1] - left) // 2
                lows.append(middle - abs(left) // 2)
                at = middle + piece.mean, right
                highs.append(at[0] + abs(right) // 2)
            best = min(best, max(highs) - min(lows))
    return best


@settings(max_examples=60, deadline=None)
@given(st.lists(blanks(), min_size=1, max_size=3))
def test_no_order_is_shorter(pieces: list[Blank]) -> None:
    laid = lay(pieces, 0)
    length = max(place.start + pieces[place.piece].length for place in laid) - min(place.start for place in laid)
    assert length == shortest(pieces) == sum(piece.mean for piece in pieces) + runs_lost(pieces)


def test_pieces_that_pass_over_others_are_joined_to_them() -> None:
    """From 0 to 3 and back nothing is lost; a piece with runs of 1 at both ends must be reached besides."""
    runs = [(0, 6000), (6000, 0), (2000, -2000)]
    pieces = [Blank(400_000, abs(a) // 2, 400_000 - abs(b) // 2, (a, b), 200_000) for a, b in runs]
    assert runs_lost(pieces[:2]) == 0
    assert runs_lost(pieces) == 2000


def test_saw_lines_hold_the_outline_and_touch_it() -> None:
    outline = plate(1000, -20, 14, tongue=3)
    this = blank(outline)
    lines = ((this.start, this.runs[0]), (this.end, this.runs[1]))
    sawn = [(x / 1000 + y * run / 1000 / DEPTH, y) for x, run in lines for y in (-DEPTH / 2, DEPTH / 2)]
    assert shapely.Polygon([sawn[k] for k in (0, 2, 3, 1)]).buffer(1e-9).contains(shapely.Polygon(outline))
    assert this.runs == (-20000, 14000)
    assert this.mean / 1000 == pytest.approx(1000 - 17, abs=3e-3)
    assert square(5).mean == 5


def moved(layout: BarLayout, **change: object) -> BarLayout:
    bar = layout.bars[0]
    cuts = (bar.cuts[0], replace(bar.cuts[1], **change), *bar.cuts[2:])
    return replace(layout, bars=(replace(bar, cuts=cuts), *layout.bars[1:]))


def test_neighbours_nearer_than_the_kerf_are_found() -> None:
    members = [member("M", plate(1500, -20, 20), 3)]
    layout = nest_bars(members, STOCK)
    second = layout.bars[0].cuts[1]
    faults = ({"start": second.start - 0.03}, {"turned": "none"}, {"start": layout.bars[0].cuts[0].start})
    for fault in faults:
        assert "N-BAR-06" in {finding.code for finding in check_bars(members, STOCK, moved(layout, **fault))}
