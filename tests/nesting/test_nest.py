"""Layouts of sheets and blanks: everything through the checker, and good enough."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from nesting_examples import GLASS, located, part_lists, racks, rows_of_trapezoids, trapezoid

from isomould.errors import Refused
from isomould.nesting import portfolio, search
from isomould.nesting.bound import bound_stock
from isomould.nesting.checker import check_layout
from isomould.nesting.files import layout_from_json, layout_to_json
from isomould.nesting.layout import Layout, Part
from isomould.nesting.nest import nest_blanks, nest_sheets
from isomould.nesting.rack import sort_classes
from isomould.nesting.search import Effort, Search
from isomould.nesting.settings import SheetStock, StockSettings

STOCK = StockSettings(sheets=(GLASS,), gap=5, trim=20)
QUICK = Search("quick")


def prove(parts: tuple[Part, ...], stock: StockSettings, effort: Effort) -> None:
    layout = nest_sheets(parts, stock, Search(effort))
    assert check_layout(parts, stock, layout) == ()
    assert max(layout.bound, layout.pattern_bound or 0) <= len(layout.sheets)
    assert layout.price_bound <= layout.price
    assert not layout.unplaced
    assert set(layout.cut_trees) == {sheet.id for sheet in layout.sheets}


@pytest.mark.slow
@settings(max_examples=500, deadline=None)
@given(part_lists(), racks())
def test_every_layout_is_proved(parts: tuple[Part, ...], stock: StockSettings) -> None:
    prove(parts, stock, "quick")


@settings(max_examples=50, deadline=None)
@given(part_lists(), racks())
def test_every_layout_of_columns_is_proved(parts: tuple[Part, ...], stock: StockSettings) -> None:
    prove(parts, stock, "normal")


@pytest.mark.long
@settings(max_examples=10_000, deadline=None)
@given(part_lists(), racks(), st.sampled_from(["quick", "normal", "best"]))
def test_very_many_layouts_are_proved(parts: tuple[Part, ...], stock: StockSettings, effort: Effort) -> None:
    prove(parts, stock, effort)


@pytest.mark.parametrize("way", ["refilled", "generated"])
def test_more_jobs_give_the_same_layout(way: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Small pools, so that several are filled side by side, and windows or covers after them."""
    monkeypatch.setattr(search, "POOL", 20)
    monkeypatch.setattr(portfolio, "LOSS", 9.0 if way == "refilled" else 0.0)
    parts = tuple(replace(part, quantity=2) for part in rows_of_trapezoids(3, 3, 10))
    found = [layout_to_json(nest_sheets(parts, STOCK, Search("normal", jobs=jobs))) for jobs in (1, 2, 3)]
    assert found[1:] == found[:1] * 2


@settings(max_examples=50, deadline=None)
@given(part_lists(), racks())
def test_blanks_are_proved(parts: tuple[Part, ...], stock: StockSettings) -> None:
    blanks = stock.model_copy(update={"sheets": ()})
    layout = nest_blanks(parts, stock)
    assert check_layout(parts, blanks, layout) == ()
    assert not layout.unplaced


@pytest.mark.parametrize("unequal", [False, True])
def test_vault_is_near_its_bound(unequal: bool) -> None:
    layout = nest_sheets(rows_of_trapezoids(7, 8, 20, unequal=unequal), STOCK, QUICK)
    assert len(layout.sheets) <= 1.08 * layout.bound


def test_same_parts_give_the_same_bytes() -> None:
    parts = rows_of_trapezoids(3, 4, 6)
    one, other = (layout_to_json(nest_sheets(parts, STOCK, QUICK)) for _ in range(2))
    assert one == other


def test_rectangles_fill_a_sheet_exactly() -> None:
    stock = StockSettings(sheets=(SheetStock(name="s", width=3000, height=2000),), gap=0, trim=0)
    layout = nest_sheets([Part("A", trapezoid(1000, 500, 0, 0), 24)], stock, QUICK)
    assert (len(layout.sheets), layout.yield_percent) == (2, 100.0)


