"""What the cutting of a layout comes to: number and length of the cuts, and the largest offcut in one piece."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from isomould.arrays import Floats
from isomould.nesting.cut_checker import Replay, replay, sheet_inside
from isomould.nesting.layout import Layout, Offcut
from isomould.nesting.settings import StockSettings
from isomould.nesting.twins import first_twins


def measure_cuts(layout: Layout, stock: StockSettings) -> Layout:
    """Add cuts, their length, the largest rectangle left over, and the yield that credits it."""
    firsts = first_twins(layout, {})
    times = Counter(firsts[name] for name in layout.cut_trees)
    found = {name: _replay(layout, name, stock) for name in times}
    offcut = max(
        (piece for name, one in found.items() for piece in _offcuts(name, one)),
        key=lambda piece: piece.width * piece.height,
        default=None,
    )
    bought = sum(sheet.width * sheet.height for sheet in layout.sheets)
    spared = offcut.width * offcut.height if offcut else 0.0
    credited = layout.yield_percent * bought / (bought - spared) if bought else 0.0
    return replace(
        layout,
        cuts=sum(times[name] * len(one.cuts) for name, one in found.items()),
        cut_length=sum(times[name] * sum(one.cuts) for name, one in found.items()),
        offcut=offcut,
        yield_with_offcut_percent=credited,
    )


def _replay(layout: Layout, sheet: str, stock: StockSettings) -> Replay:
    return replay(layout.cut_trees[sheet], sheet_inside(layout, sheet, stock.trim), stock.kerf)


def _offcuts(sheet: str, found: Replay) -> Iterator[Offcut]:
    """Give the rectangles among the pieces that hold no part, 0.001 mm rounded inwards."""
    for freed in found.freed:
        if freed.placement is None and len(freed.piece) >= 3:
            low = np.ceil(freed.piece.min(axis=0) * 1e3 - 1e-6) / 1e3
            size = np.floor(freed.piece.max(axis=0) * 1e3 + 1e-6) / 1e3 - low
            if size.min() > 0 and abs(_area(freed.piece) - size.prod()) < 1e-2 * size.sum():
                yield Offcut(sheet, *(round(float(v), 3) for v in (*low, *size)))


def _area(piece: Floats) -> float:
    x, y = piece.T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2)
