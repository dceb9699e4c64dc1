"""The orientation mark of a panel: an engraved arrow to side a, and which side is coated."""

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from isomould.arrays import Floats, round_um
from isomould.documents.drawing import Polyline
from isomould.documents.stroke_font import text_strokes

SIZES = (10.0, 7.0, 5.0, 3.5, 2.5, 2.0)
"""Sizes of the mark, largest first, mm."""
_ARROW = (np.array([[0.0, 3.0], [0.0, 1.0]]), np.array([[-0.5, 1.8], [0.0, 1.0], [0.5, 1.8]]))
"""Shaft and head in sizes: x along the side from its middle, y inwards. The tip is one size from the edge."""
_TEXT_AT = np.array([1.0, 1.5])


def point_to_side(outline: Floats, free: BaseGeometry, text: str) -> list[Polyline]:
    """Engrave an arrow to the middle of the first side of an outline (n, 2), with a text of one size beside it.

    The arrow stands square on the side; the shaft is the stroke with two points. Nothing is engraved where even the
    smallest mark does not fit the free area.
    """
    marks = (_strokes(outline, size, text) for size in SIZES)
    return next((found for found in marks if _fits(found, free)), [])


def _strokes(outline: Floats, size: float, text: str) -> list[Polyline]:
    drawn = [*_ARROW, *(stroke + _TEXT_AT for stroke in text_strokes(text, 1.0))]
    frame, middle = _frame(outline)
    return [Polyline("ENGRAVE", round_um(stroke * size @ frame + middle), closed=False) for stroke in drawn]


def _frame(outline: Floats) -> tuple[Floats, Floats]:
    """Directions (2, 2) along the first side and inwards, and the middle of the side."""
    along = (outline[1] - outline[0]) / np.linalg.norm(outline[1] - outline[0])
    x, y = outline.T
    way = np.sign(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    return np.stack([along, way * np.array([-along[1], along[0]])]), (outline[0] + outline[1]) / 2


def _fits(strokes: list[Polyline], free: BaseGeometry) -> bool:
    return all(free.contains(shapely.LineString(stroke.points)) for stroke in strokes)
