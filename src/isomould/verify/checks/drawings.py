"""V40: drawings that a machine can read, with the outlines that the schedule describes."""

from collections.abc import Callable

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, Outline, area, net_area, one_outline
from isomould.verify.read.tables import Table, half_unit, number, pairs, texts
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, Unreadable, faults, worst_of

LAYERS = {  # what each layer may hold (deliverables, DXF for machines)
    "CUT": {"LWPOLYLINE"},
    "CUT_INNER": {"LWPOLYLINE"},
    "DRILL": {"CIRCLE"},
    "ENGRAVE": {"LWPOLYLINE", "LINE"},
    "SCORE": {"LWPOLYLINE", "LINE"},
    "SHEET": {"LWPOLYLINE"},
    "INFO": {"LWPOLYLINE", "LINE", "CIRCLE", "ARC", "TEXT", "MTEXT", "DIMENSION"},
    "AXIS": {"LINE", "TEXT"},  # setting-out only
}
WORKED = ("CUT", "CUT_INNER", "ENGRAVE", "SCORE")
RELATIVE = 1e-9
SPATIAL = {"setting-out"}
"""Drawings in space, which no machine cuts."""
ROUNDING = 1.5e-3
"""Points of a level line, each rounded to 0.001 mm, mm."""


def machine_files(delivery: Delivery) -> Measured:
    """Read every drawing strictly and list what a machine would trip over."""
    folders = {"panels": delivery.panels, "members": delivery.members, "sheets": delivery.sheets}
    folders |= {"nodes": delivery.node_drawings, "fittings": delivery.fitting_drawings, ".": delivery.drawings(".")}
    folders |= {f"r12/{name}": found for name, found in delivery.twins.items()}
    named = [(f"{folder}/{d.name}.dxf", d) for folder, found in folders.items() for d in found.values()]
    problems = [f"{path}: {fault}" for path, drawing in named for fault in drawing_faults(drawing)]
    return faults(len(named), problems + _missing(delivery))


def _missing(delivery: Delivery) -> list[str]:
    """Name marks without a part file, and part files without a mark."""
    found = {"panels": delivery.panels, "members": delivery.members}
    marks = {name: set(texts(delivery.table(name), "mark")) for name in found}
    differing = {name: sorted(marks[name] ^ files.keys()) for name, files in found.items()}
    return [f"{name}: {mark} in the schedule or the folder only" for name, rest in differing.items() for mark in rest]


def drawing_faults(drawing: Drawing) -> list[str]:
    """List what is wrong with one drawing."""
    found = [] if drawing.units == 4 or drawing.version == "AC1009" else [f"$INSUNITS is {drawing.units}, not 4 (mm)"]
    found += [f"audit: {finding}" for finding in drawing.findings] + _strangers(drawing) + _entity_faults(drawing)
    for outline in drawing.outlines:
        found += [f"{fault} on {outline.layer}" for fault in outline_faults(outline)]
    return found + ([] if _all_different(drawing) else ["a segment is there twice"])


def _strangers(drawing: Drawing) -> list[str]:
    kinds = [("LWPOLYLINE", outline.layer) for outline in drawing.outlines]
    kinds += [(entity.kind, entity.layer) for entity in drawing.entities]
    wrong = {(kind, layer) for kind, layer in kinds if kind not in LAYERS.get(layer, set())}
    return [f"{kind} on layer {layer}" for kind, layer in sorted(wrong)]


def _entity_faults(drawing: Drawing) -> list[str]:
    found = list[str]()
    for entity in drawing.entities:
        values = np.array([*np.ravel(entity.points), entity.radius])
        if not np.isfinite(values).all() or (entity.kind == "CIRCLE" and entity.radius <= 0):
            found.append(f"{entity.kind} on {entity.layer} that is not finite or has no size")
        if drawing.name not in SPATIAL and any(point[2] != 0 for point in entity.points):
            found.append(f"{entity.kind} on {entity.layer} off the plane z = 0")
    return found


