"""Views: model millimetres to paper millimetres at scales of ISO 5455 and steps between."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats
from isomould.documents.numbers import format_number
from isomould.documents.shop.page import Line, Paper, Pen
from isomould.ties import NOISE

SCALES = (1.0, 2.0, 2.5, 5.0, 10.0, 15.0, 20.0, 25.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0)
"""Model millimetres per millimetre on paper: those of the standard, and steps between that fill sheets better."""

ENLARGED = (0.1, 0.2, 0.5)
"""Scales of parts that would be too small to be read."""

_SMALL_ENOUGH = 20.0
"""Coarsest scale that is drawn on A4 while A3 would be finer."""


@dataclass(frozen=True, eq=False)
class View:
    """Model point `centre` (2,) lies at `at` (2,) on paper; `scale` model mm are one on paper."""

    scale: float
    centre: Floats
    at: Floats

    def place(self, points: Floats) -> Floats:
        """Give the places (…, 2) on paper of model points (…, 2), rounded so that noise decides nothing there."""
        return np.round((points - self.centre) / self.scale + self.at, 6) + 0.0

    def outline(self, points: Floats, pen: Pen = "outline") -> Line:
        """Draw a closed outline (n, 2)."""
        return Line(pen, self.place(points), closed=True)

    def line(self, points: Iterable[Floats], pen: Pen) -> Line:
        """Draw an open line through model points."""
        return Line(pen, self.place(np.array(list(points), dtype=float)))


def fit_scale(extent: tuple[float, float] | Floats, room: tuple[float, float]) -> float:
    """Give the largest standard scale at which an extent in x and y (model mm) fits a room (paper mm).

    >>> fit_scale((2400.0, 200.0), (220.0, 60.0))
    15.0
    """
    width, height = room[0] + NOISE, room[1] + NOISE
    fitting = (scale for scale in SCALES if extent[0] / scale <= width and extent[1] / scale <= height)
    return next(fitting, SCALES[-1])


def choose_paper(asked: Paper | None, scale_on_a4: float) -> Paper:
    """Give the paper that was asked for, else A4 where the scale there is 1:20 or larger."""
    return asked or ("A4" if scale_on_a4 <= _SMALL_ENOUGH else "A3")


def scale_text(scale: float) -> str:
    """Write a scale.

    >>> scale_text(20.0), scale_text(0.5)
    ('1:20', '2:1')
    """
    return f"1:{format_number(scale)}" if scale >= 1 else f"{format_number(1 / scale)}:1"


def middle(points: Floats) -> Floats:
    """Give the middle (2,) of the box around points (n, 2)."""
    return (points.min(axis=0) + points.max(axis=0)) / 2