def test_head_to_tail_row_needs_the_length_of_the_formula() -> None:
    """Sum of mean widths + (n - 1) gap / cos + h tan (nesting, "What works", 1)."""
    layout = nest_blanks([Part("A", trapezoid(1000, 800, 60, 60), 5)], StockSettings(gap=5))
    expected = 5 * 940 + 4 * 5 * np.hypot(1, 60 / 800) + 60
    assert layout.sheets[0].width == pytest.approx(expected, abs=0.005)
    assert layout.sheets[0].height == 800


def test_locations_come_back_once_each() -> None:
    part = located(Part("P01", trapezoid(900, 700, 10, 10), 40))
    layout = nest_sheets([part], STOCK, QUICK)
    assert sorted(item.location or "" for item in layout.placements) == sorted(part.locations)


def test_part_that_fits_no_sheet_is_named_with_its_size() -> None:
    with pytest.raises(Refused, match=r"part P09: needs 7040 x 540 mm"):
        nest_sheets([Part("P09", trapezoid(7000, 500, 0, 0))], STOCK)


def test_part_longer_than_a_blank_is_refused() -> None:
    with pytest.raises(Refused, match=r"part P09: 7000 mm long"):
        nest_blanks([Part("P09", trapezoid(7000, 500, 0, 0))], StockSettings())


def test_used_up_stock_leaves_parts_unplaced() -> None:
    stock = STOCK.model_copy(update={"sheets": (GLASS.model_copy(update={"quantity": 1}),)})
    layout = nest_sheets([Part("A", trapezoid(2900, 1500, 0, 0), 9)], stock, QUICK)
    assert (len(layout.placements), len(layout.unplaced), layout.status) == (4, 5, "incomplete")


def test_grain_forbids_quarter_turns() -> None:
    tall = Part("A", trapezoid(500, 3300, 0, 0))
    grained = STOCK.model_copy(update={"sheets": (GLASS.model_copy(update={"grain": True}),)})
    assert nest_sheets([tall], STOCK, QUICK).placements[0].rotation_deg in (90, 270)
    with pytest.raises(Refused):
        nest_sheets([tall], grained, QUICK)


def test_cheaper_sheets_are_preferred() -> None:
    cheap = SheetStock(name="cheap", width=3000, height=2000, price=1)
    dear = SheetStock(name="dear", width=6000, height=2000, price=10)
    stock = StockSettings(sheets=(dear, cheap), gap=5)
    layout = nest_sheets([Part("A", trapezoid(900, 900, 10, 10), 12)], stock, QUICK)
    assert {sheet.stock for sheet in layout.sheets} == {"cheap"}


def test_stopped_search_gives_a_whole_layout_that_is_not_reproducible() -> None:
    parts = rows_of_trapezoids(3, 4, 6)
    layout = nest_sheets(parts, STOCK, Search("best", should_stop=lambda: True))
    assert (layout.status, layout.reproducible) == ("complete", False)


def test_progress_is_told() -> None:
    told: list[tuple[int, int, int, int]] = []
    layout = nest_sheets(rows_of_trapezoids(3, 4, 6), STOCK, Search("quick", lambda *news: told.append(news)))
    assert [done for done, _, _, _ in told] == list(range(1, len(told) + 1))
    assert len(told) <= told[-1][1]
    assert told[-1][2] == len(layout.sheets)


def test_layout_survives_its_file() -> None:
    parts = rows_of_trapezoids(3, 2, 6)
    text = layout_to_json(nest_sheets(parts, STOCK, QUICK))
    again = layout_from_json(text)
    assert layout_to_json(again) == text
    assert check_layout(parts, STOCK, again) == ()


def test_file_that_is_no_layout_is_refused() -> None:
    with pytest.raises(Refused, match="layout"):
        layout_from_json('{"schema": 2}')


def test_search_ends_at_the_bound() -> None:
    told: list[tuple[int, int, int, int]] = []
    parts = [Part("A", trapezoid(2900, 1500, 0, 0), 8)]
    layout = nest_sheets(parts, STOCK, Search("best", lambda *news: told.append(news)))
    assert (layout.gap_to_bound, told, layout.reproducible) == (0, [], True)