def outline_faults(outline: Outline) -> list[str]:
    """List what is wrong with one polyline: numbers, zero length, closed and turned as its layer asks."""
    if len(outline.points) < 2 or not np.isfinite(np.column_stack((outline.points, outline.bulges))).all():
        return ["polyline with too few or not finite points"]
    found = ["segment without length"] if (_lengths(outline) < 1e-9).any() else []
    sign = {"CUT": 1, "SHEET": 1, "CUT_INNER": -1}.get(outline.layer)
    if sign and not outline.closed:
        found.append("open contour")
    elif sign and area(outline) * sign <= 0:
        found.append("contour the wrong way round or without area")
    return found


def _lengths(outline: Outline) -> Floats:
    steps = np.roll(outline.points, -1, axis=0) - outline.points
    return np.linalg.norm(steps if outline.closed else steps[:-1], axis=1)


def _all_different(drawing: Drawing) -> bool:
    keys = [_segments(outline) for outline in drawing.outlines if outline.layer in WORKED]
    rows = np.round(np.vstack(keys), 6) if keys else np.empty((0, 6))
    circles = {(entity.points, entity.radius) for entity in drawing.entities if entity.kind == "CIRCLE"}
    count = sum(entity.kind == "CIRCLE" for entity in drawing.entities)
    return len(np.unique(rows, axis=0)) == len(rows) and len(circles) == count


def _segments(outline: Outline) -> Floats:
    """Give (k, 5): ends of every segment in one order and the bulge as run that way."""
    start, end = outline.points, np.roll(outline.points, -1, axis=0)
    swap = (start[:, 0] > end[:, 0]) | ((start[:, 0] == end[:, 0]) & (start[:, 1] > end[:, 1]))
    ordered = np.where(swap[:, None], np.hstack((end, start)), np.hstack((start, end)))
    rows = np.column_stack((ordered, np.where(swap, -outline.bulges, outline.bulges)))
    return rows if outline.closed else rows[:-1]


def twins(delivery: Delivery) -> Measured:
    """Drawings of R12 against those of R2010: no file missing, the same outlines, circles and texts, mm."""
    if "R12" not in delivery.design.raw.get("dxf", []):
        raise NotApplicable("no R12 twins asked for")
    ours = {name: getattr(delivery, name) for name in delivery.twins}
    off = {f"{name}/{k}": _apart(ours[name].get(k), delivery.twins[name].get(k))
           for name in ours for k in sorted(ours[name].keys() | delivery.twins[name].keys())}  # fmt: skip
    return worst_of(list(off.values()), list(off))


def _apart(first: Drawing | None, second: Drawing | None) -> float:
    """Give the largest difference of two drawings' coordinates, infinite where they hold different things."""
    if first is None or second is None or second.version != "AC1009" or _names(first) != _names(second):
        return np.inf
    pairs = zip(first.outlines, second.outlines, strict=True)
    others = zip(first.entities, second.entities, strict=True)
    off = [abs(np.column_stack((a.points - b.points, a.bulges - b.bulges))).max() for a, b in pairs]
    off += [abs(np.array([*np.ravel(a.points), a.radius]) - [*np.ravel(b.points), b.radius]).max() for a, b in others]
    return float(np.max(off, initial=0.0))


def _names(drawing: Drawing) -> list[tuple[str, str, int, bool]]:
    """Say what a drawing holds, in order."""
    found = [("POLYLINE", outline.layer, len(outline.points), outline.closed) for outline in drawing.outlines]
    return found + [(entity.kind, entity.layer, len(entity.points), False) for entity in drawing.entities]


def panel_areas(delivery: Delivery) -> Measured:
    """Areas of the panels' part files against the schedule, relative, its rounding apart: slivers have small areas."""
    claimed = {mark: number(cell) for mark, cell in pairs(delivery.table("panels"), "mark", "area_m2").items()}
    rounding = half_unit("area_m2")
    areas = {mark: net_area(drawing) / 1e6 for mark, drawing in delivery.panels.items()}
    off = [max(0.0, abs(area - claimed[mark]) - rounding) / claimed[mark] for mark, area in areas.items()]
    return worst_of(off, list(areas))


