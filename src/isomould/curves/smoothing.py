"""Making joints smooth that kink by no more than drawings are inexact.

A line and an arc that touched in CAD kink by a millionth once their numbers are printed with six digits. Such a
chain is changed a little, every part of it by a small affine map: lines stay straight, arcs keep their ellipse's
shape, splines their inflections. A kink was not meant if that makes the curve smooth and moves nothing by more
than `join`.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, eye_array
from scipy.sparse.linalg import spsolve

from isomould.arrays import Floats, Ints
from isomould.curves.bezier import Bezier
from isomould.curves.joining import place_text
from isomould.curves.pieces import Ellipse, Line, Piece
from isomould.curves.spatial import ROUNDING
from isomould.curves.turning import KINK, turn
from isomould.errors import Note

SHALLOW = 1e-3
"""A kink of more than this is drawn on purpose, rad."""

_UNKNOWNS = 6
"""Of a part: two to move it, two to turn and scale it, and two by its kind (see `_changed`)."""

_STEP = 1e-4
"""Of differences, as a share of the part's size: their error is its square."""

_ROUNDS = 8
_TOUCHING = 1e-11
"""Directions this near are one, rad: well below `KINK`, by which others judge."""
_MET = 1e-8
"""Ends this near are one, mm."""


def smoothed(
    pieces: tuple[Piece, ...], closed: bool, join: float, field: str
) -> tuple[tuple[Piece, ...], tuple[Note, ...]]:
    """Make the shallow kinks of a chain smooth, if nothing moves by more than `join`, mm.

    A polyline is left as it was drawn: its vertices are meant.
    """
    kinks = _kinks(pieces, closed)
    shallow = np.flatnonzero((np.abs(kinks) > KINK) & (np.abs(kinks) <= SHALLOW))
    if not shallow.size or all(isinstance(piece, Line) for piece in pieces):
        return pieces, ()
    what = _described(pieces, kinks, shallow)
    smooth = None if _bends(pieces, kinks) else _relaxed(_bodies(pieces, kinks, closed), closed, join)
    away = np.inf if smooth is None else _farthest(pieces, smooth)
    if smooth is None or away > join + ROUNDING:
        text = f"{what} not made smooth: that would move the curve by more than {join:g} mm (join)"
        return pieces, (Note("W-DRAWN-KINK", field, text),)
    return smooth, (Note("W-DRAWN-SMOOTHED", field, f"{what} made smooth, nothing moved by more than {away:.2g} mm"),)


def _bends(pieces: tuple[Piece, ...], kinks: Floats) -> bool:
    """Tell whether lines in a row turn by more than a kink that was not meant: a polyline of a bent curve."""
    inner = [isinstance(one, Line) and isinstance(other, Line) for one, other in pairwise(pieces)]
    turned = np.cumsum(np.where(inner, kinks[1:], 0.0))
    outside = ~np.array(inner)
    # measured from where the row of lines begins
    before = np.maximum.accumulate(np.where(outside, np.arange(len(inner)), -1))
    begun = np.where(before < 0, 0.0, turned[before])
    return bool(np.any(np.abs(turned - begun) > SHALLOW))


def _described(pieces: tuple[Piece, ...], kinks: Floats, shallow: Ints) -> str:
    """Give number, largest angle and place of kinks."""
    steepest = int(shallow[np.argmax(np.round(np.abs(kinks[shallow]), 12))])
    # a micrometre is enough to find a joint
    place = place_text(np.round(pieces[steepest].point(np.zeros(1))[0], 3) + 0.0)
    angle = f"{np.degrees(abs(kinks[steepest])):.2g}°"
    if shallow.size == 1:
        return f"1 joint with a kink of {angle} at ({place})"
    return f"{shallow.size} joints with kinks, the largest {angle} at ({place}),"


class _Body(NamedTuple):
    """Consecutive pieces that change together, about a place, by unknowns of which each is a length in mm."""

    pieces: tuple[Piece, ...]
    centre: Floats
    size: float


