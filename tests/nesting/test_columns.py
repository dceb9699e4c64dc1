"""Searches that generate columns: nested sheets for few classes, dives for many; bounds of several sizes."""

import numpy as np
import pytest
import shapely
from nesting_examples import GLASS, trapezoid

from isomould.arrays import Ints
from isomould.nesting.bound import bound_stock
from isomould.nesting.checker import check_layout
from isomould.nesting.choosing import choose_sheets
from isomould.nesting.cover import Rack, fill_sheets, pieces_of
from isomould.nesting.crew import gather
from isomould.nesting.cut_checker import replay
from isomould.nesting.dive import dive_part
from isomould.nesting.files import layout_to_json
from isomould.nesting.layout import Part
from isomould.nesting.master import add_plans, add_stack, add_strip, make_master, solve
from isomould.nesting.nest import nest_sheets
from isomould.nesting.patterns import stack_up
from isomould.nesting.pricing import make_offers
from isomould.nesting.rack import make_rack, piece_counts, sort_classes
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings
from isomould.nesting.sheets import fill, strip_parts

SMALL = StockSettings(sheets=(SheetStock(name="s", width=3000, height=1500),), gap=8, kerf=3, trim=10)
LARGE = StockSettings(sheets=(GLASS,), gap=5, trim=20)


def dome() -> list[Part]:
    """Eight rings whose heights do not stack on a sheet."""
    sizes = [(1500 - 130 * k, 1460 - 130 * k, 898 - 60 * k) for k in range(8)]
    return [Part(f"P{k}", trapezoid(a, h, (a - b) / 2, (a - b) / 2), 12) for k, (a, b, h) in enumerate(sizes)]


def stadium() -> list[Part]:
    """Three tall rows of thirty different panels, of which two strips leave much of a sheet."""
    chance = np.random.default_rng(5)
    sizes = [(h, a) for h in (1446, 1357, 1272) for a in chance.uniform(1000, 2200, 30)]
    return [Part(k, trapezoid(a, h, 25, 25), 2) for k, (h, a) in enumerate(sizes)]


DOME = nest_sheets(dome(), SMALL, Search("normal"))


@pytest.mark.parametrize(("parts", "stock"), [(dome(), SMALL), (stadium(), LARGE)], ids=["dome", "stadium"])
def test_columns_better_the_first_filling_and_are_proved(parts: list[Part], stock: StockSettings) -> None:
    quick, normal = (nest_sheets(parts, stock, Search(effort)) for effort in ("quick", "normal"))
    assert check_layout(parts, stock, normal) == ()
    assert normal.pattern_bound is not None
    assert len(quick.sheets) > len(normal.sheets) >= normal.pattern_bound >= normal.bound - 1


def test_zones_turn_parts_by_a_quarter_beside_others_that_are_not() -> None:
    layout = nest_sheets(dome(), SMALL, Search("normal"))
    turns = {
        sheet.id: {p.rotation_deg % 180 for p in layout.placements if p.sheet == sheet.id} for sheet in layout.sheets
    }
    assert {0, 90} in turns.values()


def test_columns_are_reproducible() -> None:
    assert layout_to_json(nest_sheets(dome(), SMALL, Search("normal"))) == layout_to_json(DOME)


def test_stopped_columns_keep_a_whole_layout() -> None:
    calls = iter(range(10**6))
    layout = nest_sheets(stadium(), LARGE, Search("best", should_stop=lambda: next(calls) > 4))
    assert (layout.status, layout.reproducible) == ("complete", False)


def test_best_stack_of_heights_by_hand() -> None:
    """Room 10: 4 + 6 is worth 5 + 8, two of 4 only 10, three of 3 (2 each) 6."""
    stacks = stack_up(np.array([3, 4, 6]), np.array([[2.0], [5.0], [8.0]]), 10)
    assert stacks.worth[-1, 0] == 13.0
    assert sorted(stacks.trace(0)) == [1, 2]


