"""Rates and Cost: input cells with names, limits and comments; sub-totals and the total below the lines."""

from collections.abc import Sequence

from isomould.documents.costs import Result
from isomould.documents.table import cells
from isomould.writers.formulas import RATE, formula
from isomould.writers.xlsx_checks import RED
from isomould.writers.xlsx_page import Page, absolute, write_cell, write_texts

_INPUT = {"bg_color": "#FFF2CC", "border": 1, "border_color": "#BF9000", "num_format": "#,##0.00", "locked": False}
_MONEY = "#,##0.00"
_VALIDATION = {
    "validate": "decimal",
    "criteria": ">=",
    "value": 0,
    "error_title": "Not a rate",
    "error_message": "A rate is a number, zero or more.",
}


def write_rates(page: Page) -> None:
    """Turn the values of the rates into input cells, `rate_<code>`, with a comment each; a blank one is red."""
    codes, descriptions, units = (cells(page.table, column) for column in page.table.columns[:3])
    style = page.style(**_INPUT)
    for row, value in enumerate(cells(page.table, page.table.columns[3]), start=1):
        write_cell(page, (row, 3), value, style)
        page.book.define_name(f"{RATE}{codes[row - 1]}", absolute(page, row, 3))
        page.sheet.write_comment(row, 3, f"{descriptions[row - 1]} ({units[row - 1]}). Blank counts as nothing.")
    last = len(codes)
    page.sheet.data_validation(1, 3, last, 3, _VALIDATION)
    page.sheet.conditional_format(1, 3, last, 3, {"type": "blanks", "format": page.style(**RED)})


def write_results(page: Page, results: Sequence[Result]) -> None:
    """Write the figures below the lines of the cost; those with a name get it."""
    amount = len(page.table.columns) - 1
    for row, result in enumerate(results, start=page.below):
        style = page.style(num_format=_MONEY if result.unit else "0", bold=bool(result.name))
        write_texts(page, (row, 2), [(result.label, result.unit)])
        write_cell(page, (row, amount), result.live.value, style, formula(result.live, page.table))
        if result.name:
            page.book.define_name(result.name, absolute(page, row, amount))
        if result.name == "blank_rates":
            missing = {"type": "cell", "criteria": ">", "value": 0, "format": page.style(**RED)}
            page.sheet.conditional_format(row, amount, row, amount, missing)
