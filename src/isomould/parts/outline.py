"""Outlines of flat parts, rounded once: the rounded outline is the part (fabrication)."""

import numpy as np

from isomould.arrays import Floats, read_only, round_um


def round_outline(points: Floats) -> Floats:
    """Round an outline (n, 2) to 0.001 mm and drop vertices that coincide with the one before."""
    rounded = round_um(points) + 0.0
    distinct = np.any(rounded != np.roll(rounded, 1, axis=0), axis=1)
    return read_only(rounded[distinct])


def area(outline: Floats) -> float:
    """Signed area mm² of an outline (n, 2), positive counter-clockwise.

    >>> area(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]))
    2.0
    """
    x, y = outline.T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def sides(outline: Floats) -> Floats:
    """Lengths (n,) mm of the sides, the first from vertex 0 to vertex 1."""
    return np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1)
