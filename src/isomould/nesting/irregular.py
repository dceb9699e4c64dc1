"""Concave parts on sheets, each in the hollows of others, where that takes fewer sheets than their hulls.

The search of strips sees hulls. Here the sheets that it took are emptied, the pieces dealt out to fewer of them, and
every sheet is asked of the engine. Such sheets are cut along the outlines: no straight cut goes from edge to edge.
"""

from collections import Counter, deque
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from os import cpu_count
from threading import Event

import numpy as np
import shapely

from isomould.errors import Note
from isomould.nesting.assembly import Filled, Filling, make_layout
from isomould.nesting.bound import bound_stock, fits, room_inside, room_of
from isomould.nesting.interlocking import WORKERS, Answer, Lot, has_engine, interlock
from isomould.nesting.layout import Layout, Part
from isomould.nesting.nest import nest_sheets, of_material, prove
from isomould.nesting.rack import PartClass, sort_classes
from isomould.nesting.search import Effort, Search
from isomould.nesting.settings import SheetStock, StockSettings, allowed_rotations_deg
from isomould.nesting.shapes import UM, round_away

HOLLOW = 0.02
"""Share of the area of all hulls that is no part, from which parts are worth interlocking."""

DENSITY = 0.8
"""Share of a sheet that interlocked parts are expected to fill: where the search begins."""

ATTEMPTS: dict[Effort, int] = {"quick": 1, "normal": 2, "best": 6}
"""Failures of the engine after which a sheet is given up."""

REASON = "parts lie in the hollows of others and are cut along their outlines"


@dataclass(frozen=True, eq=False)
class Nest:
    """A layout, the stock as it was used (`guillotine`), and what should be known."""

    layout: Layout
    stock: StockSettings
    notes: tuple[Note, ...]


def nest_parts(parts: Sequence[Part], stock: StockSettings, task: Search) -> Nest:
    """Nest parts of any outline on stock sheets: in strips, and concave ones in each other's hollows if that is better.

    Scored glass, and stock that says `guillotine = true` itself, are nested in strips alone.

    Raises
    ------
    Refused
        As `nest_sheets`.
    """
    hulls, areas = hull_areas(parts)
    if hulls - areas <= HOLLOW * hulls:
        return Nest(nest_sheets(parts, stock, task), stock, ())
    cut_straight = stock.scored or (stock.guillotine and "guillotine" in stock.model_fields_set)
    layout = nest_sheets(parts, stock, task)
    held = len({part.grain for part in parts}) > 1
    if cut_straight or held or not has_engine():
        return Nest(layout, stock, (_hull_note(hulls, areas, cut_straight=cut_straight, held=held),))
    free = stock.model_copy(update={"guillotine": False})
    better = interlocked(parts, free, layout, task)
    if better:
        return Nest(better, free, ())
    # A search that was stopped might have found a better layout.
    return Nest(replace(layout, reproducible=layout.reproducible and not task.stops), stock, ())


def hull_areas(parts: Sequence[Part]) -> tuple[float, float]:
    """Give the area of the hulls of all pieces, and of the pieces without their holes filled, mm²."""
    outlines = np.array([shapely.Polygon(part.outline) for part in parts], dtype=object)
    counts = np.array([part.quantity for part in parts])
    hulls = shapely.area(shapely.convex_hull(outlines))
    return float(counts @ hulls), float(counts @ shapely.area(outlines))


def _hull_note(hulls: float, areas: float, *, cut_straight: bool, held: bool) -> Note:
    size = f"concave parts are nested by their hulls, {hulls / 1e6:.2f} m² for {areas / 1e6:.2f} m² of parts"
    way_out = "pip install isomould[irregular] interlocks them"
    if cut_straight:
        way_out = "the stock is cut from edge to edge"
    elif held:
        way_out = "their grains differ"
    return Note("W-NEST-HULL", "parts", f"{size} (+{100 * (hulls / areas - 1):.0f} %): {way_out}")


@dataclass(frozen=True, eq=False)
class _Trial:
    """Answers for all sheets, nothing if one of them failed; whether that depends on the seed alone."""

    answers: tuple[Answer, ...]
    steady: bool


def interlocked(parts: Sequence[Part], stock: StockSettings, layout: Layout, task: Search) -> Layout | None:
    """Give a proved layout on fewer sheets than a layout in strips, or with all of its pieces, if one is found."""
    classes, bins = sort_classes(parts), _bins(layout, stock)
    most = len(bins) if layout.unplaced else len(bins) - 1
    least = max(1, _least_sheets(classes, stock))
    if task.stops or most < least:
        return None
    tried = list[_Trial]()
    found: tuple[Answer, ...] = ()
    # Fewer sheets as long as that goes well, more where it does not, halving from where it is expected.
    failed, enough = least - 1, most + 1
    count = min(max(_expected_sheets(classes, bins), least), most)
    while failed + 1 < enough and not task.stops:
        lots = _deal(classes, bins[:count], stock)
        tried.append(_fill(lots, task) if lots else _Trial((), steady=True))
        if tried[-1].answers:
            found, enough = tried[-1].answers, count
        else:
            failed = count
        count = (failed + enough) // 2
    if not found:
        return None
    steady = layout.reproducible and not task.stops and all(trial.steady for trial in tried)
    return _layout(parts, stock, list(zip(bins, found, strict=False)), steady=steady)


