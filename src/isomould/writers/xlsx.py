"""The workbook: one named table per sheet, totals as live formulas that carry their values.

XlsxWriter is known here and in the `xlsx_…` modules beside.
"""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from xlsxwriter import Workbook

from isomould.documents.costs import Result
from isomould.documents.digits import cell_format
from isomould.documents.info import Logo, ProjectInfo
from isomould.documents.table import Table, cells
from isomould.documents.title_block import heading
from isomould.documents.totals import Total, column_totals
from isomould.errors import Note
from isomould.writers.disk import write_bytes
from isomould.writers.formulas import formula
from isomould.writers.xlsx_checks import write_reconciliations
from isomould.writers.xlsx_costs import write_rates, write_results
from isomould.writers.xlsx_cover import Figures, cover_table, write_cover
from isomould.writers.xlsx_page import TEXTS_BELOW, Page, add_table, write_cell, write_column, write_texts
from isomould.writers.xlsx_print import fit_columns, fit_texts, set_up_print
from isomould.writers.xlsx_repetition import draw_repetition

_OPTIONS = {
    "in_memory": True,
    "strings_to_formulas": False,
    "strings_to_urls": False,
    "strings_to_numbers": False,
}
_CREATED = datetime(2000, 1, 1, tzinfo=UTC)


@dataclass(frozen=True, eq=False)
class Words:
    """What stands beside the tables: title block, notes, the figures that follow from the cost, a logo."""

    info: ProjectInfo
    notes: Sequence[Note] = ()
    results: Sequence[Result] = ()
    logo: Logo | None = None


def write_workbook(path: Path, tables: Sequence[Table], words: Words) -> None:
    """Write a cover and the tables as sheets: "summary", "rates" and "cost" first, "checks" last, others in order.

    The rows of "summary" that are totals of the others (`make_summary`) are formulas.
    Under "checks" stand the sums that must agree, under "cost" sub-totals and the total, under "summary" the notes.

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
        cover, *pages = (Page(book, book.add_worksheet(table.title), table) for table in (cover_table(), *tables))
        for page in pages:
            add_table(page)
            for index, column in enumerate(page.table.columns):
                write_column(page, index, column)
        failed = _write_extras(pages, words)
        for page in (cover, *pages):
            set_up_print(page, words.info)
        for page in pages:
            fit_texts(page) if page.table.name in TEXTS_BELOW else fit_columns(page)
        write_cover(cover, pages, words.info, words.logo, _figures(words.results, failed))
    return buffer.getvalue()


def _write_extras(pages: Sequence[Page], words: Words) -> int | None:
    """Write what stands beside and below the tables; give the number of failed checks, if there is their sheet."""
    tables, by_name = [page.table for page in pages], {page.table.name: page for page in pages}
    if "summary" in by_name:
        _write_summary(by_name["summary"], column_totals(tables), words.notes)
    if "rates" in by_name:
        write_rates(by_name["rates"])
    if "cost" in by_name:
        write_results(by_name["cost"], words.results)
    if "repetition" in by_name:
        draw_repetition(by_name["repetition"])
    return write_reconciliations(by_name["checks"], tables) if "checks" in by_name else None


def _figures(results: Sequence[Result], failed: int | None) -> Figures:
    total = next((result for result in results if result.name == "total_cost"), None)
    return Figures(total.live.value, total.unit, failed) if total else Figures(failed=failed)


def _write_summary(page: Page, totals: Sequence[Total], notes: Sequence[Note]) -> None:
    """Make the totals live, wherever they stand, show counts as such, and repeat the notes below."""
    by_item = {total.item: total for total in totals}
    columns = (cells(page.table, column) for column in page.table.columns)
    for row, (item, value, unit) in enumerate(zip(*columns, strict=True), start=1):
        total = by_item.get(str(item))
        number = value if isinstance(value, int | float) else None
        style = page.style(num_format=cell_format(str(unit or ""), number), align="right")
        write_cell(page, (row, 1), value, style, formula(total, page.table) if total else None)
    rows = [(note.code, note.field, note.text) for note in notes]
    write_texts(page, (page.below, 0), [("Notes",), *rows] if rows else [])
