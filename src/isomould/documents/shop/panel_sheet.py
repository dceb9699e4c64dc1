"""The sheet of a panel class: outline from outside with sides, diagonals, angles and height, mark, data."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats
from isomould.documents.shop.dimensions import FIRST, PITCH, Side, Span, right_of, stack
from isomould.documents.shop.grid import grid, grid_size
from isomould.documents.shop.page import LARGE, NORMAL, SMALL, SMALLEST, Item, Line, Page, Text, paper_size, point
from isomould.documents.shop.placing import collide, place_all
from isomould.documents.shop.rows import Row, data_rows, length_text
from isomould.documents.shop.title_block import Stationery, Subject, finish, room
from isomould.documents.shop.view import View, choose_paper, fit_scale, middle, scale_text
from isomould.documents.table import Table

_AROUND = 24.0
"""Room for the dimensions around the outline, mm."""
_HEIGHT_OUT = 22.0
_ROWS = 6
"""Rows in which the dimension of a short side looks for room."""
_A4_ROOM = (130.0, 100.0)


@dataclass(frozen=True, eq=False)
class PanelDrawing:
    """What is drawn of a panel class: its row in the schedule, its outline (n, 2) mm from outside, its make-up."""

    row: Row
    outline: Floats
    notes: tuple[str, ...]


def panel_sheet(stationery: Stationery, table: Table, panel: PanelDrawing, sheet: int, sheets: int) -> Page:
    """Draw one panel class."""
    rough = fit_scale(np.ptp(panel.outline, axis=0), _A4_ROOM)
    size = paper_size(choose_paper(stationery.paper, rough), lying=True)
    left, bottom, right, top = room(stationery, size)
    data = [("Panel", panel.row["mark"]), *data_rows(table, panel.row)]
    width, height = grid_size(data)
    space = (right - width - left - 2 * _AROUND - 12, top - bottom - 2 * _AROUND)
    scale = fit_scale(np.ptp(panel.outline, axis=0), space)
    view = View(scale, middle(panel.outline), np.array([left + _AROUND + space[0] / 2, (bottom + top) / 2]))
    items = [
        *grid(data, (right - width, top)),
        *_corners(panel, (right - width, top - height - 5)),
        *_drawn(panel, view),
        *(Text(note, (left, bottom + 4.5 * k), SMALL) for k, note in enumerate(panel.notes)),
    ]
    return finish(stationery, Subject("Panel", panel.row["mark"], scale_text(scale), sheet, sheets), size, items)


def _drawn(panel: PanelDrawing, view: View) -> list[Item]:
    items = [*_sides(panel, view), *_height(panel, view), *_diagonals(panel, view)]
    items += place_all(_angles(panel, view), items)
    return [*items, *place_all([_marks(panel, view)], items, 1.0)]


def _sides(panel: PanelDrawing, view: View) -> list[Item]:
    """Draw the outline and dimension its sides, longest first; where two would meet one stands further out."""
    start = view.place(panel.outline)
    way = np.roll(start, -1, axis=0) - start
    length = np.linalg.norm(way, axis=1)
    along = way / length[:, None]
    away = np.stack([along[:, 1], -along[:, 0]], axis=1)
    texts, drawn = _side_texts(panel), list[Item]([view.outline(panel.outline)])
    for k in np.argsort(-length, kind="stable").tolist():
        side, spans = Side(start[k], along[k], away[k]), [Span(0.0, float(length[k]), texts[k])]
        ways = (stack(side, spans, FIRST + row * PITCH) for row in range(_ROWS))
        drawn += next((way for way in ways if not collide(way, drawn)), stack(side, spans))
    return drawn


def _side_texts(panel: PanelDrawing) -> list[str]:
    """Lengths of the sides: as scheduled, or of the outline where it has one of its own, trimmed or chamfered."""
    if not panel.row["outline"]:
        return [panel.row[f"side_{letter}_mm"] for letter in "abcd"]
    lengths = np.linalg.norm(np.roll(panel.outline, -1, axis=0) - panel.outline, axis=1)
    return [length_text(length) for length in lengths.tolist()]


def _height(panel: PanelDrawing, view: View) -> list[Item]:
    """Dimension the height over side a, beyond the dimensions of the sides."""
    if panel.row["outline"] or not panel.row["height_mm"]:
        return []
    points = view.place(panel.outline)
    right, low = points[:, 0].max(), points[0, 1]
    feet = tuple(float(points[k, 0] - right) for k in (1, 2))
    span = Span(0.0, float(points[2, 1] - low), panel.row["height_mm"], (feet[0], feet[1]))
    return stack(right_of(np.array([right, low])), [span], first=_HEIGHT_OUT)


def _diagonals(panel: PanelDrawing, view: View) -> list[Item]:
    if len(panel.outline) != 4:
        return []
    points = view.place(panel.outline)
    lengths = np.linalg.norm(panel.outline[[2, 3]] - panel.outline[[0, 1]], axis=1).tolist()
    texts = [panel.row[f"diagonal_{k}_mm"] or length_text(lengths[k - 1]) for k in (1, 2)]
    lines: list[Item] = [Line("centre", points[[0, 2]]), Line("centre", points[[1, 3]])]
    ways = [_along(points[[0, 2]], texts[0]), _along(points[[3, 1]], texts[1])]
    taken = [view.outline(panel.outline), *lines]
    return [*lines, *place_all(ways, taken, 0.3)]


def _along(ends: Floats, text: str) -> Iterator[Text]:
    """Places of a text along a line, just above it."""
    way = ends[1] - ends[0]
    turn = float(np.arctan2(way[1], way[0]))
    up = 0.9 * np.array([-np.sin(turn), np.cos(turn)])
    for share in (0.27, 0.73, 0.33, 0.67, 0.22, 0.78, 0.38, 0.62):
        yield Text(text, point(ends[0] + share * way + up), SMALL, "middle", turn)


def _angles(panel: PanelDrawing, view: View) -> list[Iterator[Text]]:
    """Places for the angle of every corner: inside along its bisector, then outside between the extension lines."""
    points = view.place(panel.outline)
    ahead, behind = np.roll(points, -1, axis=0) - points, np.roll(points, 1, axis=0) - points
    units = [way / np.linalg.norm(way, axis=1)[:, None] for way in (ahead, behind)]
    bisector = units[0] + units[1]
    texts = _angle_texts(panel, units)
    return [_near_corner(*each) for each in zip(points, bisector, texts, strict=True)]


def _near_corner(corner: Floats, bisector: Floats, text: str) -> Iterator[Text]:
    start = float(np.arctan2(bisector[1], bisector[0]))
    for reach in (*np.arange(5.0, 25.0, 1.5).tolist(), *np.arange(-4.0, -22.0, -1.0).tolist()):
        for way in (start, start + 0.35, start - 0.35):
            at = (corner[0] + reach * np.cos(way), corner[1] + reach * np.sin(way) - SMALLEST / 2)
            yield Text(text, (float(at[0]), float(at[1])), SMALLEST, "middle")


def _angle_texts(panel: PanelDrawing, units: Sequence[Floats]) -> list[str]:
    if not panel.row["outline"]:
        return [f"{panel.row[f'angle_{k}_deg']}°" for k in range(1, 5)]
    angles = np.degrees(np.arccos(np.clip(np.sum(units[0] * units[1], axis=1), -1, 1)))
    return [f"{length_text(angle)}°" for angle in angles.tolist()]


def _marks(panel: PanelDrawing, view: View) -> list[Text]:
    """Places for the mark: the middle, then inside every triangle of the middle and a side, smaller and smaller."""
    points = view.place(panel.outline)
    centre = points.mean(axis=0)
    places = [centre, *((points + np.roll(points, -1, axis=0)) / 2 * 0.55 + centre * 0.45)]
    drop = np.array([0.0, -0.5])
    return [
        Text(panel.row["mark"], point(place + height * drop), height, "middle", bold=True)
        for height in (LARGE, NORMAL, SMALL)
        for place in places
    ]


def _corners(panel: PanelDrawing, corner: tuple[float, float]) -> list[Item]:
    """List the corners of a trimmed panel as scheduled."""
    if not panel.row["outline"]:
        return []
    pairs = [pair.split(",") for pair in panel.row["outline"].split(";")]
    return grid([("Corner", "x", "y"), *((str(k), x, y) for k, (x, y) in enumerate(pairs, start=1))], corner)
