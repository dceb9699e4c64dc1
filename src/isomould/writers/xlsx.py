"""The workbook: one named table per sheet, totals as live formulas that carry their values.

The only module that knows XlsxWriter. Its traps (`add_table` makes formulas of user text, formula
results default to 0, range errors return codes) are met by writing every cell with a typed call.
"""

import io
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from xlsxwriter import Workbook
from xlsxwriter.format import Format
from xlsxwriter.worksheet import Worksheet

from isomould.documents.columns import Column
from isomould.documents.info import ProjectInfo
from isomould.documents.table import Cell, Table, cells
from isomould.documents.title_block import heading, title_lines
from isomould.documents.totals import Total, column_totals, reconcile
from isomould.errors import Note, Refused
from isomould.writers.disk import write_bytes
from isomould.writers.formulas import (
    number_format,
    row_formula,
    status_formula,
    table_name,
    total_formula,
    visible_formula,
)

_OPTIONS = {
    "in_memory": True,
    "strings_to_formulas": False,
    "strings_to_urls": False,
    "strings_to_numbers": False,
}
_CREATED = datetime(2000, 1, 1, tzinfo=UTC)
_A3 = 8
_WIDEST_PX = 400
_HEADER_TEXT = 60
_RED = {"bg_color": "#FFC7CE", "font_color": "#9C0006"}


@dataclass(frozen=True)
class _Page:
    """A sheet of the workbook being written, and the table on it."""

    book: Workbook
    sheet: Worksheet
    table: Table

    @property
    def below(self) -> int:
        """First free row below the table, after an empty one."""
        return _last_row(self.table) + 2 + _has_totals(self.table)

    def style(self, **properties: object) -> Format:
        return self.book.add_format(properties)


def write_workbook(path: Path, tables: Sequence[Table], info: ProjectInfo, notes: Sequence[Note] = ()) -> None:
    """Write the tables as sheets: "summary" first, "checks" last, the others in their order.

    The rows of "summary" that are totals of the others (`make_summary`) are formulas.
    Under "checks" stand the sums that must agree. Notes and title block stand on the first sheet.

    Raises
    ------
    Refused
        If a sheet has more rows, or a text more characters, than Excel holds.
    OutputFault
        If the file cannot be written.
    """
    write_bytes(path, _render(sorted(tables, key=_place), info, notes))


def _place(table: Table) -> int:
    return {"summary": -1, "checks": 1}.get(table.name, 0)


def _render(tables: Sequence[Table], info: ProjectInfo, notes: Sequence[Note]) -> bytes:
    buffer = io.BytesIO()
    with Workbook(buffer, _OPTIONS) as book:
        book.set_properties({"title": heading(info), "author": info.author, "created": _CREATED})
        pages = [_Page(book, book.add_worksheet(table.title), table) for table in tables]
        for page in pages:
            _write_page(page, info)
        _write_extras(pages, notes)
    return buffer.getvalue()


def _write_page(page: _Page, info: ProjectInfo) -> None:
    _add_table(page)
    for index, column in enumerate(page.table.columns):
        _write_column(page, index, column)
    if page.table.name == "summary":
        _write_texts(page, (0, len(page.table.columns) + 1), title_lines(info))
    _set_up_print(page.sheet, info)


def _write_extras(pages: Iterable[_Page], notes: Sequence[Note]) -> None:
    tables = [page.table for page in pages]
    for page in pages:
        if page.table.name == "summary":
            _write_summary(page, column_totals(tables), notes)
        if page.table.name == "checks":
            _write_reconciliation(page, tables)
        page.sheet.autofit(_WIDEST_PX)


def _add_table(page: _Page) -> None:
    table, last = page.table, _last_row(page.table) + _has_totals(page.table)
    options = {
        "name": table_name(table),
        "columns": [_column_options(table, column) for column in table.columns],
        "total_row": _has_totals(table),
        "style": "Table Style Light 9",
    }
    _done(page, page.sheet.add_table(0, 0, last, len(table.columns) - 1, options))
    page.sheet.freeze_panes(1, 1)


def _column_options(table: Table, column: Column) -> dict[str, object]:
    total = {"total_function": "sum"} if column.total else {}
    formula = row_formula(table, column)
    return {"header": column.header, **total, **({"formula": formula} if formula else {})}


