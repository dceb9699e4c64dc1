"""V31-V35: every part lies once on a sheet, in its own shape, with its gap, the areas add up, the cuts free it."""

from collections import Counter
from math import ceil, pi
from typing import Any

import numpy as np
import shapely
from scipy.spatial import KDTree

from isomould.verify.cutting import Loop, reach, saw
from isomould.verify.delivery import Delivery
from isomould.verify.planar import loop_distance, quarter_turned, signed_area, to_origin
from isomould.verify.read.dxf import Drawing, Outline, one_outline, outlines_on
from isomould.verify.read.layout import Placement
from isomould.verify.read.tables import half_unit, numbers, texts
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, Unreadable, faults, worse, worst_of

LENGTH = 1e-6


def presence(delivery: Delivery) -> Measured:
    """Quantities, locations and sheets agree in schedule, layout and cut sheets; nothing is left over."""
    placed = delivery.layout.placements
    problems = _quantity_faults(delivery) + _location_faults(delivery) + _sheet_faults(delivery)
    problems += [f"{part['id']} is unplaced: {part['reason']}" for part in delivery.layout.raw["unplaced"]]
    return faults(len(placed), problems)


def _quantity_faults(delivery: Delivery) -> list[str]:
    placed = Counter(placed.mark for placed in delivery.layout.placements)
    panels = delivery.table("panels")
    wanted = dict(zip(texts(panels, "mark"), numbers(panels, "quantity").tolist(), strict=True))
    marks = sorted(placed.keys() | wanted.keys())
    return [f"{m}: {placed[m]} placed, {wanted.get(m)} scheduled" for m in marks if placed[m] != wanted.get(m)]


def _location_faults(delivery: Delivery) -> list[str]:
    instances = delivery.table("panel_instances")
    rows = zip(*(texts(instances, name) for name in ("location", "mark", "sheet")), strict=True)
    wanted = Counter(rows)
    placed = Counter((placed.location, placed.mark, placed.sheet) for placed in delivery.layout.placements)
    differing = sorted((wanted - placed) | (placed - wanted))
    return [f"{' '.join(row)}: not the same in schedule and layout" for row in differing]


def _sheet_faults(delivery: Delivery) -> list[str]:
    named = delivery.layout.sheets.keys()
    scheduled = texts(delivery.table("sheets"), "sheet")
    missing = [f"sheet {name} has no drawing or no layout" for name in sorted(named ^ delivery.sheets.keys())]
    repeated = [] if Counter(scheduled) == Counter(named) else ["sheets of schedule and layout differ"]
    return missing + repeated


def drawn(delivery: Delivery) -> Measured:
    """Outlines of every cut sheet against its layout, one to one."""
    found = [_drawn_on(delivery, sheet, drawing) for sheet, drawing in delivery.sheets.items()]
    return worse(*found)


def _drawn_on(delivery: Delivery, sheet: str, drawing: Drawing) -> Measured:
    outlines = [outline.points for outline in contours(delivery, drawing)]
    placed = delivery.layout.on(sheet)
    if len(outlines) != len(placed) or not placed:
        return Measured(len(placed), np.inf, f"{sheet}: {len(outlines)} drawn, {len(placed)} placed")
    middles = KDTree([p.points.mean(axis=0) for p in placed])
    found = middles.query(np.array([points.mean(axis=0) for points in outlines]))[1]
    nearest: list[int] = np.asarray(found).tolist()
    twice = len(set(nearest)) < len(placed)
    off = [loop_distance(points, placed[k].points) for points, k in zip(outlines, nearest, strict=True)]
    return worst_of([np.inf, *off[1:]] if twice else off, [f"{sheet} {placed[k].location}" for k in nearest])


def contours(delivery: Delivery, drawing: Drawing) -> list[Outline]:
    """Give the outlines of the parts on a cut sheet: on INFO, not CUT, where lines are scored (gap = 0)."""
    return outlines_on(drawing, "INFO" if delivery.nesting["gap_mm"] == 0 else "CUT")


def rigid(delivery: Delivery) -> Measured:
    """Every placed polygon is its part file's outline, turned and moved, mirrored only where allowed."""
    placed = delivery.layout.placements
    return worst_of([_distortion(delivery, p) for p in placed], [f"{p.mark} {p.location}" for p in placed])


