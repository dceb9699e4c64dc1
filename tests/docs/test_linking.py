"""An office's own workbook follows ours: what docs/workbook.md says of LibreOffice, tried there."""

import re
from pathlib import Path

import openpyxl
import pytest
from linked import refreshed, write_office_book

import isomould
from museum import SMALL, changed, write_project
from recalculate import needs_libreoffice

PAGE = Path(__file__).parents[2] / "docs" / "workbook.md"


def total(book):
    found = openpyxl.load_workbook(book, data_only=True)
    title, cell = found.defined_names["total_cost"].value.replace("$", "").rsplit("!", 1)
    return found[title.strip("'")][cell].value


@pytest.mark.slow
@needs_libreoffice
def test_a_rebuild_refreshes_the_workbook_of_an_office(built_folder, tmp_path):
    before = total(built_folder / "schedules.xlsx")
    project = write_project(tmp_path / "small.toml", changed(SMALL, costs={"assembly": 99}))
    isomould.schedule(project, tmp_path / "out", run=isomould.Run(effort="quick", jobs=1))
    after = total(tmp_path / "out" / "schedules.xlsx")
    cells = [
        ("VLOOKUP(&quot;Total&quot;;['out/schedules.xlsx'#$Cost.C1:.H99];6;0)", before),
        ("SUM(['out/schedules.xlsx'#$Panels.B2:B21])", 0.0),
    ]
    found = refreshed(write_office_book(tmp_path / "office.fods", cells), tmp_path)
    assert found == [pytest.approx(after, rel=1e-12), 35]
    assert after > before + 100


def test_names_that_the_page_promises_are_defined(built_folder):
    text = PAGE.read_text(encoding="utf-8")
    promised = set(re.findall(r"`(\w+)`", text.partition("## Names")[2].partition("\n## ")[0]))
    book = openpyxl.load_workbook(built_folder / "schedules.xlsx")
    tables = {table.name for sheet in book for table in sheet.tables.values()}
    assert promised
    assert promised <= set(book.defined_names) | tables
