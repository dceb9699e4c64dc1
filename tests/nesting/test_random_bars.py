"""Bars with every option, drawn by lot, through the checker; a few pieces against the best of all cuttings."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import pytest
from bar_examples import best_cutting, few_pieces, random_bars

from isomould.errors import Refused
from isomould.nesting.bar_checker import check_bars
from isomould.nesting.bars import nest_bars
from isomould.nesting.layout import BarLayout, Member
from isomould.nesting.settings import StockSettings


def check_case(members: Sequence[Member], stock: StockSettings) -> BarLayout | None:
    """Nest and check; None if a member is longer than every bar, which is refused."""
    if any(all(member.length > room for room in rooms(member, stock)) for member in members):
        with pytest.raises(Refused, match="needs a bar of"):
            nest_bars(members, stock)
        return None
    layout = nest_bars(members, stock)
    assert check_bars(members, stock, layout) == ()
    assert not fitting(members, stock, layout)
    return layout


def rooms(member: Member, stock: StockSettings) -> list[float]:
    return [bar.length - 2 * stock.bar_trim for bar in stock.bars if bar.section == member.section]


def fitting(members: Sequence[Member], stock: StockSettings, layout: BarLayout) -> list[object]:
    """Pieces that were left although a bar that could hold them is still in the rack."""
    sections = {member.id: member.section for member in members}
    used = Counter((bar.section, bar.length) for bar in layout.bars)
    free = [bar for bar in stock.bars if bar.quantity is None or bar.quantity > used[bar.section, bar.length]]
    return [
        piece.id
        for piece in layout.unplaced
        for bar in free
        if bar.section == sections[piece.id] and piece.needs[0] <= bar.length - 2 * stock.bar_trim
    ]


def test_random_bars_are_proved() -> None:
    layouts = [check_case(*random_bars(seed)) for seed in range(500)]
    kinds = Counter(layout.status if layout else "refused" for layout in layouts)
    turned = sum(cut.turned != "none" for layout in layouts if layout for bar in layout.bars for cut in bar.cuts)
    assert min(kinds["complete"], kinds["incomplete"], kinds["refused"], turned) > 5


@pytest.mark.long
def test_ten_thousand_random_bars_are_proved() -> None:
    for seed in range(500, 10_500):
        check_case(*random_bars(seed))


@pytest.mark.parametrize("seed", range(40))
def test_bounds_of_slanted_pieces_hold_for_boxes(seed: int) -> None:
    """Boxes are one of all cuttings."""
    members, stock = random_bars(seed)
    slanted = check_case(members, stock.model_copy(update={"bar_ends": "head-to-tail"}))
    boxed = check_case(members, stock.model_copy(update={"bar_ends": "square"}))
    if slanted and boxed and not slanted.unplaced and not boxed.unplaced:
        assert boxed.price >= slanted.price_bound - 1e-6
        assert slanted.bound <= len(boxed.bars)


def check_few(members: Sequence[Member], stock: StockSettings, *, slanted: bool) -> None:
    """The layout is the best there is, and bounds do not exceed it; what was left is counted out."""
    layout = check_case(members, stock)
    if layout is None:
        return
    priced = any(bar.price for bar in stock.bars)
    cost = layout.price if priced else sum(bar.length for bar in layout.bars)
    pieces, least, bars = best_cutting(members, stock, slanted=slanted)
    assert (len(layout.unplaced), cost, len(layout.bars)) == (pieces, pytest.approx(least), bars)
    left = Counter(piece.id for piece in layout.unplaced)
    placed = [replace(member, quantity=member.quantity - left[member.id]) for member in members]
    assert layout.bound <= best_cutting(placed, stock, least="bars", slanted=slanted)[2]
    assert layout.price_bound <= (best_cutting(placed, stock, slanted=slanted)[1] if priced else 0.0) + 1e-6


def test_few_square_pieces_are_cut_best() -> None:
    for seed in range(100):
        check_few(*few_pieces(seed, 7, slanted=False), slanted=False)


def test_few_slanted_pieces_are_cut_best() -> None:
    for seed in range(10):
        check_few(*few_pieces(seed, 4, slanted=True), slanted=True)


@pytest.mark.long
def test_thousands_of_few_pieces_are_cut_best() -> None:
    for seed in range(100, 5_100):
        check_few(*few_pieces(seed, 7, slanted=False), slanted=False)
    for seed in range(10, 1_010):
        check_few(*few_pieces(seed, 5, slanted=True), slanted=True)
