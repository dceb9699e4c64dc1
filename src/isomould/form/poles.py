"""Generatrices past the poles: cut into strips that keep off them, and strips chained to one polygon (geometry §5).

At a pole the normal of the generatrix is parallel to the axis of the rail, and tangent directions are whole
multiples of π.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from isomould.arrays import Bools, Floats, Ints
from isomould.curves.curve import PlanarCurve
from isomould.curves.turning import Spans, tangency
from isomould.form.polygon import CurvePolygon, Edges, Role
from isomould.form.tangents import join

_CLEAR = 1e-9
"""Distance (rad) from a limit below which a span is not cut there."""


@dataclass(frozen=True)
class Strips:
    """What is left of a generatrix between its poles, in order.

    A closed curve's first strip begins behind the last pole. `cut` says whether something was taken out before the
    first strip and behind the last.
    """

    spans: tuple[Spans, ...]
    closed: bool
    cut: tuple[bool, bool]

    @property
    def whole(self) -> bool:
        """Whether nothing was taken out."""
        return len(self.spans) == 1 and not any(self.cut)


def strips_between_poles(curve: PlanarCurve, turns: Spans, min_angle: float) -> Strips:
    """Take out of a walk what comes nearer than `min_angle` (rad) to a pole.

    Parameters
    ----------
    turns
        Spans in walking order. Those of a closed curve begin and end off the poles, where they join.
    """
    divided = _cut(curve, turns, _limits(turns, min_angle))
    if curve.closed:
        divided = _from_pole(divided, _near(divided, min_angle))
    near = _near(divided, min_angle)
    starts = np.flatnonzero(np.diff(near, prepend=not near[0]))
    runs = (np.arange(a, b) for a, b in pairwise([*starts, len(near)]))
    spans = tuple(_take(divided, run) for run in runs if not near[run[0]])
    return Strips(spans, curve.closed, (bool(near[0]), bool(near[-1])))


def half_of(strip: Spans) -> int:
    """Number of the half turn between two poles that a strip's directions lie in; 0 has its normals outside."""
    return int(np.floor((strip.theta0[0] + strip.theta1[0]) / 2 / np.pi))


def chain(strips: list[CurvePolygon]) -> CurvePolygon:
    """Join open polygons to one, with an edge of the role `gap` between each and the next."""
    if len(strips) == 1:
        return strips[0]
    runs = [strips[0].edges]
    for before, after in pairwise(strips):
        runs += [_gap(before, after), after.edges]
    return CurvePolygon(
        vertices=np.vstack([strip.vertices for strip in strips]),
        edges=join(runs),
        turning=np.concatenate([strip.turning for strip in strips]),
        closed=False,
        deviation=max(strip.deviation for strip in strips),
    )


def _gap(before: CurvePolygon, after: CurvePolygon) -> Edges:
    chord = after.vertices[0] - before.vertices[-1]
    near = (before.edges.direction[-1] + after.edges.direction[0]) / 2
    raw = np.arctan2(chord[1], chord[0])
    direction = raw + 2 * np.pi * np.rint((near - raw) / (2 * np.pi))
    contact = before.vertices[-1:].copy()
    return Edges(np.array([np.nan]), np.array([direction]), contact, np.zeros(1, np.int64), np.zeros(1), (Role.GAP,))


def _limits(turns: Spans, min_angle: float) -> Floats:
    """Directions at which strips may end, increasing."""
    every = np.concatenate([turns.theta0, turns.theta1]) / np.pi
    poles = np.pi * np.arange(np.floor(every.min()), np.ceil(every.max()) + 1)
    return np.sort(np.concatenate([poles - min_angle, poles + min_angle]))


def _near(turns: Spans, min_angle: float) -> Bools:
    """Whether spans (k,), none of them across a limit, lie nearer to a pole than allowed."""
    middle = (turns.theta0 + turns.theta1) / 2
    return np.abs(middle - np.pi * np.rint(middle / np.pi)) < min_angle


def _cut(curve: PlanarCurve, turns: Spans, limits: Floats) -> Spans:
    """Divide the spans where they have one of the directions `limits`."""
    low, high = np.minimum(turns.theta0, turns.theta1), np.maximum(turns.theta0, turns.theta1)
    inside = (limits > low[:, None] + _CLEAR) & (limits < high[:, None] - _CLEAR)
    span, which = np.nonzero(inside)
    order = np.lexsort((turns.sign[span] * which, span))
    span, direction = span[order], limits[which[order]]
    parameter = tangency(curve, turns, span, direction)
    ahead = _take(turns, np.sort(np.concatenate([np.arange(len(turns.sign)), span])))
    return replace(
        ahead,
        t0=np.insert(turns.t0, span + 1, parameter),
        t1=np.insert(turns.t1, span, parameter),
        theta0=np.insert(turns.theta0, span + 1, direction),
        theta1=np.insert(turns.theta1, span, direction),
    )


def _from_pole(turns: Spans, near: Bools) -> Spans:
    """Let the spans of a closed curve begin behind the last pole, one turn back."""
    last = int(np.flatnonzero(near)[-1])
    order = np.roll(np.arange(len(near)), -(last + 1))
    full = float(turns.theta1[-1] - turns.theta0[0])
    back = np.where(order > last, full, 0.0)
    rolled = _take(turns, order)
    return replace(rolled, theta0=rolled.theta0 - back, theta1=rolled.theta1 - back)


def _take(turns: Spans, rows: Ints) -> Spans:
    return replace(
        turns,
        piece=turns.piece[rows],
        t0=turns.t0[rows],
        t1=turns.t1[rows],
        theta0=turns.theta0[rows],
        theta1=turns.theta1[rows],
        sign=turns.sign[rows],
        closed=False,
    )
