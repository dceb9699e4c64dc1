"""`tables/*.csv`: RFC 4180, UTF-8 without a byte order mark, CRLF, decimal point."""

import csv
import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from isomould.verify.read.text import refusing
from isomould.verify.rules import Floats, Unreadable

_NUMBER = re.compile(r"-?\d+(\.\d+)?([eE][+-]?\d+)?")
_DECIMALS = {"mm": 3, "deg": 4, "kg": 3, "m2": 12, "cm3": 3, "percent": 3}


@dataclass(frozen=True)
class Table:
    """The cells of one file as text, column by column, without neutralising apostrophes."""

    name: str
    columns: dict[str, tuple[str, ...]]
    rows: int


@refusing
def read_table(path: Path) -> Table:
    """Read a table; ragged rows, repeated columns or bare line feeds make it unreadable."""
    text = path.read_bytes().decode("utf-8")
    if text.startswith("\ufeff") or not text.endswith("\r\n"):
        message = "has a byte order mark or does not end with CRLF"
        raise Unreadable(message)
    header, *rows = csv.reader(text.split("\r\n")[:-1], strict=True)
    if len(set(header)) < len(header) or any(len(row) != len(header) for row in rows):
        message = "repeats a column or has rows of different lengths"
        raise Unreadable(message)
    columns = [tuple(map(plain, column)) for column in zip(*rows, strict=True)] or [()] * len(header)
    return Table(path.stem, dict(zip(header, columns, strict=True)), len(rows))


def texts(table: Table, column: str) -> tuple[str, ...]:
    """Give a column's texts."""
    if column not in table.columns:
        message = f"tables/{table.name}.csv has no column {column}"
        raise Unreadable(message)
    return table.columns[column]


def plain(text: str) -> str:
    """Undo the apostrophe that keeps spreadsheets from reading a formula."""
    return text[1:] if re.match(r"'[=+\-@\t\r]", text) else text


def number(text: str) -> float:
    """Read one finite number with a decimal point; a blank is NaN."""
    if text and not (_NUMBER.fullmatch(text) and math.isfinite(float(text))):
        message = f"{text!r} is not a number"
        raise Unreadable(message)
    return float(text) if text else math.nan


def numbers(table: Table, column: str, *, blank: bool = False) -> Floats:
    """Give a column of numbers; blanks are refused unless allowed (then NaN)."""
    found = np.array([number(text) for text in texts(table, column)], dtype=np.float64)
    if not blank and np.isnan(found).any():
        message = f"tables/{table.name}.csv has a blank in column {column}"
        raise Unreadable(message)
    return found


def pairs(table: Table, key: str, column: str) -> dict[str, str]:
    """Map one column on another, such as location on mark; a repeated key is refused."""
    found = dict(zip(texts(table, key), texts(table, column), strict=True))
    if len(found) < table.rows:
        message = f"tables/{table.name}.csv repeats a {key}"
        raise Unreadable(message)
    return found


def half_unit(column: str) -> float:
    """Give half a unit of the last printed digit of a column, by the unit in its name.

    Numbers are snapped three digits further before they are rounded (failure mode E5), hence a little more.

    >>> f"{half_unit('mass_kg'):.7f} {half_unit('azimuth_1_deg'):.8f}"
    '0.0005005 0.00005005'
    """
    return 0.5005 * 10.0 ** -_DECIMALS[column.rsplit("_", 1)[-1]]
