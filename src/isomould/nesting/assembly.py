"""From planned sheets to a layout: coordinates in mm, marks and locations, sheet numbers."""

from collections import Counter, deque
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.nesting.bound import Bound, room_inside
from isomould.nesting.layout import BLANK, CutTree, Id, Layout, Placement, Sheet, Unplaced
from isomould.nesting.placing import Laid, Placed, Saw, map_tree, place
from isomould.nesting.rack import PartClass, box
from isomould.nesting.settings import StockSettings
from isomould.nesting.shapes import UM, round_away
from isomould.nesting.sheets import SheetPlan

Piece = tuple[Id, str | None]


@dataclass(frozen=True, eq=False)
class Filled:
    """A sheet without a number; the cut tree counts placements from 0."""

    stock: str
    width: float
    height: float
    placed: tuple[tuple[Piece, Placed], ...]
    tree: CutTree
    price: float = 0.0


@dataclass(frozen=True, eq=False)
class Filling:
    """Sheets filled with some classes, and the pieces that found no place."""

    filled: tuple[Filled, ...]
    left: tuple[tuple[Piece, Floats], ...]


def fill_stock(plans: Sequence[SheetPlan], classes: Sequence[PartClass], stock: StockSettings) -> Filling:
    """Give the planned stock sheets their coordinates."""
    queues = [deque(kind.pieces) for kind in classes]
    different = {id(plan): plan for plan in plans}
    laid = {key: _laid(plan, stock) for key, plan in different.items()}
    filled = [_stock_sheet(plan, laid[id(plan)], queues, stock) for plan in plans]
    return Filling(tuple(filled), _left(queues, classes))


def fill_blanks(plans: Sequence[SheetPlan], classes: Sequence[PartClass], stock: StockSettings) -> Filling:
    """Give the planned blanks their coordinates, and the size that they need."""
    queues = [deque(kind.pieces) for kind in classes]
    return Filling(tuple(_blank(plan, queues, stock) for plan in plans), _left(queues, classes))


def _left(queues: Sequence[deque[Piece]], classes: Sequence[PartClass]) -> tuple[tuple[Piece, Floats], ...]:
    return tuple((piece, kind.outline) for queue, kind in zip(queues, classes, strict=True) for piece in queue)


def _laid(plan: SheetPlan, stock: StockSettings) -> Laid:
    """Place a plan on its stock sheet; equal sheets share what comes of it."""
    sheet = stock.sheets[plan.frame.stock]
    room = room_inside(sheet.width, sheet.height, stock.trim)
    return _moved(plan, stock, room.height if plan.frame.turned else room.width)


def _stock_sheet(plan: SheetPlan, laid: Laid, queues: Sequence[deque[Piece]], stock: StockSettings) -> Filled:
    sheet = stock.sheets[plan.frame.stock]
    placed, tree = laid
    return Filled(sheet.name, sheet.width, sheet.height, _marked(placed, queues), tree, sheet.price)


def _blank(plan: SheetPlan, queues: Sequence[deque[Piece]], stock: StockSettings) -> Filled:
    placed, tree = _moved(plan, stock, 0)
    size = np.max([item.points.max(axis=0) for item in placed], axis=0) + round_away(stock.trim * UM)
    return Filled(BLANK, float(size[0]) / UM, float(size[1]) / UM, _marked(placed, queues), tree)


def _marked(placed: Sequence[Placed], queues: Sequence[deque[Piece]]) -> tuple[tuple[Piece, Placed], ...]:
    return tuple((queues[item.part].popleft(), item) for item in placed)


def _moved(plan: SheetPlan, stock: StockSettings, length: int) -> Laid:
    """Place a plan and move it inside the trim; the tree in mm."""
    trim = round_away(stock.trim * UM)
    saw = Saw(stock.gap * UM, round_away(stock.gap * UM), flips=stock.turning != "none")
    placed, tree = place(plan, saw, length)
    moved = [replace(item, points=item.points + trim) for item in placed]
    return moved, map_tree(tree, lambda line: [[(x + trim) / UM, (y + trim) / UM] for x, y in line], 0)


def make_layout(fillings: Sequence[Filling], bound: Bound, *, ended: bool) -> Layout:
    """Give the filled sheets their numbers and add up."""
    filled = [sheet for filling in fillings for sheet in filling.filled]
    digits = max(3, len(str(len(filled))))
    sheets = [Sheet(f"S{k + 1:0{digits}}", item.stock, item.width, item.height) for k, item in enumerate(filled)]
    placements = [
        _placement(sheet.id, *pair) for sheet, item in zip(sheets, filled, strict=True) for pair in item.placed
    ]
    left = tuple(_unplaced(*pair) for filling in fillings for pair in filling.left)
    return Layout(
        sheets=tuple(sheets),
        placements=tuple(placements),
        unplaced=left,
        bound=bound.sheets,
        bound_kind=bound.kind,
        price_bound=bound.price,
        price=sum(item.price for item in filled),
        yield_percent=yield_percent(sheets, placements),
        cut_trees=_number_trees(sheets, filled),
        status="incomplete" if left else "complete",
        reproducible=ended,
    )


def _placement(sheet: str, piece: Piece, placed: Placed) -> Placement:
    return Placement(*piece, sheet, placed.points_mm, placed.rotation_deg, placed.turned_over)


def _unplaced(piece: Piece, outline: Floats) -> Unplaced:
    return Unplaced(piece[0], "no sheet is left in stock", box(outline), piece[1])


def _number_trees(sheets: Sequence[Sheet], filled: Sequence[Filled]) -> dict[str, CutTree]:
    firsts = np.cumsum([0] + [len(item.placed) for item in filled]).tolist()
    rows = zip(sheets, filled, firsts, strict=False)
    return {sheet.id: map_tree(item.tree, lambda line: line, first) for sheet, item, first in rows}


def yield_percent(sheets: Sequence[Sheet], placements: Sequence[Placement]) -> float:
    """Give the true area of the parts as a percentage of the area of the sheets."""
    area = sum(sheet.width * sheet.height for sheet in sheets)
    # Equal sheets share the points of their placements.
    times = Counter(id(item.points) for item in placements)
    different = {id(item.points): item.points for item in placements}
    used = sum(times[key] * shapely.Polygon(points).area for key, points in different.items())
    return 100 * used / area if area else 0.0
