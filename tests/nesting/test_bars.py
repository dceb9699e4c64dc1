"""Members on bars, through the checker, with faults seeded into good layouts."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from isomould.errors import Refused
from isomould.nesting.bar_checker import check_bars
from isomould.nesting.bars import nest_bars
from isomould.nesting.layout import BarLayout, Member
from isomould.nesting.search import Search
from isomould.nesting.settings import BarStock, StockSettings

STOCK = StockSettings(bars=(BarStock(section="P", length=6000),), bar_kerf=3, bar_trim=10)
MEMBERS = (
    Member("M1", "P", 1990.0, 3, ("a", "b", "c")),
    Member("M2", "P", 995.5, 2, ("d", "e")),
    Member("M3", "P", 5980.0),
)
LAYOUT = nest_bars(MEMBERS, STOCK)


def test_pieces_fill_a_bar_to_the_last_kerf() -> None:
    """Two pieces and one kerf between: the kerf is counted n - 1 times (failure mode F3)."""
    layout = nest_bars([Member("M", "P", 2988.5, 2)], STOCK)
    assert (len(layout.bars), layout.bars[0].rest) == (1, 0)
    assert len(nest_bars([Member("M", "P", 2988.501, 2)], STOCK).bars) == 2


def test_many_lengths_meet_their_bound() -> None:
    chance = np.random.default_rng(1)
    lengths = np.round(chance.uniform(600, 2400, 150), 1)
    layout = nest_bars([Member(k, "P", float(x), 2) for k, x in enumerate(lengths)], STOCK)
    assert layout.gap_to_bound == 0


def test_quick_effort_leaves_out_the_patterns_of_many_lengths() -> None:
    """The greedy ways, and bars filled again: near the bound, and at it with patterns."""
    chance = np.random.default_rng(5)
    members = [Member(k, "P", float(x)) for k, x in enumerate(np.round(chance.uniform(1200, 3600, 120), 3))]
    stock = StockSettings(bars=(BarStock(section="P", length=6000),))
    quick, normal = nest_bars(members, stock, Search("quick")), nest_bars(members, stock)
    assert check_bars(members, stock, quick) == ()
    assert quick.bound <= normal.bound == len(normal.bars) < len(quick.bars) <= 1.05 * quick.bound


def test_few_lengths_meet_the_bound_of_their_patterns() -> None:
    """Three patterns and no other fill a bar: first fit alone needs more."""
    stock = StockSettings(bars=(BarStock(section="P", length=100),), bar_kerf=0)
    layout = nest_bars([Member(k, "P", float(x), 6) for k, x in enumerate((60, 40, 25, 15))], stock)
    assert layout.gap_to_bound == 0


def test_cheaper_bars_are_preferred() -> None:
    bars = (BarStock(section="P", length=6000, price=100), BarStock(section="P", length=4000, price=20))
    layout = nest_bars([Member("M", "P", 1900.0, 8)], StockSettings(bars=bars))
    assert {bar.length for bar in layout.bars} == {4000}


def test_remnants_are_cut_before_bars_are_bought() -> None:
    bars = (BarStock(section="P", length=6000, price=90), BarStock(section="P", length=2500, quantity=3))
    layout = nest_bars([Member("M", "P", 2400.0, 5)], StockSettings(bars=bars))
    assert sorted(bar.length for bar in layout.bars) == [2500, 2500, 2500, 6000]
    assert layout.price == layout.price_bound == 90


def test_of_equal_prices_the_fewer_bars_are_taken() -> None:
    bars = (BarStock(section="P", length=6000, price=90), BarStock(section="P", length=500, quantity=9))
    layout = nest_bars([Member("M", "P", 1900.0), Member("N", "P", 400.0, 4)], StockSettings(bars=bars))
    assert [bar.length for bar in layout.bars] == [6000]


def test_last_bars_in_stock_suffice_if_they_are_shared_out_well() -> None:
    """60 + 40 and 40 + 30 fill them; a bar more of any length there is none."""
    bars = (BarStock(section="P", length=100, quantity=1), BarStock(section="P", length=70, quantity=1))
    members = [Member(k, "P", float(length)) for k, length in enumerate((60, 40, 40, 30))]
    layout = nest_bars(members, StockSettings(bars=bars, bar_kerf=0))
    assert (layout.status, len(layout.bars)) == ("complete", 2)


SIX = [
    (30, 600, 6000),
    (30, 600, 12000),
    (700, 600, 6000),
    (700, 600, 12000),
    (30, 1200, 6000),
    pytest.param(700, 1200, 6000, marks=pytest.mark.long),
]


def thirteen_hundred(lengths: int, shortest: int) -> list[Member]:
    """Members of so many lengths, 600 to 2400 or 1200 to 3600, drawn by lot."""
    chance = np.random.default_rng(1)
    sizes = np.round(chance.uniform(shortest, 2400 if shortest == 600 else 3600, lengths), 3)
    counts = 1 + chance.multinomial(1300 - lengths, np.full(lengths, 1 / lengths))
    return [Member(k, "P", float(x), int(n)) for k, (x, n) in enumerate(zip(sizes, counts, strict=True))]


@pytest.mark.parametrize(("lengths", "shortest", "bar"), SIX)
def test_thirteen_hundred_members_meet_their_bound(lengths: int, shortest: int, bar: int) -> None:
    stock = StockSettings(bars=(BarStock(section="P", length=bar),))
    members = thirteen_hundred(lengths, shortest)
    layout = nest_bars(members, stock)
    assert check_bars(members, stock, layout) == ()
    assert layout.gap_to_bound == 0


@pytest.mark.parametrize(
    ("seed", "lengths", "cost"),
    [(1, 30, 9531.5), (2, 30, 9394.5), pytest.param(2, 200, 9933.0, marks=pytest.mark.long)],
)
def test_several_lengths_of_bars_cost_the_least_that_is_proved(seed: int, lengths: int, cost: float) -> None:
    """The cheapest numbers of bars that may hold all, and then their exact filling."""
    chance = np.random.default_rng(seed)
    sizes = np.round(chance.uniform(600, 2400, lengths), 3)
    counts = 1 + chance.multinomial(400 - lengths, np.full(lengths, 1 / lengths))
    members = [Member(k, "P", float(x), int(n)) for k, (x, n) in enumerate(zip(sizes, counts, strict=True))]
    prices = ((6000, 100), (12000, 190), (7500, 121.5))
    layout = nest_bars(members, StockSettings(bars=tuple(BarStock(section="P", length=x, price=p) for x, p in prices)))
    assert layout.price == layout.price_bound == cost


def test_heap_shrinks_until_a_bar_is_saved() -> None:
    """160 bars of 12 m with 41 mm to spare in all: patterns on a grid miss it."""
    chance = np.random.default_rng(12)
    sizes = np.round(chance.uniform(600, 2400, 30), 3)
    counts = 1 + chance.multinomial(1270, np.full(30, 1 / 30))
    members = [Member(k, "P", float(x), int(n)) for k, (x, n) in enumerate(zip(sizes, counts, strict=True))]
    layout = nest_bars(members, StockSettings(bars=(BarStock(section="P", length=12000),)))
    assert len(layout.bars) == layout.bound == 160


def test_member_longer_than_every_bar_is_refused() -> None:
    with pytest.raises(Refused, match="member M9: needs a bar of 6020 mm"):
        nest_bars([Member("M9", "P", 6000.0)], STOCK)


def test_bars_of_one_length_need_one_entry() -> None:
    bars = (BarStock(section="P", length=6000, price=90), BarStock(section="P", length=6000, quantity=2))
    with pytest.raises(ValueError, match="two stock bars of P are 6000 mm long; one entry"):
        StockSettings(bars=bars)


def test_section_without_bars_is_refused() -> None:
    with pytest.raises(Refused, match="stock bars of Q: none"):
        nest_bars([Member("M9", "Q", 600.0)], STOCK)


def test_used_up_stock_leaves_members_unplaced() -> None:
    stock = STOCK.model_copy(update={"bars": (BarStock(section="P", length=6000, quantity=1),)})
    layout = nest_bars(MEMBERS, stock)
    assert (layout.status, len(layout.bars)) == ("incomplete", 1)


def change(bar: int, cut: int, **values: Any) -> Callable[[BarLayout], BarLayout]:
    def fault(layout: BarLayout) -> BarLayout:
        bars = list(layout.bars)
        cuts = list(bars[bar].cuts)
        cuts[cut] = replace(cuts[cut], **values)
        bars[bar] = replace(bars[bar], cuts=tuple(cuts))
        return replace(layout, bars=tuple(bars))

    return fault


FAULTS: dict[str, tuple[Callable[[BarLayout], BarLayout], str]] = {
    "lost": (lambda layout: replace(layout, bars=layout.bars[:-1]), "N-BAR-01"),
    "doubled": (lambda layout: replace(layout, bars=layout.bars * 2), "N-BAR-01"),
    "location": (change(0, 0, location="z"), "N-BAR-02"),
    "status": (lambda layout: replace(layout, status="incomplete"), "N-BAR-03"),
    "short kerf": (change(1, 1, start=LAYOUT.bars[1].cuts[1].start - 0.1), "N-BAR-06"),
    "in the trim": (change(0, 0, start=9.0), "N-BAR-06"),
    "past the end": (change(0, 0, start=11.0), "N-BAR-07"),
    "sum": (
        lambda layout: replace(layout, bars=tuple(replace(bar, rest=1.5) for bar in layout.bars)),
        "N-BAR-08",
    ),
    "length": (change(0, 0, length=10.0), "N-BAR-09"),
    "bound": (lambda layout: replace(layout, bounds={"P": 99}), "N-BAR-10"),
    "price": (lambda layout: replace(layout, price=1.0, price_bound=0.0), "N-BAR-11"),
    "price bound": (lambda layout: replace(layout, price_bound=1.0), "N-BAR-12"),
    "stock": (
        lambda layout: replace(layout, bars=tuple(replace(bar, length=6001.0) for bar in layout.bars)),
        "N-BAR-04",
    ),
}


def test_good_layout_is_proved() -> None:
    assert check_bars(MEMBERS, STOCK, LAYOUT) == ()


@pytest.mark.parametrize(("fault", "code"), FAULTS.values(), ids=FAULTS.keys())
def test_fault_is_found(fault: Callable[[BarLayout], BarLayout], code: str) -> None:
    assert code in {finding.code for finding in check_bars(MEMBERS, STOCK, fault(LAYOUT))}
