"""Sums that must agree across the schedules: computed here, written as live formulas that turn red."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from isomould.documents.costs import GROUPS
from isomould.documents.live import Given, Live, add_up
from isomould.documents.quantities import Tables, count, products, sum_if, total
from isomould.documents.table import Table, cells

Side = Callable[[Tables], Live]
_AREA_LIMIT, _MASS_LIMIT, _MONEY_LIMIT = 1e-6, 1e-6, 1e-6


@dataclass(frozen=True, eq=False)
class Reconciliation:
    """Two figures that must agree to `limit`."""

    what: str
    found: Live
    expected: Live
    limit: float

    @property
    def status(self) -> Literal["pass", "fail"]:
        """Whether they do."""
        return "pass" if abs(self.found.value - self.expected.value) <= self.limit else "fail"


def reconcile(tables: Iterable[Table]) -> tuple[Reconciliation, ...]:
    """Pair the figures that must agree, for the tables that hold rows."""
    filled = {table.name: table for table in tables if len(table.frame)}
    return tuple(
        Reconciliation(what, found(filled), expected(filled), limit)
        for what, names, found, expected, limit in _RECONCILED
        if filled.keys() >= set(names.split())
    )


def _sum(path: str) -> Side:
    return lambda tables: total(tables, path)


def _count(path: str) -> Side:
    return lambda tables: count(tables, path)


def _products(one: str, other: str) -> Side:
    return lambda tables: products(tables, one, other)


def _line(code: str, column: str) -> Side:
    """Give a figure of one line of the cost."""
    return lambda tables: sum_if(tables["cost"], "code", code, column)


def _stock_lines(kind: str) -> Side:
    """Add up the lines of all stock sheets or bars."""
    return lambda tables: _added(
        [sum_if(tables["cost"], "code", code, "amount") for code in _codes(tables["cost"]) if code.startswith(kind)]
    )


def _codes(cost: Table) -> list[str]:
    return [str(code) for code in cells(cost, cost.columns[0])]


def _groups(tables: Tables) -> Live:
    return _added([sum_if(tables["cost"], "group", group, "amount") for group in GROUPS])


def _masses(tables: Tables) -> Live:
    """Mass of all parts in tonnes, part by part; caps are in no other part, fins in nodes, end plates in members."""
    parts = [products(tables, f"{part}.quantity", "mass_kg") for part in ("nodes", "members", "panels")]
    caps = [sum_if(tables["fittings"], "kind", "cap", "total_mass_kg")] if "fittings" in tables else []
    return _added([*parts, *caps]) / Given(1000.0)


def _lines(*codes: str) -> Side:
    """Add up the quantities of some lines of the cost."""
    return lambda tables: _added([sum_if(tables["cost"], "code", code, "quantity") for code in codes])


def _added(values: Sequence[Live]) -> Live:
    return add_up(values) if values else Given(0.0)


_PARTS = "nodes members panels"
_RECONCILED: tuple[tuple[str, str, Side, Side, float], ...] = (
    ("Node quantities = nodes", "nodes node_instances", _sum("nodes.quantity"), _count("node_instances.location"), 0.0),
    (
        "Member quantities = members",
        "members member_instances",
        _sum("members.quantity"),
        _count("member_instances.location"),
        0.0,
    ),
    (
        "Panel quantities = panels",
        "panels panel_instances",
        _sum("panels.quantity"),
        _count("panel_instances.location"),
        0.0,
    ),
    (
        "Arms of nodes = ends of members",
        "nodes members",
        _products("nodes.quantity", "valence"),
        lambda tables: total(tables, "members.quantity") * Given(2.0),
        0.0,
    ),
    (
        "Parts on sheets = panels",
        "sheets panel_instances",
        _sum("sheets.parts"),
        _count("panel_instances.location"),
        0.0,
    ),
    (
        "Pieces on bars = members",
        "bars member_instances",
        _sum("bars.pieces"),
        _count("member_instances.location"),
        0.0,
    ),
    (
        "Area on sheets = panel area (m²)",
        "sheets panels",
        _sum("sheets.part_area_m2"),
        _sum("panels.total_area_m2"),
        _AREA_LIMIT,
    ),
    (
        "Area × quantity = panel area (m²)",
        "panels",
        _products("panels.quantity", "area_m2"),
        _sum("panels.total_area_m2"),
        _AREA_LIMIT,
    ),
    ("Mass transported = mass of parts (t)", f"cost {_PARTS}", _line("transport", "quantity"), _masses, _MASS_LIMIT),
    (
        "Price of sheets = their lines of the cost",
        "cost sheets",
        _sum("sheets.price"),
        _stock_lines("sheet_"),
        _MONEY_LIMIT,
    ),
    ("Price of bars = their lines of the cost", "cost bars", _sum("bars.price"), _stock_lines("bar_"), _MONEY_LIMIT),
    (
        "Bolts, nuts and washers paid for = hardware",
        "cost hardware",
        _lines("bolt", "nut", "washer"),
        _products("hardware.quantity", "pieces"),
        0.0,
    ),
    (
        "Caps, end plates and fins paid for = fittings",
        "cost fittings",
        _lines("cap", "end_plate", "fin"),
        _sum("fittings.quantity"),
        0.0,
    ),
    ("Sub-totals = lines of the cost", "cost", _groups, _sum("cost.amount"), _MONEY_LIMIT),
)
"""What is compared, the tables that it needs, both sides, and by how much they may differ."""
