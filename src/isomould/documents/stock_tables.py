"""The tables of sheets and bars (deliverables, Folder)."""

from collections.abc import Mapping, Sequence

import numpy as np

from isomould.documents.live import RateCell
from isomould.documents.table import Table, make_live_table, make_table
from isomould.nesting.layout import BarLayout, Layout, Placement, Sheet
from isomould.nesting.scoring import score_lines
from isomould.nesting.settings import StockSettings
from isomould.parts.outline import area, sides

Columns = dict[str, list[object]]


def sheet_table(layout: Layout, stock: StockSettings) -> Table:
    """Give one row per sheet: parts, areas, cut lengths, the largest offcut along an edge, price (that of its rate).

    What is cut are the contours of the parts; of scored sheets the lines that are scored.
    """
    price = {sheet.name: RateCell(f"sheet_{k}", sheet.price) for k, sheet in enumerate(stock.sheets, start=1)}
    on: dict[str, list[Placement]] = {sheet.id: [] for sheet in layout.sheets}
    for placement in layout.placements:
        on[placement.sheet].append(placement)
    areas = [sum(abs(area(p.points - p.points[0])) for p in on[sheet.id]) for sheet in layout.sheets]
    offcut = [offcut_rectangle(sheet, on[sheet.id], stock)[2:] for sheet in layout.sheets]
    cut = _cuts(layout, on, stock)
    data: Columns = {
        "sheet": [sheet.id for sheet in layout.sheets],
        "stock": [sheet.stock for sheet in layout.sheets],
        "parts": [len(on[sheet.id]) for sheet in layout.sheets],
        "part_area_m2": [value / 1e6 for value in areas],
        "yield_percent": [100 * a / (s.width * s.height) for a, s in zip(areas, layout.sheets, strict=True)],
        "cut_length_mm": [sum(cuts) for cuts in cut],
        "cuts": [len(cuts) for cuts in cut],
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


def saw_table(layout: BarLayout) -> Table:
    """Give one row per cut, bar by bar from the left end; the offcut of a bar stands in the row of its last cut."""
    rows = [(bar, number, cut) for bar in layout.bars for number, cut in enumerate(bar.cuts, start=1)]
    data: Columns = {
        "bar": [bar.id for bar, _, _ in rows],
        "stock": [bar_name(bar.section, bar.length) for bar, _, _ in rows],
        "cut": [number for _, number, _ in rows],
        "mark": [str(cut.id) for _, _, cut in rows],
        "location": [cut.location or "" for _, _, cut in rows],
        "position_mm": [cut.start for _, _, cut in rows],
        "length_mm": [cut.length for _, _, cut in rows],
        "bar_turned": [cut.turned for _, _, cut in rows],
        "offcut_mm": [bar.rest if number == len(bar.cuts) else None for bar, number, _ in rows],
    }
    return make_table("saw_list", data)


def bar_name(section: str, length: float) -> str:
    """Name a stock bar.

    >>> bar_name("FL200*12", 6000.0)
    'FL200*12 x 6000'
    """
    return f"{section} x {length:g}"


def _cuts(layout: Layout, on: Mapping[str, Sequence[Placement]], stock: StockSettings) -> list[list[float]]:
    """Give the lengths (mm) of all that is cut, sheet by sheet."""
    if stock.scored:
        scores = score_lines(layout, stock)
        return [np.hypot(*(lines[:, 1] - lines[:, 0]).T).tolist() for lines in scores.values()]
    return [[float(sides(p.points).sum()) for p in on[sheet.id]] for sheet in layout.sheets]


def offcut_rectangle(
    sheet: Sheet, placements: Sequence[Placement], stock: StockSettings
) -> tuple[float, float, float, float]:
    """Give x, y, width and height (mm) of the larger rectangle left above or beside all parts, a gap away from them."""
    reach = np.concatenate([p.points for p in placements]).max(axis=0) + stock.gap
    right, top = sheet.width - stock.trim, sheet.height - stock.trim
    above = (stock.trim, float(reach[1]), right - stock.trim, max(0.0, top - float(reach[1])))
    beside = (float(reach[0]), stock.trim, max(0.0, right - float(reach[0])), top - stock.trim)
    best = max(above, beside, key=lambda box: box[2] * box[3])
    return best if min(best[2:]) > 0 else (stock.trim, stock.trim, 0.0, 0.0)