@pytest.mark.parametrize("lowest", [1, 2, 40])
def test_best_stacks_are_those_of_a_plain_knapsack(lowest: int) -> None:
    """Low items are compared all at once, high ones one after another: both against one level and item at a time."""
    chance = np.random.default_rng(lowest)
    heights = lowest + np.sort(chance.choice(100, 60, replace=False))
    heights[0], room = lowest, 300
    worth = np.round(heights * chance.uniform(0.8, 1.0, 60), 6)
    best = [0.0]
    for level in range(1, room + 1):
        pairs = zip(heights.tolist(), worth.tolist(), strict=True)
        best.append(max([best[-1], *(best[level - h] + w for h, w in pairs if h <= level)]))
    stacks = stack_up(heights, worth[:, None], room)
    np.testing.assert_allclose(stacks.worth[:, 0], best, atol=1e-9)
    found = stacks.trace(0)
    assert heights[found].sum() <= room
    assert worth[found].sum() == pytest.approx(best[-1])


def test_whole_numbers_of_columns_save_a_sheet_that_the_dive_loses() -> None:
    """Fifty rectangles of 1 to 35 mm on sheets of 40 mm: a dive alone ends with twelve sheets."""
    sizes = np.random.default_rng(3).integers(1, 36, (50, 2)).tolist()
    parts = [Part(k, trapezoid(w, h, 0, 0)) for k, (w, h) in enumerate(sizes)]
    stock = StockSettings(sheets=(SheetStock(name="s", width=40, height=40),), gap=0, turning="none")
    layout = nest_sheets(parts, stock, Search("normal"))
    assert len(layout.sheets) == layout.pattern_bound == 11


def test_whole_sheets_cover_all_pieces_at_the_cost_that_is_asked_or_none_are_given() -> None:
    """Seven squares of 30 mm on sheets of 60 mm, four on a sheet: two sheets, never one."""
    stock = StockSettings(sheets=(SheetStock(name="s", width=60, height=60),), gap=0)
    classes = sort_classes([Part("P", trapezoid(30, 30, 0, 0), 7)])
    rack, counts = make_rack(classes, stock), piece_counts(classes)
    master = make_master(counts)
    add_plans(master, fill_sheets(rack, counts, rack.areas))
    chosen = choose_sheets(rack, master, counts, 2.0)
    assert (len(chosen), pieces_of(chosen, 1).tolist()) == (2, [7])
    assert choose_sheets(rack, master, counts, 1.0) == []


def test_part_that_fits_only_the_dear_size_bounds_price_and_number() -> None:
    """Three long parts want a long sheet each, at 10, with 0.3 left over; nine square metres nine short ones at 1."""
    long, short = (SheetStock(name=n, width=w, height=1000, price=p) for n, w, p in (("l", 3000, 10), ("s", 1000, 1)))
    stock = StockSettings(sheets=(long, short), gap=0)
    outlines = [trapezoid(3000, 900, 0, 0)] * 3 + [trapezoid(1000, 1000, 0, 0)] * 9
    bound = bound_stock([shapely.Polygon(outline) for outline in outlines], stock)
    assert (bound.sheets, bound.price, bound.kind) == (6, 39.0, "lp")


def test_remnants_for_nothing_are_used_first() -> None:
    new = SheetStock(name="new", width=3000, height=2000, price=100)
    remnant = SheetStock(name="remnant", width=1000, height=1000, quantity=2)
    stock = StockSettings(sheets=(new, remnant), gap=5)
    layout = nest_sheets([Part("A", trapezoid(900, 900, 10, 10), 8)], stock, Search("normal"))
    assert sorted(sheet.stock for sheet in layout.sheets) == ["new", "remnant", "remnant"]
    assert (layout.price, layout.price_bound) == (100, 100)


def test_offcut_above_the_strips_is_credited() -> None:
    """One strip of 1000 on a sheet of 2000: what is above it and its cut of 6 is 2000 x 994."""
    stock = StockSettings(sheets=(SheetStock(name="s", width=2000, height=2000),), gap=6, kerf=6, turning="half")
    layout = nest_sheets([Part("A", trapezoid(997, 1000, 0, 0), 2)], stock)
    offcut = layout.offcut
    assert offcut is not None
    assert (offcut.width, offcut.height) == (2000, 994)
    assert layout.yield_with_offcut_percent == pytest.approx(100 * 2 * 0.997 / (4 - 2 * 0.994))
    assert (layout.cuts, layout.cut_length) == (2, 3000)


