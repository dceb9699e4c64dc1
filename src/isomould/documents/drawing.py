"""Neutral drawings for machines: frozen entities on layers, checked checked by `drawing_checks`."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from isomould.arrays import Floats, read_only

Layer = Literal["CUT", "CUT_INNER", "DRILL", "ENGRAVE", "SCORE", "SHEET", "INFO"]
"""One process per layer; SHEET and INFO are not worked."""

_ARC_PIECES = 16
"""Chords of an arc where only its extent matters."""

WORKED: frozenset[str] = frozenset(("CUT", "CUT_INNER", "DRILL", "ENGRAVE", "SCORE"))


@dataclass(frozen=True, eq=False)
class Polyline:
    """A polyline in the plane: points (n, 2) mm, first vertex not repeated when closed.

    `bulges` (n,) are tan(angle / 4) of the arc that follows each point, 0 for a straight segment.
    """

    layer: Layer
    points: Floats
    closed: bool
    bulges: Floats | None = None

    def __post_init__(self) -> None:
        read_only(self.points)


@dataclass(frozen=True)
class Circle:
    """A drilled hole: centre (x, y) and radius, mm."""

    layer: Layer
    centre: tuple[float, float]
    radius: float


@dataclass(frozen=True)
class Segment3D:
    """A line in space from start to end (x, y, z), mm."""

    layer: Layer
    start: tuple[float, float, float]
    end: tuple[float, float, float]


@dataclass(frozen=True)
class Label:
    """A line of text with its lower left corner at (x, y, z), height in mm."""

    layer: Layer
    text: str
    position: tuple[float, float, float]
    height: float


Entity = Polyline | Circle | Segment3D | Label


@dataclass(frozen=True)
class CutDrawing:
    """A drawing, 1:1 in mm."""

    entities: tuple[Entity, ...]


def signed_area(polyline: Polyline) -> float:
    """Give the area of a closed polyline with its arcs in mm², positive when counter-clockwise.

    Examples
    --------
    >>> disc = Polyline("CUT", np.array([[0.0, 0.0], [2.0, 0.0]]), True, np.array([1.0, 1.0]))
    >>> print(round(signed_area(disc), 6))
    3.141593
    """
    start, end = segment_ends(polyline)
    triangles = (start[:, 0] * end[:, 1] - end[:, 0] * start[:, 1]) / 2
    return float(np.sum(triangles + _arc_areas(np.hypot(*(end - start).T), bulges(polyline))))


def _arc_areas(chord: Floats, bulge: Floats) -> Floats:
    """Area between arc and chord: (φ − sin φ) r²/2 with φ = 4 atan b and r = chord / (2 sin(φ/2))."""
    angle = 4 * np.arctan(bulge)
    radius = np.divide(chord, 2 * np.sin(angle / 2), out=np.zeros_like(chord), where=angle != 0)
    return (angle - np.sin(angle)) * radius**2 / 2


def chords(polyline: Polyline, pieces: int = _ARC_PIECES) -> Floats:
    """Give the points (m, 2) of a closed polyline with its arcs cut into so many chords, mm.

    The centre of an arc of angle φ from a to b is (a + b)/2 + i (b − a)/2 · cot(φ/2).
    """
    start, end = (part @ np.array([1, 1j]) for part in segment_ends(polyline))
    arcs = [_arc(*arc, pieces) for arc in zip(start, end, bulges(polyline), strict=True)]
    return np.concatenate(arcs).view(float).reshape(-1, 2)


def _arc(start: complex, end: complex, bulge: float, pieces: int) -> NDArray[np.complex128]:
    if bulge == 0:
        return np.array([start])
    angle = 4 * np.arctan(bulge)
    centre = (start + end) / 2 + 0.5j * (end - start) / np.tan(angle / 2)
    return centre + (start - centre) * np.exp(1j * angle * np.arange(pieces) / pieces)


def bulges(polyline: Polyline) -> Floats:
    """Give the bulges (n,) of a polyline, zeros when it has none."""
    return np.zeros(len(polyline.points)) if polyline.bulges is None else polyline.bulges


def segment_ends(polyline: Polyline) -> tuple[Floats, Floats]:
    """Give the start and end points (k, 2), (k, 2) of the segments."""
    following = np.roll(polyline.points, -1, axis=0)
    count = len(polyline.points) - (0 if polyline.closed else 1)
    return polyline.points[:count], following[:count]
