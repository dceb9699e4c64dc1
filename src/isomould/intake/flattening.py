"""Curves of parts as polygons that hold the part: no part is ever cut smaller than it was drawn.

All curves run with the part at their left: an outline counter-clockwise, a hole clockwise. Where a curve turns left it
bulges out of the part and tangents take its place, where it turns right chords do.
"""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TypeGuard

import numpy as np

from isomould.arrays import Floats, round_um
from isomould.curves.pieces import Ellipse, Line, Piece

OUTWARD = 0.05
"""How far a polygon may lie off its curve, mm."""

_STEP = 0.001
"""What points beside a curve keep off it, so that rounding brings none of them to the wrong side, mm."""

_ROOM = OUTWARD - 2 * _STEP
"""What is left for tangents and chords."""

_SAMPLES = np.linspace(0.0, 1.0, 9)
"""Where the distance between a curve and its polygon is measured, along every chord."""

_MOST_CHORDS = 2**12
"""Of a span; none of a part needs as many."""


def polygon_around(pieces: Sequence[Piece]) -> Floats:
    """Give the polygon (n, 2) mm, in multiples of 0.001, that takes the place of a closed chain of curves."""
    points = np.concatenate([flat_points(piece) for piece in pieces])
    return without_repeats(round_um(points))


def without_repeats(points: Floats) -> Floats:
    """Leave out points of a ring that repeat the one before."""
    return points[(points != np.roll(points, 1, axis=0)).any(axis=1)]


def flat_points(piece: Piece) -> Floats:
    """Give the points (n, 2) mm of the polygon along a piece, without the end of the piece."""
    if isinstance(piece, Line):
        return np.array([piece.start])
    if is_round(piece):
        return _arc_points(piece)
    stations = [0.0, *piece.splits().tolist(), 1.0]
    return np.vstack([_span_points(piece, *span) for span in pairwise(stations)])


def is_round(piece: Piece) -> TypeGuard[Ellipse]:
    """Tell whether a piece is an arc of a circle, within 1e-9 of its radius."""
    if not isinstance(piece, Ellipse):
        return False
    one, other = math.hypot(*piece.major), math.hypot(*piece.minor)
    leaning = abs(float(np.dot(piece.major, piece.minor)))
    return abs(one - other) <= 1e-9 * one and leaning <= 1e-9 * one * other


def bulge_angle(arc: Ellipse) -> float:
    """Give the angle of an arc, rad, positive to the left."""
    side = arc.major[0] * arc.minor[1] - arc.major[1] * arc.minor[0]
    return math.copysign(1.0, side) * (arc.end - arc.start)


def _arc_points(arc: Ellipse) -> Floats:
    radius, turn = float(np.hypot(*arc.major)), bulge_angle(arc)
    if turn > 0:
        # Corners of tangents that touch in the middle between them.
        step = 2 * math.acos(radius / (radius + OUTWARD - _STEP))
        count = max(math.ceil(abs(turn) / step), 3)
        shares, reach = (np.arange(count) + 0.5) / count, radius / math.cos(turn / count / 2) + _STEP
    else:
        step = 2 * math.acos(max(1 - (OUTWARD - _STEP) / radius, 0.0))
        count = max(math.ceil(abs(turn) / step), 1)
        shares, reach = np.arange(1, count) / count, radius - _STEP
    centre = np.array(arc.centre)
    return np.vstack([arc.point(np.zeros(1)), centre + (arc.point(shares) - centre) * (reach / radius)])


def _span_points(piece: Piece, start: float, end: float) -> Floats:
    """Give the points along a span that turns one way, with as few chords as keep the polygon near the curve."""
    corners = _tangent_corners if _turns_left(piece, start, end) else _chord_corners
    chords, off, points = 1, math.inf, np.empty((0, 2))
    while off > _ROOM and chords <= _MOST_CHORDS:
        points, off = corners(piece, np.linspace(start, end, chords + 1))
        chords *= 2
    return np.vstack([piece.point(np.array([start])), points])


def _turns_left(piece: Piece, start: float, end: float) -> bool:
    along = _directions(piece, np.array([start, (start + end) / 2, end]))
    return float(_cross(along[:-1], along[1:]).sum()) > 0


def _tangent_corners(piece: Piece, t: Floats) -> tuple[Floats, float]:
    """Give where tangents meet that touch at t (n,): (n - 1, 2), and how far these corners are off the curve."""
    along = _directions(piece, t)
    touching = piece.point(t) + _STEP * _right(along)
    onward = np.diff(touching, axis=0)
    turn = _cross(along[:-1], along[1:])
    straight = np.abs(turn) < 1e-9
    reach = _cross(onward, along[1:]) / np.where(straight, 1.0, turn)
    met = touching[:-1] + reach[:, None] * along[:-1]
    corners = np.where(straight[:, None], touching[:-1] + onward / 2, met)
    if (along[:-1] * along[1:]).sum(axis=1).min() <= 0:
        return corners, math.inf
    apart = np.linalg.norm(_samples(piece, t) - corners[:, None], axis=2)
    return corners, float(apart.min(axis=1).max())


def _chord_corners(piece: Piece, t: Floats) -> tuple[Floats, float]:
    """Give the points between the first and the last of t (n,): (n - 2, 2), and how far chords are off the curve."""
    ends = piece.point(t)
    chords = np.diff(ends, axis=0)
    away = _samples(piece, t) - ends[:-1, None]
    length = np.maximum(np.linalg.norm(chords, axis=1), 1e-12)
    off = np.abs(_cross(chords[:, None], away)) / length[:, None]
    return ends[1:-1] + _STEP * _right(_directions(piece, t[1:-1])), float(off.max())


def _samples(piece: Piece, t: Floats) -> Floats:
    """Give points along every chord: (n - 1, samples, 2)."""
    between = t[:-1, None] + np.diff(t)[:, None] * _SAMPLES
    return piece.point(between.ravel()).reshape(*between.shape, 2)


def _directions(piece: Piece, t: Floats) -> Floats:
    """Give unit tangents; where a curve stands still, at an end with doubled control points, those close by."""
    along = piece.derivative(t)
    speed = np.hypot(*along.T)
    still = speed <= 1e-9 * max(float(speed.max(initial=0.0)), 1e-300)
    if still.any():
        along[still] = piece.derivative(np.where(t[still] < 0.5, t[still] + 1e-4, t[still] - 1e-4))
        speed = np.hypot(*along.T)
    return along / np.maximum(speed, 1e-300)[:, None]


def _right(along: Floats) -> Floats:
    return along[:, ::-1] * np.array([1.0, -1.0])


def _cross(one: Floats, other: Floats) -> Floats:
    return one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]
