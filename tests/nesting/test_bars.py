"""Members on bars, through the checker, with faults seeded into good layouts."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from isomould.errors import Refused
from isomould.nesting.bar_checker import check_bars
from isomould.nesting.bars import nest_bars
from isomould.nesting.layout import BarLayout, Member
from isomould.nesting.settings import BarStock, StockSettings

STOCK = StockSettings(bars=(BarStock(section="P", length=6000),), bar_kerf=3, bar_trim=10)
MEMBERS = (
    Member("M1", "P", 1990.0, 3, ("a", "b", "c")),
    Member("M2", "P", 995.5, 2, ("d", "e")),
    Member("M3", "P", 5980.0),
)
LAYOUT = nest_bars(MEMBERS, STOCK)


@settings(max_examples=100, deadline=None)
@given(
    st.lists(st.tuples(st.sampled_from("PQ"), st.integers(100, 4000), st.integers(1, 9)), max_size=12),
    st.sampled_from([0.0, 3.0, 2.5]),
    st.sampled_from([0.0, 15.0]),
)
def test_every_layout_is_proved(rows: list[tuple[str, int, int]], kerf: float, trim: float) -> None:
    members = [Member(k, section, length + k / 8, count) for k, (section, length, count) in enumerate(rows)]
    bars = [BarStock(section=section, length=length) for section in "PQ" for length in (5000, 6500)]
    stock = StockSettings(bars=tuple(bars), bar_kerf=kerf, bar_trim=trim)
    layout = nest_bars(members, stock)
    assert check_bars(members, stock, layout) == ()
    assert not layout.unplaced
    assert layout.bound <= len(layout.bars)


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


def test_few_lengths_meet_the_bound_of_their_patterns() -> None:
    """Three patterns and no other fill a bar: first fit alone needs more."""
    stock = StockSettings(bars=(BarStock(section="P", length=100),), bar_kerf=0)
    layout = nest_bars([Member(k, "P", float(x), 6) for k, x in enumerate((60, 40, 25, 15))], stock)
    assert layout.gap_to_bound == 0


def test_cheaper_bars_are_preferred() -> None:
    bars = (BarStock(section="P", length=6000, price=100), BarStock(section="P", length=4000, price=20))
    layout = nest_bars([Member("M", "P", 1900.0, 8)], StockSettings(bars=bars))
    assert {bar.length for bar in layout.bars} == {4000}


def test_member_longer_than_every_bar_is_refused() -> None:
    with pytest.raises(Refused, match="member M9: needs a bar of 6020 mm"):
        nest_bars([Member("M9", "P", 6000.0)], STOCK)


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
