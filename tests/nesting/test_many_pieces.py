"""Many pieces of few kinds: work on patterns and counts, the proof too."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from nesting_examples import rows_of_trapezoids, trapezoid

from isomould.nesting import offcuts, search
from isomould.nesting.checker import check_layout
from isomould.nesting.cover import pieces_of
from isomould.nesting.crew import Order, gather
from isomould.nesting.cut_checker import Replay, replay
from isomould.nesting.files import layout_to_json
from isomould.nesting.layout import Part
from isomould.nesting.nest import nest_sheets
from isomould.nesting.rack import make_rack, piece_counts, sort_classes
from isomould.nesting.search import Effort, Search
from isomould.nesting.settings import SheetStock, StockSettings
from isomould.nesting.sheets import SheetPlan
from isomould.nesting.twins import first_twins

STOCK = StockSettings(sheets=(SheetStock(name="s", width=3000, height=1500),), gap=5, trim=10)
PANEL = Part("A", trapezoid(600, 450, 30, 50), 300)
MIX = (
    replace(PANEL, quantity=100),
    Part("B", trapezoid(900, 700, 20, 20), 40),
    Part("C", trapezoid(400, 340, 0, 60), 80),
)
LAYOUT = nest_sheets([PANEL], STOCK, Search("quick"))


def test_equal_sheets_are_replayed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []

    def counted(tree: object, *rest: object) -> Replay:
        asked.append(tree)
        return replay(tree, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(offcuts, "replay", counted)
    layout = nest_sheets([replace(PANEL, quantity=3000)], STOCK, Search("quick"))
    assert len(layout.sheets) >= 200
    assert len(asked) <= 4


def test_cuts_of_twins_are_counted_each() -> None:
    lengths = [
        replay(tree, np.array([[10, 10], [2990, 10], [2990, 1490], [10, 1490]]), 0).cuts
        for tree in LAYOUT.cut_trees.values()
    ]
    assert LAYOUT.cuts == sum(map(len, lengths))
    assert LAYOUT.cut_length == pytest.approx(sum(map(sum, lengths)))


@pytest.mark.parametrize("moved", [0, -20])
def test_a_fault_on_one_of_many_equal_sheets_is_found(moved: int) -> None:
    """Shifted by 0.01 mm a piece breaks its gap; its sheet is a twin no more."""
    items = list(LAYOUT.placements)
    items[moved] = replace(items[moved], points=np.round(items[moved].points + np.array([0.01, 0.0]), 3))
    faulty = replace(LAYOUT, placements=tuple(items))
    assert {finding.code for finding in check_layout([PANEL], STOCK, faulty)} & {"N-GAP-01", "N-EDGE-01", "N-CUT-03"}


def test_a_tree_that_frees_a_piece_of_another_sheet_is_no_twin() -> None:
    one, other = (sheet.id for sheet in LAYOUT.sheets[:2])
    assert first_twins(LAYOUT, {})[other] == one
    faulty = replace(LAYOUT, cut_trees={**LAYOUT.cut_trees, other: LAYOUT.cut_trees[one]})
    assert first_twins(faulty, {})[other] == other
    assert [finding.code for finding in check_layout([PANEL], STOCK, faulty)] == ["N-CUT-02"]


def test_twins_have_parts_of_one_outline() -> None:
    """A part of another list that is told to have the same place is not that part."""
    small = replace(PANEL, id="B", outline=PANEL.outline * np.array([0.5, 1.0]), quantity=1)
    items = [replace(item, id="B") if item is LAYOUT.placements[40] else item for item in LAYOUT.placements]
    faulty = replace(LAYOUT, placements=tuple(items))
    found = check_layout([replace(PANEL, quantity=299), small], STOCK, faulty)
    assert [finding.code for finding in found] == ["N-PLACE-02"]


@pytest.mark.parametrize("effort", ["quick", "normal"])
def test_many_pieces_take_as_many_sheets_as_their_share(effort: Effort) -> None:
    """Five times the pieces: at most five times the sheets, and the same layout on one core as on two."""
    few, many = (
        nest_sheets([replace(p, quantity=p.quantity * times) for p in MIX], STOCK, Search(effort)) for times in (1, 5)
    )
    assert len(many.sheets) <= 5 * len(few.sheets)
    again = nest_sheets([replace(p, quantity=p.quantity * 5) for p in MIX], STOCK, Search(effort, jobs=2))
    assert layout_to_json(again) == layout_to_json(many)


def test_a_hasty_search_stays_near_the_fine_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Small pools on a coarse grid: proved like all others, and at most a sheet more."""
    parts = rows_of_trapezoids(4, 10, 24)
    stock = StockSettings(sheets=(SheetStock(name="glass", width=6000, height=3210),), gap=5, trim=20)
    fine = nest_sheets(parts, stock, Search("quick"))
    monkeypatch.setattr(search, "HASTY", 100)
    monkeypatch.setattr(search, "POOL", 120)
    monkeypatch.setattr(search, "SMALL_POOL", 60)
    hasty = nest_sheets(parts, stock, Search("quick"))
    assert check_layout(parts, stock, hasty) == ()
    assert len(hasty.sheets) <= len(fine.sheets) + 1


def test_scarce_kinds_stop_only_the_sheets_that_have_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 3,600 pieces a few dozen are scarce: sheets without them are cut again, so that few pools are filled."""
    monkeypatch.setattr(search, "POOL", 100)
    chance = np.random.default_rng(4)
    sizes = [(a, h, 300 if k < 12 else 7) for k, (a, h) in enumerate(chance.uniform(250, 900, (18, 2)))]
    classes = sort_classes([Part(k, trapezoid(a, h, 20, 20), many) for k, (a, h, many) in enumerate(sizes)])
    rack, counts = make_rack(classes, STOCK), piece_counts(classes)
    pools: list[int] = []
    with gather(rack, 1) as crew:

        def counted(orders: Sequence[Order]) -> list[list[SheetPlan]]:
            pools.append(len(orders))
            return crew(orders)

        plans = search.first_sheets(rack, counts, Search("quick"), counted)
    assert (pieces_of(plans, len(counts)) == counts).all()
    assert len(pools) <= 6
