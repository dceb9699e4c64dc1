"""A table of the schedules: columns and a frame, rounded once, the same for every writer."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import pandas as pd
from pandas.api.extensions import ExtensionArray

from isomould.arrays import Floats
from isomould.documents.columns import Column, columns, is_of_shape, per_piece, title
from isomould.documents.live import Live
from isomould.documents.numbers import round_to
from isomould.errors import Refused

Values = Floats | ExtensionArray

Cell = str | int | float | bool | None
"""What a cell holds; None is a blank."""


@dataclass(frozen=True, eq=False)
class Table:
    """A table of the schedules.

    Attributes
    ----------
    name : str
        Stem of the CSV file, such as "member_instances".
    title : str
        Sheet in Excel, such as "Member instances".
    columns : tuple of Column
    frame : DataFrame
        One frame column per `columns`, in order; a blank is NA (an empty string in text).
    live : mapping of column name to expressions
        What stands behind the values of a column, row by row; None where a plain value does.
    """

    name: str
    title: str
    columns: tuple[Column, ...]
    frame: pd.DataFrame
    live: Mapping[str, Sequence[Live | None]] = field(default_factory=dict[str, Sequence[Live | None]])


def make_live_table(name: str, data: Mapping[str, Iterable[object]]) -> Table:
    """Make a table whose cells may be expressions: their values are its data, the expressions stay beside it.

    Values of expressions are not rounded, so that a spreadsheet that computes them anew gives the very same.
    """
    rows = {column: list(values) for column, values in data.items()}
    live = {c: [v if isinstance(v, Live) else None for v in vs] for c, vs in rows.items()}
    plain = {c: [v.value if isinstance(v, Live) else v for v in vs] for c, vs in rows.items()}
    return replace(make_table(name, plain), live={c: vs for c, vs in live.items() if any(vs)})


FILES = ("file", "files", "solid_file", "drawing_file")
"""Columns that name files of the delivery."""


def without_files(table: Table) -> Table:
    """Leave the names of files blank, in a folder that holds none of them."""
    named = [column for column in FILES if column in table.frame]
    return replace(table, frame=table.frame.assign(**dict.fromkeys(named, ""))) if named else table


def make_table(name: str, data: Mapping[str, Iterable[object]]) -> Table:
    """Make the table `name` from its columns; numbers are rounded here and nowhere else.

    Parameters
    ----------
    name : str
        One of `isomould.documents.columns.TABLES`.
    data : mapping of column name to values
        Every column of the table, of one length, `None` for a blank. The `total_…` columns are
        derived (quantity × value per piece) and must not be given.

    Raises
    ------
    Refused
        If a number is NaN or infinite.
    ValueError
        If columns are missing, unknown, of other types or of different lengths.

    Examples
    --------
    >>> table = make_table("bars", dict(bar=["B001"], stock=["6000"], pieces=[4], used_mm=[5990.00049],
    ...                                 offcut_mm=[10.0], price=[None]))
    >>> table.title, cells(table, table.columns[3]), cells(table, table.columns[5])
    ('Bars', [5990.0], [None])
    """
    specs = columns(name, _largest_arm(data), tuple(filter(is_of_shape, data)))
    given = {column.name: list(data.get(column.name, ())) for column in specs if not per_piece(column.name)}
    _check_names(name, given.keys(), data.keys())
    _check_lengths(name, given)
    frame = {column.name: _values(name, column, given[column.name]) for column in specs if column.name in given}
    return Table(name, title(name), specs, pd.DataFrame({c.name: _derived(c, frame) for c in specs}))


def cells(table: Table, column: Column) -> list[Cell]:
    """Give one column as plain Python values, None for a blank."""
    values = table.frame[column.name].tolist()
    return [None if value is pd.NA or value != value else value for value in values]  # noqa: PLR0124


def _largest_arm(names: Iterable[str]) -> int:
    found = (re.fullmatch(r"azimuth_(\d+)_deg", name) for name in names)
    return max((int(match[1]) for match in found if match), default=0)


def _check_names(table: str, wanted: Iterable[str], given: Iterable[str]) -> None:
    missing, unknown = sorted(set(wanted) - set(given)), sorted(set(given) - set(wanted))
    if missing or unknown:
        message = f"table {table}: missing columns {missing}, unknown or derived columns {unknown}"
        raise ValueError(message)


def _check_lengths(table: str, given: Mapping[str, Sequence[object]]) -> None:
    lengths = {name: len(values) for name, values in given.items()}
    if len(set(lengths.values())) > 1:
        message = f"table {table}: columns of different lengths {lengths}"
        raise ValueError(message)


_NULLABLE = {"integer": "Int64", "yes_no": "boolean"}
_ACCEPTED: dict[str, tuple[type, ...]] = {
    "text": (str,),
    "integer": (int, np.integer),
    "number": (int, float, np.integer, np.floating),
    "yes_no": (bool, np.bool_),
}


def _values(table: str, column: Column, values: Sequence[object]) -> Values:
    for row, value in enumerate(values):
        _check_value(table, column, row, value)
    if column.kind == "number":
        return round_to(np.array(values, dtype=float), column.decimals)  # None becomes NaN, the blank
    if column.kind == "text":
        return pd.array(["" if value is None else value for value in values], dtype=object)
    return pd.Series(np.array(values, dtype=object), dtype=_NULLABLE[column.kind]).array


def _check_value(table: str, column: Column, row: int, value: object) -> None:
    flag = isinstance(value, bool) and column.kind != "yes_no"
    if value is not None and (flag or not isinstance(value, _ACCEPTED[column.kind])):
        message = f"table {table}, {column.name}, row {row}: {value!r} is no {column.kind}"
        raise ValueError(message)
    if isinstance(value, float | np.floating) and not np.isfinite(value):
        raise _not_finite(table, column, row, value)


def _not_finite(table: str, column: Column, row: int, value: object) -> Refused:
    where = f"table {table}, {column.name}, row {row}"
    return Refused("E-OUT-01", where, str(value), "a finite number", "Please report the project file.")


def _derived(column: Column, frame: Mapping[str, Values]) -> Values:
    """Give a column of the frame, `total_…` as quantity times its value per piece."""
    piece = per_piece(column.name)
    if piece is None:
        return frame[column.name]
    quantity = np.array([np.nan if count is pd.NA else count for count in frame["quantity"]], dtype=float)
    return round_to(quantity * np.asarray(frame[piece], dtype=float), column.decimals)
