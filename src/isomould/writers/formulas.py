"""Formulas of the workbook as text: structured references that Excel and LibreOffice both read."""

from isomould.documents.columns import Column, per_piece
from isomould.documents.table import Table
from isomould.documents.totals import Reconciliation, Total

_NUMBER_FORMATS = {"mm": "0.0", "deg": "0.00", "kg": "0.00", "m2": "0.000", "cm3": "0.0", "percent": "0.0"}


def table_name(table: Table) -> str:
    """Name a table for formulas.

    >>> from isomould.documents.table import make_table
    >>> table_name(make_table("summary", {"item": [], "value": [], "unit": []}))
    'tblSummary'
    """
    return "tbl" + table.name.title().replace("_", "")


def total_formula(total: Total) -> str:
    """Sum (or count) a whole column, filtered or not."""
    function = {"sum": "SUM", "count": "COUNTA"}[total.how]
    return f"={function}({_column(total.table, total.column)})"


def visible_formula(total: Total) -> str:
    """Sum the visible rows of a column, as a total row under a filtered table does."""
    return f"=SUBTOTAL(109,{_column(total.table, total.column)})"


def row_formula(table: Table, column: Column) -> str | None:
    """Multiply the value per piece by the quantity, or None for a column of plain values."""
    piece = per_piece(column.name)
    if piece is None:
        return None
    headers = {other.name: other.header for other in table.columns}
    return f"={_cell(table, headers['quantity'])}*{_cell(table, headers[piece])}"


def status_formula(check: Reconciliation) -> str:
    """Say whether two totals agree."""
    difference = f"{total_formula(check.found)[1:]}-{total_formula(check.expected)[1:]}"
    return f'=IF(ABS({difference})<={check.limit!r},"pass","fail")'


def number_format(column: Column) -> str:
    """Give the Excel format of a column; it shortens what is shown, never what is stored."""
    if column.kind != "number":
        return {"integer": "0"}.get(column.kind, "@")
    if column.decimals is None:
        return "0.00E+00"
    return _NUMBER_FORMATS.get(
        column.name.rpartition("_")[2], {2: "#,##0.00", 9: "0.0000", 12: "#,##0.###"}.get(column.decimals, "General")
    )


def _column(table: Table, column: Column) -> str:
    return f"{table_name(table)}[{column.header}]"


def _cell(table: Table, header: str) -> str:
    return f"{table_name(table)}[[#This Row],[{header}]]"
