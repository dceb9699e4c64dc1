"""Engraved marks: where a line of text finds room on a part, and its strokes."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from isomould.arrays import Floats, round_um
from isomould.documents.drawing import Circle, Polyline, chords
from isomould.documents.stroke_font import ARROW, text_strokes, text_width

TEXT_HEIGHTS = (20.0, 14.0, 10.0, 7.0, 5.0, 3.5, 2.5, 2.0)
"""Heights of engraved marks, tallest first (ISO 3098 steps), mm."""

_MARGIN = 0.5
"""Clear distance of the mark from the outline, in text heights."""

_LEVEL = 2e-3
"""How far the corners of a level edge may differ in height, each rounded to 0.001 mm."""

_TURNS = (np.array([[1.0, 0.0], [0.0, 1.0]]), np.array([[0.0, 1.0], [-1.0, 0.0]]))
"""A mark stands level or turned by 90°."""


@dataclass(frozen=True, eq=False)
class Stamp:
    """A placed line of text: its middle (x, y) mm, cap height in mm, turned counter-clockwise by 90° or not."""

    text: str
    middle: Floats
    height: float
    turned: bool = False

    @property
    def corner(self) -> Floats:
        """Where the text begins: its lower left corner as it is read, mm."""
        return round_um(self.middle - _size(self.text, self.height) / 2 @ _TURNS[self.turned])


def free_area(contour: Polyline, holes: Iterable[Polyline | Circle], reserved: Iterable[Floats] = ()) -> BaseGeometry:
    """Give what a contour leaves beside the holes in it and the polygons (k, 2) that are reserved."""
    taken = [*(_extent(hole) for hole in holes), *(shapely.Polygon(polygon) for polygon in reserved)]
    return shapely.Polygon(chords(contour)).difference(shapely.union_all(taken))


def place_in_middle(text: str, free: BaseGeometry) -> Stamp | None:
    """Place text in the middle at the tallest height that fits the free area; None when even the lowest does not."""
    middle = round_um(np.array(_middle(free).coords[0]))
    lines = (Stamp(text, middle, height, turned) for height in TEXT_HEIGHTS for turned in (False, True))
    return next((line for line in lines if free.contains(_box(line))), None)


def place_at_start(text: str, outline: Floats, free: BaseGeometry) -> Stamp | None:
    """Place text and an arrow below the top edge where the body of a member begins, or else in the middle.

    `outline` (n, 2) mm runs along the member with x from start to end and y to the outside; the arrow points to the
    end. The mark stays off the tongues, which disappear in the slots of the nodes.
    """
    read, corner = text + ARROW, _body_corner(outline)
    lines = (_below(read, corner, height) for height in TEXT_HEIGHTS)
    return next((line for line in lines if free.contains(_box(line))), None) or place_in_middle(read, free)


def engrave(stamp: Stamp | None) -> list[Polyline]:
    """Draw the strokes of a placed text; nothing for none."""
    return [] if stamp is None else [Polyline("ENGRAVE", points, closed=False) for points in _strokes(stamp)]


def _extent(hole: Polyline | Circle) -> shapely.Polygon:
    if isinstance(hole, Circle):
        return shapely.Point(hole.centre).buffer(hole.radius)
    return shapely.Polygon(chords(hole))


def _body_corner(outline: Floats) -> Floats:
    """Give the upper left corner of the largest upright box that top and bottom edge share at the start."""
    starts = [_edge_start(outline, level) for level in (outline[:, 1].min(), outline[:, 1].max())]
    return np.array([max(starts), outline[:, 1].max()])


def _edge_start(outline: Floats, level: float) -> float:
    """Give where the longest edge at a level starts: a tongue as high as the body has an edge of its own there."""
    following = np.roll(outline, -1, axis=0)
    there = (np.abs([outline[:, 1] - level, following[:, 1] - level]) < _LEVEL).all(axis=0)
    longest = np.argmax(np.where(there, np.abs(following - outline)[:, 0], -1.0))
    return float(min(outline[longest, 0], following[longest, 0]))


def _below(text: str, corner: Floats, height: float) -> Stamp:
    inwards = (_size(text, height) / 2 + 2 * _MARGIN * height) * [1, -1]
    return Stamp(text, round_um(corner + inwards), height)


def _middle(free: BaseGeometry) -> shapely.Point:
    if free.contains(free.centroid):
        return free.centroid
    # corners of arcs carry noise, which must not choose between rooms of one size on both sides of a hole
    return shapely.transform(free, _settled).representative_point()


def _settled(points: Floats) -> Floats:
    return np.round(points, 6)


def _box(stamp: Stamp) -> shapely.Polygon:
    """Box of a line of text about its middle, with the margin around it."""
    half = np.abs((_size(stamp.text, stamp.height) / 2 + _MARGIN * stamp.height) @ _TURNS[stamp.turned])
    return shapely.box(*(stamp.middle - half), *(stamp.middle + half))


def _size(text: str, height: float) -> Floats:
    return np.array([text_width(text, height), height])


def _strokes(stamp: Stamp) -> list[Floats]:
    half = _size(stamp.text, stamp.height) / 2
    strokes = text_strokes(stamp.text, stamp.height)
    return [round_um((stroke - half) @ _TURNS[stamp.turned] + stamp.middle) for stroke in strokes]