def _kinks(pieces: Sequence[Piece], closed: bool) -> Floats:
    """Give the angle (k,) between each piece and the one before it, rad; at the start of an open chain 0."""
    leaving = np.array([piece.derivative(np.zeros(1))[0] for piece in pieces])
    arriving = np.array([piece.derivative(np.ones(1))[0] for piece in pieces])
    angles = turn(np.roll(arriving, 1, axis=0), leaving)
    angles[0] = angles[0] if closed else 0.0
    return angles


def _bodies(pieces: tuple[Piece, ...], kinks: Floats, closed: bool) -> list[_Body]:
    """Keep the segments of a spline together, so that its curvature goes on as it did."""
    runs = [[pieces[0]]]
    for before, piece, kink in zip(pieces[:-1], pieces[1:], kinks[1:].tolist(), strict=True):
        together = isinstance(before, Bezier) and isinstance(piece, Bezier) and abs(kink) <= KINK
        if together:
            runs[-1].append(piece)
        else:
            runs.append([piece])
    if closed and len(runs) == 1:
        # no affine map changes the kink between a curve's own ends: halves do
        half = len(pieces) // 2
        runs = [run for run in (runs[0][:half], runs[0][half:]) if run]
    return [_body(tuple(run)) for run in runs]


def _body(pieces: tuple[Piece, ...]) -> _Body:
    places = np.concatenate([piece.point(np.linspace(0, 1, 5)) for piece in pieces])
    low, high = places.min(axis=0), places.max(axis=0)
    return _Body(pieces, (low + high) / 2, float(np.linalg.norm(high - low)) / 2)


def _changed(body: _Body, piece: Piece, unknowns: Floats) -> Piece:
    """Change a piece of a body: move, turn and scale it; stretch what is no arc; let arcs begin and end elsewhere."""
    shares = unknowns / body.size
    scale, angle = shares[2:4]
    linear = np.array([[1 + scale, -angle], [angle, 1 + scale]])
    if isinstance(piece, Ellipse):
        radius = float(np.sqrt(np.hypot(*piece.major) * np.hypot(*piece.minor)))
        slides = unknowns[4:] / radius
        piece = replace(piece, start=piece.start + float(slides[0]), end=piece.end + float(slides[1]))
    else:
        stretch, shear = shares[4:]
        linear += np.array([[stretch, shear], [shear, -stretch]])
    return piece.mapped(linear, body.centre + unknowns[:2] - linear @ body.centre)


class _Tips(NamedTuple):
    """Where a body starts and ends, and its directions there as vectors."""

    start: Floats
    end: Floats
    leaving: Floats
    arriving: Floats


def _tips(body: _Body, unknowns: Floats) -> _Tips:
    first = _changed(body, body.pieces[0], unknowns)
    last = _changed(body, body.pieces[-1], unknowns)
    zero, one = np.zeros(1), np.ones(1)
    return _Tips(first.point(zero)[0], last.point(one)[0], first.derivative(zero)[0], last.derivative(one)[0])


def _rates(body: _Body, unknowns: Floats) -> tuple[Floats, Floats]:
    """Give how place (2) and direction (rad) change with each unknown, (3, 6) at the start and at the end."""
    step = _STEP * body.size
    starts, ends = np.empty((3, _UNKNOWNS)), np.empty((3, _UNKNOWNS))
    for k, nudge in enumerate(step * np.eye(_UNKNOWNS)):
        low, high = _tips(body, unknowns - nudge), _tips(body, unknowns + nudge)
        starts[:, k] = np.append(high.start - low.start, _angle(low.leaving, high.leaving)) / (2 * step)
        ends[:, k] = np.append(high.end - low.end, _angle(low.arriving, high.arriving)) / (2 * step)
    return starts, ends


def _angle(a: Floats, b: Floats) -> float:
    return float(turn(a[None], b[None])[0])


class _Joint(NamedTuple):
    """Two bodies in a row, as numbers, and the length that turns their angle into mm; 0 where the kink was meant."""

    before: int
    after: int
    reach: float