def _bins(layout: Layout, stock: StockSettings) -> list[SheetStock]:
    """Give the sheets that a layout takes, those first that give most room for their price, or for their number."""
    rack = {sheet.name: sheet for sheet in stock.sheets}
    taken = [rack[sheet.stock] for sheet in layout.sheets]
    return sorted(taken, key=lambda sheet: (sheet.price / (sheet.width * sheet.height), -sheet.width * sheet.height))


def _least_sheets(classes: Sequence[PartClass], stock: StockSettings) -> int:
    """Bound the sheets of parts that lie in no hole."""
    return bound_stock([shapely.Polygon(kind.outline) for kind in classes for _ in kind.pieces], stock).sheets


def _expected_sheets(classes: Sequence[PartClass], bins: Sequence[SheetStock]) -> int:
    area = sum(len(kind.pieces) * shapely.Polygon(kind.outline).area for kind in classes)
    rooms = DENSITY * np.cumsum([sheet.width * sheet.height for sheet in bins])
    return int(np.searchsorted(rooms, area)) + 1


def _deal(classes: Sequence[PartClass], bins: Sequence[SheetStock], stock: StockSettings) -> list[Lot]:
    """Deal the pieces out, the largest first, each to the sheet that is least full; nothing if one fits none."""
    rooms = np.array([room_of(sheet, stock) for sheet in bins])
    polygons = [shapely.Polygon(kind.outline) for kind in classes]
    areas = [polygon.buffer(stock.gap / 2).area for polygon in polygons]
    order = sorted(range(len(classes)), key=lambda k: (-round(polygons[k].convex_hull.area, 3), k))
    filled, dealt = np.zeros(len(bins)), [Counter[int]() for _ in bins]
    for k in order:
        fitting = np.array([fits(classes[k].outline, sheet, stock, classes[k].grain) for sheet in bins])
        if not fitting.any():
            return []
        for _ in classes[k].pieces:
            share = np.where(fitting, np.round((filled + areas[k]) / rooms, 9), np.inf)
            target = int(np.argmin(share))
            filled[target] += areas[k]
            dealt[target][k] += 1
    if (filled > rooms).any():
        return []
    return [_lot(classes, pieces, sheet, stock) for pieces, sheet in zip(dealt, bins, strict=True) if pieces]


def _lot(classes: Sequence[PartClass], pieces: Counter[int], sheet: SheetStock, stock: StockSettings) -> Lot:
    parts = tuple((k, classes[k].outline, pieces[k]) for k in sorted(pieces))
    room = room_inside(sheet.width, sheet.height, stock.trim)
    # Parts of one grain: others are nested in strips.
    grain = classes[min(pieces)].grain
    return Lot(parts, allowed_rotations_deg(stock, sheet, grain), room, stock.gap)


def _fill(lots: Sequence[Lot], task: Search) -> _Trial:
    """Ask the engine for every sheet, once for equal ones; the first that fails ends the others."""
    equal = dict[tuple[object, ...], Lot]()
    for lot in lots:
        equal.setdefault(_key(lot), lot)
    failed = Event()

    def ask(lot: Lot) -> Answer:
        if failed.is_set():
            return Answer(None, steady=False)
        answer = interlock(lot, ATTEMPTS[task.effort], lambda: failed.is_set() or task.stops)
        if answer.placed is None:
            failed.set()
        return answer

    at_once = max(1, (task.jobs or cpu_count() or 1) // WORKERS)
    with ThreadPoolExecutor(at_once) as pool:
        answers = dict(zip(equal, pool.map(ask, equal.values()), strict=True))
    lost = [answer for answer in answers.values() if answer.placed is None]
    if lost:
        # Whichever sheet failed first: one that fails by the seed alone always does.
        return _Trial((), steady=any(answer.steady for answer in lost))
    return _Trial(tuple(answers[_key(lot)] for lot in lots), steady=all(answer.steady for answer in answers.values()))


def _key(lot: Lot) -> tuple[object, ...]:
    return (lot.room, lot.turns, *((index, pieces) for index, _, pieces in lot.parts))


def _layout(
    parts: Sequence[Part], stock: StockSettings, sheets: Sequence[tuple[SheetStock, Answer]], *, steady: bool
) -> Layout:
    """Give the pieces their marks, add up, and prove."""
    queues = [deque(kind.pieces) for kind in sort_classes(parts)]
    trim = round_away(stock.trim * UM)
    filled = [
        Filled(
            stock=sheet.name,
            width=sheet.width,
            height=sheet.height,
            placed=tuple(
                (queues[one.part].popleft(), replace(one, points=one.points + trim)) for one in answer.placed or ()
            ),
            tree={},
            price=sheet.price,
        )
        for sheet, answer in sheets
    ]
    bound = bound_stock([part.polygon for part in parts for _ in range(part.quantity)], stock)
    layout = make_layout([Filling(tuple(filled), ())], bound, ended=steady)
    sheets_made = of_material(layout, parts, stock)
    return prove(parts, stock, replace(layout, sheets=sheets_made, cut_trees={}, no_cuts=REASON))
