"""Placed outlines compared: same loop whatever its first vertex, quarter turns, distances."""

import numpy as np

from isomould.verify.rules import Floats

_TURNS = {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}


def signed_area(points: Floats) -> float:
    """Give the area of a polygon (n, 2), positive if counter-clockwise."""
    x, y = (points - points[0]).T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def loop_distance(a: Floats, b: Floats) -> float:
    """Give the largest vertex distance of two loops from their best first vertices; inf if they differ."""
    if len(a) != len(b):
        return np.inf
    a, b = (points if signed_area(points) > 0 else points[::-1] for points in (a, b))
    return min(float(np.linalg.norm(np.roll(a, k, axis=0) - b, axis=1).max()) for k in range(len(a)))


def quarter_turned(points: Floats, rotation_deg: float, *, turned_over: bool) -> Floats:
    """Mirror (x to −x) if turned over, then turn by a multiple of 90°; KeyError for other angles."""
    c, s = _TURNS[int(rotation_deg) if rotation_deg == int(rotation_deg) else -1]
    flipped = points * [-1, 1] if turned_over else points
    return flipped @ np.array([[c, s], [-s, c]])


def to_origin(points: Floats) -> Floats:
    """Move the lower left corner of the bounding box to the origin."""
    return points - points.min(axis=0)