def _relaxed(bodies: list[_Body], closed: bool, join: float) -> tuple[Piece, ...] | None:
    """Give the pieces after the least change that makes the joints smooth; None if a small one does not.

    Newton's method; of all steps that close the joints to first order the shortest one is taken.
    """
    unknowns = np.zeros((len(bodies), _UNKNOWNS))
    joints = _joints(bodies, closed)
    reaches = np.array([joint.reach for joint in joints])
    for _ in range(_ROUNDS):
        missing = _missing(bodies, joints, unknowns)
        gap, kink = float(np.abs(missing[:, :2]).max()), float(np.abs(missing[reaches > 0, 2]).max())
        if gap <= _MET and kink <= _TOUCHING:
            return tuple(_changed(body, piece, unknowns[k]) for k, body in enumerate(bodies) for piece in body.pieces)
        unknowns = unknowns - _shortest_step(bodies, joints, unknowns, missing)
        if not np.abs(unknowns).max() <= 10 * join:
            return None
    return None


def _joints(bodies: list[_Body], closed: bool) -> list[_Joint]:
    count = len(bodies)
    pairs = [(k, (k + 1) % count) for k in range(count - (not closed))]
    still = np.zeros(_UNKNOWNS)
    joints = list[_Joint]()
    for before, after in pairs:
        kink = _angle(_tips(bodies[before], still).arriving, _tips(bodies[after], still).leaving)
        reach = min(bodies[before].size, bodies[after].size)
        joints.append(_Joint(before, after, reach if abs(kink) <= SHALLOW else 0.0))
    return joints


def _missing(bodies: list[_Body], joints: list[_Joint], unknowns: Floats) -> Floats:
    """Give the gap (2, mm) and the kink (rad) that are left at each joint, (j, 3)."""
    tips = [_tips(body, own) for body, own in zip(bodies, unknowns, strict=True)]
    rows = [
        np.append(tips[j.after].start - tips[j.before].end, _angle(tips[j.before].arriving, tips[j.after].leaving))
        for j in joints
    ]
    return np.array(rows)


def _shortest_step(bodies: list[_Body], joints: list[_Joint], unknowns: Floats, missing: Floats) -> Floats:
    """Solve J·step = missing with the shortest step, Jᵀ(JJᵀ)⁻¹·missing."""
    rates = [_rates(body, own) for body, own in zip(bodies, unknowns, strict=True)]
    scales = np.array([[1.0, 1.0, joint.reach] for joint in joints])
    blocks = [(k, j.after, scales[k][:, None] * rates[j.after][0]) for k, j in enumerate(joints)]
    blocks += [(k, j.before, -scales[k][:, None] * rates[j.before][1]) for k, j in enumerate(joints)]
    rows = np.concatenate([np.repeat(3 * k + np.arange(3), _UNKNOWNS) for k, _, _ in blocks])
    columns = np.concatenate([np.tile(_UNKNOWNS * b + np.arange(_UNKNOWNS), 3) for _, b, _ in blocks])
    values = np.concatenate([block.ravel() for _, _, block in blocks])
    jacobian = coo_array((values, (rows, columns)), shape=(missing.size, unknowns.size)).tocsc()
    square = jacobian @ jacobian.T
    # rows of meant kinks are empty, others may depend on each other: a trace of damping costs a round at most
    damped = square + _DAMPING * square.diagonal().max() * eye_array(missing.size)
    pull = spsolve(damped.tocsc(), (scales * missing).ravel())
    return np.asarray(jacobian.T @ pull, np.float64).reshape(unknowns.shape)


_DAMPING = 1e-12


def _farthest(before: tuple[Piece, ...], after: tuple[Piece, ...]) -> float:
    """Give how far the farthest place has moved, mm."""
    t = np.linspace(0, 1, 17)
    steps = [old.point(t) - new.point(t) for old, new in zip(before, after, strict=True)]
    return float(max(np.linalg.norm(step, axis=1).max() for step in steps))
