"""How a curve turns: monotone spans, arcs between inflections, and where it has a given direction."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import elementwise

from isomould.arrays import Floats, Ints, read_only
from isomould.curves.curve import PlanarCurve
from isomould.curves.pieces import Piece

KINK = 1e-9
"""Directions nearer than this are one direction, rad (failure mode B1)."""


@dataclass(frozen=True, eq=False)
class Spans:
    """Stretches that turn one way by less than π, in order along the curve.

    Within a run of smoothly joined spans theta1 of one is theta0 of the next, and a closed curve without
    kinks ends at theta0[0] plus a multiple of 2π, exactly. Across a kink theta goes on by the kink's angle.
    """

    piece: Ints
    """(k,) piece index."""
    t0: Floats
    t1: Floats
    theta0: Floats
    """(k,) tangent direction at t0, rad, unwrapped along the curve."""
    theta1: Floats
    sign: Ints
    """(k,) +1 turning left, −1 right, 0 straight (turning by no more than `KINK`)."""
    closed: bool
    kink_span: Ints
    """(m,) span at whose start the tangent jumps (0 also for the joint of a closed curve)."""
    kink_angle: Floats
    """(m,) jump in (−π, π], rad."""
    kink_point: Floats
    """(m, 2) place of the jump, mm."""


@dataclass(frozen=True, eq=False)
class Arcs:
    """Maximal runs of spans of equal sign, straight runs among them.

    On a closed curve the run across the start comes last and has first > last; a curve of one sign is one
    arc from span 0 to span k − 1.
    """

    first: Ints
    last: Ints
    sign: Ints
    turning: Floats
    """(a,) signed turning without kinks, rad; the directions go from theta0[first] on by this much."""


def spans(curve: PlanarCurve) -> Spans:
    """Divide a curve into monotone spans (geometry §1, §2)."""
    fences = [_fences(piece) for piece in curve.pieces]
    piece = np.repeat(np.arange(len(fences)), [f.size - 1 for f in fences])
    t0, t1 = np.concatenate([f[:-1] for f in fences]), np.concatenate([f[1:] for f in fences])
    starts, ends = curve.derivative(piece, t0), curve.derivative(piece, t1)
    turning = turn(starts, ends)
    jump = turn(np.roll(ends, 1, axis=0), starts)
    jump[0] = jump[0] if curve.closed else 0.0
    sign = np.where(np.abs(turning) > KINK, np.sign(turning), 0).astype(np.int64)
    theta = _snapped(*_directions(starts, turning, jump), jump, sign, curve.closed)
    kinks = np.flatnonzero(np.abs(jump) > KINK)
    points = curve.point(piece[kinks], t0[kinks])
    return _frozen(Spans(piece, t0, t1, *theta, sign, curve.closed, kinks, jump[kinks], points))


def arcs(spans: Spans) -> Arcs:
    """Merge spans into maximal runs of equal sign (geometry §2)."""
    starts = np.flatnonzero(np.diff(spans.sign, prepend=np.nan) != 0)
    ends = np.append(starts[1:], spans.sign.size) - 1
    turning = np.add.reduceat(spans.theta1 - spans.theta0, starts)
    sign = spans.sign[starts]
    if spans.closed and starts.size > 1 and sign[0] == sign[-1]:
        turning[-1] += turning[0]
        starts, ends, sign, turning = starts[1:], np.append(ends[1:-1], ends[0]), sign[1:], turning[1:]
    return Arcs(*(read_only(np.ascontiguousarray(a)) for a in (starts, ends, sign, turning)))  # type: ignore[arg-type]


def tangency(curve: PlanarCurve, spans: Spans, span_index: Ints, theta: Floats) -> Floats:
    """Find where the curve has given directions.

    Parameters
    ----------
    span_index : (n,) int
        The span to look in, one per direction.
    theta : (n,) float, rad
        In the unwrapped measure of `spans`.

    Returns
    -------
    (n,) float
        Parameters t in [t0, t1] of the span's piece, where |cross(T, u)| <= 1e-12·|T| inside the span; at
        its ends up to `KINK`, by which directions are clamped and joints made equal.

    Raises
    ------
    ValueError
        If a direction lies outside its span by more than 1e-9 rad. Within it, and on a straight span, the
        answer is one of those that differ by rounding only in direction: on a line it is t0.
    """
    target = _clamped(spans, span_index, theta)
    at0, at1 = target == spans.theta0[span_index], target == spans.theta1[span_index]
    t = np.where(at1 & ~at0, spans.t1[span_index], spans.t0[span_index])
    inner = np.flatnonzero(~at0 & ~at1)
    t[inner] = _solve(curve, spans, span_index[inner], target[inner])
    return t


def turn(a: Floats, b: Floats) -> Floats:
    """Give the signed angle from vectors a to b, both (n, 2), in (−π, π], as (n,) rad."""
    return np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], np.sum(a * b, axis=1))


def _fences(piece: Piece) -> Floats:
    """Give the ends of a piece and its splits, without those beside which it hardly turns."""
    t = np.concatenate([[0.0], piece.splits(), [1.0]])
    tangents = piece.derivative(t)
    turns = np.abs(turn(tangents[:-1], tangents[1:])) > KINK
    inner = turns[:-1].copy()
    inner[-1:] &= turns[-1:]
    return t[np.concatenate([[True], inner, [True]])]


def _directions(starts: Floats, turning: Floats, jump: Floats) -> tuple[Floats, Floats]:
    """Unwrap the directions at both ends of each span, anchored to atan2: rounding does not add up."""
    raw = np.arctan2(starts[:, 1], starts[:, 0])
    steps = turning[:-1] + jump[1:]
    walked = raw[0] + np.concatenate([[0.0], np.cumsum(steps)])
    theta0 = raw + 2 * np.pi * np.round((walked - raw) / (2 * np.pi))
    return theta0, theta0 + turning


def _snapped(theta0: Floats, theta1: Floats, jump: Floats, sign: Ints, closed: bool) -> tuple[Floats, Floats]:
    """Make directions at smooth joints equal: a straight span's own, else the following span's start."""
    joint = np.flatnonzero(np.abs(jump) <= KINK)
    joint = joint if closed else joint[joint > 0]
    wrap = np.where(joint == 0, 2 * np.pi * np.round((theta1[-1] - theta0[0]) / (2 * np.pi)), 0.0)
    before, after = sign[joint - 1] != 0, sign[joint] != 0
    lead, follow = joint[before], joint[~before & after]
    theta0, theta1 = theta0.copy(), theta1.copy()
    theta1[lead - 1] = theta0[lead] + wrap[before]
    theta0[follow] = theta1[follow - 1] - wrap[~before & after]
    return theta0, theta1


def _frozen(spans: Spans) -> Spans:
    for value in vars(spans).values():
        if isinstance(value, np.ndarray):
            read_only(value)
    return spans


def _clamped(spans: Spans, index: Ints, theta: Floats) -> Floats:
    low = np.minimum(spans.theta0[index], spans.theta1[index])
    high = np.maximum(spans.theta0[index], spans.theta1[index])
    target = np.clip(theta, low, high)
    beyond = np.abs(target - theta)
    if theta.size and not beyond.max() <= KINK:
        worst = int(beyond.argmax())
        message = f"direction {theta[worst]} is not in span {index[worst]}: {low[worst]} to {high[worst]}"
        raise ValueError(message)
    return target


def _solve(curve: PlanarCurve, spans: Spans, index: Ints, theta: Floats) -> Floats:
    """Bracket the places strictly inside spans, to the last bit of t."""
    piece, low, high = spans.piece[index], spans.t0[index], spans.t1[index]
    normal = np.column_stack([-np.sin(theta), np.cos(theta)])

    def miss(t: Floats, lane: Floats) -> Floats:
        lanes = lane.astype(np.int64)
        return np.sum(curve.derivative(piece[lanes], t) * normal[lanes], axis=1)

    every = np.arange(theta.size, dtype=float)
    found = elementwise.find_root(miss, (low, high), args=(every,))
    nearer = np.where(np.abs(miss(low, every)) <= np.abs(miss(high, every)), low, high)
    t = np.where(found.success, found.x, nearer)
    return _polished(curve, piece, normal, t)


def _polished(curve: PlanarCurve, piece: Ints, normal: Floats, t: Floats) -> Floats:
    """Take one Newton step where it helps."""
    miss = np.sum(curve.derivative(piece, t) * normal, axis=1)
    rate = np.sum(curve.second(piece, t) * normal, axis=1)
    stepped = np.clip(t - np.divide(miss, rate, out=np.zeros_like(t), where=rate != 0), 0.0, 1.0)
    better = np.abs(np.sum(curve.derivative(piece, stepped) * normal, axis=1)) < np.abs(miss)
    return np.where(better, stepped, t)
