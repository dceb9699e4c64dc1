"""A checker that has never failed proves nothing: seeded faults, each of which it must find."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from nesting_examples import GLASS, located, rows_of_trapezoids, trapezoid

from isomould.arrays import Floats
from isomould.nesting.checker import check_layout
from isomould.nesting.layout import Layout, Offcut, Part, Placement, Sheet, Unplaced
from isomould.nesting.nest import nest_sheets
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings

STOCK = StockSettings(sheets=(GLASS.model_copy(update={"quantity": 9}),), gap=5, kerf=3, trim=20)
PARTS = (
    *(located(part) for part in rows_of_trapezoids(1, 2, 5)),
    located(Part("R", trapezoid(700, 500, 0, 40), 3)),
)
LAYOUT = nest_sheets(PARTS, STOCK, Search("quick"))

Fault = Callable[[Layout], Layout]


def change(index: int, **values: Any) -> Fault:
    def fault(layout: Layout) -> Layout:
        items = list(layout.placements)
        items[index] = replace(items[index], **values)
        return replace(layout, placements=tuple(items))

    return fault


def move(index: int, x: float, y: float) -> Fault:
    return change(index, points=np.round(LAYOUT.placements[index].points + np.array([x, y]), 3))


def neighbour_shift(missing: float) -> Fault:
    """Move the first part towards the second until the gap is short by so much."""
    one, other = LAYOUT.placements[0], LAYOUT.placements[1]
    towards = np.sign(other.points.mean(axis=0) - one.points.mean(axis=0))
    step = towards * (np.abs(other.points.mean(axis=0) - one.points.mean(axis=0)) > 400)
    return move(0, *(missing * step))


def mirrored() -> Floats:
    points = piece("R").points.copy()
    points[:, 0] = points[:, 0].min() + points[:, 0].max() - points[:, 0]
    return np.round(points, 3)


def piece(mark: str) -> Placement:
    return next(item for item in LAYOUT.placements if item.id == mark)


def index_of(mark: str) -> int:
    return LAYOUT.placements.index(piece(mark))


def lose_last(layout: Layout) -> Layout:
    return replace(layout, placements=layout.placements[:-1])


def double_first(layout: Layout) -> Layout:
    return replace(layout, placements=(*layout.placements, layout.placements[0]))


def swap_sheet(layout: Layout) -> Layout:
    last = max(sheet.id for sheet in layout.sheets)
    return change(0, sheet=last)(layout) if last != layout.placements[0].sheet else lose_last(layout)


def widen_sheet(layout: Layout) -> Layout:
    return replace(layout, sheets=tuple(replace(sheet, width=sheet.width + 100) for sheet in layout.sheets))


def empty_sheet(layout: Layout) -> Layout:
    return replace(layout, sheets=(*layout.sheets, Sheet("S999", "glass", 6000, 3210)))


def flip_cut(layout: Layout) -> Layout:
    trees = {name: tree | {"lines": [[b, a] for a, b in tree["lines"]]} for name, tree in layout.cut_trees.items()}
    return replace(layout, cut_trees=trees)


def shift_cuts(layout: Layout) -> Layout:
    def shifted(tree: dict[str, Any]) -> dict[str, Any]:
        lines = [[[x + 1.1, y + 1.1] for x, y in line] for line in tree.get("lines", [])]
        return tree | {"lines": lines, "pieces": [shifted(p) for p in tree["pieces"]]} if lines else tree

    return replace(layout, cut_trees={name: shifted(tree) for name, tree in layout.cut_trees.items()})


FAULTS: dict[str, tuple[Fault, str]] = {
    "overlap": (move(0, 300, 0), "N-GAP-01"),
    "gap short by 2 um": (neighbour_shift(0.002), "N-GAP-01"),
    "outside the trim": (move(0, -6000, 0), "N-EDGE-01"),
    "mirrored": (change(index_of("R"), points=mirrored()), "N-PLACE-02"),
    "mirrored and said so": (change(index_of("R"), points=mirrored(), turned_over=True), "N-PLACE-04"),
    "rotation not told": (change(0, rotation_deg=90), "N-PLACE-02"),
    "odd rotation": (change(0, rotation_deg=45), "N-PLACE-02"),
    "stretched": (change(0, points=np.round(LAYOUT.placements[0].points * [1.001, 1], 3)), "N-PLACE-02"),
    "between micrometres": (change(0, points=LAYOUT.placements[0].points + 0.0004), "N-PLACE-01"),
    "not a number": (change(0, points=LAYOUT.placements[0].points * np.nan), "N-PLACE-01"),
    "lost": (lose_last, "N-QUANTITY-01"),
    "doubled": (double_first, "N-QUANTITY-01"),
    "other mark": (
        change(0, id="R", points=piece("R").points, rotation_deg=piece("R").rotation_deg),
        "N-QUANTITY-01",
    ),
    "unknown mark": (change(0, id="Q"), "N-NAME-03"),
    "unknown sheet": (change(0, sheet="S777"), "N-NAME-04"),
    "empty sheet": (empty_sheet, "N-NAME-05"),
    "location twice": (change(0, location=LAYOUT.placements[1].location), "N-LOCATION-01"),
    "other sheet": (swap_sheet, "N-"),
    "sheet not in stock": (widen_sheet, "N-STOCK-01"),
    "yield": (lambda layout: replace(layout, yield_percent=layout.yield_percent + 0.001), "N-AREA-01"),
    "bound too high": (lambda layout: replace(layout, bound=99), "N-AREA-02"),
    "incomplete": (lambda layout: replace(layout, status="incomplete"), "N-QUANTITY-02"),
    "unplaced too": (
        lambda layout: replace(layout, unplaced=(Unplaced("R", "", (1.0, 1.0)),), status="incomplete"),
        "N-QUANTITY-01",
    ),
    "no cuts": (lambda layout: replace(layout, cut_trees={}), "N-CUT-01"),
    "cut through parts": (flip_cut, "N-CUT-03"),
    "cut off its kerf": (shift_cuts, "N-CUT-03"),
    "cuts without pieces": (
        lambda layout: replace(layout, cut_trees={k: t | {"pieces": []} for k, t in layout.cut_trees.items()}),
        "N-CUT-04",
    ),
    "offcut on a part": (lambda layout: replace(layout, offcut=Offcut("S001", 20, 20, 500, 500)), "N-OFFCUT-03"),
    "offcut over the edge": (lambda layout: replace(layout, offcut=Offcut("S001", 0, 0, 5, 5)), "N-OFFCUT-02"),
    "credited yield": (lambda layout: replace(layout, yield_with_offcut_percent=99.0), "N-OFFCUT-01"),
    "price": (lambda layout: replace(layout, price=1.0), "N-AREA-04"),
    "price bound too high": (lambda layout: replace(layout, price_bound=1.0), "N-AREA-04"),
    "cut tree of nothing": (lambda layout: replace(layout, cut_trees={"S001": {}}), "N-CUT-02"),
}


def test_good_layout_is_proved() -> None:
    assert check_layout(PARTS, STOCK, LAYOUT) == ()


@pytest.mark.parametrize(("fault", "code"), FAULTS.values(), ids=FAULTS.keys())
def test_fault_is_found(fault: Fault, code: str) -> None:
    codes = [finding.code for finding in check_layout(PARTS, STOCK, fault(LAYOUT))]
    assert any(found.startswith(code) for found in codes), codes


@pytest.mark.parametrize(
    ("stock", "code"),
    [
        (STOCK.model_copy(update={"sheets": (GLASS.model_copy(update={"quantity": 0}),)}), "N-STOCK-02"),
        (STOCK.model_copy(update={"gap": 5.01}), "N-GAP-01"),
        (STOCK.model_copy(update={"trim": 20.01}), "N-EDGE-01"),
        (STOCK.model_copy(update={"kerf": 5.1}), "N-CUT-03"),
        (STOCK.model_copy(update={"turning": "none"}), "N-PLACE-03"),
        (STOCK.model_copy(update={"sheets": (SheetStock(name="x", width=6000, height=3210),)}), "N-STOCK-01"),
    ],
)
def test_other_rules_are_found_broken(stock: StockSettings, code: str) -> None:
    assert code in {finding.code for finding in check_layout(PARTS, stock, LAYOUT)}


def touching(overlap: float) -> tuple[tuple[Part, ...], StockSettings, Layout]:
    square = trapezoid(100, 100, 0, 0)
    stock = StockSettings(sheets=(SheetStock(name="s", width=300, height=100),), gap=0, guillotine=False)
    placed = [Placement("A", None, "S1", np.round(square + np.array([x, 0.0]), 3), 0) for x in (0.1, 100.1 - overlap)]
    layout = Layout((Sheet("S1", "s", 300, 100),), tuple(placed), (), 1, "area", 200 / 3, {})
    return (Part("A", square, 2),), stock, layout


def test_parts_may_touch_without_a_gap() -> None:
    assert check_layout(*touching(0.0)) == ()


def test_overlap_by_a_micrometre_is_found() -> None:
    assert [finding.code for finding in check_layout(*touching(0.001))] == ["N-GAP-01"]
