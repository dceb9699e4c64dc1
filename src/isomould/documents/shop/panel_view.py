"""The view of a panel: its outline from outside with sides, diagonals, angles, height and mark.

What finds no room in the view or beside it, as on slivers and tiny panels, waits for a place further off.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats
from isomould.documents.shop.dimensions import FIRST, PITCH, Side, Span, right_of, ways_to_write
from isomould.documents.shop.page import LARGE, NORMAL, SMALL, SMALLEST, Arc, Item, Line, Text, moved, point, reading
from isomould.documents.shop.placing import Waiting, Wish, bounds, collide, place_or_wait
from isomould.documents.shop.rows import Row, length_text
from isomould.documents.shop.view import ENLARGED, SCALES, View, middle
from isomould.ties import NOISE, first_least, in_order

_AROUND = 13.5
"""What one row of dimensions takes beside the outline, mm."""
_HEIGHT_OUT = 22.0
_OUTER = tuple(FIRST + PITCH * k for k in range(6))
"""Rows in which a dimension looks for room, mm from its side."""
_ANGLE_REACHES = (*np.arange(5.0, 17.0, 1.5).tolist(), *np.arange(-4.0, -14.0, -1.0).tolist())
_NUMBER_REACHES = (*np.arange(-3.0, -7.0, -0.5).tolist(), *np.arange(3.0, 9.0, 0.5).tolist())
"""How far along a corner's bisector angle and number look for room, inwards, mm."""
_RING = 1.7

Placed = tuple[list[Item], list[Waiting]]
"""What is drawn, and what found no room."""
Dimension = tuple[Side, Span, Sequence[float]]
"""Where a length is measured, what, and the rows it may stand in."""


@dataclass(frozen=True, eq=False)
class PanelDrawing:
    """What is drawn of a panel class: its row in the schedule, its outline (n, 2) mm from outside, its make-up."""

    row: Row
    outline: Floats
    notes: tuple[str, ...]

    @property
    def own_outline(self) -> bool:
        """Whether the schedule lists its corners instead of its sides."""
        return bool(self.row["outline"])


def fitted_view(panel: PanelDrawing, box: Floats) -> tuple[float, Placed]:
    """Draw at the largest scale at which the view with its dimensions fits a box (2, 2).

    Returns
    -------
    scale, (drawn, waiting)
        Drawn as near to the middle of the box as can be; what found no room.
    """
    space, extent = np.ptp(box, axis=0), np.ptp(panel.outline, axis=0)
    room = space - 2 * _AROUND + NOISE
    rough = [scale for scale in (*ENLARGED, *SCALES) if (extent / scale <= room).all()] or SCALES[-1:]
    drawn = ((scale, _draw(panel, View(scale, middle(panel.outline), middle(box)))) for scale in rough)
    scale, (items, waiting) = next(way for way in drawn if way[0] == rough[-1] or _fits(way[1][0], space))
    low, high = box - bounds(items)
    way = np.clip(np.zeros(2), low, np.maximum(low, high))
    return scale, (moved(items, way), [(text, target + way) for text, target in waiting])


def _fits(items: Sequence[Item], space: Floats) -> bool:
    return bool((np.ptp(bounds(items), axis=0) <= space + NOISE).all())


def _draw(panel: PanelDrawing, view: View) -> Placed:
    """Draw the view: lines first, then texts, each where it meets nothing that is there."""
    lines: list[Item] = [view.outline(panel.outline), *_diagonals(panel, view)]
    items, waiting = _dimensioned([*_sides(panel, view), *_height(panel, view)], lines)
    wishes = [*_diagonal_wishes(panel, view), *_angles(panel, view), _mark(panel, view)]
    numbers, unnumbered = _numbers(panel, view, items)
    texts, unplaced = place_or_wait(wishes, [*items, *numbers])
    return [*items, *numbers, *texts], [*waiting, *unnumbered, *unplaced]


def _dimensioned(wanted: Iterable[Dimension], lines: list[Item]) -> Placed:
    """Draw dimensions one after the other, each in the first of its rows where no text meets anything."""
    drawn, waiting = lines, list[Waiting]()
    for side, span, rows in wanted:
        way = next((way for way in ways_to_write(side, span, rows) if not collide(way, drawn)), None)
        drawn = [*drawn, *(way or [])]
        waiting += [] if way else [(span.text, side.at((span.start + span.end) / 2, 0.0))]
    return drawn, waiting


def _sides(panel: PanelDrawing, view: View) -> Iterator[Dimension]:
    """Give the dimensions of the sides, longest first."""
    start = view.place(panel.outline)
    way = np.roll(start, -1, axis=0) - start
    length = np.linalg.norm(way, axis=1)
    along = way / length[:, None]
    away = np.stack([along[:, 1], -along[:, 0]], axis=1)
    texts = side_texts(panel)
    for k in in_order(-length).tolist():
        yield Side(start[k], along[k], away[k]), Span(0.0, float(length[k]), texts[k]), _OUTER


def side_texts(panel: PanelDrawing) -> list[str]:
    """Give the lengths of the sides: as scheduled, or of the outline where it has its own."""
    if not panel.own_outline:
        return [panel.row[f"side_{letter}_mm"] for letter in "abcd"]
    lengths = np.linalg.norm(np.roll(panel.outline, -1, axis=0) - panel.outline, axis=1)
    return [length_text(length) for length in lengths.tolist()]


