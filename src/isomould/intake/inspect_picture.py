"""The picture of what was read of a drawing: every curve in a colour of its own, its start, direction and end."""

from collections.abc import Iterator

import numpy as np

from isomould.arrays import Floats
from isomould.documents.picture import Caption, Dot, Frame, Item, Picture, Shape, colour, fit
from isomould.intake.inspection import ReadCurve, ReadDrawing

_WIDTH, _MARGIN, _LINE = 960.0, 30.0, 16.0
_START, _END = "#1f8a4c", "#c9352b"
_ARROW = np.array([[7.0, 0.0], [-4.0, 4.0], [-4.0, -4.0]])
_MOST_NAMED = 20
"""Curves in the legend; those beyond are drawn without."""


def drawing_picture(drawing: ReadDrawing) -> Picture:
    """Draw all curves that were read: green where they start, red where open ones end, an arrow in the middle."""
    frame = _frame(drawing.curves)
    items = [item for number, curve in enumerate(drawing.curves) for item in _curve(number, curve, frame)]
    named = drawing.curves[:_MOST_NAMED]
    legend = [_caption(number, curve) for number, curve in enumerate(named)]
    return Picture(f"What is read of {drawing.file}", _WIDTH, frame.height, (*items, *legend))


def _frame(curves: tuple[ReadCurve, ...]) -> Frame:
    """Fit all curves, those too that are a straight line along an axis."""
    points = np.concatenate([curve.points for curve in curves])
    low, high = points.min(axis=0), points.max(axis=0)
    least = max(float((high - low).max()), 1.0) / 50
    pad = np.maximum(least - (high - low), 0.0) / 2
    foot = _LINE * (1 + min(len(curves), _MOST_NAMED))
    return fit(np.array([low - pad, high + pad]), _WIDTH, _MARGIN, foot)


def _curve(number: int, curve: ReadCurve, frame: Frame) -> Iterator[Item]:
    placed = frame.place(curve.points)
    yield Shape(placed, False, None, colour(number), 1.6)
    yield Shape(_arrow(placed), True, colour(number), None)
    if not curve.closed:
        yield Dot(_pair(placed[-1]), 4.0, _END)
    yield Dot(_pair(placed[0]), 4.0, _START)


def _arrow(placed: Floats) -> Floats:
    """Give the corners (3, 2) of an arrow half way along a curve."""
    steps = np.diff(placed, axis=0)
    walked = np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])
    step = min(int(np.searchsorted(walked, walked[-1] / 2)), len(steps)) - 1
    middle, way = (placed[step] + placed[step + 1]) / 2, steps[step]
    cosine, sine = way / max(float(np.hypot(*way)), 1e-9)
    return _ARROW @ np.array([[cosine, sine], [-sine, cosine]]) + middle


def _caption(number: int, curve: ReadCurve) -> Caption:
    kind = "closed" if curve.closed else "open"
    text = f"{number + 1}: layer {curve.layer}, {kind}, {curve.length:.3f} mm"
    return Caption(text, (_MARGIN, _LINE * (number + 0.6)), 12.0)


def _pair(point: Floats) -> tuple[float, float]:
    return float(point[0]), float(point[1])
