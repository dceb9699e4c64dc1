"""The sheet of a node class: section through arm 1, plan from outside below it (first angle), arms, data."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.documents.shop.base_view import base_views
from isomould.documents.shop.dimensions import Span, above, left_of, stack
from isomould.documents.shop.grid import grid, grid_size
from isomould.documents.shop.page import (
    NORMAL,
    SMALL,
    SMALLEST,
    Arc,
    Item,
    Line,
    Page,
    Text,
    moved,
    paper_size,
    point,
    reading,
)
from isomould.documents.shop.placing import bounds, place_all
from isomould.documents.shop.rows import Row, data_rows
from isomould.documents.shop.title_block import Stationery, Subject, finish, room, wrap
from isomould.documents.shop.view import SCALES, View, scale_text
from isomould.documents.table import Table
from isomould.parts.details.joint import Fin
from isomould.parts.sections import Polygons, SolidViews
from isomould.parts.supports import Base
from isomould.ties import FINE, NOISE

_STUB, _BALLOON = 15.0, 3.0
"""Length of an arm's line beyond the solid, and radius of the circle around its number, mm on paper."""
_HATCH = 2.5
_INSIDE, _APART = 3.0, 7.0
"""How far views may reach to the left into the margin of the frame, and what keeps plan and section apart, mm."""
_ARM_HEADING = ("Arm", "Azimuth °", "Elev. °", "Family", "Section", "Set-back")
_CROSS = 1.5


@dataclass(frozen=True, eq=False)
class NodeDrawing:
    """What is drawn of a node class: its row in the schedule, its solid, set-backs of its arms, notes, its base.

    `fins` are the marks of the fins on its arms, empty for none; `fin` is that of arm 1.
    """

    row: Row
    views: SolidViews
    set_backs: tuple[str, ...]
    notes: tuple[str, ...]
    base: Base | None = None
    fins: tuple[str, ...] = ()
    fin: Fin | None = None


def node_sheet(stationery: Stationery, table: Table, node: NodeDrawing, sheet: int, sheets: int) -> Page:
    """Draw one node class."""
    size = paper_size(stationery.paper or ("A3" if node.base else "A4"), lying=False)
    left, bottom, right, top = room(stationery, size)
    arms = _arm_rows(node)
    data = data_rows(table, node.row)
    tables = [("Node", node.row["mark"]), *data], arms
    column = right - max(grid_size(tables[0])[0], grid_size(arms, SMALLEST)[0])
    scale, drawn = _fitted(node, np.array([[left - _INSIDE, bottom], [column - 2, top]]))
    under = top - grid_size(tables[0])[1] - 6
    noted = under - grid_size(arms, SMALLEST)[1] - 8
    notes = [line for note in node.notes for line in wrap(note, SMALL, right - column)]
    free = (column, bottom, right, noted - 4.5 * len(notes) - 2)
    items = [
        *drawn,
        *grid(tables[0], (column, top)),
        *grid(arms, (column, under), SMALLEST),
        *_notes(notes, column, noted),
        *(base_views(node.base, free) if node.base else []),
    ]
    return finish(stationery, Subject("Node", node.row["mark"], scale_text(scale), sheet, sheets), size, items)


def _arm_rows(node: NodeDrawing) -> list[tuple[str, ...]]:
    names = ("azimuth_{}_deg", "elevation_{}_deg", "family_{}", "section_{}")
    rows = [
        (str(k), *(node.row[name.format(k)] for name in names), back) for k, back in enumerate(node.set_backs, start=1)
    ]
    if not any(node.fins):
        return [_ARM_HEADING, *rows]
    return [(*row, fin) for row, fin in zip([_ARM_HEADING, *rows], ("Fin", *node.fins), strict=True)]


def _notes(notes: Sequence[str], left: float, top: float) -> list[Text]:
    return [Text(note, (left, top - 4.5 * k), SMALL) for k, note in enumerate(notes)]


