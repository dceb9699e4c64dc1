"""What is drawn twice: entities that lie on others, as copies and imports leave them behind."""

from typing import Any

import numpy as np
from scipy.spatial import KDTree

from isomould.arrays import Bools, Floats
from isomould.curves.chains import P, Stroke

_SAMPLES = 33
"""Places of a piece between which the nearest one is searched."""

_NEWTON = 4

_ALIKE = 2e-3
"""Boxes of samples of one shape differ by less than this share of its size, however it is divided."""

_MOST_COMPARED = 60
"""Strokes among which overlaps are looked for, to word a refusal."""


def without_doubles(strokes: list[Stroke[P]], tolerance: float) -> tuple[list[Stroke[P]], list[tuple[str, str]]]:
    """Leave out strokes that lie on another one as a whole, in whatever direction, within a tolerance in mm.

    Returns
    -------
    strokes, pairs
        Those that are left, and for each one left out the name of the one kept and its own.
    """
    boxes = np.array([_box(stroke) for stroke in strokes])
    if len(strokes) < 2:
        return strokes, []
    dim = boxes.shape[1] // 2
    sizes = np.linalg.norm(boxes[:, dim:] - boxes[:, :dim], axis=1)
    near = KDTree(boxes).query_ball_point(boxes, 2 * tolerance + _ALIKE * sizes)
    gone = dict[int, int]()
    for k, others in enumerate(near):
        for other in sorted(int(n) for n in others):
            if other < k and other not in gone and _are_one(strokes[other], strokes[k], tolerance):
                gone[k] = other
                break
    kept = [stroke for k, stroke in enumerate(strokes) if k not in gone]
    return kept, [(strokes[kept_one].name, strokes[k].name) for k, kept_one in gone.items()]


def overlapping(strokes: list[Stroke[Any]], tolerance: float) -> list[tuple[str, str]]:
    """Give pairs of names of strokes that lie on each other over a length, of the first few dozen strokes."""
    compared = strokes[:_MOST_COMPARED]
    found = list[tuple[str, str]]()
    for k, stroke in enumerate(compared):
        inner = _inner_points(stroke)
        for other in compared[k + 1 :]:
            here = _lie_on(inner, other, tolerance)
            there = _lie_on(_inner_points(other), stroke, tolerance)
            # a crossing is one place; lying on each other is two places side by side
            if np.any(here[1:] & here[:-1]) or np.any(there[1:] & there[:-1]):
                found.append((stroke.name, other.name))
    return found


def _are_one(a: Stroke[Any], b: Stroke[Any], tolerance: float) -> bool:
    return bool(_lie_on(_inner_points(a), b, tolerance).all() and _lie_on(_inner_points(b), a, tolerance).all())


def _box(stroke: Stroke[Any]) -> Floats:
    points = np.concatenate([piece.point(np.linspace(0, 1, _SAMPLES)) for piece in stroke.pieces])
    return np.concatenate([points.min(axis=0), points.max(axis=0)])


def _inner_points(stroke: Stroke[Any]) -> Floats:
    """Give places inside a stroke, several of each piece."""
    return np.concatenate([piece.point((np.arange(7) + 0.5) / 7) for piece in stroke.pieces])


def _lie_on(points: Floats, stroke: Stroke[Any], tolerance: float) -> Bools:
    """Tell which points (n, dim) lie on a stroke."""
    away = np.full(len(points), np.inf)
    for piece in stroke.pieces:
        away = np.minimum(away, _distances(points, piece))
    return away <= tolerance


def _distances(points: Floats, piece: Any) -> Floats:
    """Give the distances (n,) of points from a piece: from the nearest sample on by Newton's method."""
    t = np.linspace(0, 1, _SAMPLES)
    samples = piece.point(t)
    nearest = np.linalg.norm(points[:, None] - samples[None], axis=2).argmin(axis=1)
    at = t[nearest]
    for _ in range(_NEWTON):
        offset, along = points - piece.point(at), piece.derivative(at)
        speed = np.maximum(np.sum(along**2, axis=1), np.finfo(float).tiny)
        at = np.clip(at + np.sum(offset * along, axis=1) / speed, 0.0, 1.0)
    return np.minimum(
        np.linalg.norm(points - piece.point(at), axis=1), np.linalg.norm(points - samples[nearest], axis=1)
    )
