import io
import re
from datetime import date

import openpyxl
import pytest
from openpyxl.utils.escape import unescape

from isomould.documents.info import ProjectInfo
from isomould.documents.table import cells
from isomould.errors import Note, Refused
from isomould.writers.xlsx import Words, write_workbook

INFO = ProjectInfo(name="A & B 5 Tower", number="=7", client="@client", revision="C", date=date(2026, 3, 1))
NOTES = [Note("W-RAIL-03", "rail.divide", "=HYPERLINK(1) straight for 6 120 mm")]


@pytest.fixture
def path(tables, tmp_path):
    write_workbook(tmp_path / "schedules.xlsx", tables[::-1], Words(INFO, NOTES))
    return tmp_path / "schedules.xlsx"


@pytest.fixture
def live(path):
    return openpyxl.load_workbook(io.BytesIO(path.read_bytes()))


@pytest.fixture
def values(path):
    return openpyxl.load_workbook(io.BytesIO(path.read_bytes()), data_only=True)


def test_cover_and_summary_are_first_and_checks_are_last(live):
    assert live.sheetnames[:2] == ["Cover", "Summary"]
    assert live.sheetnames[-1] == "Checks"


def test_every_cell_holds_the_value_and_type_of_the_table(values, tables):
    for table in tables:
        sheet = values[table.title]
        for index, column in enumerate(table.columns, start=1):
            found = [read(sheet.cell(row, index).value) for row in range(2, len(table.frame) + 2)]
            assert found == [as_excel(cell) for cell in cells(table, column)], (table.name, column.name)


def read(value):
    """Undo the `_x000D_` of the file format, which openpyxl leaves as it is."""
    return unescape(value) if isinstance(value, str) else value


def as_excel(cell):
    return {True: "yes", False: "no"}[cell] if isinstance(cell, bool) else (None if cell == "" else cell)


FORMATS = {
    "mm": "#,##0.0",
    "°": "#,##0.00",
    "m²": "#,##0.00",
    "kg": "[>=1000]#,##0;#,##0.0",
    "%": "#,##0.0",
    "Price": "#,##0.00",
}
"""How people read numbers of a unit, or of a column."""


def test_numbers_have_the_formats_of_their_units(live, tables):
    """Only what is shown is shortened: `test_every_cell_holds_the_value_…` reads what is stored."""
    seen = set()
    for table in tables:
        for index, column in enumerate(table.columns, start=1):
            of = re.search(r"\((.+)\)$|^(Price)$", column.header)
            unit = of and (of[1] or of[2])
            if column.kind == "number" and unit in FORMATS:
                assert live[table.title].cell(2, index).number_format == FORMATS[unit], column.name
                seen.add(unit)
    assert {"mm", "m²", "kg", "Price"} <= seen


def test_figures_of_the_summary_have_the_formats_of_their_units(live):
    sheet = live["Summary"]
    formats = {(row[0].value, row[2].value or ""): row[1].number_format for row in sheet.iter_rows(2) if row[1].value}
    assert formats["Greatest deviation", "mm"] == "#,##0.0"
    totals = {unit: style for (_, unit), style in formats.items()}
    assert totals["m²"] == "#,##0.00"
    assert totals["kg"] == "[>=1000]#,##0;#,##0.0"


def test_one_named_table_per_sheet_with_filters_and_frozen_header(live, tables):
    for table in tables:
        sheet = live[table.title]
        (found,) = sheet.tables.values()
        assert found.name == "tbl" + table.name.title().replace("_", "")
        assert [column.name for column in found.tableColumns] == [column.header for column in table.columns]
        assert found.autoFilter is not None
        assert sheet.freeze_panes == "B2"


def test_pages_are_landscape_one_wide_with_repeated_header(live):
    for sheet in live:
        assert sheet.page_setup.orientation == "landscape"
        assert sheet.sheet_properties.pageSetUpPr.fitToPage
        assert (sheet.page_setup.fitToWidth or 1, sheet.page_setup.fitToHeight) == (1, 0)
        assert sheet.print_title_rows == "$1:$1"
        assert "A && B 5 Tower, =7, revision C" in sheet.oddHeader.left.text


def formulas(book):
    return {
        (sheet.title, cell.coordinate): cell.value
        for sheet in book
        for row in sheet
        for cell in row
        if cell.data_type == "f"
    }


