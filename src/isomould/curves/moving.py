"""Moving the ends of pieces by as little as drawings are inexact, so that nothing else of them changes visibly.

A line turns and a spline bends by its end; arcs stay arcs of their ellipse's shape and give way in their centre,
size and angles, by the least change that does it.
"""

from typing import Any

import numpy as np

from isomould.arrays import Floats
from isomould.curves.pieces import Ellipse, Line, Piece
from isomould.curves.space_curve import SpatialPiece, piece_in_space
from isomould.curves.spatial import Shape, anchors, piece_on
from isomould.curves.sweep import FULL

_MET = 1e-9
"""Ends this near to where they should be are there, mm."""

_ROUNDS = 8


def is_stiff(piece: Any) -> bool:
    """Tell whether others should give way: the radius of an arc is what a shop bends to."""
    return isinstance(piece, Ellipse) or (isinstance(piece, SpatialPiece) and isinstance(piece.plan, Ellipse))


def moved(piece: Any, start: Floats, end: Floats) -> Any:
    """Give the piece with its ends moved by two small vectors (2 or 3,), mm.

    Raises
    ------
    ValueError
        If no small change of an arc moves its ends so.
    """
    if not start.any() and not end.any():
        return piece
    if isinstance(piece, SpatialPiece):
        return piece_in_space(_moved_shape(_shape_of(piece), start, end))
    if isinstance(piece, Ellipse):
        return _moved_arc(piece, start, end)
    flat, numbers = anchors(piece)
    return piece_on(Shape(type(piece), flat, numbers), flat + _shares(len(flat), start, end))


def closed_turn(piece: Piece) -> Piece:
    """Give an arc that nearly meets itself as a full turn, in its own direction."""
    if not isinstance(piece, Ellipse):
        return piece
    turn = FULL if piece.end > piece.start else -FULL
    return Ellipse(piece.centre, piece.major, piece.minor, piece.start, piece.start + turn)


def _shares(count: int, start: Floats, end: Floats) -> Floats:
    """Give how far each control point moves: from cubics on two at either end, which keeps both tangents."""
    if count > 3:
        weight = np.zeros(count)
        weight[-2:] = 1.0
        opposite = weight[::-1]
    else:
        weight = np.linspace(0.0, 1.0, count)
        opposite = 1.0 - weight
    return np.outer(opposite, start) + np.outer(weight, end)


def _moved_arc(arc: Ellipse, start: Floats, end: Floats) -> Ellipse:
    """Change centre, size and angles by the least that moves the ends: Newton's method with least squares."""
    frame = np.array([arc.major, arc.minor])
    size = float(np.sqrt(np.mean(frame**2) * 2))
    targets = np.concatenate([arc.point(np.zeros(1))[0] + start, arc.point(np.ones(1))[0] + end])
    # centre x and y, then scale and both angles as the lengths that they move a point by
    values: Floats = np.array([*arc.centre, size, arc.start * size, arc.end * size])
    for _ in range(_ROUNDS):
        ends, change = _ends_of_arc(values, frame, size)
        missing = targets - ends
        if np.abs(missing).max() < _MET:
            break
        values = values + np.asarray(np.linalg.lstsq(change, missing, rcond=None)[0], np.float64)
    scale, angles = values[2] / size, values[3:] / size
    result = Ellipse(
        (float(values[0]), float(values[1])),
        (float(scale * frame[0, 0]), float(scale * frame[0, 1])),
        (float(scale * frame[1, 0]), float(scale * frame[1, 1])),
        float(angles[0]),
        float(angles[1]),
    )
    _refuse_far(arc, result, float(np.abs([start, end]).max()))
    return result


def _ends_of_arc(values: Floats, frame: Floats, size: float) -> tuple[Floats, Floats]:
    """Give both ends (4,) of an arc and how they change (4, 5) with its centre, scale and angles."""
    scale = values[2] / size
    change = np.zeros((4, 5))
    ends = np.zeros(4)
    for k, angle in enumerate(values[3:] / size):
        out = np.array([np.cos(angle), np.sin(angle)]) @ frame
        along = np.array([-np.sin(angle), np.cos(angle)]) @ frame
        rows = slice(2 * k, 2 * k + 2)
        ends[rows] = values[:2] + scale * out
        change[rows, :2] = np.eye(2)
        change[rows, 2] = out / size
        change[rows, 3 + k] = scale * along / size
    return ends, change


def _refuse_far(before: Ellipse, after: Ellipse, step: float) -> None:
    t = np.linspace(0, 1, 17)
    away = float(np.linalg.norm(after.point(t) - before.point(t), axis=1).max())
    if not away <= 4 * step:
        message = f"closing the gap would move an arc by {away:.3g} mm"
        raise ValueError(message)


def _shape_of(piece: SpatialPiece) -> Shape:
    """Give the shape in space whose images a piece consists of."""
    (plan, numbers), (side, _) = anchors(piece.plan), anchors(piece.side)
    return Shape(type(piece.plan), np.column_stack([plan, side[:, 1]]), numbers)


def _moved_shape(shape: Shape, start: Floats, end: Floats) -> Shape:
    """Move the ends of a shape in space; an arc gives way by the least affine change."""
    if shape.kind is Line or shape.kind is not Ellipse:
        return shape._replace(anchors=shape.anchors + _shares(len(shape.anchors), start, end))
    angles = np.array(shape.numbers)
    # an end is centre + cos·(tip − centre) + sin·(tip − centre)
    ends = np.column_stack([1 - np.cos(angles) - np.sin(angles), np.cos(angles), np.sin(angles)])
    step = np.linalg.lstsq(ends, np.array([start, end]), rcond=None)[0]
    if not np.abs(ends @ step - [start, end]).max() < _MET:
        message = "no small change of an arc closes the gap"
        raise ValueError(message)
    return shape._replace(anchors=shape.anchors + step)
