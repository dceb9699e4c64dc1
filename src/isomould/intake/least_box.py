"""Parts that are drawn at an odd angle: how to turn them so that the box around them is the least."""

import math

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.ties import NOISE

_LEVEL = 1e-6
"""What counts as level or upright, rad."""

_STRAIGHT = 0.1
"""A side shorter than this share of the box's diagonal says nothing of how a part was meant to lie."""

_WORTHWHILE = 1e-3
"""A box that is smaller by less is no reason to turn a part: a disc has the same box at any angle."""


def odd_angle(outline: Floats) -> float:
    """Give the angle, rad, by which to turn an outline (n, 2) clear of an odd angle; 0 where it is not drawn at one.

    An outline with a long straight side that is level or upright lies as it was meant to. Any other is turned to its
    least box, with the longer side level.

    Examples
    --------
    >>> plate = np.array([[0.0, 0.0], [8.0, 6.0], [5.0, 10.0], [-3.0, 4.0]])
    >>> round(math.degrees(odd_angle(plate)), 2)
    -36.87
    """
    if _lies_level(outline):
        return 0.0
    hull = shapely.get_coordinates(shapely.convex_hull(shapely.Polygon(outline)))
    angles, length = _sides(hull)
    boxes = np.array([_box(hull, -angle) for angle in angles])
    # Equal boxes along several sides: the longest side decides, then the first.
    area = np.round(boxes.prod(axis=1) / boxes.prod(axis=1).min(), 9)
    best = int(np.lexsort((-np.round(length, 6), area))[0])
    upright = boxes[best, 0] < boxes[best, 1] - NOISE
    turn = -float(angles[best]) + (math.pi / 2 if upright else 0.0)
    drawn = float(np.ptp(hull, axis=0).prod())
    spared = 1 - float(boxes[best].prod()) / drawn
    return _least_turn(turn) if spared > _WORTHWHILE else 0.0


def _lies_level(outline: Floats) -> bool:
    """Tell whether a long straight side is level or upright."""
    angles, length = _sides(np.vstack([outline, outline[:1]]))
    aslant = np.abs(angles - np.round(angles / (np.pi / 2)) * (np.pi / 2))
    diagonal = float(np.hypot(*np.ptp(outline, axis=0)))
    return bool(((aslant <= _LEVEL) & (length >= _STRAIGHT * diagonal)).any())


def _sides(ring: Floats) -> tuple[Floats, Floats]:
    """Give angle and length of the sides of a closed ring."""
    sides = np.diff(ring, axis=0)
    return np.arctan2(sides[:, 1], sides[:, 0]), np.hypot(*sides.T)


def _box(points: Floats, angle: float) -> Floats:
    return np.ptp(points @ rotation(angle).T, axis=0)


def rotation(angle: float) -> Floats:
    """Give the matrix (2, 2) of a rotation, rad, counter-clockwise."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]])


def _least_turn(angle: float) -> float:
    """Give the same turn, or the one by half a turn more, that turns less."""
    return angle - math.pi * round(angle / math.pi)
