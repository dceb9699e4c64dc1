"""The sheet of checks: those of the makers, and sums that must agree as formulas that turn red."""

from collections.abc import Sequence

from xlsxwriter.utility import xl_range_abs

from isomould.documents.reconciliations import reconcile
from isomould.documents.table import Table, cells
from isomould.writers.formulas import formula, status_formula
from isomould.writers.xlsx_page import Page, absolute, write_cell, write_texts

RED = {"bg_color": "#FFC7CE", "font_color": "#9C0006"}
FAILED = "failed_checks"
"""Defined name of the number of failed checks."""


def write_reconciliations(page: Page, tables: Sequence[Table]) -> int:
    """Write the sums that must agree under the columns of the checks, turn what fails red, and count it."""
    status = [column.name for column in page.table.columns].index("status")
    write_texts(page, (page.below, 0), [("Id", "Reconciliation")])
    for column, side in enumerate(("Found", "Expected"), start=2):
        write_cell(page, (page.below, column), side, page.style(align="right"))
    figure = page.style(num_format="#,##0.000")
    failed, row = cells(page.table, page.table.columns[status]).count("fail"), page.below
    for row, check in enumerate(reconcile(tables), start=page.below + 1):
        write_texts(page, (row, 0), [(f"R{row - page.below}", check.what)])
        for column, side in enumerate((check.found, check.expected), start=2):
            write_cell(page, (row, column), side.value, figure, formula(side, page.table))
        write_cell(page, (row, status), check.status, None, status_formula(check, page.table))
        failed += check.status == "fail"
    failing = {"type": "cell", "criteria": "==", "value": '"fail"', "format": page.style(**RED)}
    page.sheet.conditional_format(1, status, row, status, failing)
    _write_count(page, (row + 2, status), failed)
    return failed


def _write_count(page: Page, at: tuple[int, int], failed: int) -> None:
    """Count what failed, under a name."""
    above = xl_range_abs(1, at[1], at[0] - 2, at[1])
    write_texts(page, (at[0], 1), [("Checks that failed",)])
    write_cell(page, at, failed, page.style(num_format="0", bold=True), f'=COUNTIF({above},"fail")')
    page.book.define_name(FAILED, absolute(page, *at))
    some = {"type": "cell", "criteria": ">", "value": 0, "format": page.style(**RED)}
    page.sheet.conditional_format(*at, *at, some)
