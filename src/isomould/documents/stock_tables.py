"""The tables of sheets and bars (deliverables, Folder)."""

import numpy as np

from isomould.documents.live import RateCell
from isomould.documents.table import Table, make_live_table
from isomould.nesting.layout import BarLayout, Layout, Placement, Sheet
from isomould.nesting.settings import StockSettings
from isomould.parts.outline import area, sides

Columns = dict[str, list[object]]


def sheet_table(layout: Layout, stock: StockSettings) -> Table:
    """Give one row per sheet: parts, areas, cut lengths, the largest offcut along an edge, price (that of its rate)."""
    price = {sheet.name: RateCell(f"sheet_{k}", sheet.price) for k, sheet in enumerate(stock.sheets, start=1)}
    on: dict[str, list[Placement]] = {sheet.id: [] for sheet in layout.sheets}
    for placement in layout.placements:
        on[placement.sheet].append(placement)
    areas = [sum(abs(area(p.points - p.points[0])) for p in on[sheet.id]) for sheet in layout.sheets]
    offcut = [_offcut(sheet, on[sheet.id], stock) for sheet in layout.sheets]
    data: Columns = {
        "sheet": [sheet.id for sheet in layout.sheets],
        "stock": [sheet.stock for sheet in layout.sheets],
        "parts": [len(on[sheet.id]) for sheet in layout.sheets],
        "part_area_m2": [value / 1e6 for value in areas],
        "yield_percent": [100 * a / (s.width * s.height) for a, s in zip(areas, layout.sheets, strict=True)],
        "cut_length_mm": [sum(float(sides(p.points).sum()) for p in on[sheet.id]) for sheet in layout.sheets],
        "cuts": [len(on[sheet.id]) for sheet in layout.sheets],
        "offcut_width_mm": [width for width, _ in offcut],
        "offcut_height_mm": [height for _, height in offcut],
        "price": [price.get(sheet.stock) for sheet in layout.sheets],
        "file": [f"sheets/{sheet.id}.dxf" for sheet in layout.sheets],
    }
    return make_live_table("sheets", data)


def bar_table(layout: BarLayout, stock: StockSettings) -> Table:
    """Give one row per bar; used is what pieces and kerfs take."""
    price = {(bar.section, bar.length): RateCell(f"bar_{k}", bar.price) for k, bar in enumerate(stock.bars, start=1)}
    data: Columns = {
        "bar": [bar.id for bar in layout.bars],
        "stock": [bar_name(bar.section, bar.length) for bar in layout.bars],
        "pieces": [len(bar.cuts) for bar in layout.bars],
        "used_mm": [bar.length - bar.rest for bar in layout.bars],
        "offcut_mm": [bar.rest for bar in layout.bars],
        "price": [price[bar.section, bar.length] for bar in layout.bars],
    }
    return make_live_table("bars", data)


def bar_name(section: str, length: float) -> str:
    """Name a stock bar.

    >>> bar_name("FL200*12", 6000.0)
    'FL200*12 x 6000'
    """
    return f"{section} x {length:g}"


def _offcut(sheet: Sheet, placements: list[Placement], stock: StockSettings) -> tuple[float, float]:
    """Width and height (mm) of the larger rectangle left above or beside all parts, a gap away from them."""
    reach = np.concatenate([p.points for p in placements]).max(axis=0) + stock.gap
    width, height = sheet.width - 2 * stock.trim, sheet.height - 2 * stock.trim
    above = (width, max(0.0, sheet.height - stock.trim - reach[1]))
    beside = (max(0.0, sheet.width - stock.trim - reach[0]), height)
    best = max(above, beside, key=lambda box: box[0] * box[1])
    return best if min(best) > 0 else (0.0, 0.0)
