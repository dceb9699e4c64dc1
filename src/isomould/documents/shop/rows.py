"""Rows of the schedules as texts: what drawings print is what schedules print."""

import re
from collections.abc import Mapping

from isomould.documents.columns import unit
from isomould.documents.digits import shown
from isomould.documents.numbers import format_number
from isomould.documents.table import Cell, Table, cells

Row = Mapping[str, str]
"""The texts of one row by column; a blank is empty."""

_NOT_SHOWN = re.compile(
    r"mark|outline|max_deviation_\w+|files?|\w+_file|(azimuth|elevation)_\d+_deg|(family|section)_\d+"
)


def schedule_rows(table: Table) -> list[Row]:
    """Give the rows of a table as the texts that its CSV has."""
    columns = [[_text(cell) for cell in cells(table, column)] for column in table.columns]
    names = [column.name for column in table.columns]
    return [dict(zip(names, row, strict=True)) for row in zip(*columns, strict=True)]


def data_rows(table: Table, row: Row) -> list[tuple[str, str]]:
    """Give the headers and texts of what a part's own sheet lists; blanks, arms and files apart."""
    listed = [column for column in table.columns if row[column.name] and not _NOT_SHOWN.fullmatch(column.name)]
    return [(column.header, amount_text(column.name, row[column.name])) for column in listed]


_AMOUNTS = frozenset(("kg", "m²", "cm³", "%"))
"""Of what is weighed, coated, filled or used. Lengths and angles are what is cut: views repeat them digit by digit."""


def amount_text(name: str, text: str) -> str:
    """Write a mass, an area, a volume or a share of a schedule with the digits of its unit, all else as it stands.

    >>> amount_text("area_m2", "1.234567890123"), amount_text("length_mm", "1234.567"), amount_text("mass_kg", "")
    ('1.23', '1234.567', '')
    """
    of = unit(name)
    return shown(float(text), of) if text and of in _AMOUNTS else text


def length_text(value: float) -> str:
    """Write a length that no schedule has, mm, as a schedule would."""
    return format_number(value, 3)


def _text(cell: Cell) -> str:
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    return "" if cell is None else cell if isinstance(cell, str) else format_number(cell)