def _write_column(page: _Page, index: int, column: Column) -> None:
    style = page.style(num_format=number_format(column))
    _write_cell(page, (0, index), column.header, page.style(bold=True, bottom=1))
    formula = row_formula(page.table, column)
    for row, cell in enumerate(cells(page.table, column) or [None], start=1):
        _write_cell(page, (row, index), cell, style, formula)
    if column.total:
        _write_total(page, index, Total(page.table, column))


def _write_total(page: _Page, index: int, total: Total) -> None:
    style = page.style(num_format=number_format(total.column), bold=True, top=1)
    _write_cell(page, (_last_row(page.table) + 1, index), total.value, style, visible_formula(total))


def _write_cell(
    page: _Page, at: tuple[int, int], cell: Cell, style: Format | None = None, formula: str | None = None
) -> None:
    """Write one cell with the call of its type; a formula carries the cell as its value."""
    value = {True: "yes", False: "no"}[cell] if isinstance(cell, bool) else cell
    if value is None or value == "":
        _done(page, page.sheet.write_blank(*at, None, style))
    elif formula:
        _done(page, page.sheet.write_formula(*at, formula, style, value))  # pyright: ignore[reportArgumentType]
    elif isinstance(value, str):
        _done(page, page.sheet.write_string(*at, value, style))
    else:
        _done(page, page.sheet.write_number(*at, value, style))


def _done(page: _Page, code: int) -> None:
    """XlsxWriter answers with a negative number where others raise."""
    if code:
        size = f"{len(page.table.frame)} rows, or a text of more than 32 767 characters"
        limit = "what one Excel sheet holds"
        raise Refused("E-OUT-04", f"sheet {page.table.title}", size, limit, "Use the CSV tables, or split the project.")


def _write_summary(page: _Page, totals: Sequence[Total], notes: Sequence[Note]) -> None:
    """Make the totals live, wherever they stand, and repeat the notes below."""
    by_item = {total.item: total for total in totals}
    for row, item in enumerate(cells(page.table, page.table.columns[0]), start=1):
        if total := by_item.get(str(item)):
            _write_cell(page, (row, 1), total.value, None, total_formula(total))
    rows = [(note.code, note.field, note.text) for note in notes]
    _write_texts(page, (page.below, 0), [("Notes",), *rows] if rows else [])


def _write_reconciliation(page: _Page, tables: Sequence[Table]) -> None:
    """Write the sums that must agree under the columns of the checks, and turn what fails red."""
    status = [column.name for column in page.table.columns].index("status")
    _write_texts(page, (page.below, 0), [("Id", "Reconciliation", "Found", "Expected")])
    row = page.below
    for row, check in enumerate(reconcile(tables), start=page.below + 1):
        _write_texts(page, (row, 0), [(f"R{row - page.below}", check.what)])
        _write_cell(page, (row, 2), check.found.value, None, total_formula(check.found))
        _write_cell(page, (row, 3), check.expected.value, None, total_formula(check.expected))
        _write_cell(page, (row, status), check.status, None, status_formula(check))
    failing = {"type": "cell", "criteria": "==", "value": '"fail"', "format": page.style(**_RED)}
    page.sheet.conditional_format(1, status, row, status, failing)


def _write_texts(page: _Page, corner: tuple[int, int], rows: Iterable[Sequence[str]]) -> None:
    for row, texts in enumerate(rows, start=corner[0]):
        for column, text in enumerate(texts, start=corner[1]):
            _write_cell(page, (row, column), text)


def _set_up_print(sheet: Worksheet, info: ProjectInfo) -> None:
    sheet.set_landscape()
    sheet.set_paper(_A3)
    sheet.fit_to_pages(1, 0)
    sheet.repeat_rows(0)
    sheet.set_header(f"&L{_header_text(heading(info))}&R&A")
    sheet.set_footer(f"&L{_header_text(info.client)}&RPage &P of &N")


def _header_text(text: str) -> str:
    """Cut user text for a page header, where & starts a code and 255 characters are the limit."""
    return text[:_HEADER_TEXT].replace("&", "&&")


def _last_row(table: Table) -> int:
    """Row of the last data row; Excel has no table without one."""
    return max(1, len(table.frame))


def _has_totals(table: Table) -> bool:
    return any(column.total for column in table.columns)
