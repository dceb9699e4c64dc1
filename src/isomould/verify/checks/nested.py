"""V31, V32b, V34b, V40, V45f of nests that stand alone: what a layout says of its parts, in its sheets and its plan."""

from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from isomould.verify.checks.cutting_plan import Row, plan_faults
from isomould.verify.checks.drawings import drawing_faults
from isomould.verify.checks.nesting import LENGTH, shortfall
from isomould.verify.checks.sheet_materials import plan_says
from isomould.verify.delivery import Delivery
from isomould.verify.planar import loop_distance, quarter_turned, signed_area
from isomould.verify.read.dxf import Drawing, Outline, one_outline, outlines_on
from isomould.verify.read.layout import Placement
from isomould.verify.read.tables import half_unit
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, faults, worse, worst_of


def presence(delivery: Delivery) -> Measured:
    """Quantities of placed and unplaced parts, the status, sheets without a drawing or without a part."""
    raw, placed = delivery.layout.raw, delivery.layout.placements
    found = Counter([*(item.mark for item in placed), *(str(item["id"]) for item in raw["unplaced"])])
    wanted = Counter({str(part["id"]): int(part["quantity"]) for part in raw["parts"]})
    problems = [
        f"{mark}: {found[mark]} of {wanted[mark]}" for mark in sorted(found | wanted) if found[mark] != wanted[mark]
    ]
    if raw["status"] == ("complete" if raw["unplaced"] else "incomplete"):
        problems.append(f"status {raw['status']} with {len(raw['unplaced'])} unplaced")
    names = delivery.layout.sheets.keys()
    problems += [f"{name}.dxf: no drawing or no layout" for name in sorted(names ^ _drawn(delivery, set(names)))]
    problems += [f"{name}: nothing lies on it" for name in sorted(names - {item.sheet for item in placed})]
    return faults(sum(wanted.values()), problems)


def _drawn(delivery: Delivery, names: set[str]) -> set[str]:
    try:
        return set(delivery.sheets)
    except NotApplicable:
        return names


def holes(delivery: Delivery) -> Measured:
    """Inner contours and drilled holes of every sheet against those of the parts where they lie."""
    if not any(len(part.outlines) > 1 or part.entities for part in delivery.panels.values()):
        raise NotApplicable("no part has holes")
    off = {name: _holes_off(delivery, name, drawing) for name, drawing in delivery.sheets.items()}
    return worst_of(list(off.values()), list(off))


def _holes_off(delivery: Delivery, sheet: str, drawing: Drawing) -> float:
    placed = [(delivery.panels[item.mark], item) for item in delivery.layout.on(sheet)]
    wanted = [_moved(_rim(hole), *pair) for pair in placed for hole in outlines_on(pair[0], "CUT_INNER")]
    drawn = [_rim(hole) for hole in outlines_on(drawing, "CUT_INNER")]
    circles = [row for part, item in placed for row in _circles(part, partial(_moved, part=part, placed=item))]
    return max(_loops_off(wanted, drawn), _loops_off(circles, _circles(drawing, np.array)))


def _circles(drawing: Drawing, move: Callable[[Floats], Floats]) -> list[Floats]:
    """Give drilled holes as loops: the middle and a point to the right and above of it, a radius away."""
    circles = [entity for entity in drawing.entities if entity.layer == "DRILL"]
    middles = [move(np.array([circle.points[0][:2]])) for circle in circles]
    return [middle + circle.radius * _CORNERS for middle, circle in zip(middles, circles, strict=True)]


_CORNERS = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])


def _rim(hole: Outline) -> Floats:
    """Give the vertices of a contour and the middles of its sides or arcs in between, (2n, 2) mm."""
    along = np.roll(hole.points, -1, axis=0) - hole.points
    middles = hole.points + along / 2 + hole.bulges[:, None] * along[:, ::-1] * [0.5, -0.5]
    return np.stack([hole.points, middles], axis=1).reshape(-1, 2)


def _moved(points: Floats, part: Drawing, placed: Placement) -> Floats:
    """Move points of a part as its outline was moved: the lower left corners of both lie in one place."""
    turned = partial(quarter_turned, rotation_deg=placed.rotation_deg, turned_over=placed.turned_over)
    return turned(points) + placed.points.min(axis=0) - turned(one_outline(part).points).min(axis=0)


