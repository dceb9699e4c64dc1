"""Quantities taken off the schedules, as expressions that stay alive in the workbook."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from isomould.documents.columns import Column
from isomould.documents.live import Live
from isomould.documents.table import Table, cells
from isomould.documents.totals import Total

Tables = Mapping[str, Table]


@dataclass(frozen=True, eq=False)
class Products(Live):
    """Sum over the rows of a table of the product of two columns."""

    table: Table
    columns: tuple[Column, Column]

    @property
    def value(self) -> float:
        """The sum; blanks count as 0."""
        one, other = (cells(self.table, column) for column in self.columns)
        return math.fsum(_number(a) * _number(b) for a, b in zip(one, other, strict=True))


@dataclass(frozen=True, eq=False)
class Matches(Live):
    """Number of the rows whose cell in a column is exactly `text`."""

    table: Table
    column: Column
    text: str

    @property
    def value(self) -> float:
        """The number."""
        return float(cells(self.table, self.column).count(self.text))


@dataclass(frozen=True, eq=False)
class SumIf(Live):
    """Sum of a column over the rows whose cell in the column `by` is `text` (a word of ours, no pattern)."""

    table: Table
    by: Column
    text: str
    column: Column

    @property
    def value(self) -> float:
        """The sum."""
        pairs = zip(cells(self.table, self.by), cells(self.table, self.column), strict=True)
        return math.fsum(_number(value) for word, value in pairs if word == self.text)


@dataclass(frozen=True, eq=False)
class Blanks(Live):
    """Number of the blank cells of a column."""

    table: Table
    column: Column

    @property
    def value(self) -> float:
        """The number."""
        return float(cells(self.table, self.column).count(None))


def total(tables: Tables, path: str) -> Total:
    """Sum of a column: `total(tables, "nodes.quantity")`."""
    return Total(*_find(tables, path))


def count(tables: Tables, path: str) -> Total:
    """Number of the filled cells of a column."""
    return Total(*_find(tables, path), "count")


def products(tables: Tables, one: str, other: str) -> Products:
    """Sum of products of two columns of one table: `products(tables, "nodes.quantity", "slots")`."""
    table, column = _find(tables, one)
    return Products(table, (column, _column(table, other)))


def matches(tables: Tables, path: str, text: str) -> Matches:
    """Number of the rows that say `text`."""
    return Matches(*_find(tables, path), text)


def sum_if(table: Table, by: str, text: str, column: str) -> SumIf:
    """Sum of a column over the rows that say `text` in the column `by`."""
    return SumIf(table, _column(table, by), text, _column(table, column))


def _find(tables: Tables, path: str) -> tuple[Table, Column]:
    name, _, field = path.partition(".")
    return tables[name], _column(tables[name], field)


def _column(table: Table, name: str) -> Column:
    return next(column for column in table.columns if column.name == name)


def _number(cell: object) -> float:
    return float(cell) if isinstance(cell, int | float) else 0.0