def test_only_our_cells_are_formulas_and_user_text_is_none(live, values):
    found = formulas(live)
    assert {sheet for sheet, _ in found} == {"Cover", "Summary", "Panels", "Bars", "Checks"}
    ours = ("=SUM(", "=SUMPRODUCT(tbl", "=SUBTOTAL(109,tbl", "=tbl", "=COUNTA(", "=IF(", "=COUNTIF(")
    assert all(text.startswith(ours) for text in found.values())
    assert all(values[sheet][at].value is not None for sheet, at in found)
    linked = {cell.hyperlink.location for sheet in live for row in sheet for cell in row if cell.hyperlink}
    assert linked == {f"'{name}'!A1" if " " in name else f"{name}!A1" for name in live.sheetnames[1:]}


def test_totals_are_live_and_carry_their_values(live, values):
    header = [cell.value for cell in live["Panels"][1]]
    area, total = (header.index(name) + 1 for name in ("Area (m²)", "Total area (m²)"))
    assert (
        live["Panels"].cell(2, total).value == "=tblPanels[[#This Row],[Quantity]]*tblPanels[[#This Row],[Area (m²)]]"
    )
    assert values["Panels"].cell(2, total).value == 3 * values["Panels"].cell(2, area).value == 3.0000015
    assert live["Panels"].cell(4, total).value == "=SUBTOTAL(109,tblPanels[Total area (m²)])"
    assert values["Panels"].cell(4, total).value == 3.1000015


def test_summary_totals_the_tables(live, values):
    rows = {row[0].value: row[1] for row in live["Summary"].iter_rows(min_row=2, max_col=2)}
    assert rows["Panels: total area"].value == "=SUM(tblPanels[Total area (m²)])"
    assert values["Summary"][rows["Panels: total area"].coordinate].value == 3.1000015
    assert rows["Greatest deviation"].value == 12.3456


def texts(sheet):
    return {cell.value for row in sheet for cell in row if cell.data_type == "s"}


def test_title_block_stands_on_the_cover_and_notes_on_the_summary_as_text(live):
    assert {"A & B 5 Tower", "=7", "@client", "2026-03-01"} <= texts(live["Cover"])
    assert {"W-RAIL-03", NOTES[0].text} <= texts(live["Summary"])


def test_the_cover_shows_what_failed(live, values):
    rows = {row[0].value: row[1] for row in values["Cover"].iter_rows(max_col=2)}
    assert (rows["All checks"].value, rows["Panels"].value, rows["Panel instances"].value) == ("fail", 2, 4)
    assert live["Cover"][rows["All checks"].coordinate].value == '=IF(failed_checks=0,"pass","fail")'
    (rule,) = [rule for found in live["Cover"].conditional_formatting for rule in found.rules]
    assert rule.formula == ['"fail"']


def test_reconciliation_is_live_and_failures_turn_red(live, values):
    rows = {row[1].value: row for row in values["Checks"].iter_rows(min_row=4)}
    row = rows["Panel quantities = panels"]
    assert [cell.value for cell in row] == ["R1", row[1].value, 4, 4, None, None, None, "pass", None]
    formula = live["Checks"][row[7].coordinate].value
    assert formula.startswith("=IF(ABS(SUM(tblPanels[Quantity])-COUNTA(tblPanelInstances[Location]))")
    rules = [rule for found in live["Checks"].conditional_formatting for rule in found.rules]
    assert [rule.formula for rule in rules] == [['"fail"'], ["0"]]
    assert values["Checks"][failed_checks(live)].value == 1


def failed_checks(book):
    return book.defined_names["failed_checks"].value.replace("$", "").rpartition("!")[2]


def test_texts_longer_than_excel_holds_are_refused(tables, tmp_path):
    bars = next(table for table in tables if table.name == "bars")
    bars.frame.loc[0, "bar"] = "x" * 32768
    with pytest.raises(Refused, match="E-OUT-04 sheet Bars"):
        write_workbook(tmp_path / "schedules.xlsx", tables, Words(INFO))
    assert not (tmp_path / "schedules.xlsx").exists()


def test_tables_without_rows_are_written(tables, tmp_path):
    empty = [table.__class__(table.name, table.title, table.columns, table.frame.iloc[:0]) for table in tables]
    write_workbook(tmp_path / "empty.xlsx", empty, Words(INFO))
    book = openpyxl.load_workbook(tmp_path / "empty.xlsx", data_only=True)
    assert [cell.value for cell in book["Panels"][2] if cell.value is not None] == []