def _height(panel: PanelDrawing, view: View) -> Iterator[Dimension]:
    """Give the dimension of the height over side a, beyond the dimensions of the sides."""
    if panel.own_outline or not panel.row["height_mm"]:
        return
    points = view.place(panel.outline)
    right, low = points[:, 0].max(), points[0, 1]
    feet = tuple(float(points[k, 0] - right) for k in (1, 2))
    span = Span(0.0, float(points[2, 1] - low), panel.row["height_mm"], (feet[0], feet[1]))
    yield right_of(np.array([right, low])), span, [_HEIGHT_OUT + row - FIRST for row in _OUTER]


def _diagonals(panel: PanelDrawing, view: View) -> list[Line]:
    points = view.place(panel.outline)
    return [Line("centre", points[[k, k + 2]]) for k in (0, 1)] if len(points) == 4 else []


def _diagonal_wishes(panel: PanelDrawing, view: View) -> list[Wish]:
    points = view.place(panel.outline)
    ends = (points[[0, 2]], points[[3, 1]]) if len(points) == 4 else ()
    return [
        (text, line.mean(axis=0), _along(line, text)) for line, text in zip(ends, diagonal_texts(panel), strict=True)
    ]


def diagonal_texts(panel: PanelDrawing) -> list[str]:
    """Give the lengths of the diagonals of four corners: as scheduled, or of the outline where it has its own."""
    if len(panel.outline) != 4:
        return []
    lengths = np.linalg.norm(panel.outline[[2, 3]] - panel.outline[[0, 1]], axis=1).tolist()
    return [panel.row[f"diagonal_{k}_mm"] or length_text(length) for k, length in enumerate(lengths, start=1)]


def _along(ends: Floats, text: str) -> Iterator[Text]:
    """Places of a text along a line, just above it or just below."""
    way = ends[1] - ends[0]
    turn = reading(float(np.arctan2(way[1], way[0])))
    up = np.array([-np.sin(turn), np.cos(turn)])
    for rise in (0.9, -0.9 - SMALL):
        for share in (0.27, 0.73, 0.33, 0.67, 0.22, 0.78, 0.38, 0.62, 0.15, 0.85):
            yield Text(text, point(ends[0] + share * way + rise * up), SMALL, "middle", turn)


def _angles(panel: PanelDrawing, view: View) -> list[Wish]:
    points = view.place(panel.outline)
    texts = angle_texts(panel)
    return [(text, points[k], _near_corner(points, k, text, _ANGLE_REACHES)) for k, text in enumerate(texts)]


def _near_corner(points: Floats, k: int, text: str, reaches: Sequence[float]) -> Iterator[Text]:
    """Places along the bisector of a corner, nearer to it than to any other: inside, then outside."""
    ahead, behind = (np.roll(points, turn, axis=0)[k] - points[k] for turn in (-1, 1))
    bisector = ahead / np.linalg.norm(ahead) + behind / np.linalg.norm(behind)
    start = float(np.arctan2(bisector[1], bisector[0]))
    for reach in reaches:
        for turn in (start, start + 0.35, start - 0.35):
            middle_of = points[k] + reach * np.array([np.cos(turn), np.sin(turn)])
            if first_least(np.linalg.norm(points - middle_of, axis=1)) == k:
                yield Text(text, point(middle_of - np.array([0.0, SMALLEST / 2])), SMALLEST, "middle")


def angle_texts(panel: PanelDrawing) -> list[str]:
    """Give the angles: as scheduled, or of the outline where it has its own."""
    if not panel.own_outline:
        return [f"{panel.row[f'angle_{k}_deg']}°" for k in range(1, 5)]
    ahead, behind = (np.roll(panel.outline, turn, axis=0) - panel.outline for turn in (-1, 1))
    units = [way / np.linalg.norm(way, axis=1)[:, None] for way in (ahead, behind)]
    angles = np.degrees(np.arccos(np.clip(np.sum(units[0] * units[1], axis=1), -1, 1)))
    return [f"{length_text(angle)}°" for angle in angles.tolist()]


def _numbers(panel: PanelDrawing, view: View, items: Sequence[Item]) -> Placed:
    """Number the corners that the schedule lists, in rings."""
    if not panel.own_outline:
        return [], []
    points = view.place(panel.outline)
    wishes = [(str(k + 1), points[k], _near_corner(points, k, str(k + 1), _NUMBER_REACHES)) for k in range(len(points))]
    texts, waiting = place_or_wait(wishes, items, _RING)
    rings = [Arc("thin", (text.at[0], text.at[1] + SMALLEST / 2), _RING) for text in texts]
    return [*texts, *rings], [(f"Corner {text}", target) for text, target in waiting]


def _mark(panel: PanelDrawing, view: View) -> Wish:
    """Places for the mark: the middle, then inside every triangle of the middle and a side, smaller and smaller."""
    points = view.place(panel.outline)
    centre = points.mean(axis=0)
    places = [centre, *((points + np.roll(points, -1, axis=0)) / 2 * 0.55 + centre * 0.45)]
    drop = np.array([0.0, -0.5])
    sizes = ((height, place) for height in (LARGE, NORMAL, SMALL) for place in places)
    mark = panel.row["mark"]
    return mark, centre, (Text(mark, point(at + high * drop), high, "middle", bold=True) for high, at in sizes)
