"""Neutral pages: lines by pen, arcs and texts in paper millimetres, the origin at the lower left of the sheet."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from isomould.arrays import Floats, read_only
from isomould.ties import FINE

Pen = Literal["outline", "hidden", "centre", "thin", "frame"]
"""Visible outlines; hidden ones; centre and system lines; dimensions, hatching and tables; the frame (ISO 128)."""

Anchor = Literal["start", "middle", "end"]
Paper = Literal["A4", "A3"]

SMALLEST, SMALL, NORMAL, LARGE = 1.8, 2.5, 3.5, 7.0
"""Heights of capitals (ISO 3098), mm."""


@dataclass(frozen=True, eq=False)
class Line:
    """A polyline (n, 2), mm; `filled` closed ones are arrowheads."""

    pen: Pen
    points: Floats
    closed: bool = False
    filled: bool = False

    def __post_init__(self) -> None:
        read_only(self.points)


@dataclass(frozen=True)
class Arc:
    """An arc about a centre, counter-clockwise from `start` to `end` (rad); by default a circle."""

    pen: Pen
    centre: tuple[float, float]
    radius: float
    start: float = 0.0
    end: float = 2 * np.pi


@dataclass(frozen=True)
class Text:
    """A line of text; `at` is the point of its baseline that `anchor` says, `turn` its direction (rad)."""

    text: str
    at: tuple[float, float]
    height: float = SMALL
    anchor: Anchor = "start"
    turn: float = 0.0
    bold: bool = False


@dataclass(frozen=True)
class Code:
    """A QR code that says `text`; its lower left corner and its side without the quiet zone, mm."""

    text: str
    at: tuple[float, float]
    side: float


Item = Line | Arc | Text | Code


@dataclass(frozen=True)
class Page:
    """A sheet of paper: its bookmark, its size in mm and what is on it."""

    name: str
    size: tuple[float, float]
    items: tuple[Item, ...]


@dataclass(frozen=True)
class Book:
    """Pages that make one file: `nodes` is written to `drawings/nodes.pdf`."""

    name: str
    title: str
    pages: tuple[Page, ...]


SIZES: dict[Paper, tuple[float, float]] = {"A4": (210.0, 297.0), "A3": (297.0, 420.0)}
"""Upright sizes, mm."""

BINDING, MARGIN = 20.0, 10.0
"""From the edge of the paper to the frame: on the left, elsewhere (ISO 5457), mm."""


def paper_size(paper: Paper, *, lying: bool) -> tuple[float, float]:
    """Give width and height of a sheet."""
    short, long = SIZES[paper]
    return (long, short) if lying else (short, long)


def point(xy: Floats) -> tuple[float, float]:
    """Give an array (2,) as a pair of floats."""
    return float(xy[0]), float(xy[1])


def unit(way: Floats) -> Floats:
    """Give a direction (2,) a length of 1."""
    return way / np.hypot(*way)


def moved(items: Iterable[Item], way: Floats) -> list[Item]:
    """Move items by (2,) mm."""
    return [_moved(item, way) for item in items]


def _moved(item: Item, way: Floats) -> Item:
    if isinstance(item, Line):
        return replace(item, points=item.points + way)
    if isinstance(item, Arc):
        return replace(item, centre=point(np.array(item.centre) + way))
    return replace(item, at=point(np.array(item.at) + way))


_FLIP = np.radians(105.0)
"""Texts read from below or from the right; those that lean a little beyond the upright stay as they are."""


def reading(angle: float) -> float:
    """Give the direction (rad, of two opposite ones) in which a text along a line is read.

    >>> print(round(reading(np.pi), 6), round(reading(1.6), 6), round(reading(-1.5), 6))
    0.0 1.6 1.641593
    """
    turned = round(float(np.mod(angle, 2 * np.pi)), 12)  # level is level, and not a hair below it
    turned = turned - 2 * np.pi if turned > _FLIP + np.pi + FINE else turned
    return (turned if turned <= _FLIP + FINE else turned - np.pi) + 0.0
