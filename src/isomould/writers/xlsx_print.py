"""How a sheet looks and prints: column widths, wrapped headers, pages wide enough to read."""

import math
import re
from collections.abc import Sequence

from isomould.documents.columns import Column
from isomould.documents.info import ProjectInfo
from isomould.documents.table import Cell, Table, cells
from isomould.documents.title_block import heading
from isomould.writers.formulas import number_format
from isomould.writers.xlsx_page import WIDEST, Page, is_wrapped

_A3 = 8
_WIDEST_PX = 400
_CHARACTER_PX, _PADDING_PX, _FILTER_PX = 7, 9, 16
_NARROWEST = 5
"""Characters in a column."""
_SPARE = 6
"""Characters that a line of a wrapped text may fall short of its column, where a wider font stands in."""
_FIGURE = 15
"""Characters of a figure below a table."""
_PAGE_PX = 2100
"""What one A3 page holds of cells of 11 pt, printed at 8 pt; at 6 pt where a wider font stands in for Excel's own."""
_LINE_PT = 15
_HEADER_TEXT = 60


def set_up_print(page: Page, info: ProjectInfo) -> None:
    """Print landscape on A3 with header, footer, and the first row and column on every page."""
    sheet = page.sheet
    sheet.set_landscape()
    sheet.set_paper(_A3)
    sheet.set_margins(left=0.4, right=0.4, top=0.7, bottom=0.6)
    sheet.repeat_rows(0)
    sheet.set_header(f"&L{_header_text(heading(info))}&R&A")
    sheet.set_footer(f"&L{_header_text(info.client)}&RPage &P of &N")
    sheet.fit_to_pages(1, 0)


def fit_columns(page: Page) -> None:
    """Make columns as wide as their cells, wrap what is longer, and print as many pages wide as can be read."""
    widths = [_width(page.table, column) for column in page.table.columns]
    for index, width in enumerate(widths):
        page.sheet.set_column_pixels(index, index, _pixels(width))
    lines = [_lines(column.header, width) for column, width in zip(page.table.columns, widths, strict=True)]
    page.sheet.set_row(0, _LINE_PT * max(lines, default=1))
    _fit_rows(page)
    pages = math.ceil(sum(map(_pixels, widths)) / _PAGE_PX)
    page.sheet.fit_to_pages(pages, 0)
    if pages > 1:
        page.sheet.repeat_columns("A:A")


def _fit_rows(page: Page) -> None:
    """Make rows with wrapped texts as high as these; not every reader does it by itself."""
    wrapped = [cells(page.table, column) for column in page.table.columns if is_wrapped(page.table, column)]
    for row, texts in enumerate(zip(*wrapped, strict=True), start=1):
        lines = max(math.ceil(len(str(text)) / (WIDEST - _SPARE)) for text in texts)
        if lines > 1:
            page.sheet.set_row(row, _LINE_PT * lines)


def fit_texts(page: Page) -> None:
    """Make the columns of a sheet with texts below its table as wide as these, and those of numbers for the figures."""
    page.sheet.autofit(_WIDEST_PX)
    for index, column in enumerate(page.table.columns):
        if column.kind != "text":
            page.sheet.set_column_pixels(index, index, _pixels(max(_FIGURE, _width(page.table, column))))


def _pixels(width: int) -> int:
    return _CHARACTER_PX * width + _PADDING_PX


def _width(table: Table, column: Column) -> int:
    """Characters that a column needs: its longest cell, the longest word of its header and the filter button."""
    words = max(map(len, column.header.split())) + _FILTER_PX // _CHARACTER_PX
    longest = max((len(_shown(cell, column)) for cell in _extremes(table, column)), default=0)
    total = len(_shown(float(table.frame[column.name].sum()), column)) if column.total else 0
    room = 1 if column.kind in {"text", "yes_no"} else 0  # the indent
    return min(WIDEST, max(_NARROWEST, words, longest + room, total))


def _extremes(table: Table, column: Column) -> Sequence[Cell]:
    """Give the cells that may be longest: of numbers the least and the greatest."""
    filled = [cell for cell in cells(table, column) if cell is not None]
    numbers = [cell for cell in filled if isinstance(cell, int | float)]
    return [min(numbers), max(numbers)] if len(numbers) == len(filled) and numbers else filled


def _shown(cell: object, column: Column) -> str:
    """Give a cell about as Excel shows it; thousands are parted where the format says so."""
    if isinstance(cell, bool) or not isinstance(cell, int | float):
        return {True: "yes", False: "no", None: ""}.get(cell, str(cell))  # pyright: ignore[reportArgumentType, reportCallIssue]
    style = number_format(column).rpartition(";")[2]  # of two formats the one with more digits
    if style == "General" or "E" in style:
        return f"{cell:.6g}"
    return f"{cell:{',' if ',' in style else ''}.{len(style.partition('.')[2])}f}"


def _lines(header: str, width: int) -> int:
    """Lines that a header takes when it is wrapped at its spaces."""
    rows, room = 1, 0
    for word in re.split(r"\s+", header):
        rows, room = (rows, room + len(word) + 1) if room + len(word) < width else (rows + 1, len(word) + 1)
    return rows


def _header_text(text: str) -> str:
    """Cut user text for a page header, where & starts a code and 255 characters are the limit."""
    return text[:_HEADER_TEXT].replace("&", "&&")