def _fitted(node: NodeDrawing, box: Floats) -> tuple[float, list[Item]]:
    """Draw section and plan at the largest scale at which both fit a box (2, 2) above each other, in its middle."""
    space = np.ptp(box, axis=0)
    drawn = ((scale, _views(node, scale)) for scale in SCALES)
    fits = (way for way in drawn if way[0] == SCALES[-1] or (np.ptp(bounds(way[1]), axis=0) <= space + NOISE).all())
    scale, items = next(fits)
    (left, _), (right, top) = bounds(items)
    return scale, moved(items, np.array([(box[:, 0].sum() - left - right) / 2, box[1, 1] - top]))


def _views(node: NodeDrawing, scale: float) -> list[Item]:
    """Draw the section and under it the plan, both about the axis."""
    section = _captioned("Section A-A", _section(node, View(scale, np.zeros(2), np.zeros(2))))
    plan = _captioned("Plan, seen from outside", _plan(node, View(scale, np.zeros(2), np.zeros(2))))
    under = bounds(section)[0, 1] - _APART - bounds(plan)[1, 1]
    return [*section, *moved(plan, np.array([0.0, under]))]


def _captioned(words: str, items: list[Item]) -> list[Item]:
    """Write a caption over a view."""
    return [*items, Text(words, (0.0, float(bounds(items)[1, 1]) + 3.0), NORMAL, "middle")]


def _section(node: NodeDrawing, view: View) -> list[Item]:
    """Draw the section through the axis and arm 1, which lies to the right."""
    corners, cut = np.concatenate(node.views.elevation), np.concatenate(node.views.upright)
    low, high = (view.place(end(corners, axis=0)) for end in (np.min, np.max))
    radius = float(node.row["drum_diameter_mm"]) / 2 / view.scale
    foot, head = (view.place(end(cut, axis=0)) for end in (np.min, np.max))
    elevation = np.radians(float(node.row["elevation_1_deg"]))
    way = np.array([np.cos(elevation), np.sin(elevation)])
    start, reach = view.place(np.zeros(2)), float(high[0] - view.at[0]) + _STUB
    level = np.array([[start[0], start[1]], [start[0] + reach / way[0], start[1]]])
    over, beside = float(head[1] - high[1]), float(low[0] - view.at[0] + radius)
    diameter = Span(0.0, 2 * radius, f"Ø{node.row['drum_diameter_mm']}", (over, over))
    height = Span(0.0, float(head[1] - foot[1]), node.row["drum_height_mm"], (beside, beside))
    return [
        *(view.outline(polygon) for polygon in node.views.elevation),
        *(view.outline(polygon) for polygon in node.views.upright),
        *hatching(view, node.views.upright),
        Line("centre", np.array([[view.at[0], low[1] - 4], [view.at[0], high[1] + 4]])),
        Line("centre", np.array([start, start + reach / way[0] * way])),
        *([Line("thin", level)] if abs(elevation) > 1e-9 else []),
        *(_fin(node.fin, float(elevation), view) if node.fin else []),
        *stack(above(np.array([view.at[0] - radius, high[1]])), [diameter]),
        *stack(left_of(np.array([low[0], foot[1]])), [height]),
        _arm_text(start + (reach + 1.5) / way[0] * way, float(elevation), "1"),
    ]


def _fin(fin: Fin, elevation: float, view: View) -> list[Item]:
    """Draw the fin of arm 1 behind the plane of the section, with its holes."""
    side = np.array([1.0, -1.0 if elevation < -FINE else 1.0])
    outline = view.outline(_upright(np.array(fin.corners) * side, elevation))
    items: list[Item] = [outline]
    for hole in fin.holes:
        centre = view.place(_upright(np.array([[hole.x, hole.y]]), elevation))[0]
        reach = hole.diameter / 2 / view.scale
        arms = np.eye(2) * (reach + _CROSS)
        items += [Arc("outline", point(centre), reach)]
        items += [Line("centre", np.array([centre - arm, centre + arm])) for arm in arms]
    return items


def _upright(points: Floats, elevation: float) -> Floats:
    """Turn points (n, 2) from the frame of arm 1's member into the section: outwards, and along the axis."""
    sine, cosine = np.sin(elevation), np.cos(elevation)
    return points @ np.array([[cosine, sine], [-sine, cosine]])


