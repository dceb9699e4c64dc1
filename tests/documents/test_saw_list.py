"""The saw list on paper: nothing overlaps, however many bars and pieces there are."""

import pytest

from isomould.documents.info import ProjectInfo
from isomould.documents.shop.checks import clashes
from isomould.documents.shop.page import Text
from isomould.documents.shop.saw_list import saw_list
from isomould.documents.shop.title_block import Stationery, read_title_block
from isomould.nesting.bars import nest_bars
from isomould.nesting.layout import Member
from isomould.nesting.settings import BarStock, StockSettings
from isomould.templates import template_folder

BLOCK = read_title_block((template_folder() / "sheets" / "title-block.toml").read_text(encoding="utf-8"))


@pytest.mark.parametrize(("length", "quantity", "stock"), [(1430, 130, None), (59, 250, None), (900, 20, 2)])
def test_nothing_overlaps_and_all_is_said(length, quantity, stock):
    bars = (BarStock(section="FL200*12", length=6000, price=80, quantity=stock),)
    members = [Member("M01", "FL200*12", length, quantity), Member("M02", "FL200*12", length / 2, 3)]
    settings = StockSettings(bars=bars, bar_trim=10)
    layout = nest_bars(members, settings)
    book = saw_list(Stationery(BLOCK, ProjectInfo(name="Hall")), layout, settings)
    assert [clash for page in book.pages for clash in clashes(page)] == []
    texts = [item.text for page in book.pages for item in page.items if isinstance(item, Text)]
    assert {bar.id for bar in layout.bars} <= set(texts)
    assert texts.count("Offcut (mm)") == len(layout.bars) + 1
    assert ("No place for" in texts) == bool(layout.unplaced)
    pieces = [cut for bar in layout.bars for cut in bar.cuts]
    assert texts.count("M01") + texts.count("M02") == len(pieces) + len({one.id for one in layout.unplaced})
