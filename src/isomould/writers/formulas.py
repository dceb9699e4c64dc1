"""Formulas of the workbook as text: structured references that Excel and LibreOffice both read."""

from functools import singledispatch

from isomould.documents.columns import Column, per_piece, unit
from isomould.documents.digits import cell_format
from isomould.documents.live import Given, Here, Joint, Live, NamedCell, RateCell
from isomould.documents.numbers import format_number
from isomould.documents.quantities import Blanks, Matches, Products, SumIf
from isomould.documents.reconciliations import Reconciliation
from isomould.documents.table import Table
from isomould.documents.totals import Total

RATE = "rate_"
"""Before the code of a rate in the name of its cell."""

_MONEY = frozenset(("quantity", "rate", "amount", "price", "cost"))
"""Ends of the names of columns with two decimals: money, and what is paid for."""


def table_name(table: Table) -> str:
    """Name a table for formulas.

    >>> from isomould.documents.table import make_table
    >>> table_name(make_table("summary", {"item": [], "value": [], "unit": []}))
    'tblSummary'
    """
    return "tbl" + table.name.title().replace("_", "")


def formula(live: Live, table: Table) -> str:
    """Word an expression that stands on the sheet of a table.

    >>> from isomould.documents.table import make_table
    >>> formula((Given(1) + RateCell("margin", 5.0)) * NamedCell("works_cost", Given(3)), make_table("bars", {
    ...     "bar": [], "stock": [], "pieces": [], "used_mm": [], "offcut_mm": [], "price": []}))
    '=(1+rate_margin)*works_cost'
    """
    text = _words(live, table)
    return f"={text[1:-1] if isinstance(live, Joint) else text}"


@singledispatch
def _words(live: Live, table: Table) -> str:
    raise NotImplementedError(type(live).__name__)


@_words.register
def _(live: Given, table: Table) -> str:
    return format_number(live.number)


@_words.register
def _(live: RateCell, table: Table) -> str:
    return f"{RATE}{live.code}"


@_words.register
def _(live: NamedCell, table: Table) -> str:
    return live.name


@_words.register
def _(live: Here, table: Table) -> str:
    headers = {column.name: column.header for column in table.columns}
    return _cell(table, headers[live.column])


@_words.register
def _(live: Joint, table: Table) -> str:
    return f"({_words(live.left, table)}{live.sign}{_words(live.right, table)})"


@_words.register
def _(live: Total, table: Table) -> str:
    function = {"sum": "SUM", "count": "COUNTA"}[live.how]
    return f"{function}({_column(live.table, live.column)})"


@_words.register
def _(live: Products, table: Table) -> str:
    return f"SUMPRODUCT({','.join(_column(live.table, column) for column in live.columns)})"


@_words.register
def _(live: Matches, table: Table) -> str:
    """Compare exactly: COUNTIF would take `*` in a section's name for any text."""
    quoted = live.text.replace('"', '""')
    return f'SUMPRODUCT(--EXACT({_column(live.table, live.column)},"{quoted}"))'


@_words.register
def _(live: SumIf, table: Table) -> str:
    return f'SUMIF({_column(live.table, live.by)},"{live.text}",{_column(live.table, live.column)})'


@_words.register
def _(live: Blanks, table: Table) -> str:
    return f"COUNTBLANK({_column(live.table, live.column)})"


def visible_formula(total: Total) -> str:
    """Sum the visible rows of a column, as a total row under a filtered table does."""
    return f"=SUBTOTAL(109,{_column(total.table, total.column)})"


def cell_formulas(table: Table, column: Column) -> list[str | None]:
    """Word what stands behind every cell of a column; None for plain values."""
    if column.name in table.live:
        return [live and formula(live, table) for live in table.live[column.name]]
    return [row_formula(table, column)] * max(1, len(table.frame))


def row_formula(table: Table, column: Column) -> str | None:
    """Multiply the value per piece by the quantity, or None for a column of plain values."""
    piece = per_piece(column.name)
    if piece is None:
        return None
    headers = {other.name: other.header for other in table.columns}
    return f"={_cell(table, headers['quantity'])}*{_cell(table, headers[piece])}"


def status_formula(check: Reconciliation, table: Table) -> str:
    """Say whether two figures agree."""
    difference = f"{_words(check.found, table)}-{_words(check.expected, table)}"
    return f'=IF(ABS({difference})<={format_number(check.limit)},"pass","fail")'


def number_format(column: Column) -> str:
    """Give the Excel format of a column; it shortens what is shown, never what is stored."""
    if column.kind != "number":
        return {"integer": "0"}.get(column.kind, "@")
    if column.decimals is None:
        return "0.00E+00"
    if unit(column.name) or column.name.rpartition("_")[2] in _MONEY:
        return cell_format(unit(column.name))
    return {9: "0.0000", 12: "#,##0.###"}.get(column.decimals, "General")


def _column(table: Table, column: Column) -> str:
    return f"{table_name(table)}[{column.header}]"


def _cell(table: Table, header: str) -> str:
    return f"{table_name(table)}[[#This Row],[{header}]]"
