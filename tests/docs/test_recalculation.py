"""LibreOffice, an independent reader, opens the workbook, recalculates every value, and follows every rate."""

import csv

import openpyxl
import pytest
from recalculate import needs_libreoffice, recalculate, with_cell


@pytest.mark.slow
@needs_libreoffice
def test_every_stored_value_comes_back(built_folder, tmp_path):
    (book,) = recalculate([built_folder / "schedules.xlsx"], tmp_path)
    ours, theirs = (openpyxl.load_workbook(path, data_only=True) for path in (built_folder / "schedules.xlsx", book))
    formulas = openpyxl.load_workbook(built_folder / "schedules.xlsx")
    compared = 0
    for sheet in formulas:
        for row in sheet.iter_rows():
            for cell in row:
                if cell.data_type == "f":
                    stored, found = (book[sheet.title][cell.coordinate].value for book in (ours, theirs))
                    assert found == (pytest.approx(stored, rel=1e-12) if isinstance(stored, float | int) else stored)
                    compared += 1
    assert compared > 50


def read(folder, name):
    with (folder / "tables" / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def predict(folder, rates):
    """Add up the cost from the quantities and rates alone."""
    pieces = {name: sum(int(row["quantity"]) for row in read(folder, name)) for name in ("nodes", "members", "panels")}
    quantity = {line["code"]: float(line["quantity"]) for line in read(folder, "cost")}
    quantity["assembly"] = sum(rates[f"hours_{name[:-1]}"] * count for name, count in pieces.items())
    works = sum(amount * rates[code] for code, amount in quantity.items())
    return works * (1 + rates["overhead"] / 100) * (1 + rates["margin"] / 100)


@pytest.mark.slow
@needs_libreoffice
def test_a_tenth_more_on_any_rate_moves_the_total_as_predicted(built_folder, tmp_path):
    book = built_folder / "schedules.xlsx"
    rows = {row["code"]: (k, float(row["value"] or 0)) for k, row in enumerate(read(built_folder, "rates"), start=2)}
    rates = {code: value for code, (_, value) in rows.items()}
    sheet = openpyxl.load_workbook(book, read_only=True).sheetnames.index("Rates") + 1
    raised = {code: rates | {code: value * 1.1} for code, value in rates.items() if value}
    changed = [
        with_cell(book, sheet, f"D{rows[code][0]}", after[code], tmp_path / f"{code}.xlsx")
        for code, after in raised.items()
    ]
    assert len(changed) > 12
    for path, after in zip(recalculate(changed, tmp_path), raised.values(), strict=True):
        found = openpyxl.load_workbook(path, data_only=True)
        title, cell = found.defined_names["total_cost"].value.replace("$", "").rsplit("!", 1)
        assert found[title.strip("'")][cell].value == pytest.approx(predict(built_folder, after), rel=1e-12)
