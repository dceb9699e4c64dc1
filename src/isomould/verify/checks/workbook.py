"""V41: the workbook says what the tables say, cell by cell, and its formulas show what they compute."""

import re

from isomould.verify.delivery import Delivery
from isomould.verify.formula import evaluate
from isomould.verify.read.tables import Table, number
from isomould.verify.read.workbook import Cell, Value, Workbook
from isomould.verify.rules import Measured, Rule, Unreadable, faults, worst_of

CALCULATED = {"Cover", "Summary", "Checks", "Cost", "Rates", "Repetition"}
"""Sheets that may hold formulas and texts anywhere."""

_NUMERIC = re.compile(
    r".*_(mm|deg|kg|m2|cm3|percent)|(axis|ref)_[xyz]|i|j|quantity(_\w+)?|valence|slots|facets|fins|holes|threads"
    r"|arm|base_holes|parts|cuts|(total_)?pieces|first_corner|value|worst|limit|count|rate|amount|price|parallels|generatrices|aspect"
    r"|freegrid_planarity|freegrid_lengths"
    r"|horizontal_parallels|\w+_(count|classes|cost)"
)
_LISTS = {"packers_mm"}


def cells(delivery: Delivery) -> Measured:
    """Compare every cell of every table, type and value; nothing but totals stands below a table."""
    titles = {table.name.replace("_", " ").capitalize() for table in delivery.tables.values()}
    alone = sorted(delivery.workbook.sheets.keys() - titles - CALCULATED)
    problems, count = [f"sheet {title} has no table" for title in alone], 0
    for table in delivery.tables.values():
        problems += _table_faults(delivery.workbook, table)
        count += table.rows * len(table.columns)
    return faults(count, problems)


def _table_faults(workbook: Workbook, table: Table) -> list[str]:
    title = table.name.replace("_", " ").capitalize()
    if title not in workbook.sheets:
        return [f"sheet {title} is missing"]
    sheet = workbook.sheets[title]
    inside = {(row, column) for row in range(1, table.rows + 2) for column in range(1, len(table.columns) + 1)}
    strays = [] if title in CALCULATED else _strays(sheet, table, inside)
    problems = [f"{title} {place}: {_shown(sheet[place])} is in no table" for place in strays]
    for column, (name, texts) in enumerate(table.columns.items(), 1):
        for row, text in enumerate(texts, 2):
            found = sheet.get((row, column), Cell(None))
            if not _agrees(name, text, found, anywhere=title in CALCULATED):
                problems.append(f"{title} row {row} {name}: {_shown(found)}, table says {text!r}")
    return problems


def _strays(sheet: dict[tuple[int, int], Cell], table: Table, inside: set[tuple[int, int]]) -> list[tuple[int, int]]:
    """Give the cells outside the table that are neither a formula nor a text under it."""
    below = table.rows + 1
    return [
        place
        for place, cell in sorted(sheet.items())
        if place not in inside and not (place[0] > below and (cell.formula or isinstance(cell.value, str)))
    ]


def _agrees(column: str, text: str, cell: Cell, *, anywhere: bool) -> bool:
    if cell.formula and not (anywhere or _computed(column)):
        return False
    return _is_number(text, cell) if _wants_number(column) and text else _is_text(text, cell.value)


def _wants_number(column: str) -> bool:
    return _NUMERIC.fullmatch(column) is not None and column not in _LISTS


def _is_number(text: str, cell: Cell) -> bool:
    """Tell whether the cell holds a number, the table's to the last bit."""
    if isinstance(cell.value, bool) or not isinstance(cell.value, int | float):
        return False
    return float(cell.value) == number(text)


def _is_text(text: str, value: Value) -> bool:
    if isinstance(value, bool):
        return text == ("yes" if value else "no")
    return text == ("" if value is None else value)


def _shown(cell: Cell) -> str:
    return cell.formula or repr(cell.value)


def formulas(delivery: Delivery) -> Measured:
    """Compute every formula anew from the values shown, relative to the size of the value."""
    book = delivery.workbook
    found = [(s, place, c) for s, sheet in book.sheets.items() for place, c in sheet.items() if c.formula]
    off = [_off(book, sheet, place, cell) for sheet, place, cell in found]
    return worst_of(off, [f"{sheet} {place} {cell.formula}" for sheet, place, cell in found])


def _off(book: Workbook, sheet: str, place: tuple[int, int], cell: Cell) -> float:
    own = evaluate(book, sheet, place[0], cell.formula)
    if isinstance(own, int | float) and isinstance(cell.value, int | float):
        return abs(own - cell.value) / max(1.0, abs(own))
    return 0.0 if own == cell.value else float("inf")


def whitelist(delivery: Delivery) -> Measured:
    """Formulas stand in total columns and under tables only, and on the sheets meant for computing."""
    problems, count = list[str](), 0
    for title, sheet in delivery.workbook.sheets.items():
        for (row, column), cell in sheet.items():
            if cell.formula and title not in CALCULATED:
                count += 1
                problems += [f"{title} ({row}, {column}): {cell.formula}"] * (
                    not _may_compute(_table_of(delivery, title), row, column)
                )
    return faults(max(count, 1), problems)


def _table_of(delivery: Delivery, title: str) -> Table:
    name = title.lower().replace(" ", "_")
    if name not in delivery.tables:
        message = f"sheet {title} holds formulas but belongs to no table"
        raise Unreadable(message)
    return delivery.tables[name]


def _may_compute(table: Table, row: int, column: int) -> bool:
    return row > table.rows + 1 or _computed(list(table.columns)[column - 1])


def _computed(column: str) -> bool:
    """Tell whether the cells of a column are formulas: products with the quantity, and prices out of the rates."""
    return column.startswith("total_") or column == "price"


RULES = (
    Rule("V41", "workbook cells = tables, types and values", 0, "cells", cells),
    Rule("V41b", "formulas show what they compute", 1e-9, "relative", formulas),
    Rule("V41c", "formulas only where they belong", 0, "formulas", whitelist),
)
