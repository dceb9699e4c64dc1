"""Rings around holes, for bounds: whatever may lie in a hole lies in its ring."""

import math

import numpy as np
import shapely

from isomould.arrays import Floats, read_only
from isomould.documents.drawing import Circle, Polyline, bulges, chords, segment_ends

_PIECES = 128
"""Chords of an arc."""

_ROUNDING = 0.001
"""Holes are rounded to this where they are cut, mm."""


def ring_around(hole: Polyline | Circle) -> Floats:
    """Give a ring (n, 2) mm that a hole lies inside of, a few micrometres larger than the hole.

    Examples
    --------
    >>> ring = shapely.Polygon(ring_around(Circle("DRILL", (0.0, 0.0), 10.0)))
    >>> bool(100 * math.pi < ring.area < 100.2 * math.pi)
    True
    """
    if isinstance(hole, Circle):
        angles = 2 * math.pi * np.arange(_PIECES) / _PIECES
        reach = (hole.radius + _ROUNDING) / math.cos(math.pi / _PIECES)
        return read_only(hole.centre + reach * np.column_stack([np.cos(angles), np.sin(angles)]))
    inside = shapely.Polygon(chords(hole, _PIECES))
    grown = inside.buffer(_sagitta(hole) + _ROUNDING, join_style="mitre")
    return read_only(shapely.get_coordinates(grown.exterior)[:-1])


def _sagitta(hole: Polyline) -> float:
    """Give how far an arc stands off its chords at most, mm."""
    start, end = segment_ends(hole)
    half_angle = 2 * np.arctan(np.abs(bulges(hole)))
    sine = np.sin(half_angle)
    half_chord = np.hypot(*(end - start).T) / 2
    radius = np.divide(half_chord, sine, out=np.zeros_like(sine), where=sine > 0)
    return float((radius * (1 - np.cos(half_angle / _PIECES))).max())