def panel_sizes(delivery: Delivery) -> Measured:
    """Sides, diagonals, box of the panels' part files against the schedule, at its rounding."""
    return _sizes(delivery, "panels", delivery.panels, _panel_size)


def _panel_size(outline: Outline) -> dict[str, float]:
    points = outline.points
    width, height = np.ptp(points, axis=0)
    found = {"box_width_mm": width, "box_height_mm": height}
    if len(points) == 4:
        sides = [f"side_{letter}_mm" for letter in "abcd"]
        found |= dict(zip(sides, np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1), strict=True))
        found["diagonal_1_mm"] = np.linalg.norm(points[2] - points[0])
        found["diagonal_2_mm"] = np.linalg.norm(points[3] - points[1])
    return {name: float(value) for name, value in found.items()}


def panel_outlines(delivery: Delivery) -> Measured:
    """Points of trimmed panels in the schedule's outline column against their part files."""
    written = {k: v for k, v in pairs(delivery.table("panels"), "mark", "outline").items() if v}
    off = [_outline_off(text, one_outline(_drawing(delivery.panels, mark)).points) for mark, text in written.items()]
    return worst_of(off, list(written), none="no panel is trimmed")


def _outline_off(text: str, points: Floats) -> float:
    found = np.array([[number(x) for x in pair.split(",")] for pair in text.split(";")])
    return float(abs(found - points).max()) if found.shape == points.shape else np.inf


def _drawing(drawings: dict[str, Drawing], mark: str) -> Drawing:
    if mark not in drawings:
        message = f"{mark}.dxf is missing"
        raise Unreadable(message)
    return drawings[mark]


def member_sizes(delivery: Delivery) -> Measured:
    """Lengths of the members' part files against the schedule: over all, along the top, along the bottom."""
    return _sizes(delivery, "members", delivery.members, _member_size)


def _member_size(outline: Outline) -> dict[str, float]:
    top, bottom = (_edge_length(outline, side) for side in (1, -1))
    return {"cut_length_mm": float(np.ptp(outline.points[:, 0])), "top_length_mm": top, "bottom_length_mm": bottom}


def _edge_length(outline: Outline, side: int) -> float:
    """Give the longest level segment on one side: the part's edge without its tongues."""
    here, there = outline.points, np.roll(outline.points, -1, axis=0)
    middle = (here + there)[:, 1] / 2 - np.ptp(here[:, 1]) / 2 - here[:, 1].min()
    level = (abs(there - here)[:, 1] < ROUNDING) & (middle * side > 0)
    return float(np.max(abs(there - here)[level, 0], initial=0.0))


def _sizes(
    delivery: Delivery,
    name: str,
    drawings: dict[str, Drawing],
    measure: Callable[[Outline], dict[str, float]],
) -> Measured:
    table, off, where = delivery.table(name), list[float](), list[str]()
    rows = {mark: k for k, mark in enumerate(texts(table, "mark"))}
    for mark, row in rows.items():
        for column, value in measure(one_outline(_drawing(drawings, mark))).items():
            claimed = texts(table, column)[row]
            if claimed or not _trimmed(table, row):
                off.append(abs(value - number(claimed)))
                where.append(f"{mark} {column}")
    return worst_of(off, where, limit=half_unit("length_mm") + RELATIVE)


def _trimmed(table: Table, row: int) -> bool:
    """Tell a panel with an outline of its own, whose sides are blank in the schedule."""
    return "outline" in table.columns and bool(texts(table, "outline")[row])


RULES = (
    Rule("V40", "drawings are what machines can read", 0, "faults", machine_files),
    Rule("V40b", "areas of panel drawings = schedule", RELATIVE, "relative", panel_areas),
    Rule("V40c", "sides, diagonals and boxes of panel drawings = schedule", 0.0005, "mm", panel_sizes),
    Rule("V40d", "lengths of member drawings = schedule", 0.0005, "mm", member_sizes),
    Rule("V40f", "R12 drawings = R2010 drawings", RELATIVE, "mm", twins),
    Rule("V40e", "outlines of trimmed panels = schedule", RELATIVE, "mm", panel_outlines),
)
