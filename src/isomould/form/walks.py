"""Where the walk along a closed curve begins: at a direction, or at an inflection (geometry §2)."""

from dataclasses import replace

import numpy as np

from isomould.curves.curve import PlanarCurve
from isomould.curves.turning import Spans, arcs, tangency
from isomould.form.polygon import unit

_WHOLE = 1e-9
_LEVEL = 1e-6
"""Tangents whose distances differ by less (mm) support a curve alike."""


def from_direction(curve: PlanarCurve, turns: Spans, first: float, sense: float, field: str) -> Spans:
    """Cut a closed curve's spans open at its outermost tangent of direction `first` (rad).

    The drawing's start point has no influence: of several tangents with this direction, the one that supports the
    whole curve is taken, of several points where it does (beside a dent) the hindmost, and of a straight part its
    middle.
    """
    lower = np.minimum(turns.theta0, turns.theta1)
    upper = np.maximum(turns.theta0, turns.theta1)
    direction = first + 2 * np.pi * np.ceil((lower - first - _WHOLE) / (2 * np.pi))
    candidates = np.flatnonzero((direction <= upper + _WHOLE) & (turns.sign != -sense))
    if len(candidates) == 0:
        candidates = np.flatnonzero(direction <= upper + _WHOLE)
    target = np.clip(direction[candidates], lower[candidates], upper[candidates])
    middle = (turns.t0[candidates] + turns.t1[candidates]) / 2
    curved = turns.sign[candidates] != 0
    parameter = np.where(curved, tangency(curve, turns, candidates, target), middle)
    contact = curve.point(turns.piece[candidates], parameter)
    support = contact @ unit(np.array([first - sense * np.pi / 2]))[0]
    outermost = np.flatnonzero(support >= support.max() - _LEVEL)
    along = np.round(contact[outermost] @ unit(np.array([first]))[0], 6)
    best = int(outermost[np.lexsort((along, curved[outermost]))[0]])
    return _cut_open(turns, int(candidates[best]), float(parameter[best]), float(direction[candidates[best]]))


def _cut_open(turns: Spans, span: int, parameter: float, direction: float) -> Spans:
    """Start the spans of a closed curve inside one of them, where it has the given direction."""
    order = np.concatenate([np.arange(span, len(turns.sign)), np.arange(span + 1)])
    full = float((turns.theta1 - turns.theta0).sum())
    shift = np.where(np.arange(len(order)) < len(turns.sign) - span, 0.0, full)
    t0, t1 = turns.t0[order].copy(), turns.t1[order].copy()
    theta0, theta1 = turns.theta0[order] + shift, turns.theta1[order] + shift
    t0[0], theta0[0], t1[-1], theta1[-1] = parameter, direction, parameter, direction + full
    return replace(
        turns,
        piece=turns.piece[order],
        t0=t0,
        t1=t1,
        theta0=theta0,
        theta1=theta1,
        sign=turns.sign[order],
        closed=False,
    )


def from_inflection(walk: Spans) -> Spans:
    """Start the spans of a closed curve, cut open anywhere, at an inflection or straight part instead."""
    runs = arcs(walk)
    first = int(runs.first[1 if runs.sign[0] else 2])
    order = np.concatenate([np.arange(first, len(walk.sign)), np.arange(1, first)])
    full = float((walk.theta1 - walk.theta0).sum())
    t1, theta0, theta1 = walk.t1.copy(), walk.theta0.copy(), walk.theta1.copy()
    theta0[:first] += full
    theta1[:first] += full
    t1[-1], theta1[-1] = t1[0], theta1[0]
    return replace(
        walk,
        piece=walk.piece[order],
        t0=walk.t0[order],
        t1=t1[order],
        theta0=theta0[order],
        theta1=theta1[order],
        sign=walk.sign[order],
        closed=True,
    )