def _arm_text(at: Floats, turn: float, text: str) -> Text:
    """Write the number of an arm behind the end of its line."""
    down = SMALL / 2 * np.array([-np.sin(turn), np.cos(turn)])
    return Text(text, point(at - down), SMALL, "start", turn)


def _plan(node: NodeDrawing, view: View) -> list[Item]:
    radius = float(np.hypot(*np.concatenate(node.views.plan).T).max()) / view.scale
    arms = range(1, int(node.row["valence"]) + 1)
    cross = [view.at + np.array([[-1, 0], [1, 0]]) * (radius + 3), view.at + np.array([[0, -1], [0, 1]]) * (radius + 3)]
    ways = [np.radians(float(node.row[f"azimuth_{k}_deg"])) for k in arms]
    free = [ends for ends, turn in zip(cross, (0, np.pi / 2), strict=True) if not _near(ways, turn)]
    items = [
        *(view.outline(polygon) for polygon in node.views.plan),
        *(view.outline(polygon, "hidden") for polygon in _inner(node.views)),
        *(Line("centre", ends) for ends in free),
        *(item for k, way in zip(arms, ways, strict=True) for item in _arm(view.at, float(way), radius, k, node.row)),
    ]
    return [*items, *_cutting_plane(view.at, radius, items)]


def _near(ways: Sequence[float], turn: float) -> bool:
    """Tell whether an arm lies so near to a line through the axis that the line would only blur it."""
    return any(abs(np.sin(way - turn)) < 0.2 for way in ways)


def _inner(views: SolidViews) -> Polygons:
    """Give the section at the work point where the plan does not show it already."""
    same = abs(_net(views.plan) - _net(views.level)) < 1e-6 * _net(views.plan)
    return () if same else views.level


def _net(polygons: Polygons) -> float:
    areas = [np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1)) / 2 for p in polygons]
    return float(np.sum(areas))


def _arm(centre: Floats, way: float, radius: float, number: int, row: Row) -> list[Item]:
    """Draw an arm's line with its azimuth written along it and its number in a circle at its end."""
    out = np.array([np.cos(way), np.sin(way)])
    far = centre + (radius + _STUB) * out
    ring = far + _BALLOON * out
    turn = reading(way)
    up = np.array([-np.sin(turn), np.cos(turn)])
    label = centre + (radius + _STUB / 2 + 0.5) * out + 0.8 * up
    return [
        Line("centre", np.array([centre, far])),
        Arc("thin", point(ring), _BALLOON),
        Text(str(number), point(ring - np.array([0, SMALL / 2])), SMALL, "middle"),
        Text(f"{row[f'azimuth_{number}_deg']}°", point(label), SMALLEST, "middle", turn),
    ]


def _cutting_plane(centre: Floats, radius: float, items: Sequence[Item]) -> list[Text]:
    """Mark the plane of section A-A on both sides, above or below the arm."""
    x, heights = radius + _STUB + _BALLOON, (-9.0, 6.0, -13.0, 10.0)
    ends = [[centre + np.array([side * x, y]) for y in heights] for side in (-1, 1)]
    return place_all([[Text("A", point(at), NORMAL, "middle", bold=True) for at in places] for places in ends], items)


def hatching(view: View, polygons: Polygons) -> list[Item]:
    """Hatch what is cut: thin lines at 45° in outlines (even–odd)."""
    cut = shapely.Polygon()
    for polygon in polygons:
        cut = cut.symmetric_difference(shapely.Polygon(view.place(polygon)).buffer(0))
    low_x, low_y, high_x, high_y = cut.bounds
    reach = high_y - low_y
    steps = np.arange(low_x - reach, high_x, _HATCH * np.sqrt(2)).tolist()
    lines = shapely.MultiLineString([((x, low_y), (x + reach, high_y)) for x in steps])
    pieces = shapely.get_parts(lines.intersection(cut))
    return [Line("thin", shapely.get_coordinates(piece)) for piece in pieces if piece.geom_type == "LineString"]
