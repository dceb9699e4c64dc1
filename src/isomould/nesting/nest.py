"""Panels on sheets and in blanks. Every layout that leaves this room has been proved by `checker`."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from isomould.errors import Gathering, Refused
from isomould.nesting.assembly import Filling, fill_blanks, fill_stock, make_layout
from isomould.nesting.bound import Bound, bound_stock, dilated_area, grown_rectangle, sheets_for
from isomould.nesting.checker import check_layout
from isomould.nesting.cover import fill_sheets
from isomould.nesting.layout import Id, Layout, Part, Sheet
from isomould.nesting.offcuts import measure_cuts
from isomould.nesting.portfolio import find_plans
from isomould.nesting.rack import (
    PartClass,
    blank_length,
    box,
    make_blank_rack,
    make_rack,
    piece_counts,
    refuse_oversize,
    sort_classes,
)
from isomould.nesting.scoring import refuse_unscorable
from isomould.nesting.search import Found, Search
from isomould.nesting.settings import StockSettings
from isomould.nesting.shapes import micrometres

NOTHING = Found([], ended=True)


def nest_sheets(parts: Sequence[Part], stock: StockSettings, task: Search | None = None) -> Layout:
    """Nest parts on the stock sheets.

    Returns
    -------
    Layout
        Proved by `check_layout`. Pieces for which no sheet is left in stock are listed as unplaced;
        `reproducible` is False if the task was told to stop.

    Raises
    ------
    Refused
        If a part fits no sheet, or cannot be scored free where the gap is 0.
    """
    refuse_unnestable(parts, stock)
    classes = sort_classes(parts)
    found = _search(classes, stock, task or Search()) if classes else NOTHING
    filling = fill_stock(found.plans, classes, stock)
    polygons = {part.id: part.polygon for part in parts}
    placed = [polygons[item[0][0]] for sheet in filling.filled for item in sheet.placed]
    layout = make_layout([filling], bound_stock(placed, stock), ended=found.ended)
    layout = replace(layout, sheets=of_material(layout, parts, stock), pattern_bound=found.pattern_bound)
    return prove(parts, stock, layout)


def of_material(layout: Layout, parts: Sequence[Part], stock: StockSettings) -> tuple[Sheet, ...]:
    """Give the sheets with what they are made of: what their parts say, and what is said of the stock besides."""
    of_part = {part.id: part.material for part in parts}
    of_stock = {kind.name: kind.made_of for kind in stock.sheets}
    on = {item.sheet: of_part[item.id] for item in layout.placements}
    return tuple(replace(sheet, material=on[sheet.id].completed(of_stock[sheet.stock])) for sheet in layout.sheets)


def _search(classes: Sequence[PartClass], stock: StockSettings, task: Search) -> Found:
    rack = make_rack(classes, stock, coarse=task.hastens(len(classes)))
    return find_plans(rack, piece_counts(classes), task)


def nest_blanks(parts: Sequence[Part], stock: StockSettings) -> Layout:
    """Nest every row of parts head to tail in blanks to order, at most `max_blank_length` long.

    Parts without a row are sorted by their height. The bound counts the blanks of every row by area.

    Raises
    ------
    Refused
        If a part is longer than the longest blank.
    """
    stock = stock.model_copy(update={"sheets": ()})
    refuse_unnestable(parts, stock)
    rows = _rows(parts)
    fillings = [_blanks(row, stock) for row in rows]
    bound = sum(_blank_bound(row, stock) for row in rows)
    return prove(parts, stock, make_layout(fillings, Bound(bound, 0.0, "area"), ended=True))


def refuse_unnestable(parts: Sequence[Part], stock: StockSettings) -> None:
    """Refuse parts that no nesting on these sheets places, or without sheets in blanks to order.

    Raises
    ------
    Refused
        If a part is larger than every sheet or blank, or cannot be scored free where the gap is 0.
    """
    with Gathering() as faults:
        faults.run(refuse_oversize if stock.sheets else _refuse_long, parts, stock)
        faults.run(refuse_unscorable, parts, stock)


def _rows(parts: Sequence[Part]) -> list[list[Part]]:
    """Give the parts row by row, in the order in which the rows first come."""
    rows = dict[tuple[bool, Id | float], list[Part]]()
    for part in parts:
        key = (True, part.row) if part.row is not None else (False, box(part.outline)[1])
        rows.setdefault(key, []).append(part)
    return list(rows.values())


def _blanks(row: Sequence[Part], stock: StockSettings) -> Filling:
    classes = sort_classes(row)
    rack = make_blank_rack(classes, stock)
    return fill_blanks(fill_sheets(rack, piece_counts(classes), rack.areas), classes, stock)


def _blank_bound(row: Sequence[Part], stock: StockSettings) -> int:
    height = max(box(part.outline)[1] for part in row)
    need = dilated_area([part.polygon for part in row for _ in range(part.quantity)], stock.gap)
    return sheets_for(need, grown_rectangle(stock.max_blank_length - 2 * stock.trim, height, stock.gap))


def _refuse_long(parts: Sequence[Part], stock: StockSettings) -> None:
    for part in parts:
        if np.ptp(micrometres(part.outline)[:, 0]) > blank_length(stock):
            length = box(part.outline)[0] + 2 * stock.trim
            limit = f"blanks of at most {stock.max_blank_length:g} mm"
            way_out = "Raise stock.max_blank_length or divide the part."
            raise Refused("E-NEST-02", f"part {part.id}", f"{length:g} mm long with the trim", limit, way_out)


def prove(parts: Sequence[Part], stock: StockSettings, layout: Layout) -> Layout:
    """Measure the cuts of a layout and give it back if the checker finds nothing wrong with it.

    Raises
    ------
    AssertionError
        A fault of this program, never of its input.
    """
    layout = measure_cuts(layout, stock)
    findings = check_layout(parts, stock, layout)
    if findings:
        message = f"the layout failed its own check ({len(findings)} findings): {findings[0]}"
        raise AssertionError(message)
    return layout
