"""The sheet of a member class: elevation with its lengths, both ends enlarged, section, holes, data."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.documents.shop.dimensions import Side, Span, above, below, left_of, running, stack, stack_height
from isomould.documents.shop.grid import grid, grid_size
from isomould.documents.shop.page import (
    MARGIN,
    NORMAL,
    SMALL,
    SMALLEST,
    Arc,
    Item,
    Line,
    Page,
    Paper,
    Text,
    paper_size,
    point,
)
from isomould.documents.shop.placing import place_all
from isomould.documents.shop.rows import Row, data_rows, length_text
from isomould.documents.shop.title_block import Stationery, Subject, finish, room
from isomould.documents.shop.view import View, choose_paper, fit_scale, scale_text
from isomould.documents.table import Table
from isomould.parts.features import Hole
from isomould.parts.members import MemberShape
from isomould.ties import NOISE, first_least

_END_SHARE = 0.75
"""How much of an end is enlarged, in depths of the section."""
_END_ROOM = (48.0, 42.0)
_A4_WIDTH = 257.0
_CORNER = -3.0
"""From the tip of an enlarged end outwards to the first running dimension of both its sides, mm."""
_LEVEL = 0.0035
"""Corners on one level line: heights of drums are rounded down to 0.001 mm, corners to the nearest."""
_MOST_HOLES: dict[Paper, int] = {"A4": 7, "A3": 20}
_HOLES_AT: dict[Paper, tuple[float, float]] = {"A4": (-3.0, -4.0), "A3": (190.0, 70.0)}
"""Holes in one table, and where its upper left corner stands: from the lower left of the drawing's room, mm."""
_LYING = "Outside up, start on the left"
_HOLES_FROM = "x and y of holes from the work point at the start"
_HOLE_HEADING = ("Hole", "Face", "x", "y", "Ø", "Slot", "Thread")


@dataclass(frozen=True, eq=False)
class MemberDrawing:
    """What is drawn of a member class: its row in the schedule, its shape, and its section (k, 2) outlines, mm."""

    row: Row
    shape: MemberShape
    section: tuple[Floats, ...]


def member_sheet(stationery: Stationery, table: Table, member: MemberDrawing, sheet: int, sheets: int) -> Page:
    """Draw one member class."""
    asked = stationery.paper or ("A3" if member.shape.holes else None)
    paper = choose_paper(asked, _scale(member, _A4_WIDTH))
    size = paper_size(paper, lying=True)
    left, bottom, right, top = room(stationery, size)
    data = [("Member", member.row["mark"]), *data_rows(table, member.row)]
    width, height = grid_size(data)
    scale = _scale(member, right - left)
    ends = fit_scale((_END_SHARE * _depth(member), _depth(member)), _end_room(member, paper))
    low = bottom + 24.0
    items = [
        *grid(data, (right - width, bottom + height)),
        *_elevation(member, scale, ((left + right) / 2, top)),
        *_end(member, ends, np.array([left + 24, low]), 1),
        *_end(member, ends, np.array([left + 129, low]), -1),
        *_section(member, ends, np.array([left + 167, low])),
        *_holes(member.shape.holes, paper, (left, bottom)),
    ]
    notes = [_LYING, _HOLES_FROM] if member.shape.holes else [_LYING]
    items += place_all([_note_places(note, left, bottom, top) for note in notes], items)
    scales = f"{scale_text(scale)} ({scale_text(ends)})"
    return finish(stationery, Subject("Member", member.row["mark"], scales, sheet, sheets), size, items)


def _note_places(note: str, left: float, bottom: float, top: float) -> list[Text]:
    """Places for a note on how the member lies: beside the title block, else in a corner of the room."""
    return [Text(note, (left, y), SMALL) for y in (MARGIN + 8.5, MARGIN + 4.0, bottom, top - SMALL)]


def _end_room(member: MemberDrawing, paper: Paper) -> tuple[float, float]:
    """Room (mm) of an enlarged end: on small paper the running dimensions of holes take half of it."""
    wide, high = _END_ROOM
    return (wide, high / 2) if member.shape.holes and paper == "A4" else (wide, high)


def _depth(member: MemberDrawing) -> float:
    return float(np.ptp(member.shape.outline[:, 1]))


def _scale(member: MemberDrawing, width: float) -> float:
    length = max(member.shape.system_length, member.shape.cut_length)
    return fit_scale((length, _depth(member)), (width - 25.0, 24.0))


