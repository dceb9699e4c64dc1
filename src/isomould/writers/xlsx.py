"""The workbook: one named table per sheet, totals as live formulas that carry their values.

XlsxWriter is known here and in the `xlsx_…` modules beside.
"""

import io
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from xlsxwriter import Workbook
from xlsxwriter.worksheet import Worksheet

from isomould.documents.costs import Result
from isomould.documents.info import ProjectInfo
from isomould.documents.table import Table, cells
from isomould.documents.title_block import heading, title_lines
from isomould.documents.totals import Total, column_totals, reconcile
from isomould.errors import Note
from isomould.writers.disk import write_bytes
from isomould.writers.formulas import status_formula, total_formula
from isomould.writers.xlsx_costs import write_rates, write_results
from isomould.writers.xlsx_page import Page, add_table, write_cell, write_column, write_texts

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


@dataclass(frozen=True, eq=False)
class Words:
    """What stands beside and below the tables: title block, notes, and the figures that follow from the cost."""

    info: ProjectInfo
    notes: Sequence[Note] = ()
    results: Sequence[Result] = ()


def write_workbook(path: Path, tables: Sequence[Table], words: Words) -> None:
    """Write the tables as sheets: "summary", "rates" and "cost" first, "checks" last, the others in their order.

    The rows of "summary" that are totals of the others (`make_summary`) are formulas.
    Under "checks" stand the sums that must agree, under "cost" sub-totals and the total. Notes and title block stand on
    the first sheet.

    Raises
    ------
    Refused
        If a sheet has more rows, or a text more characters, than Excel holds.
    OutputFault
        If the file cannot be written.
    """
    write_bytes(path, workbook_bytes(tables, words))


def workbook_bytes(tables: Sequence[Table], words: Words) -> bytes:
    """Give the workbook that `write_workbook` writes."""
    return _render(sorted(tables, key=_place), words)


def _place(table: Table) -> int:
    return {"summary": -3, "rates": -2, "cost": -1, "checks": 1}.get(table.name, 0)


def _render(tables: Sequence[Table], words: Words) -> bytes:
    buffer = io.BytesIO()
    with Workbook(buffer, _OPTIONS) as book:
        book.set_properties({"title": heading(words.info), "author": words.info.author, "created": _CREATED})
        pages = [Page(book, book.add_worksheet(table.title), table) for table in tables]
        for page in pages:
            _write_page(page, words.info)
        _write_extras(pages, words)
    return buffer.getvalue()


def _write_page(page: Page, info: ProjectInfo) -> None:
    add_table(page)
    for index, column in enumerate(page.table.columns):
        write_column(page, index, column)
    if page.table.name == "summary":
        write_texts(page, (0, len(page.table.columns) + 1), title_lines(info))
    _set_up_print(page.sheet, info)


def _write_extras(pages: Iterable[Page], words: Words) -> None:
    tables = [page.table for page in pages]
    extras: dict[str, Callable[[Page], None]] = {
        "summary": lambda page: _write_summary(page, column_totals(tables), words.notes),
        "rates": write_rates,
        "cost": lambda page: write_results(page, words.results),
        "checks": lambda page: _write_reconciliation(page, tables),
    }
    for page in pages:
        extras.get(page.table.name, lambda _: None)(page)
        page.sheet.autofit(_WIDEST_PX)


def _write_summary(page: Page, totals: Sequence[Total], notes: Sequence[Note]) -> None:
    """Make the totals live, wherever they stand, and repeat the notes below."""
    by_item = {total.item: total for total in totals}
    for row, item in enumerate(cells(page.table, page.table.columns[0]), start=1):
        if total := by_item.get(str(item)):
            write_cell(page, (row, 1), total.value, None, total_formula(total))
    rows = [(note.code, note.field, note.text) for note in notes]
    write_texts(page, (page.below, 0), [("Notes",), *rows] if rows else [])


def _write_reconciliation(page: Page, tables: Sequence[Table]) -> None:
    """Write the sums that must agree under the columns of the checks, and turn what fails red."""
    status = [column.name for column in page.table.columns].index("status")
    write_texts(page, (page.below, 0), [("Id", "Reconciliation", "Found", "Expected")])
    row = page.below
    for row, check in enumerate(reconcile(tables), start=page.below + 1):
        write_texts(page, (row, 0), [(f"R{row - page.below}", check.what)])
        write_cell(page, (row, 2), check.found.value, None, total_formula(check.found))
        write_cell(page, (row, 3), check.expected.value, None, total_formula(check.expected))
        write_cell(page, (row, status), check.status, None, status_formula(check))
    failing = {"type": "cell", "criteria": "==", "value": '"fail"', "format": page.style(**_RED)}
    page.sheet.conditional_format(1, status, row, status, failing)


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
