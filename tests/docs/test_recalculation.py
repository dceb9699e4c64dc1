"""LibreOffice, an independent reader, opens the workbook, recalculates every value, and follows every rate."""

import csv

import openpyxl
import pytest

import isomould
from museum import SMALL, TEMPLATES, write_project
from recalculate import needs_libreoffice, recalculate, with_cell


def assert_same(ours, theirs):
    """Compare every formula's stored value with the one that LibreOffice computes; give their number."""
    formulas = openpyxl.load_workbook(ours)
    stored, found = (openpyxl.load_workbook(book, data_only=True) for book in (ours, theirs))
    cells = [cell for sheet in formulas for row in sheet.iter_rows() for cell in row if cell.data_type == "f"]
    for cell in cells:
        value, other = (book[cell.parent.title][cell.coordinate].value for book in (stored, found))
        assert other == (pytest.approx(value, rel=1e-12) if isinstance(value, float | int) else value), cell
    return len(cells)


@pytest.mark.slow
@needs_libreoffice
def test_every_stored_value_comes_back(built_folder, tmp_path):
    families = tmp_path / "families.xlsx"
    isomould.compare(write_project(tmp_path / "small.toml", SMALL), out=families)
    books = [built_folder / "schedules.xlsx", families]
    counts = list(map(assert_same, books, recalculate(books, tmp_path)))
    assert counts[0] > 100
    assert counts[1] == 5 * 14


@pytest.mark.long
@needs_libreoffice
@pytest.mark.parametrize("name", sorted(path.stem for path in TEMPLATES.glob("*.toml")))
def test_every_stored_value_of_a_template_comes_back(name, tmp_path):
    run = isomould.Run(effort="quick", jobs=1)
    book = isomould.schedule(TEMPLATES / f"{name}.toml", tmp_path / "out", run=run).folder / "schedules.xlsx"
    assert assert_same(book, *recalculate([book], tmp_path)) > 100


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


def rate_cells(folder):
    """Row on the sheet, and value, of every rate by its code."""
    return {row["code"]: (k, float(row["value"] or 0)) for k, row in enumerate(read(folder, "rates"), start=2)}


def with_rates(folder, rates, target):
    """Copy the workbook with other rates in its input cells."""
    book, cells = folder / "schedules.xlsx", rate_cells(folder)
    sheet = openpyxl.load_workbook(book, read_only=True).sheetnames.index("Rates") + 1
    for code, value in rates.items():
        if value != cells[code][1]:
            book = with_cell(book, sheet, f"D{cells[code][0]}", value, target.with_stem(f"{target.stem}-{code}"))
    return book


def total_cost(book):
    found = openpyxl.load_workbook(book, data_only=True)
    title, cell = found.defined_names["total_cost"].value.replace("$", "").rsplit("!", 1)
    return found[title.strip("'")][cell].value


@pytest.mark.slow
@needs_libreoffice
def test_other_rates_move_the_total_as_predicted(built_folder, tmp_path):
    """All at once, each by a share of its own: what is added twice or left out would show."""
    given = [(code, value) for code, (_, value) in rate_cells(built_folder).items()]
    rates = {code: value * (1.1 + k / 100) for k, (code, value) in enumerate(given)}
    (book,) = recalculate([with_rates(built_folder, rates, tmp_path / "raised.xlsx")], tmp_path)
    assert total_cost(book) == pytest.approx(predict(built_folder, rates), rel=1e-12)


@pytest.mark.long
@needs_libreoffice
def test_a_tenth_more_on_any_rate_moves_the_total_as_predicted(built_folder, tmp_path):
    rates = {code: value for code, (_, value) in rate_cells(built_folder).items()}
    raised = {code: rates | {code: value * 1.1} for code, value in rates.items() if value}
    changed = [with_rates(built_folder, after, tmp_path / "one.xlsx") for after in raised.values()]
    assert len(changed) > 12
    for book, after in zip(recalculate(changed, tmp_path), raised.values(), strict=True):
        assert total_cost(book) == pytest.approx(predict(built_folder, after), rel=1e-12)
