"""Totals of the schedules and the sums that must agree: computed here, written as live formulas."""

import math
from collections.abc import Iterable, Mapping, Sequence
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


@dataclass(frozen=True, eq=False)
class Reconciliation:
    """Two totals that must agree to `limit`."""

    what: str
    found: Total
    expected: Total
    limit: float

    @property
    def status(self) -> Literal["pass", "fail"]:
        """Whether they do."""
        return "pass" if abs(self.found.value - self.expected.value) <= self.limit else "fail"


_AREA_LIMIT = 1e-6
_RECONCILED = (
    ("Node quantities = nodes", "nodes.quantity", "node_instances.location", 0.0),
    ("Member quantities = members", "members.quantity", "member_instances.location", 0.0),
    ("Panel quantities = panels", "panels.quantity", "panel_instances.location", 0.0),
    ("Parts on sheets = panels", "sheets.parts", "panel_instances.location", 0.0),
    ("Area on sheets = panel area (m²)", "sheets.part_area_m2", "panels.total_area_m2", _AREA_LIMIT),
    ("Pieces on bars = members", "bars.pieces", "member_instances.location", 0.0),
)


def column_totals(tables: Iterable[Table]) -> tuple[Total, ...]:
    """Give the totals of every table in order."""
    return tuple(Total(table, column) for table in tables for column in table.columns if column.total)


def make_summary(facts: Sequence[tuple[str, float, str]], tables: Iterable[Table]) -> Table:
    """Make the table "summary" of facts (item, value, unit), followed by the totals of the tables."""
    totals = [(total.item, total.value, unit(total.column.name)) for total in column_totals(tables)]
    item, value, units = zip(*facts, *totals, strict=True) if facts or totals else ((), (), ())
    return make_table("summary", {"item": item, "value": value, "unit": units})


def reconcile(tables: Iterable[Table]) -> tuple[Reconciliation, ...]:
    """Pair the totals that must agree, for the tables that hold rows."""
    filled = {table.name: table for table in tables if len(table.frame)}
    pairs = ((what, _named(filled, a), _named(filled, b), limit) for what, a, b, limit in _RECONCILED)
    return tuple(Reconciliation(what, a, b, limit) for what, a, b, limit in pairs if a and b)


def _named(tables: Mapping[str, Table], path: str) -> Total | None:
    name, _, field = path.partition(".")
    if name not in tables:
        return None
    column = next(column for column in tables[name].columns if column.name == field)
    return Total(tables[name], column, "count" if field == "location" else "sum")


def _sum(filled: Sequence[object], column: Column) -> float:
    total = math.fsum(float(cell) for cell in filled if isinstance(cell, int | float))
    return float(format_number(total, column.decimals))
