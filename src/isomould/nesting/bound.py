"""Lower bounds for the number of sheets that hold for any nesting, whatever its patterns."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.optimize import Bounds, LinearConstraint, milp

from isomould.arrays import Floats
from isomould.nesting.layout import BoundKind
from isomould.nesting.material import Grain
from isomould.nesting.settings import SheetStock, StockSettings, allowed_rotations_deg
from isomould.nesting.shapes import UM, micrometres, round_away

NODES = 10_000
"""Nodes of the integer programme that shares parts out among several sizes."""


@dataclass(frozen=True)
class Bound:
    """No nesting uses fewer sheets or costs less; kind "lp" where several sizes of sheets share the parts."""

    sheets: int
    price: float
    kind: BoundKind


def bound_stock(parts: Sequence[shapely.Polygon], stock: StockSettings) -> Bound:
    """Bound the number and the price of the stock sheets for any nesting of parts that have places in it.

    Parts that stand apart by the gap do not overlap when each grows by half of it, and stay in the sheet's
    usable rectangle grown likewise: parts that fit some sizes only need enough area of those. A part grows into its
    holes too, and what is left of them may hold other parts. The least whole number of sheets that have the
    area, none used more often than it is there, is a small integer programme.

    Parameters
    ----------
    parts
        One polygon per piece, mm; holes that hold all that is cut out.
    """
    needs = _needs(parts, stock)
    if not needs:
        return Bound(0, 0.0, "area")
    kind: BoundKind = "area" if len(stock.sheets) == 1 else "lp"
    count = _least(needs, stock, [1.0] * len(stock.sheets))
    price = _least(needs, stock, [sheet.price for sheet in stock.sheets])
    return Bound(math.ceil(count - 1e-6), price, kind)


def _needs(parts: Sequence[shapely.Polygon], stock: StockSettings) -> dict[tuple[bool, ...], float]:
    """Give the dilated area of the parts that fit just the same sizes, by those."""
    groups = dict[tuple[bool, ...], list[shapely.Polygon]]()
    held = {id(part): _holding(part, stock) for part in {id(part): part for part in parts}.values()}
    for part in parts:
        groups.setdefault(held[id(part)], []).append(part)
    return {sizes: dilated_area(group, stock.gap) for sizes, group in groups.items()}


def _holding(part: shapely.Polygon, stock: StockSettings) -> tuple[bool, ...]:
    """Tell of every size whether it holds a part."""
    outline = shapely.get_coordinates(part.exterior)
    return tuple(fits(outline, sheet, stock) for sheet in stock.sheets)


def _least(needs: Mapping[tuple[bool, ...], float], stock: StockSettings, cost: Sequence[float]) -> float:
    rooms = [room_of(sheet, stock) for sheet in stock.sheets]
    rows = [[room if fit else 0.0 for room, fit in zip(rooms, sizes, strict=True)] for sizes in needs]
    # What fits a few sizes only is also asked of every larger choice of sizes.
    least = [sum(need for other, need in needs.items() if _within(other, sizes)) * (1 - 1e-9) for sizes in needs]
    most = np.array([np.inf if sheet.quantity is None else float(sheet.quantity) for sheet in stock.sheets])
    whole = np.ones(len(rooms), dtype=np.int64)
    asked = LinearConstraint(np.array(rows), np.array(least), np.inf)
    limits = Bounds(np.zeros(len(most)), most)
    found = milp(np.array(cost), integrality=whole, bounds=limits, constraints=asked, options={"node_limit": NODES})
    # What the best found costs may be more than the least by the solver's tolerance: that is no bound.
    return float(found.mip_dual_bound or 0.0)


def too_few(parts: Sequence[shapely.Polygon], stock: StockSettings) -> tuple[float, float] | None:
    """Give the area that parts need and the room of all sheets that hold them, mm², where the room is the smaller.

    No search is needed to know it: parts that fit a few sizes only need the area of those, and of no others.
    """
    needs = _needs(parts, stock)
    for sizes in needs:
        need = sum(area for other, area in needs.items() if _within(other, sizes))
        rooms = [_all_rooms(sheet, stock) for sheet, fit in zip(stock.sheets, sizes, strict=True) if fit]
        if need * (1 - 1e-9) > sum(rooms):
            return need, sum(rooms)
    return None


def _all_rooms(sheet: SheetStock, stock: StockSettings) -> float:
    return math.inf if sheet.quantity is None else sheet.quantity * room_of(sheet, stock)


def _within(sizes: tuple[bool, ...], others: tuple[bool, ...]) -> bool:
    return all(other or not one for one, other in zip(sizes, others, strict=True))


def room_of(sheet: SheetStock, stock: StockSettings) -> float:
    """Give the usable area of a sheet grown by half the gap."""
    return grown_rectangle(sheet.width - 2 * stock.trim, sheet.height - 2 * stock.trim, stock.gap)


def fits(outline: Floats, sheet: SheetStock, stock: StockSettings, grain: Grain | None = None) -> bool:
    """Tell whether an outline fits inside the trim of a sheet, in a rotation that is allowed there."""
    allowed = allowed_rotations_deg(stock, sheet, grain)
    room = room_inside(sheet.width, sheet.height, stock.trim)
    width, height = np.ptp(micrometres(outline), axis=0)
    upright = bool(width <= room.width and height <= room.height)
    turned = bool(height <= room.width and width <= room.height)
    return (upright and 0 in allowed) or (turned and 90 in allowed)


@dataclass(frozen=True)
class Room:
    """The room of a sheet inside the trim, micrometres."""

    width: int
    height: int


def room_inside(width: float, height: float, trim: float) -> Room:
    """Give the room that a trim leaves, whole micrometres rounded down."""
    return Room(*(int(np.floor((side - trim) * UM + 1e-6)) - round_away(trim * UM) for side in (width, height)))


def sheets_for(need: float, area: float) -> int:
    """Give the sheets of one area that hold a need, with room for the rounding of the sums."""
    return max(math.ceil(need / area - 1e-9), 0)


def dilated_area(parts: Sequence[shapely.Polygon], gap: float) -> float:
    """Give the area of parts grown by half the gap, into their holes too; arcs are replaced by chords inside them.

    A polygon that comes many times, as one object, is grown once.
    """
    times = Counter(map(id, parts))
    different = {id(part): part for part in parts}
    areas = shapely.area(shapely.buffer(np.array(list(different.values())), gap / 2, quad_segs=32))
    return float(areas @ np.array([times[key] for key in different]))


def grown_rectangle(width: float, height: float, gap: float) -> float:
    """Give the area of a rectangle grown by half the gap, its corners round."""
    return (width + gap) * (height + gap) - (4 - math.pi) * gap**2 / 4
