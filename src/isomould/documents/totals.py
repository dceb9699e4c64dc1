"""Totals of the schedules: computed here, written as live formulas."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from isomould.documents.columns import Column, unit
from isomould.documents.live import Live
from isomould.documents.numbers import format_number
from isomould.documents.table import Table, cells, make_table


@dataclass(frozen=True, eq=False)
class Total(Live):
    """The sum or the count of the filled cells of one column of a table."""

    table: Table
    column: Column
    how: Literal["sum", "count"] = "sum"

    @property
    def value(self) -> float:
        """The total as the numbers of the column give it, without the noise of adding."""
        filled = [cell for cell in cells(self.table, self.column) if cell not in (None, "")]
        return float(len(filled)) if self.how == "count" else _sum(filled, self.column)

    @property
    def item(self) -> str:
        """What is totalled: "Panels: total area"."""
        return f"{self.table.title}: {self.column.header.partition(' (')[0].lower()}"


def column_totals(tables: Iterable[Table]) -> tuple[Total, ...]:
    """Give the totals of every table in order."""
    return tuple(Total(table, column) for table in tables for column in table.columns if column.total)


def make_summary(facts: Sequence[tuple[str, float, str]], tables: Iterable[Table]) -> Table:
    """Make the table "summary" of facts (item, value, unit), followed by the totals of the tables."""
    totals = [(total.item, total.value, unit(total.column.name)) for total in column_totals(tables)]
    item, value, units = zip(*facts, *totals, strict=True) if facts or totals else ((), (), ())
    return make_table("summary", {"item": item, "value": value, "unit": units})


def _sum(filled: Sequence[object], column: Column) -> float:
    total = math.fsum(float(cell) for cell in filled if isinstance(cell, int | float))
    return float(format_number(total, column.decimals))