def test_nothing_to_nest_needs_no_sheet() -> None:
    assert nest_sheets([], STOCK).sheets == ()


def test_gap_below_the_kerf_is_refused() -> None:
    with pytest.raises(ValueError, match="kerf"):
        StockSettings(gap=5, kerf=6)


def test_the_emptiest_sheet_is_squeezed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same sheets, never a smaller offcut than without, and for most lists a larger one."""
    lists = [rows_of_trapezoids(seed, 5, 7, unequal=seed % 2 == 0) for seed in (0, 1, 5, 6)]
    squeezed = [nest_sheets(parts, STOCK, QUICK) for parts in lists]
    monkeypatch.setattr(portfolio, "leave_offcut", lambda _, plans: plans)
    plain = [nest_sheets(parts, STOCK, QUICK) for parts in lists]
    assert [len(layout.sheets) for layout in squeezed] == [len(layout.sheets) for layout in plain]
    gained = [_offcut(one) - _offcut(other) for one, other in zip(squeezed, plain, strict=True)]
    assert min(gained) > -1e3
    assert sum(area > 1e6 for area in gained) == 3


def _offcut(layout: Layout) -> float:
    assert layout.offcut is not None
    return layout.offcut.width * layout.offcut.height


class TestHolesInBounds:
    STOCK = StockSettings(sheets=(SheetStock(name="s", width=2100, height=1050),), gap=5)

    def frame(self, quantity: int) -> Part:
        hole = np.array([[100.0, 100.0], [900.0, 100.0], [900.0, 900.0], [100.0, 900.0]])
        return Part("F", trapezoid(1000, 1000, 0, 0), quantity, holes=(hole,))

    def test_a_bound_counts_the_room_in_holes(self) -> None:
        """Two frames and eight squares lie on one sheet, four squares in each frame: 350 + 5 + 350 < 800 - 2 * 5."""
        told: list[int] = []
        search = Search("quick", lambda *numbers: told.append(numbers[3]))
        layout = nest_sheets([self.frame(2), Part("S", trapezoid(350, 350, 0, 0), 8)], self.STOCK, search)
        assert layout.bound == 1
        assert set(told) <= {1}

    def test_what_the_gap_takes_of_a_hole_is_not_counted(self) -> None:
        """A frame takes 1005² less the hole without half the gap all round, 795²; nine sheets are full of twenty."""
        (frame, gap) = self.frame(20), 5.0
        need = 20 * (1005**2 - (4 - np.pi) * gap**2 / 4 - 795**2)
        room = 2105 * 1055 - (4 - np.pi) * gap**2 / 4
        layout = nest_sheets([frame], self.STOCK, Search("quick"))
        assert layout.bound == int(np.ceil(need / room))

    @settings(max_examples=60, deadline=None)
    @given(
        st.integers(1, 4),
        st.integers(1, 4),
        st.integers(20, 400),
        st.integers(5, 200),
        st.integers(0, 30),
        st.booleans(),
    )
    def test_no_bound_exceeds_a_layout_that_fills_the_holes(
        self, frames: int, across: int, side: int, wall: int, gap: int, lying: bool
    ) -> None:
        """As many sheets as frames hold the frames and a row of squares in each, all a gap apart."""
        inside = across * (side + gap) + gap
        width, height = inside + 2 * wall, side + 2 * gap + 2 * wall
        hole = np.array(
            [[wall, wall], [width - wall, wall], [width - wall, height - wall], [wall, height - wall]], float
        )
        frame = shapely.Polygon(trapezoid(width, height, 0, 0), [hole])
        square = shapely.box(0, 0, side, side)
        size = {"width": height, "height": width} if lying else {"width": width, "height": height}
        stock = StockSettings(sheets=(SheetStock(name="s", **size),), gap=gap)
        assert bound_stock([frame] * frames + [square] * (frames * across), stock).sheets <= frames

    def test_parts_that_differ_in_holes_alone_are_two_classes(self) -> None:
        plain = Part("P", trapezoid(1000, 1000, 0, 0), 2)
        assert [len(kind.pieces) for kind in sort_classes([plain, self.frame(3), replace(plain, id="Q")])] == [4, 3]