def _elevation(member: MemberDrawing, scale: float, head: tuple[float, float]) -> list[Item]:
    """Draw the member with its start at the left, outside up, lengths and set-backs; `head` is its upper middle."""
    outline, length = member.shape.outline, member.shape.system_length
    view = View(scale, np.array([length / 2, outline[:, 1].max()]), np.array([head[0], 0.0]))
    over, under, holes = _spans_above(member, view), _spans_below(member, view), _hole_marks(member.shape, view)
    view = View(scale, view.centre, np.array([head[0], head[1] - stack_height(over) - 3]))
    low, high = (view.place(np.array([0.0, end]))[1] for end in (outline[:, 1].min(), outline[:, 1].max()))
    ends, through = view.place(np.array([[0.0, 0.0], [length, 0.0]])), [u for u, _ in holes]
    foot, depth = below(np.array([0.0, low])), stack_height(under, through=through)
    return [
        view.outline(outline),
        *_drilled(view, member.shape.holes),
        Line("centre", ends + np.array([[-4.0, 0.0], [4.0, 0.0]])),
        *(Arc("thin", point(end), 0.7) for end in ends),
        *stack(above(np.array([0.0, high])), over),
        *stack(foot, under, through=through),
        *running(foot, holes, first=depth + 6.0),
    ]


def _hole_marks(shape: MemberShape, view: View) -> list[tuple[float, str]]:
    """Give the running dimensions of the holes along the part, from its start."""
    start = float(shape.outline[:, 0].min())
    places = np.unique(np.round([start, *(hole.x for hole in shape.holes)], 6)).tolist() if shape.holes else []
    return [(_along(view, x), length_text(x - start)) for x in places]


def _along(view: View, x: float) -> float:
    return (x - float(view.centre[0])) / view.scale + float(view.at[0])


def _level(member: MemberDrawing, side: int, length: str) -> Floats:
    """Give the x (2,) of the corners on the top (1) or bottom (−1) edge between which a length is scheduled.

    Where a tongue is as high as the body, its corners lie on the edge too and the length ends before them.
    """
    y = side * member.shape.outline[:, 1]
    x = member.shape.outline[y > y.max() - _LEVEL, 0]
    off = np.abs(x[None] - x[:, None] - float(length))
    return x[list(np.unravel_index(first_least(off.ravel()), off.shape))]


def _spans_above(member: MemberDrawing, view: View) -> list[Span]:
    shape, row = member.shape, member.row
    work = (shape.outline[:, 1].max()) / view.scale
    back, length = shape.set_back, shape.system_length
    return [
        _span(view, _level(member, 1, row["top_length_mm"]), row["top_length_mm"]),
        _span(view, np.array([0.0, back[0]]), row["set_back_start_mm"], (-work, -work)),
        _span(view, np.array([length - back[1], length]), row["set_back_end_mm"], (-work, -work)),
    ]


def _spans_below(member: MemberDrawing, view: View) -> list[Span]:
    shape, row = member.shape, member.row
    x, work = shape.outline[:, 0], shape.outline[:, 1].min() / view.scale
    return [
        _span(view, _level(member, -1, row["bottom_length_mm"]), row["bottom_length_mm"]),
        _span(view, np.array([x.min(), x.max()]), row["cut_length_mm"], (work / 2, work / 2)),
        _span(view, np.array([0.0, shape.system_length]), row["system_length_mm"], (work, work)),
    ]


def _span(view: View, x: Floats, text: str, feet: tuple[float, float] = (0.0, 0.0)) -> Span:
    start, end = (_along(view, each) for each in x.tolist())
    return Span(start, end, text, feet)


def _end(member: MemberDrawing, scale: float, at: Floats, way: int) -> list[Item]:
    """Enlarge the start (`way` 1) or the end (−1), its outermost point above or below `at`, with running dimensions."""
    outline = member.shape.outline
    tip, low = float((outline[:, 0] * way).min()) * way, float(outline[:, 1].min())
    view = View(scale, np.array([tip, low]), at)
    reach = min(_END_SHARE * _depth(member), 0.45 * member.shape.cut_length)
    holes = [hole for hole in member.shape.holes if hole.face == "front" and (hole.x - tip) * way < reach - NOISE]
    near = np.array([*outline[(outline[:, 0] - tip) * way < reach - NOISE], *((hole.x, hole.y) for hole in holes)])
    x, y = (np.unique(places.round(6)) for places in ((near[:, 0] - tip) * way, near[:, 1] - low))
    side = Side(at, np.array([0.0, 1.0]), np.array([-float(way), 0.0]))
    foot = Side(at, np.array([float(way), 0.0]), np.array([0.0, -1.0]))
    word = "start" if way > 0 else "end"
    caption = f"{word.capitalize()}: end angle {member.row[f'end_angle_{word}_deg']}°"
    heights = running(side, [(value / scale, length_text(value)) for value in y.tolist()], least=_CORNER)
    top = max(item.at[1] for item in heights if isinstance(item, Text)) + SMALL + 2
    head = np.array([at[0] + way * reach / 2 / scale, max(at[1] + _depth(member) / scale + 8, top)])
    return [
        *_clipped(view, outline, tip + way * reach),
        *_drilled(view, holes),
        *heights,
        *running(foot, [(value / scale, length_text(value)) for value in x.tolist()], least=_CORNER),
        Text(caption, point(head), NORMAL, "middle"),
    ]


