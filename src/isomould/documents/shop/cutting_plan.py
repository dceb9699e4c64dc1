"""The cutting plan: a list of all sheets, and a page per sheet that shows what is cut where and in which order."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from isomould.documents.digits import shown
from isomould.documents.numbers import format_number
from isomould.documents.shop.font import drawable
from isomould.documents.shop.grid import grid, grid_size
from isomould.documents.shop.page import NORMAL, SMALL, SMALLEST, Book, Item, Page, Text, paper_size
from isomould.documents.shop.rows import Row, amount_text, length_text, schedule_rows
from isomould.documents.shop.sheet_view import SheetView, sheet_items
from isomould.documents.shop.title_block import Stationery, Subject, finish, room
from isomould.documents.shop.view import choose_paper, fit_scale, scale_text
from isomould.documents.stock_tables import offcut_rectangle, sheet_table
from isomould.nesting.layout import Layout, Placement, Sheet
from isomould.nesting.settings import StockSettings

TITLE = "Cutting plan"
_LISTED = ("sheet", "stock", "parts", "yield_percent", "cut_length_mm", "cuts", "offcut_width_mm", "offcut_height_mm")
_SHOWN = (*_LISTED[:3], "part_area_m2", *_LISTED[3:], "price")
_ROW, _LINE, _BESIDE = 1.8 * SMALLEST, 5.0, 6.0
_A4_ROOM = (150.0, 110.0)

Drawn = tuple[str, str, tuple[float, float], list[Item]]
"""Part or nothing, scale, size of a page, what is on it."""


@dataclass(frozen=True, eq=False)
class _Plan:
    """A layout with what its pages say again and again."""

    layout: Layout
    stock: StockSettings
    stationery: Stationery

    @cached_property
    def rows(self) -> list[Row]:
        """The schedule of the sheets, as texts."""
        return schedule_rows(sheet_table(self.layout, self.stock))

    @cached_property
    def headers(self) -> dict[str, str]:
        """What the columns of that schedule are called."""
        return {column.name: column.header for column in sheet_table(self.layout, self.stock).columns}

    @cached_property
    def on(self) -> dict[str, list[Placement]]:
        """The placements of every sheet, in the order in which they are cut free."""
        order = {sheet: list(_freed(tree)) for sheet, tree in self.layout.cut_trees.items()}
        lying: dict[str, list[int]] = {sheet.id: [] for sheet in self.layout.sheets}
        for k, placement in enumerate(self.layout.placements):
            lying[placement.sheet].append(k)
        return {name: [self.layout.placements[k] for k in order.get(name, found)] for name, found in lying.items()}


def _freed(tree: dict[str, Any]) -> Iterator[int]:
    """Give the placements of a cutting tree in the order in which they fall."""
    if "placement" in tree:
        yield tree["placement"]
    for piece in tree.get("pieces", []):
        yield from _freed(piece)


def cutting_plan(stationery: Stationery, layout: Layout, stock: StockSettings) -> Book:
    """Draw the cutting plan of a layout."""
    plan = _Plan(layout, stock, stationery)
    drawn = [*_cover(plan), *(page for k in range(len(layout.sheets)) for page in _sheet(plan, k))]
    pages = [
        _named(finish(stationery, Subject(TITLE, part, scale, k, len(drawn)), size, items), part, k)
        for k, (part, scale, size, items) in enumerate(drawn, start=1)
    ]
    return Book("cutting-plan", TITLE, tuple(pages))


def _named(page: Page, part: str, number: int) -> Page:
    return page if part else Page(f"{TITLE} {number}", page.size, page.items)


# --- the list of all sheets


def _cover(plan: _Plan) -> Iterator[Drawn]:
    """List all sheets, as many to a page as fit, and what found no place."""
    size = paper_size(plan.stationery.paper or "A4", lying=True)
    left, bottom, _, top = room(plan.stationery, size)
    items: list[Item] = []
    for k, text in enumerate(_headlines(plan)):
        items.append(Text(text, (left, top - NORMAL - _LINE * k), SMALL if k else NORMAL, bold=not k))
    top -= _LINE * len(items) + NORMAL
    for rows in _tables(plan):
        heading, lines = rows[0], rows[1:]
        while lines:
            most = int((top - bottom) // _ROW) - 1
            if most > 0:
                taken, lines = lines[:most], lines[most:]
                items += grid([heading, *taken], (left, top), SMALLEST)
                top -= _ROW * (len(taken) + 1) + _LINE
            if lines:
                yield "", "-", size, items
                items, top = [], room(plan.stationery, size)[3]
    yield "", "-", size, items


def _headlines(plan: _Plan) -> list[str]:
    """Say what the layout is worth."""
    layout, stock = plan.layout, plan.stock
    count = f"{len(layout.sheets)} {'sheet' if len(layout.sheets) == 1 else 'sheets'}, {len(layout.placements)} parts"
    found = [
        count,
        f"No layout needs fewer than {layout.bound} ({layout.bound_kind} bound): {layout.gap_to_bound} above it",
        f"Yield {percent_text(layout.yield_percent)} %",
        f"Gap {length_text(stock.gap)} mm, kerf {length_text(stock.kerf)} mm, trim {length_text(stock.trim)} mm",
    ]
    if layout.offcut:
        width, height = length_text(layout.offcut.width), length_text(layout.offcut.height)
        credited = percent_text(layout.yield_with_offcut_percent)
        found.append(f"Largest offcut {width} x {height} mm on {layout.offcut.sheet}; with it credited {credited} %")
    if layout.price:
        price, least = format_number(layout.price, 2), format_number(layout.price_bound, 2)
        found.append(f"Price {price}; no layout costs less than {least}")
    if layout.cuts:
        length = length_text(layout.cut_length)
        found.append(f"{layout.cuts} cuts from edge to edge, {length} mm; the trim is not counted")
    if layout.no_cuts:
        found.append(f"No cuts from edge to edge: {layout.no_cuts}")
    if layout.status != "complete" or not layout.reproducible:
        found.append(f"Status {layout.status}{'' if layout.reproducible else '; stopped early, not reproducible'}")
    return found


def percent_text(value: float) -> str:
    """Write a percentage with the digits that people read."""
    return shown(value, "%")


def _tables(plan: _Plan) -> list[list[tuple[str, ...]]]:
    priced = any(float(row["price"] or 0) for row in plan.rows)
    columns = (*_LISTED, *(["price"] if priced else []))
    materials = [str(sheet.material) for sheet in plan.layout.sheets]
    said = [(drawable(material),) if any(materials) else () for material in materials]
    heading = (*(plan.headers[name] for name in columns), *(["Material"] if any(materials) else []))
    listed = [tuple(drawable(amount_text(name, row[name])) for name in columns) for row in plan.rows]
    tables = [[heading, *((*row, *material) for row, material in zip(listed, said, strict=True))]]
    left = Counter((str(one.id), one.reason, one.needs) for one in plan.layout.unplaced)
    lost = [(drawable(mark), str(n), drawable(why), *map(length_text, needs)) for (mark, why, needs), n in left.items()]
    lost_heading = ("No place for", "Pieces", "Reason", "Needs width (mm)", "Needs height (mm)")
    return [*tables, *([[lost_heading, *lost]] if lost else [])]


# --- the page of a sheet


def _sheet(plan: _Plan, number: int) -> Iterator[Drawn]:
    sheet, row = plan.layout.sheets[number], plan.rows[number]
    placements = plan.on[sheet.id]
    size = paper_size(_paper(plan, sheet, len(placements)), lying=True)
    left, bottom, right, top = room(plan.stationery, size)
    data = [(plan.headers[name], drawable(amount_text(name, row[name]))) for name in _SHOWN if row[name]]
    data.insert(2, ("Size (mm)", f"{length_text(sheet.width)} x {length_text(sheet.height)}"))
    if str(sheet.material):
        data.insert(3, ("Material", drawable(str(sheet.material))))
    parts = _part_rows(placements)
    beside = [grid_size(data)[0], grid_size(parts, SMALLEST)[0]]
    column = right - max(beside)
    items = grid(data, (column, top), heading=False)
    under = top - grid_size(data)[1] - _BESIDE
    most = int((under - bottom) // _ROW) - 1
    items += grid(parts[: most + 1], (column, under), SMALLEST)
    view = SheetView(sheet, placements, plan.stock.trim, offcut_rectangle(sheet, placements, plan.stock))
    scale, drawn = sheet_items(view, (left, bottom, column - _BESIDE, top))
    yield sheet.id, scale_text(scale), size, [*items, *drawn]
    yield from _further(plan, sheet, parts, parts[most + 1 :])


def _paper(plan: _Plan, sheet: Sheet, parts: int) -> Any:
    """Take A4 where the sheet is drawn at 1:20 there and the list of its parts is short."""
    scale = fit_scale((sheet.width, sheet.height), _A4_ROOM)
    return choose_paper(plan.stationery.paper, scale if parts <= 25 else 1e9)


def _part_rows(placements: Sequence[Placement]) -> list[tuple[str, ...]]:
    """List the parts in the order in which they are cut free."""
    located = any(p.location for p in placements)
    heading = ("No", "Part", *(["Location"] if located else []), "Turned °")
    rows = [
        (str(k), drawable(str(p.id)), *([drawable(p.location or "")] if located else []), _turn(p))
        for k, p in enumerate(placements, start=1)
    ]
    return [heading, *rows]


def _turn(placement: Placement) -> str:
    return f"{placement.rotation_deg}{', over' if placement.turned_over else ''}"


def _further(
    plan: _Plan, sheet: Sheet, parts: list[tuple[str, ...]], left_over: list[tuple[str, ...]]
) -> Iterator[Drawn]:
    """List the parts that found no room beside their sheet, in columns on pages of their own."""
    size = paper_size(plan.stationery.paper or "A4", lying=True)
    left, bottom, right, top = room(plan.stationery, size)
    most = int((top - bottom) // _ROW) - 1
    width = grid_size(parts, SMALLEST)[0] + _BESIDE
    across = max(int((right - left + _BESIDE) // width), 1)
    for page, start in enumerate(range(0, len(left_over), most * across), start=2):
        items: list[Item] = []
        for k in range(across):
            rows = left_over[start + k * most : start + (k + 1) * most]
            items += grid([parts[0], *rows], (left + k * width, top), SMALLEST) if rows else []
        yield f"{sheet.id} ({page})", "-", size, items