def _loops_off(wanted: list[Floats], drawn: list[Floats]) -> float:
    """Give how far loops are off those that were wanted, infinite if they are not as many."""
    if len(wanted) != len(drawn):
        return np.inf
    left, worst = list(drawn), 0.0
    for loop in wanted:
        off = [loop_distance(loop, other) for other in left]
        worst = max(worst, min(off))
        left.pop(int(np.argmin(off)))
    return worst


def yields(delivery: Delivery) -> Measured:
    """Yield of the whole layout against the areas."""
    parts = sum(abs(signed_area(item.points)) for item in delivery.layout.placements)
    stock = sum(width * height for width, height in delivery.layout.sheets.values())
    off = abs(100 * parts / stock - float(delivery.layout.raw["yield_percent"]))
    return worst_of([off], ["layout"], limit=half_unit("yield_percent") * (1 + 1e-6))


def machine_files(delivery: Delivery) -> Measured:
    """List what a machine would trip over."""
    problems = [f"{name}.dxf: {fault}" for name, sheet in delivery.sheets.items() for fault in drawing_faults(sheet)]
    return faults(len(delivery.sheets), problems)


def planned(delivery: Delivery) -> Measured:
    """Every sheet is listed and has a page with what can be measured of it, and its parts in cutting order."""
    return worse(plan_faults(delivery, list(_rows(delivery))), plan_says(delivery))


def _rows(delivery: Delivery) -> Iterator[Row]:
    for name, size in delivery.layout.sheets.items():
        placed = delivery.layout.on(name)
        area, (width, height) = sum(abs(signed_area(item.points)) for item in placed), size
        across, up = _offcut(delivery, size, np.concatenate([item.points for item in placed]))
        yield {
            "sheet": name,
            "parts": str(len(placed)),
            "yield_percent": 100 * area / (width * height),
            **_cut(delivery, name, placed),
            "offcut_width_mm": across,
            "offcut_height_mm": up,
        }


def _cut(delivery: Delivery, sheet: str, placed: list[Placement]) -> dict[str, str | float]:
    """Measure what is cut: the outlines, or the lines of a scored sheet if it is there."""
    if delivery.nesting["gap_mm"] > 0:
        lines = [np.vstack([item.points, item.points[:1]]) for item in placed]
    elif not (drawn := _drawn(delivery, set())):
        return {}
    else:
        lines = [line.points for line in outlines_on(delivery.sheets[sheet], "SCORE")] if sheet in drawn else []
    length = sum(float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum()) for line in lines)
    return {"cut_length_mm": length, "cuts": str(len(lines))}


def _offcut(delivery: Delivery, size: tuple[float, float], points: Floats) -> tuple[float, float]:
    """Give the larger of the strips above and beside all parts, a gap away from them; 0 where neither is left."""
    trim, gap = float(delivery.nesting["trim_mm"]), float(delivery.nesting["gap_mm"])
    width, height = (side - 2 * trim for side in size)
    right, top = points.max(axis=0) + gap - trim
    above, beside = (width, max(height - float(top), 0.0)), (max(width - float(right), 0.0), height)
    best = above if above[0] * above[1] >= beside[0] * beside[1] else beside
    return best if min(best) > 0 else (0.0, 0.0)


def placed_gaps(delivery: Delivery) -> Measured:
    """How far the clear distance of two placed parts falls short of the asked gap, sheets drawn or not."""
    gap, on = float(delivery.nesting["gap_mm"]), delivery.layout.on
    found = [shortfall(name, [item.points for item in on(name)], gap) for name in delivery.layout.sheets]
    return worse(*found)


def placed_margins(delivery: Delivery) -> Measured:
    """How far a placed part reaches into the trim of its sheet."""
    trim, over = float(delivery.nesting["trim_mm"]), list[float]()
    for name, size in delivery.layout.sheets.items():
        points = np.concatenate([item.points for item in delivery.layout.on(name)])
        over.append(max(float((trim - points).max()), float((points + trim - np.array(size)).max()), 0.0))
    return worst_of(over, list(delivery.layout.sheets))


RULES = (
    Rule("V31", "every part is placed or listed as often as asked for", 0, "faults", presence),
    Rule("V32b", "holes lie in their parts as drawn", LENGTH, "mm", holes),
    Rule("V33f", "gap between parts as they are placed", LENGTH, "mm short", placed_gaps),
    Rule("V33g", "parts as they are placed keep off the trim", LENGTH, "mm over", placed_margins),
    Rule("V34b", "yield of the layout", half_unit("yield_percent"), "%", yields),
    Rule("V40", "sheets are what machines can read", 0, "faults", machine_files),
    Rule("V45f", "the cutting plan shows every sheet as it lies", 0, "faults", planned),
)
