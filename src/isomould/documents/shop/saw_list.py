"""The saw list: a list of all bars, then every bar with its cuts in order from the left end, and what is left."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from isomould.documents.numbers import format_number
from isomould.documents.shop.font import drawable
from isomould.documents.shop.grid import grid, grid_size
from isomould.documents.shop.page import NORMAL, SMALL, SMALLEST, Book, Item, Page, Text, paper_size
from isomould.documents.shop.rows import Row, length_text, schedule_rows
from isomould.documents.shop.title_block import Stationery, Subject, finish, room
from isomould.documents.stock_tables import bar_table, saw_table
from isomould.documents.table import Table
from isomould.nesting.layout import BarLayout
from isomould.nesting.settings import StockSettings

TITLE = "Saw list"
_CUT = ("cut", "mark", "location", "position_mm", "length_mm", "bar_turned")
_ROW, _LINE, _BESIDE, _UNDER = 1.8 * SMALLEST, 5.0, 6.0, 5.0
_FEW = 3
"""Rows that a table has at least before it goes on elsewhere."""

Cells = tuple[str, ...]


@dataclass(frozen=True)
class _Block:
    """A table: rows that are repeated where it goes on elsewhere, the first of them in bold, and the others."""

    head: tuple[Cells, ...]
    rows: tuple[Cells, ...]


def saw_list(stationery: Stationery, layout: BarLayout, stock: StockSettings) -> Book:
    """Draw the saw list of a layout of bars."""
    pages = [*_cover(stationery, layout, stock), *_flow(stationery, _bars(layout), [])]
    size = _paper(stationery)
    drawn = [
        finish(stationery, Subject(TITLE, "", "-", k, len(pages)), size, items) for k, items in enumerate(pages, 1)
    ]
    named = [Page(f"{TITLE} {k}", page.size, page.items) for k, page in enumerate(drawn, start=1)]
    return Book("saw-list", TITLE, tuple(named))


def _paper(stationery: Stationery) -> tuple[float, float]:
    return paper_size(stationery.paper or "A4", lying=True)


def _cover(stationery: Stationery, layout: BarLayout, stock: StockSettings) -> list[list[Item]]:
    """List all bars, and what found none, under what the layout is worth."""
    left, _, _, top = room(stationery, _paper(stationery))
    texts = list(_headlines(layout, stock))
    items: list[Item] = [
        Text(text, (left, top - NORMAL - _LINE * k), SMALL if k else NORMAL, bold=not k) for k, text in enumerate(texts)
    ]
    table, priced = bar_table(layout, stock), any(bar.price for bar in stock.bars)
    blocks = [_listed(table, [column.name for column in table.columns if priced or column.name != "price"])]
    left_over = Counter((str(one.id), one.reason, one.needs[0]) for one in layout.unplaced)
    lost = [(drawable(mark), str(n), drawable(why), length_text(need)) for (mark, why, need), n in left_over.items()]
    if lost:
        blocks.append(_Block((("No place for", "Pieces", "Reason", "Needs length (mm)"),), tuple(lost)))
    return _flow(stationery, blocks, items, below=_LINE * len(texts) + NORMAL)


def _headlines(layout: BarLayout, stock: StockSettings) -> Iterator[str]:
    pieces = sum(len(bar.cuts) for bar in layout.bars)
    yield f"{len(layout.bars)} {'bar' if len(layout.bars) == 1 else 'bars'}, {pieces} pieces"
    yield f"No cutting needs fewer than {layout.bound} ({layout.bound_kind} bound): {layout.gap_to_bound} above it"
    yield f"Kerf {length_text(stock.bar_kerf)} mm, trim {length_text(stock.bar_trim)} mm at each end"
    if layout.price:
        price, least = format_number(layout.price, 2), format_number(layout.price_bound, 2)
        yield f"Price {price}; no cutting costs less than {least}"
    if layout.status != "complete":
        yield f"Status {layout.status}"


def _bars(layout: BarLayout) -> list[_Block]:
    """Give a table per bar: its name and stock, its cuts, its offcut."""
    table, found = saw_table(layout), dict[str, list[Row]]()
    rows = schedule_rows(table)
    for row in rows:
        found.setdefault(row["bar"], []).append(row)
    says = {
        "location": any(row["location"] for row in rows),
        "bar_turned": any(row["bar_turned"] != "none" for row in rows),
    }
    names = [name for name in _CUT if says.get(name, True)]
    headers = {column.name: column.header for column in table.columns}
    return [_bar(cuts, names, headers) for cuts in found.values()]


def _bar(cuts: Sequence[Row], names: Sequence[str], headers: Mapping[str, str]) -> _Block:
    first, last = cuts[0], cuts[-1]
    stock = {"cut": first["bar"], "mark": drawable(first["stock"])}
    offcut = {"mark": headers["offcut_mm"], "length_mm": last["offcut_mm"]}
    rows = [tuple(drawable(cut[name]) for name in names) for cut in cuts]
    heads = (tuple(headers[name] for name in names), tuple(stock.get(name, "") for name in names))
    return _Block(heads, (*rows, tuple(offcut.get(name, "") for name in names)))


def _listed(table: Table, names: Sequence[str]) -> _Block:
    headers = {column.name: column.header for column in table.columns}
    rows = [tuple(drawable(row[name]) for name in names) for row in schedule_rows(table)]
    return _Block((tuple(headers[name] for name in names),), tuple(rows))


def _flow(stationery: Stationery, blocks: Sequence[_Block], items: list[Item], below: float = 0.0) -> list[list[Item]]:
    """Set tables below each other, in columns beside each other, on as many pages as it takes."""
    left, bottom, right, top = room(stationery, _paper(stationery))
    pages, x, first = [list(items)], left, top - below
    y, width = first, max((grid_size((*b.head, *b.rows), SMALLEST)[0] for b in blocks), default=0.0)
    for block in blocks:
        rows = block.rows
        while rows:
            most = int((y - bottom) / _ROW) - len(block.head)
            if most >= min(len(rows), _FEW):
                taken, rows = rows[:most], rows[most:]
                pages[-1] += grid([*block.head, *taken], (x, y), SMALLEST)
                y -= _ROW * (len(block.head) + len(taken)) + _UNDER
            elif x + 2 * width + _BESIDE <= right:
                x, y = x + width + _BESIDE, first
            else:
                pages, x, y, first = [*pages, []], left, top, top
    return pages
