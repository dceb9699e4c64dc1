"""The cutting plan: nothing overlaps, and every page says what the layout says."""

import numpy as np
import pytest

from isomould.documents.info import ProjectInfo
from isomould.documents.shop.checks import clashes
from isomould.documents.shop.cutting_plan import cutting_plan
from isomould.documents.shop.page import Text
from isomould.documents.shop.title_block import Stationery, read_title_block
from isomould.nesting.layout import Part
from isomould.nesting.nest import nest_sheets
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings
from isomould.templates import template_folder

BLOCK = read_title_block((template_folder() / "sheets" / "title-block.toml").read_text(encoding="utf-8"))


def plan(parts, **stock):
    sheets = (SheetStock(name="Jumbo, grey", width=6000, height=3210, price=180, quantity=stock.pop("quantity", None)),)
    settings = StockSettings(sheets=sheets, **stock)
    layout = nest_sheets(parts, settings, Search("quick"))
    return layout, cutting_plan(Stationery(BLOCK, ProjectInfo(name="Hall")), layout, settings)


def texts(page):
    return {item.text for item in page.items if isinstance(item, Text)}


def panels(count, size):
    shape = np.array([(0.0, 0.0), (1.0, 0.0), (0.9, 0.8), (0.05, 0.8)])
    return [Part(f"Panel-{k:02}", np.round(shape * (size + 7 * k), 3), 3, row=k) for k in range(count)]


@pytest.mark.parametrize(
    ("count", "size", "stock"),
    [(4, 900, {"trim": 15.0, "kerf": 2.0}), (8, 210, {}), (3, 40, {"trim": 10.0}), (5, 1500, {"quantity": 1})],
)
def test_nothing_overlaps_and_all_is_said(count, size, stock):
    layout, book = plan(panels(count, size), **stock)
    assert [clash for page in book.pages for clash in clashes(page)] == []
    pages = {page.name: page for page in book.pages}
    cover = texts(book.pages[0])
    for sheet in layout.sheets:
        here = [item for item in layout.placements if item.sheet == sheet.id]
        own = set().union(*(texts(page) for name, page in pages.items() if name.startswith(sheet.id)))
        assert {sheet.id, "Jumbo, grey", f"{sheet.width:g}", f"{sheet.height:g}"} <= own
        assert {str(item.id) for item in here} <= own
        assert {str(k) for k in range(1, len(here) + 1)} <= own
        assert sheet.id in cover
    assert {str(item.id) for item in layout.unplaced} <= cover


def test_parts_are_numbered_in_cutting_order():
    layout, book = plan(panels(2, 900))

    def freed(tree):
        yield from [tree["placement"]] if "placement" in tree else []
        for piece in tree.get("pieces", []):
            yield from freed(piece)

    order = [layout.placements[k].id for k in freed(layout.cut_trees["S001"])]
    page = next(page for page in book.pages if page.name == "S001")
    listed = [item for item in page.items if isinstance(item, Text) and item.text.startswith("Panel")]
    column = max(item.at[0] for item in listed)
    rows = sorted((item for item in listed if abs(item.at[0] - column) < 1e-6), key=lambda item: -item.at[1])
    assert [item.text for item in rows] == order
