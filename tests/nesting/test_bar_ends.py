"""Slanted ends of flat bars: the best order against all orders, layouts through the checker."""

from dataclasses import replace
from itertools import permutations, product

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from isomould.nesting.bar_checker import check_bars
from isomould.nesting.bar_ends import Blank, blank, lay, runs_lost, square
from isomould.nesting.bars import nest_bars
from isomould.nesting.layout import BarLayout, Member
from isomould.nesting.settings import BarStock, StockSettings

DEPTH = 200.0
STOCK = StockSettings(
    bars=(BarStock(section="FL200*12", length=6000),), bar_kerf=3, bar_trim=10, bar_ends="head-to-tail"
)


def plate(length: float, left: float, right: float, tongue: float = 0.0) -> tuple[tuple[float, float], ...]:
    """A plate with slanted ends: `left` and `right` are x at the top less x at the bottom, tongues lower than it."""
    h = DEPTH / 2
    t = h - tongue
    start, end = abs(left) / 2, length - abs(right) / 2
    outer = [(start + y * left / DEPTH, y) for y in (t, -t)], [(end + y * right / DEPTH, y) for y in (-t, t)]
    inner = [(start + 30, -h), (end - 30, -h)], [(end - 30, h), (start + 30, h)]
    points = [*outer[0], *inner[0], *outer[1], *inner[1]] if tongue else [*outer[0], *outer[1]]
    low = min(x for x, _ in points)
    return tuple((round(x - low, 3), y) for x, y in points)


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


plates = st.builds(
    plate, st.integers(300, 2900).map(float), st.integers(-30, 30), st.integers(-30, 30), st.sampled_from([0.0, 3.0])
)


def random_bars(outlines: list[tuple[tuple[float, float], ...]], counts: list[int], stock: StockSettings) -> None:
    members = [member(k, outline, n) for k, (outline, n) in enumerate(zip(outlines, counts, strict=False))]
    layout = nest_bars(members, stock)
    assert check_bars(members, stock, layout) == ()
    boxed = nest_bars(members, stock.model_copy(update={"bar_ends": "square"}))
    if not layout.unplaced and not boxed.unplaced:
        assert boxed.price >= layout.price_bound
        assert layout.bound <= len(boxed.bars)


STOCKS = st.builds(
    lambda kinds, kerf, trim: StockSettings(
        bars=tuple(BarStock(section="FL200*12", length=x, price=p, quantity=q) for x, p, q in kinds),
        bar_kerf=kerf,
        bar_trim=trim,
        bar_ends="head-to-tail",
    ),
    st.lists(
        st.tuples(st.integers(3000, 9000), st.sampled_from([0, 7, 11.5, 12]), st.sampled_from([None, 0, 1, 3])),
        min_size=1,
        max_size=3,
        unique_by=lambda kind: kind[0],
    ),
    st.sampled_from([0.0, 3.0, 2.5]),
    st.sampled_from([0.0, 15.0]),
)
MANY = (st.lists(plates, min_size=1, max_size=6), st.lists(st.integers(1, 6), min_size=6, max_size=6), STOCKS)


@settings(max_examples=12, deadline=None)
@given(*MANY)
def test_every_slanted_layout_is_proved(outlines, counts, stock) -> None:
    random_bars(outlines, counts, stock)


@pytest.mark.long
@settings(max_examples=10_000, deadline=None)
@given(*MANY)
def test_ten_thousand_slanted_layouts_are_proved(outlines, counts, stock) -> None:
    random_bars(outlines, counts, stock)


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
