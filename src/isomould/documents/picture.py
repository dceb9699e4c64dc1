"""Neutral pictures: filled and stroked shapes in painting order, in points with y upwards."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from isomould.arrays import Floats, read_only

INK, PALE = "#26323d", "#8b98a5"


@dataclass(frozen=True, eq=False)
class Shape:
    """A polygon, or a polyline where it is not closed: points (n, 2); colours as #rrggbb, None for none.

    `opacity` is that of the fill.
    """

    points: Floats
    closed: bool
    fill: str | None = None
    stroke: str | None = INK
    width: float = 0.6
    opacity: float = 1.0

    def __post_init__(self) -> None:
        read_only(self.points)


@dataclass(frozen=True)
class Dot:
    """A filled circle."""

    centre: tuple[float, float]
    radius: float
    fill: str


@dataclass(frozen=True)
class Caption:
    """A line of text; `anchor` says which of its points lies at the position."""

    text: str
    position: tuple[float, float]
    size: float = 12.0
    anchor: Literal["start", "middle", "end"] = "start"


Item = Shape | Dot | Caption


@dataclass(frozen=True)
class Picture:
    """Items in painting order on a white sheet of width × height points; `title` is its text alternative."""

    title: str
    width: float
    height: float
    items: tuple[Item, ...]


@dataclass(frozen=True)
class Frame:
    """Where the drawing lies on the sheet: `point · scale + offset`."""

    scale: float
    offset: tuple[float, float]
    height: float

    def place(self, points: Floats) -> Floats:
        """Give the places (…, 2) on the sheet of points (…, 2)."""
        return points * self.scale + np.array(self.offset)


def fit(points: Floats, width: float, margin: float, foot: float) -> Frame:
    """Give the frame that fits points (n, 2) into a sheet, with room of `foot` points for captions below."""
    low, size = points.min(axis=0), np.ptp(points, axis=0)
    scale = min((width - 2 * margin) / size[0], 0.75 * width / max(size[1], 1e-9))
    height = size[1] * scale + 2 * margin + foot
    left = (width - size[0] * scale) / 2
    return Frame(float(scale), (float(left - low[0] * scale), float(margin + foot - low[1] * scale)), float(height))


def colour(number: int) -> str:
    """Give the colour of a class: hues a golden section apart, so that neighbours differ.

    >>> colour(0), colour(1)
    ('#2b61c9', '#8fc92b')
    """
    red, green, blue = _hue((0.61 + number * 0.618034) % 1.0)
    return f"#{red:02x}{green:02x}{blue:02x}"


def _hue(hue: float) -> tuple[int, int, int]:
    ramp = np.clip(np.abs((hue * 6 + np.array([0.0, 4.0, 2.0])) % 6 - 3) - 1, 0.0, 1.0)
    red, green, blue = np.rint(43 + 158 * ramp).astype(int).tolist()
    return red, green, blue


def blend(low: str, high: str, share: float) -> str:
    """Give the colour between two, #rrggbb.

    >>> blend("#000000", "#ffffff", 0.5)
    '#808080'
    """
    a, b = (np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)]) for text in (low, high))
    red, green, blue = np.rint(a + (b - a) * round(share, 9)).astype(int).tolist()
    return f"#{red:02x}{green:02x}{blue:02x}"
