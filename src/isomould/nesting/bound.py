"""Lower bounds for the number of sheets that hold for any nesting, whatever its patterns."""

import math
from collections.abc import Iterable, Sequence

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.nesting.settings import StockSettings


def area_bound(outlines: Sequence[Floats], stock: StockSettings) -> int:
    """Bound the number of stock sheets by area, parts and sheets dilated by half the gap.

    Parts that stand apart by the gap do not overlap when each grows by half of it, and stay in the sheet's
    usable rectangle grown likewise. The largest sheets are counted first, as many as there are.
    """
    need = dilated_area(outlines, stock.gap)
    sizes = [(sheet.width - 2 * stock.trim, sheet.height - 2 * stock.trim, sheet.quantity) for sheet in stock.sheets]
    rooms = [(grown_rectangle(width, height, stock.gap), quantity) for width, height, quantity in sizes]
    return _count(need, sorted(rooms, key=lambda room: -room[0]))


def _count(need: float, rooms: Iterable[tuple[float, int | None]]) -> int:
    total = 0
    for area, quantity in rooms:
        wanted = sheets_for(need, area)
        used = wanted if quantity is None else min(wanted, quantity)
        total, need = total + used, need - used * area
    return total


def sheets_for(need: float, area: float) -> int:
    """Give the sheets of one area that hold a need, with room for the rounding of the sums."""
    return max(math.ceil(need / area - 1e-9), 0)


def dilated_area(outlines: Sequence[Floats], gap: float) -> float:
    """Give the area of outlines grown by half the gap; arcs are replaced by chords inside them."""
    polygons = np.array([shapely.Polygon(outline) for outline in outlines])
    return float(shapely.area(shapely.buffer(polygons, gap / 2, quad_segs=32)).sum())


def grown_rectangle(width: float, height: float, gap: float) -> float:
    """Give the area of a rectangle grown by half the gap, its corners round."""
    return (width + gap) * (height + gap) - (4 - math.pi) * gap**2 / 4
