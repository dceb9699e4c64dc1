"""Tables as CSV: RFC 4180, UTF-8 without BOM, CRLF, comma, decimal point, yes/no."""

import csv
import io
from pathlib import Path

from isomould.documents.numbers import format_number
from isomould.documents.table import Cell, Table, cells
from isomould.writers.disk import write_bytes

_FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r")


def write_csv(path: Path, table: Table) -> None:
    """Write one table; blanks are empty fields.

    Text that a spreadsheet would read as a formula gets a leading apostrophe (CWE-1236); numbers
    keep their sign.
    """
    write_bytes(path, csv_text(table).encode())


def csv_text(table: Table) -> str:
    """Give the text of a table."""
    texts = [[cell_text(cell) for cell in cells(table, column)] for column in table.columns]
    buffer = io.StringIO(newline="")
    writer = csv.writer(buffer, lineterminator="\r\n")
    writer.writerow(column.name for column in table.columns)
    writer.writerows(zip(*texts, strict=True))
    return buffer.getvalue()


def cell_text(cell: Cell) -> str:
    """Write one cell.

    >>> [cell_text(cell) for cell in (True, 12, -0.5, None, "=1+1", "P01")]
    ['yes', '12', '-0.5', '', "'=1+1", 'P01']
    """
    if isinstance(cell, str):
        return f"'{cell}" if cell.startswith(_FORMULA_STARTS) else cell
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    return "" if cell is None else format_number(cell)
