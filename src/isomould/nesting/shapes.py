"""Parts in the position in which they stand in a strip, in whole micrometres.

The search sees the narrowest trapezoid around a part that spans its whole height: `left` and `right`
are the slopes dx/dy of its legs. Two neighbours are set at their true distance by `advance`.
"""

from dataclasses import dataclass

import numpy as np
import shapely

from isomould.arrays import Floats, Ints, read_only

UM = 1000
"""Micrometres per mm."""


@dataclass(frozen=True, eq=False)
class Shape:
    """An outline standing on y = 0 with its leftmost point at x = 0.

    Attributes
    ----------
    points : (n, 2) int, micrometres
    hull : (m, 2) int, micrometres
        Convex hull, counter-clockwise.
    mean : float, micrometres
        Width of the trapezoid around it at half its height.
    turned_over
        Mirrored, x to -x, before the rotation.
    """

    points: Ints
    hull: Ints
    rotation_deg: int
    left: float
    right: float
    mean: float
    turned_over: bool = False

    @property
    def width(self) -> int:
        """Width of the box."""
        return int(self.points[:, 0].max())

    @property
    def height(self) -> int:
        """Height of the box."""
        return int(self.points[:, 1].max())

    @property
    def overhang(self) -> float:
        """What both legs together stand out from their middles: the loss at the ends of a chain of one."""
        return (abs(self.left) + abs(self.right)) * self.height / 2


def stand(outline: Floats, rotation_deg: int) -> Shape:
    """Turn an outline and set it on the strip's lower edge.

    Parameters
    ----------
    outline : (n, 2) float, mm
        Multiples of 0.001.
    """
    return _shape(rotate(micrometres(outline), rotation_deg), rotation_deg)


def turn_half(shape: Shape) -> Shape:
    """Turn a shape by 180 degrees: its legs change places, their slopes stay."""
    return _shape(-shape.points, (shape.rotation_deg + 180) % 360, turned_over=shape.turned_over)


def turn_over(shape: Shape) -> Shape:
    """Mirror a shape, x to -x: its legs change places and sides. What was turned is now turned the other way."""
    return _shape(shape.points * np.array([-1, 1]), -shape.rotation_deg % 360, turned_over=not shape.turned_over)


def micrometres(points: Floats) -> Ints:
    """Give lengths in mm as whole micrometres."""
    return np.rint(points * UM).astype(np.int64)


def rotate(points: Ints, rotation_deg: int) -> Ints:
    """Rotate counter-clockwise about the origin by a multiple of 90 degrees."""
    cos, sin = {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}[rotation_deg]
    return points @ np.array([[cos, sin], [-sin, cos]])


def _shape(points: Ints, rotation_deg: int, *, turned_over: bool = False) -> Shape:
    points = read_only(points - points.min(axis=0))
    hull = _hull(points)
    (left, start), (right, end) = leg(hull, -1), leg(hull, 1)
    return Shape(points, hull, rotation_deg, left, right, end - start, turned_over)


def _hull(points: Ints) -> Ints:
    ring = np.rint(shapely.get_coordinates(shapely.convex_hull(shapely.MultiPoint(points)))[:-1])
    x, y = ring.T
    turns_left = np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) > 0
    return read_only((ring if turns_left else ring[::-1]).astype(np.int64))


def leg(hull: Ints, side: int) -> tuple[float, float]:
    """Give slope dx/dy and x at half height of the closest line past the left (-1) or right (1) side."""
    edges = np.roll(hull, -1, axis=0) - hull
    keep = edges[:, 1] * side > 0
    slope = np.append(edges[keep, 0] / edges[keep, 1], 0.0)
    half = hull[:, 1].max() / 2
    reach = side * (hull[:, 0] - slope[:, None] * (hull[:, 1] - half))
    middle = reach.max(axis=1)
    best = int(np.argmin(middle))
    return float(slope[best]), float(side * middle[best])


def advance(one: Shape, other: Shape, gap: float) -> tuple[int, Floats]:
    """Set `other` to the right of `one` with a clear gap.

    Parameters
    ----------
    gap
        Micrometres.

    Returns
    -------
    step, normal
        Least shift in micrometres, rounded up, that leaves the gap beside a line along an edge of either or
        upright, and the normal (2,) of that line.
    """
    normals = np.vstack([_normals(one.hull, 1), -_normals(other.hull, -1), [[1.0, 0.0]]])
    apart = (one.hull @ normals.T).max(axis=0) - (other.hull @ normals.T).min(axis=0)
    step = (gap * np.hypot(*normals.T) + apart) / normals[:, 0]
    best = int(np.argmin(step))
    return round_away(float(step[best])), normals[best]


def _normals(hull: Ints, side: int) -> Floats:
    edges = np.roll(hull, -1, axis=0) - hull
    return np.column_stack([edges[:, 1], -edges[:, 0]])[edges[:, 1] * side > 0].astype(np.float64)


def round_away(length: float) -> int:
    """Round micrometres up, so that no gap falls short (by 1e-9 mm at most)."""
    return int(np.ceil(length - 1e-6))
