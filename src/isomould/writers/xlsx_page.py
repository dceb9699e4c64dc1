"""A sheet of the workbook: one named table, cells written with the call of their type.

XlsxWriter's traps (`add_table` makes formulas of user text, formula results default to 0, range errors return codes)
are met here: every cell goes through `write_cell`.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from xlsxwriter import Workbook
from xlsxwriter.format import Format
from xlsxwriter.utility import xl_rowcol_to_cell
from xlsxwriter.worksheet import Worksheet

from isomould.documents.columns import Column
from isomould.documents.table import Cell, Table, cells
from isomould.documents.totals import Total
from isomould.errors import Refused
from isomould.writers.formulas import cell_formulas, number_format, row_formula, table_name, visible_formula

WIDEST = 36
"""Characters in a column."""

TEXTS_BELOW = frozenset(("summary", "rates", "cost", "checks"))
"""Tables with notes, sub-totals or sums below them."""


@dataclass(frozen=True)
class Page:
    """A sheet of the workbook being written, and the table on it."""

    book: Workbook
    sheet: Worksheet
    table: Table

    @property
    def below(self) -> int:
        """First free row below the table, after an empty one."""
        return _last_row(self.table) + 2 + _has_totals(self.table)

    def style(self, **properties: object) -> Format:
        """Make a format."""
        return self.book.add_format(properties)


def absolute(page: Page, row: int, column: int) -> str:
    """Name a cell for a defined name: `=Rates!$D$2`."""
    return f"='{page.table.title}'!{xl_rowcol_to_cell(row, column, row_abs=True, col_abs=True)}"


def add_table(page: Page) -> None:
    """Lay the named table over the sheet, without its cells."""
    table, last = page.table, _last_row(page.table) + _has_totals(page.table)
    options = {
        "name": table_name(table),
        "columns": [_column_options(table, column) for column in table.columns],
        "total_row": _has_totals(table),
        "style": "Table Style Light 9",
    }
    done(page, page.sheet.add_table(0, 0, last, len(table.columns) - 1, options))
    page.sheet.freeze_panes(1, 1)


def _column_options(table: Table, column: Column) -> dict[str, object]:
    total = {"total_function": "sum"} if column.total else {}
    formula = row_formula(table, column)
    return {"header": column.header, **total, **({"formula": formula} if formula else {})}


def write_column(page: Page, index: int, column: Column) -> None:
    """Write header, values and total of a column."""
    side = {"align": "left", "indent": int(index > 0)} if column.kind in {"text", "yes_no"} else {"align": "right"}
    style = page.style(num_format=number_format(column), valign="top", text_wrap=is_wrapped(page.table, column), **side)
    write_cell(page, (0, index), column.header, page.style(bold=True, bottom=1, valign="top", text_wrap=True, **side))
    found = zip(cells(page.table, column) or [None], cell_formulas(page.table, column), strict=True)
    for row, (cell, formula) in enumerate(found, start=1):
        write_cell(page, (row, index), cell, style, formula)
    if column.total:
        _write_total(page, index, Total(page.table, column))


def is_wrapped(table: Table, column: Column) -> bool:
    """Tell whether a column has texts too long for one line; sheets with texts below their table are wider instead."""
    lists = column.kind == "text" and table.name not in TEXTS_BELOW
    return lists and any(len(str(cell)) >= WIDEST for cell in cells(table, column))


def _write_total(page: Page, index: int, total: Total) -> None:
    style = page.style(num_format=number_format(total.column), bold=True, top=1)
    write_cell(page, (_last_row(page.table) + 1, index), total.value, style, visible_formula(total))


def write_cell(
    page: Page, at: tuple[int, int], cell: Cell, style: Format | None = None, formula: str | None = None
) -> None:
    """Write one cell with the call of its type; a formula carries the cell as its value."""
    value = {True: "yes", False: "no"}[cell] if isinstance(cell, bool) else cell
    if value is None or value == "":
        done(page, page.sheet.write_blank(*at, None, style))
    elif formula:
        done(page, page.sheet.write_formula(*at, formula, style, value))  # pyright: ignore[reportArgumentType]
    elif isinstance(value, str):
        done(page, page.sheet.write_string(*at, value, style))
    else:
        done(page, page.sheet.write_number(*at, value, style))


def done(page: Page, code: int) -> None:
    """XlsxWriter answers with a negative number where others raise."""
    if code:
        size = f"{len(page.table.frame)} rows, or a text of more than 32 767 characters"
        limit = "what one Excel sheet holds"
        raise Refused("E-OUT-04", f"sheet {page.table.title}", size, limit, "Use the CSV tables, or split the project.")


def write_texts(page: Page, corner: tuple[int, int], rows: Iterable[Sequence[str]]) -> None:
    """Write rows of texts from a corner on."""
    for row, texts in enumerate(rows, start=corner[0]):
        for column, text in enumerate(texts, start=corner[1]):
            write_cell(page, (row, column), text)


def _last_row(table: Table) -> int:
    """Row of the last data row; Excel has no table without one."""
    return max(1, len(table.frame))


def _has_totals(table: Table) -> bool:
    return any(column.total for column in table.columns)