def _distortion(delivery: Delivery, placed: Placement) -> float:
    if placed.mark not in delivery.panels:
        return np.inf
    if placed.turned_over and not delivery.flippable:
        return np.inf
    outline = one_outline(delivery.panels[placed.mark]).points
    expected = quarter_turned(outline, placed.rotation_deg, turned_over=placed.turned_over)
    return loop_distance(to_origin(expected), to_origin(placed.points))


def gaps(delivery: Delivery) -> Measured:
    """How far the clear distance of two contours on a sheet falls short of the asked gap."""
    gap = float(delivery.nesting["gap_mm"])
    drawn = {name: [one.points for one in contours(delivery, sheet)] for name, sheet in delivery.sheets.items()}
    return worse(*(shortfall(name, outlines, gap) for name, outlines in drawn.items()))


def shortfall(sheet: str, outlines: list[Floats], gap: float) -> Measured:
    """Give how much the closest outlines (n, 2) of a sheet lack to the gap; infinite where two overlap."""
    shapes = [shapely.Polygon(points) for points in outlines]
    if not all(shape.is_valid for shape in shapes):
        return Measured(len(shapes), np.inf, sheet)
    a, b = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=gap + 1.0)
    a, b = a[a < b], b[a < b]
    polygons = np.array(shapes, dtype=object)
    short = gap - shapely.distance(polygons[a], polygons[b])
    overlap = shapely.area(shapely.intersection(polygons[a], polygons[b])) > LENGTH
    where = [f"{sheet} at {shapes[k].centroid.x:.0f}, {shapes[k].centroid.y:.0f}" for k in a]
    return worst_of([0.0, *np.where(overlap, np.inf, short)], [sheet, *where])


def margins(delivery: Delivery) -> Measured:
    """How far a contour reaches into the trim of its sheet, and the drawn sheet differs from the layout's."""
    found = [_overreach(delivery, sheet, drawing) for sheet, drawing in delivery.sheets.items()]
    return worst_of(found, list(delivery.sheets))


def _overreach(delivery: Delivery, sheet: str, drawing: Drawing) -> float:
    trim, size = float(delivery.nesting["trim_mm"]), np.array(delivery.layout.sheets[sheet])
    corners = np.array([[0, 0], [size[0], 0], size, [0, size[1]]])
    points = np.vstack([outline.points for outline in contours(delivery, drawing)])
    over = max(float((trim - points).max()), float((points + trim - size).max()), 0.0)
    return max(over, loop_distance(one_outline(drawing, "SHEET").points, corners))


def areas(delivery: Delivery) -> Measured:
    """Part areas of every sheet against the schedule (relative)."""
    found = delivery.table("sheets")
    own = {sheet: _part_area(delivery, sheet) for sheet in texts(found, "sheet")}
    claimed = numbers(found, "part_area_m2") * 1e6
    parts = np.equal(numbers(found, "parts"), [len(contours(delivery, delivery.sheets[name])) for name in own])
    off = np.where(parts, abs(np.array(list(own.values())) - claimed) / claimed, np.inf)
    return worst_of(off, list(own))


def _part_area(delivery: Delivery, sheet: str) -> float:
    if sheet not in delivery.sheets:
        message = f"sheets/{sheet}.dxf is missing"
        raise Unreadable(message)
    return float(sum(signed_area(outline.points) for outline in contours(delivery, delivery.sheets[sheet])))


def yields(delivery: Delivery) -> Measured:
    """Yield of every sheet and of the whole layout against the areas."""
    found, sizes = delivery.table("sheets"), delivery.layout.sheets
    names = texts(found, "sheet")
    parts = np.array([_part_area(delivery, sheet) for sheet in names])
    stock = np.array([sizes[sheet][0] * sizes[sheet][1] for sheet in names])
    off = abs(100 * parts / stock - numbers(found, "yield_percent"))
    whole = abs(100 * parts.sum() / stock.sum() - float(delivery.layout.raw["yield_percent"]))
    return worst_of([*off, whole], [*names, "layout"], limit=half_unit("yield_percent") * (1 + 1e-6))


