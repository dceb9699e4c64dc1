"""Proves a layout of sheets in float64, apart from the search that made it."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
import shapely

from isomould.arrays import Floats, Ints
from isomould.nesting.cut_checker import replay, sheet_inside, stands_out
from isomould.nesting.layout import BLANK, CutTree, Id, Layout, Part, Placement, Sheet
from isomould.nesting.material import Grain
from isomould.nesting.material_checker import material_faults
from isomould.nesting.settings import SheetStock, StockSettings, allowed_rotations_deg
from isomould.nesting.twins import first_twins, without_twins

TOLERANCE = 1e-6
"""mm; by so much may a gap fall short or a vertex stand out of its sheet."""


@dataclass(frozen=True)
class Finding:
    """What is wrong with a layout, and where."""

    code: str
    where: str
    found: str
    limit: str


_Check = Callable[[Sequence[Part], StockSettings, Layout], Iterator[Finding]]


def check_layout(parts: Sequence[Part], stock: StockSettings, layout: Layout) -> tuple[Finding, ...]:
    """Prove that a layout cuts the parts as asked from the stock.

    Returns
    -------
    tuple of Finding
        Empty if the layout is proved. Gaps and edges hold to 1e-6 mm; everything else is exact. Of sheets that are
        alike in every number the first is proved.
    """
    findings = _found(_NAMES, parts, stock, layout)
    if findings:
        return findings
    different = without_twins(layout, first_twins(layout, {part.id: _form(part) for part in parts}))
    return _found((_check_transforms,), parts, stock, different) or _found(_WHOLE, parts, stock, layout) + _found(
        _SHEET_BY_SHEET, parts, stock, different
    )


def _found(
    checks: Sequence[_Check], parts: Sequence[Part], stock: StockSettings, layout: Layout
) -> tuple[Finding, ...]:
    return tuple(finding for check in checks for finding in check(parts, stock, layout))


def _form(part: Part) -> tuple[int, bytes, Grain | None]:
    return len(part.outline), part.outline.tobytes(), part.grain


def _check_names(parts: Sequence[Part], _: StockSettings, layout: Layout) -> Iterator[Finding]:
    yield from _repeated("N-NAME-01", "part", [part.id for part in parts])
    yield from _repeated("N-NAME-02", "sheet", [sheet.id for sheet in layout.sheets])
    placed = [*(item.id for item in layout.placements), *(item.id for item in layout.unplaced)]
    yield from _unknown("N-NAME-03", "part", placed, [part.id for part in parts])
    used = [item.sheet for item in layout.placements]
    yield from _unknown("N-NAME-04", "sheet", used, [sheet.id for sheet in layout.sheets])
    yield from _unknown("N-NAME-05", "sheet with nothing on it", [sheet.id for sheet in layout.sheets], used)


def _repeated(code: str, noun: str, names: Iterable[object]) -> Iterator[Finding]:
    for name, count in Counter(names).items():
        if count > 1:
            yield Finding(code, f"{noun} {name}", f"{count} times", "once")


def _unknown(code: str, noun: str, names: Iterable[object], known: Iterable[object]) -> Iterator[Finding]:
    rack = set(known)
    for name in Counter(names):
        if name not in rack:
            yield Finding(code, f"{noun} {name}", "unknown", "a name in the list")


def _check_quantities(parts: Sequence[Part], _: StockSettings, layout: Layout) -> Iterator[Finding]:
    placed = Counter(item.id for item in layout.placements)
    listed = Counter(item.id for item in layout.unplaced)
    for part in parts:
        total = placed[part.id] + listed[part.id]
        if total != part.quantity:
            found = f"{placed[part.id]} placed, {listed[part.id]} unplaced"
            yield Finding("N-QUANTITY-01", f"part {part.id}", found, f"{part.quantity} in all")
    if layout.status == ("complete" if layout.unplaced else "incomplete"):
        found = f"{layout.status} with {len(layout.unplaced)} unplaced"
        yield Finding("N-QUANTITY-02", "status", found, "complete if and only if all is placed")


def _check_locations(parts: Sequence[Part], _: StockSettings, layout: Layout) -> Iterator[Finding]:
    pieces = [*layout.placements, *layout.unplaced]
    found = Counter((piece.id, piece.location) for piece in pieces if piece.location is not None)
    asked = Counter((part.id, location) for part in parts for location in part.locations)
    for (mark, location), count in sorted(((found - asked) + (asked - found)).items(), key=str):
        yield Finding("N-LOCATION-01", f"part {mark}", f"location {location} {count} wrong", "each once")


def _check_stock(_: Sequence[Part], stock: StockSettings, layout: Layout) -> Iterator[Finding]:
    rack = {sheet.name: sheet for sheet in stock.sheets}
    for sheet in layout.sheets:
        if sheet.stock == BLANK and not rack:
            yield from _check_blank(stock, sheet)
        elif sheet.stock not in rack or not _same_size(sheet, rack[sheet.stock]):
            found = f"{sheet.stock} {sheet.width:g} x {sheet.height:g} mm"
            yield Finding("N-STOCK-01", f"sheet {sheet.id}", found, "a sheet in stock")
    used = Counter(sheet.stock for sheet in layout.sheets)
    for kind in stock.sheets:
        if kind.quantity is not None and used[kind.name] > kind.quantity:
            yield Finding("N-STOCK-02", f"stock {kind.name}", f"{used[kind.name]} used", f"{kind.quantity}")


def _check_blank(stock: StockSettings, sheet: Sheet) -> Iterator[Finding]:
    if sheet.width > stock.max_blank_length + TOLERANCE:
        yield Finding("N-STOCK-03", f"blank {sheet.id}", f"{sheet.width} mm", f"{stock.max_blank_length} mm")


def _same_size(sheet: Sheet, kind: SheetStock) -> bool:
    return (sheet.width, sheet.height) == (kind.width, kind.height)


def _check_transforms(parts: Sequence[Part], stock: StockSettings, layout: Layout) -> Iterator[Finding]:
    outlines = {part.id: _micrometres(part.outline) for part in parts}
    grains: dict[Id, Grain | None] = {part.id: part.grain for part in parts}
    rack = {sheet.name: sheet for sheet in stock.sheets}
    kinds = {sheet.id: rack.get(sheet.stock) for sheet in layout.sheets}
    for item in layout.placements:
        yield from _check_transform(item, outlines[item.id])
        yield from _check_rotation(item, stock, kinds[item.sheet], grains[item.id])


def _check_transform(item: Placement, outline: Ints) -> Iterator[Finding]:
    where = f"part {item.id} on {item.sheet}"
    if not np.isfinite(item.points).all() or not np.array_equal(item.points, np.rint(item.points * 1e3) / 1e3):
        yield Finding("N-PLACE-01", where, "a vertex between two micrometres", "multiples of 0.001 mm")
        return
    moved = _micrometres(item.points)
    turned = _turn(outline, item.rotation_deg, item.turned_over)
    if moved.shape != turned.shape or np.ptp(moved - turned, axis=0).any():
        found = f"not the outline turned by {item.rotation_deg} degrees"
        yield Finding("N-PLACE-02", where, found, "a rigid movement of the part")


def _check_rotation(
    item: Placement, stock: StockSettings, kind: SheetStock | None, grain: Grain | None
) -> Iterator[Finding]:
    allowed = allowed_rotations_deg(stock, kind, grain)
    if item.rotation_deg not in allowed:
        where = f"part {item.id} on {item.sheet}"
        yield Finding("N-PLACE-03", where, f"{item.rotation_deg} degrees", f"one of {allowed} degrees")
    if item.turned_over and not stock.turn_over:
        yield Finding("N-PLACE-04", f"part {item.id} on {item.sheet}", "turned over", "not turned over")


def _turn(outline: Ints, rotation_deg: int, turned_over: bool) -> Ints:
    cos, sin = {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}.get(rotation_deg, (0, 0))
    mirror = -1 if turned_over else 1
    return outline @ np.array([[mirror * cos, mirror * sin], [-sin, cos]])


def _micrometres(points: Floats) -> Ints:
    return np.rint(points * 1e3).astype(np.int64)


def _check_materials(parts: Sequence[Part], stock: StockSettings, layout: Layout) -> Iterator[Finding]:
    yield from (Finding(*fault) for fault in material_faults(parts, stock, layout))


def _check_edges(_: Sequence[Part], stock: StockSettings, layout: Layout) -> Iterator[Finding]:
    sheets = {sheet.id: sheet for sheet in layout.sheets}
    for item in layout.placements:
        sheet = sheets[item.sheet]
        size = np.array([sheet.width, sheet.height])
        inside = min(float(item.points.min()), float((size - item.points).min()))
        if not inside >= stock.trim - TOLERANCE:
            where = f"part {item.id} on {item.sheet}"
            yield Finding("N-EDGE-01", where, f"{inside:.6f} mm from the edge", f"{stock.trim:g} mm")


def _check_gaps(_: Sequence[Part], stock: StockSettings, layout: Layout) -> Iterator[Finding]:
    for items in _by_sheet(layout):
        pieces = np.array([shapely.Polygon(item.points) for item in items])
        for one, other, gap in _close_pairs(pieces, stock.gap):
            where = f"parts {items[one].id} and {items[other].id} on {items[one].sheet}"
            yield Finding("N-GAP-01", where, f"{gap:.6f} mm", f"{stock.gap:g} mm")


def _by_sheet(layout: Layout) -> Iterator[list[Placement]]:
    items = sorted(layout.placements, key=lambda item: item.sheet)
    for _, group in groupby(items, key=lambda item: item.sheet):
        yield list(group)


def _close_pairs(pieces: Any, gap: float) -> Iterator[tuple[int, int, float]]:
    """Give the pairs that stand closer than the gap; overlap is shown as -1."""
    one, other = shapely.STRtree(pieces).query(pieces, predicate="dwithin", distance=max(gap - TOLERANCE, 0.0))
    one, other = one[one < other], other[one < other]
    distance = shapely.distance(pieces[one], pieces[other])
    shrunk = shapely.buffer(pieces[one], -TOLERANCE, join_style="mitre")
    overlap = (distance == 0) & shapely.intersects(shrunk, pieces[other])
    short = overlap | (distance < gap - TOLERANCE)
    yield from zip(one[short], other[short], np.where(overlap, -1.0, distance)[short], strict=True)


def _check_areas(_: Sequence[Part], stock: StockSettings, layout: Layout) -> Iterator[Finding]:
    sheet_area = sum(sheet.width * sheet.height for sheet in layout.sheets)
    part_area = _area([item.points for item in layout.placements])
    percent = 100 * part_area / sheet_area if sheet_area else 0.0
    if abs(percent - layout.yield_percent) > 1e-9 * 100:
        yield Finding("N-AREA-01", "yield", f"{layout.yield_percent!r} %", f"{percent!r} %")
    if layout.bound > len(layout.sheets):
        yield Finding("N-AREA-02", "bound", f"{layout.bound}", f"at most {len(layout.sheets)} sheets used")
    prices = {kind.name: kind.price for kind in stock.sheets}
    price = sum(prices.get(sheet.stock, 0.0) for sheet in layout.sheets)
    if abs(price - layout.price) > 1e-9 * max(price, 1.0) or layout.price_bound > price * (1 + 1e-9):
        found = f"{layout.price!r}, at least {layout.price_bound!r}"
        yield Finding("N-AREA-04", "price", found, f"{price!r}, and no less than its bound")
    largest = max((sheet.width * sheet.height for sheet in layout.sheets), default=0.0)
    if part_area > len(layout.sheets) * largest * (1 + 1e-12):
        yield Finding("N-AREA-03", "part area", f"{part_area:g} mm2", f"{len(layout.sheets)} sheets")


def _area(rings: Sequence[Floats]) -> float:
    """Give the area of all rings, mm²."""
    if not rings:
        return 0.0
    owner = np.repeat(np.arange(len(rings)), [len(ring) for ring in rings])
    return float(shapely.area(shapely.polygons(shapely.linearrings(np.concatenate(rings), indices=owner))).sum())


def _check_offcut(_: Sequence[Part], stock: StockSettings, layout: Layout) -> Iterator[Finding]:
    """The offcut is a rectangle inside the trim, half a kerf clear of every part, and credited as it is."""
    offcut, sheets = layout.offcut, {sheet.id: sheet for sheet in layout.sheets}
    bought = sum(sheet.width * sheet.height for sheet in layout.sheets)
    spared = offcut.width * offcut.height if offcut else 0.0
    percent = layout.yield_percent * bought / (bought - spared) if bought else 0.0
    if layout.cut_trees and abs(percent - layout.yield_with_offcut_percent) > 1e-9 * 100:
        yield Finding("N-OFFCUT-01", "yield with offcut", f"{layout.yield_with_offcut_percent!r} %", f"{percent!r} %")
    if offcut is None:
        return
    rectangle = shapely.box(offcut.x, offcut.y, offcut.x + offcut.width, offcut.y + offcut.height)
    sheet = sheets[offcut.sheet]
    room = shapely.box(stock.trim, stock.trim, sheet.width - stock.trim, sheet.height - stock.trim)
    if not room.buffer(TOLERANCE).covers(rectangle):
        yield Finding("N-OFFCUT-02", f"offcut of {sheet.id}", str(rectangle), "inside the trim")
    clear = max(stock.kerf / 2 - 2 * TOLERANCE, 0.0)
    for item in (item for item in layout.placements if item.sheet == sheet.id):
        polygon = shapely.Polygon(item.points)
        if polygon.distance(rectangle) < clear or polygon.intersection(rectangle).area > TOLERANCE:
            yield Finding("N-OFFCUT-03", f"offcut of {sheet.id}", f"part {item.id} reaches into it", "free of parts")


def _check_cuts(_: Sequence[Part], stock: StockSettings, layout: Layout) -> Iterator[Finding]:
    if stock.guillotine and layout.sheets and not layout.cut_trees:
        yield Finding("N-CUT-01", "cut trees", "none", "one per sheet: the stock is cut by guillotine")
    if not layout.cut_trees:
        return
    placed = {sheet: set[int]() for sheet in layout.cut_trees}
    for index, item in enumerate(layout.placements):
        placed.setdefault(item.sheet, set()).add(index)
    for sheet, indices in placed.items():
        yield from _check_tree(sheet, layout.cut_trees.get(sheet, {}), indices, stock, layout)


def _check_tree(
    sheet: str, tree: CutTree, indices: set[int], stock: StockSettings, layout: Layout
) -> Iterator[Finding]:
    try:
        found = replay(tree, sheet_inside(layout, sheet, stock.trim), stock.kerf)
    except (ValueError, TypeError) as fault:
        yield Finding("N-CUT-04", f"sheet {sheet}", str(fault), "one piece more than lines")
        return
    held = [freed for freed in found.freed if freed.placement is not None]
    if sorted(freed.placement or 0 for freed in held) != sorted(indices):
        freed_indices = [freed.placement for freed in held]
        yield Finding("N-CUT-02", f"sheet {sheet}", f"cuts free {freed_indices}", f"placements {sorted(indices)}")
        return
    for freed in held:
        item = layout.placements[freed.placement or 0]
        out = stands_out(item.points, freed.piece)
        if not out <= TOLERANCE:
            yield Finding("N-CUT-03", f"part {item.id} on {sheet}", f"cut into by {out:.6f} mm", "cut free whole")


_NAMES: tuple[_Check, ...] = (_check_names,)
"""What all other checks take for granted."""

_WHOLE: tuple[_Check, ...] = (
    _check_quantities,
    _check_locations,
    _check_stock,
    _check_materials,
    _check_areas,
    _check_offcut,
)
"""Checks of the layout as a whole."""

_SHEET_BY_SHEET: tuple[_Check, ...] = (_check_edges, _check_gaps, _check_cuts)
"""Checks that hold for a sheet if they hold for its twin, once parts are known to be those of the list."""
