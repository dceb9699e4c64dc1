"""Charts of a delivery: how often each class is built, how full the sheets are, what it costs."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from isomould.documents.costs import GROUPS, Cost
from isomould.documents.table import Table, cells

_COUNTED = {
    "nodes": "Pieces of every node class",
    "members": "Pieces of every member class",
    "panels": "Pieces of every panel class",
}


@dataclass(frozen=True)
class Chart:
    """A bar per label; `unit` is what the values are counted in."""

    title: str
    unit: str
    labels: tuple[str, ...]
    values: tuple[float, ...]


def make_charts(tables: Mapping[str, Table], cost: Cost) -> tuple[Chart, ...]:
    """Give the charts that schedules (by name) and cost have numbers for."""
    return tuple(chart for chart in _charts(tables, cost) if chart.labels)


def _charts(tables: Mapping[str, Table], cost: Cost) -> Iterator[Chart]:
    for name, title in _COUNTED.items():
        yield _chart(tables[name], title, "pieces", ("mark", "quantity"))
    yield _chart(tables["sheets"], "Yield of every sheet", "%", ("sheet", "yield_percent"))
    priced = [result for result in cost.results if result.label in GROUPS and result.live.value]
    unit = priced[0].unit if priced else ""
    yield Chart("Cost by group", unit, tuple(r.label for r in priced), tuple(r.live.value for r in priced))


def _chart(table: Table, title: str, unit: str, columns: tuple[str, str]) -> Chart:
    """Draw one column of a table over another; blanks have no bar."""
    named = {column.name: cells(table, column) for column in table.columns}
    pairs = zip(*(named[name] for name in columns), strict=True)
    bars = [(str(label), float(value)) for label, value in pairs if isinstance(value, int | float)]
    return Chart(title, unit, tuple(label for label, _ in bars), tuple(value for _, value in bars))