def bound(delivery: Delivery) -> Measured:
    """No sheet holds more than its area, parts and usable sheet dilated by half the gap; the bound holds."""
    layout, fills = delivery.layout, {name: _fill(delivery, name) for name in delivery.layout.sheets}
    usable = sum(part for part, _ in fills.values()) / max(whole for _, whole in fills.values())
    least = max(ceil(usable - 1e-9), int(layout.raw["bound"]))
    return worst_of([*(part / whole for part, whole in fills.values()), least / len(fills)], [*fills, "bound"])


def _fill(delivery: Delivery, sheet: str) -> tuple[float, float]:
    """Give the dilated area of the parts on a sheet and of the sheet without its trim, mm²."""
    nesting = delivery.nesting
    half, trim = nesting["gap_mm"] / 2, nesting["trim_mm"]
    width, height = (side - 2 * trim + 2 * half for side in delivery.layout.sheets[sheet])
    return sum(_dilated(placed.points, half) for placed in delivery.layout.on(sheet)), width * height


def _dilated(points: Floats, by: float) -> float:
    """Give the area of a convex polygon widened by a distance with square-cut corners left round, mm²."""
    perimeter = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1).sum()
    return abs(signed_area(points)) + float(perimeter) * by + pi * by**2


def freed(delivery: Delivery) -> Measured:
    """How far a part reaches out of the piece that the cutting tree frees for it."""
    found = [_reach(delivery, name, tree) for name, tree in _trees(delivery).items()]
    return worse(*found)


def _trees(delivery: Delivery) -> dict[str, dict[str, Any]]:
    trees = delivery.layout.raw.get("cut_tree")
    if trees is None and not delivery.nesting.get("guillotine", True):
        message = "the sheets need not be cut edge to edge"
        raise NotApplicable(message)
    if trees is None or trees.keys() != delivery.layout.sheets.keys():
        message = "there is no cutting tree for every sheet"
        raise Unreadable(message)
    return trees


def _sawn(delivery: Delivery, name: str, tree: dict[str, Any]) -> list[tuple[int | None, Loop, float]]:
    nesting = delivery.nesting
    trim, (width, height) = float(nesting["trim_mm"]), delivery.layout.sheets[name]
    right, top = width - trim, height - trim
    return list(saw(tree, [(trim, trim), (right, trim), (right, top), (trim, top)], float(nesting["kerf_mm"])))


def _reach(delivery: Delivery, name: str, tree: dict[str, Any]) -> Measured:
    """Judge one sheet; infinite if its tree frees other parts than those that lie on it."""
    pieces = [(index, piece) for index, piece, _ in _sawn(delivery, name, tree) if index is not None]
    placed = delivery.layout.placements
    lying = [index for index, item in enumerate(placed) if item.sheet == name]
    if sorted(index for index, _ in pieces) != lying:
        return Measured(max(len(lying), 1), np.inf, f"{name}: other parts are freed than lie on it")
    out = [reach([(x, y) for x, y in placed[index].points.tolist()], piece) for index, piece in pieces]
    return worst_of(out, [f"{name} {placed[index].location}" for index, _ in pieces])


def counted(delivery: Delivery) -> Measured:
    """Number and length of the cuts as the layout claims them."""
    lengths = [cut for name, tree in _trees(delivery).items() for _, _, cut in _sawn(delivery, name, tree) if cut > 0]
    raw = delivery.layout.raw
    off = [abs(len(lengths) - int(raw["cuts"])), abs(sum(lengths) - float(raw["cut_length_mm"]))]
    return worst_of(off, ["cuts", "cut length"], limit=1e-6 * max(len(lengths), 1))


RULES = (
    Rule("V31", "every part is placed exactly as often as scheduled", 0, "faults", presence),
    Rule("V31b", "cut sheets show the layout", LENGTH, "mm", drawn),
    Rule("V32", "placed parts are moved, not changed", LENGTH, "mm", rigid),
    Rule("V33", "gap between parts", LENGTH, "mm short", gaps),
    Rule("V33b", "parts keep off the trim of their sheet", LENGTH, "mm over", margins),
    Rule("V34", "part areas of the sheets = schedule", 1e-9, "relative", areas),
    Rule("V34b", "yields of sheets and layout", half_unit("yield_percent"), "%", yields),
    Rule("V35", "sheets hold no more than their area", 1.0, "fill", bound),
    Rule("V35b", "cuts from edge to edge free every part whole", LENGTH, "mm out", freed),
    Rule("V35c", "cuts and their length", LENGTH, "mm", counted),
)