def test_slanted_cut_through_a_square_by_hand() -> None:
    square = np.array([[0, 0], [100, 0], [100, 100], [0, 100.0]])
    found = replay({"lines": [[[50, 0], [60, 100]]], "pieces": [{"placement": 0}, {}]}, square, 2.0)
    left, right = (freed.piece for freed in found.freed)
    slant = np.hypot(1, 0.1)
    assert found.cuts == pytest.approx((100 * slant,))
    assert left[:, 0].max() == pytest.approx(60 - slant)
    assert right[:, 0].min() == pytest.approx(50 + slant)


def rack_of(parts: list[Part], stock: StockSettings) -> tuple[Rack, Ints]:
    classes = sort_classes(parts)
    return make_rack(classes, stock), piece_counts(classes)


def test_a_lower_strip_may_lie_in_a_taller_slot() -> None:
    stock = LARGE.model_copy(update={"turning": "half"})
    rack, counts = rack_of([Part(1, trapezoid(1000, 800, 0, 0), 3)], stock)
    (strip,) = fill(rack.frames[0], counts, rack.areas).strips
    master = make_master(counts)
    add_strip(master, rack.frames[0], strip)
    add_stack(master, rack.frames[0], [900_000, 900_000])
    solution = solve(master, counts)
    assert solution.cost == pytest.approx(0.5)
    assert solution.slots == {(0, False, 800_000): pytest.approx(0.5), (0, False, 900_000): pytest.approx(0.5)}


@pytest.mark.parametrize(("parts", "stock"), [(dome(), SMALL), (stadium(), LARGE)], ids=["dome", "stadium"])
def test_offers_fit_and_bound_what_a_sheet_holds(parts: list[Part], stock: StockSettings) -> None:
    rack, counts = rack_of(parts, stock)
    worth = rack.areas * 1.2
    for offer in make_offers(rack, counts, worth, {}):
        frame = offer.frame
        full = fill(frame, counts, worth)
        assert worth[full.parts].sum() <= offer.most * frame.cost * (1 + 1e-9)
        assert offer.strips
        assert offer.stacks
        for strip in offer.strips:
            assert (np.bincount(strip_parts(strip), minlength=len(counts)) <= counts).all()
        for stack in offer.stacks:
            assert sum(height + frame.gap for height in stack) <= frame.room


def test_a_bound_by_worths_holds_for_every_cover() -> None:
    rack, counts = rack_of(stadium(), LARGE)
    most = max(offer.most for offer in make_offers(rack, counts, rack.areas, {}))
    assert rack.areas @ counts / most <= len(fill_sheets(rack, counts, rack.areas))


def test_the_best_effort_dives_into_the_emptiest_sheets() -> None:
    """Sheets filled part by part of the list, so that several are half empty whatever version of the solver."""
    rack, counts = rack_of(stadium()[::2], LARGE)
    shares = [np.where(np.arange(len(counts)) % 5 == k, counts, 0) for k in range(5)]
    first = [plan for share in shares for plan in fill_sheets(rack, share, rack.areas)]
    with gather(rack, 1) as crew:
        found = dive_part(rack, first, counts, Search("best"), crew, 10)
    assert (pieces_of(found.plans, len(counts)) == counts).all()
    assert len(found.plans) < len(first)


def test_columns_know_parts_of_which_just_the_box_fits() -> None:
    """Legs so unequal that a strip holds the box, but not the trapezoid with its set-up."""
    long = Part("A", np.array([[0, 0], [2980, 0], [2980, 800], [200, 800]], dtype=float), 6)
    stock = SMALL.model_copy(update={"turning": "half"})
    layout = nest_sheets([long], stock, Search("normal"))
    assert check_layout([long], stock, layout) == ()
    assert (len(layout.sheets), layout.pattern_bound) == (6, 6)
