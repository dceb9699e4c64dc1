"""V45f: seeded faults in a cutting plan, and what it says of parts without a place."""

from dataclasses import replace

import numpy as np
import pytest
from verify_museum import holding, status, table, vault

from isomould.documents.info import ProjectInfo
from isomould.documents.shop.cutting_plan import cutting_plan
from isomould.documents.shop.page import Text
from isomould.documents.shop.rows import schedule_rows
from isomould.documents.shop.title_block import Stationery, read_title_block
from isomould.documents.stock_tables import sheet_table
from isomould.nesting.layout import Part
from isomould.nesting.nest import nest_sheets
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings
from isomould.templates import template_folder
from isomould.verify.checks import cutting_plan as checks
from isomould.verify.read.layout import Layout, Placement
from isomould.verify.read.pdf import Book, Sheet

BLOCK = read_title_block((template_folder() / "sheets" / "title-block.toml").read_text(encoding="utf-8"))
STOCK = StockSettings(sheets=(SheetStock(name="Glas grün", width=3000, height=1600, price=80),), trim=10)
DESIGN = vault().design
TRAPEZOID = np.array([[0, 0], [1000, 0], [900, 500], [200, 500.0]])


def planned(parts, stock=STOCK):
    layout = nest_sheets(parts, stock, Search("quick"))
    return layout, cutting_plan(Stationery(BLOCK, ProjectInfo(name="Plan")), layout, stock)


def located(mark, outline, quantity):
    return Part(mark, outline, quantity, None, tuple(f"P-00-{k:02d}" for k in range(quantity)))


PARTS = [located("P01", TRAPEZOID, 14)]


def test_what_finds_no_place_is_listed_with_the_size_that_it_needs():
    stock = STOCK.model_copy(update={"sheets": (STOCK.sheets[0].model_copy(update={"quantity": 1}),)})
    layout, book = planned(PARTS, stock)
    texts = [item.text for item in book.pages[0].items if isinstance(item, Text)]
    at = texts.index("No place for")
    assert texts[at : at + 10][5:7] == ["P01", str(len(layout.unplaced))]
    assert texts[at : at + 10][8:] == ["1000", "500"]
    assert any("Status incomplete" in text for text in texts)


def delivery(change=lambda name, texts: texts):
    layout, book = planned(PARTS)
    pages = [
        Sheet(page.name, tuple(change(page.name, [i.text for i in page.items if isinstance(i, Text)])))
        for page in book.pages
    ]
    rows = schedule_rows(sheet_table(layout, STOCK))
    placed = tuple(
        Placement(str(p.id), str(p.location), p.sheet, p.points, p.rotation_deg, False) for p in layout.placements
    )
    held = holding(
        design=replace(DESIGN, raw={**DESIGN.raw, "drawings": True}),
        tables={"sheets": table("sheets", **{name: [row[name] for row in rows] for name in rows[0]})},
        layout=Layout({s.id: (s.width, s.height) for s in layout.sheets}, placed, {"cut_tree": layout.cut_trees}),
        plan=Book("cutting-plan", tuple(pages)),
    )
    return held, rows


def without(text):
    return lambda name, texts: [other for other in texts if other != text]


def test_a_plan_as_drawn_passes():
    check = status(checks.RULES, "V45f", delivery()[0])
    assert check.status == "pass", check


FAULTS = {
    "page": lambda name, texts: [] if name == "S002" else texts,
    "list": lambda name, texts: [] if name.startswith("Cutting plan") else texts,
    "location": without("P-00-01"),
    "number": without("3"),
    "label": without("Yield (%)"),
    "two parts change places": lambda name, texts: [{"1": "2", "2": "1"}.get(text, text) for text in texts],
    "another yield in the list": lambda name, texts: [
        f"{text}1" if name.startswith("Cutting plan") and "." in text else text for text in texts
    ],
}


@pytest.mark.parametrize("change", FAULTS.values(), ids=FAULTS)
def test_faults_are_found(change):
    assert status(checks.RULES, "V45f", delivery(change)[0]).status == "fail"