def _clipped(view: View, outline: Floats, x: float) -> list[Item]:
    """Draw what lies on the outline's nearer side of x; the break there is a thin line."""
    low, high = outline.min(axis=0) - 1.0, outline.max(axis=0) + 1.0
    at_start = x - low[0] < high[0] - x - NOISE
    kept = shapely.box(low[0], low[1], x, high[1]) if at_start else shapely.box(x, low[1], *high)
    edges = shapely.get_parts(shapely.line_merge(kept.intersection(shapely.LinearRing(outline))))
    cut = shapely.get_coordinates(
        shapely.Polygon(outline).intersection(shapely.LineString([(x, low[1]), (x, high[1])]))
    )
    return [*(view.line(shapely.get_coordinates(edge), "outline") for edge in edges), view.line(cut, "centre")]


def _section(member: MemberDrawing, scale: float, at: Floats) -> list[Item]:
    """Draw the section with depth and width, its lower left corner at `at`; it is seen from the start, on the right."""
    corners = np.concatenate(member.section)
    view = View(scale, corners.min(axis=0), at)
    wide, deep = np.ptp(corners, axis=0).tolist()
    return [
        *(view.outline(part) for part in member.section),
        *stack(left_of(at), [Span(0.0, deep / scale, length_text(deep))]),
        *stack(below(at), [Span(0.0, wide / scale, length_text(wide))]),
        Text("Section", (float(at[0] + wide / 2 / scale), float(at[1] + deep / scale) + 8), NORMAL, "middle"),
    ]


def _drilled(view: View, holes: Sequence[Hole]) -> list[Item]:
    """Draw the holes of the front: circles, and slots as two half circles with their sides."""
    return [item for hole in holes if hole.face == "front" for item in _hole(view, hole)]


def _hole(view: View, hole: Hole) -> list[Item]:
    radius, half = hole.diameter / 2 / view.scale, np.array([hole.lengthening / 2 / view.scale, 0.0])
    centre, up = view.place(np.array([hole.x, hole.y])), np.array([0.0, radius])
    cross = np.array([[1.5, 0.0], [0.0, 1.5]]) + np.diag([radius + half[0], radius])
    axes = [Line("centre", np.array([centre - arm, centre + arm])) for arm in cross]
    if not hole.lengthening:
        return [Arc("outline", point(centre), radius), *axes]
    ends = [Arc("outline", point(centre + half), radius, -np.pi / 2, np.pi / 2)]
    ends += [Arc("outline", point(centre - half), radius, np.pi / 2, 3 * np.pi / 2)]
    return [
        *ends,
        *(Line("outline", np.array([centre - half + s * up, centre + half + s * up])) for s in (-1, 1)),
        *axes,
    ]


def _holes(holes: Sequence[Hole], lying: Paper, corner: tuple[float, float]) -> list[Item]:
    """List the holes beside the title block, or further up on large paper: x from the work point at the start."""
    names = [hole.face for hole in holes], [hole.thread or "-" for hole in holes]
    sizes = [map(length_text, (hole.x, hole.y, hole.diameter, hole.lengthening)) for hole in holes]
    rows = [
        (str(k), face, *size, thread)
        for k, (face, size, thread) in enumerate(zip(names[0], sizes, names[1], strict=True), 1)
    ]
    (left, top), most, items = _HOLES_AT[lying], _MOST_HOLES[lying], list[Item]()
    for start in range(0, len(rows), most):
        table = [_HOLE_HEADING, *rows[start : start + most]]
        items += grid(table, (corner[0] + left, corner[1] + top), SMALLEST)
        left += grid_size(table, SMALLEST)[0] + 4
    return items
