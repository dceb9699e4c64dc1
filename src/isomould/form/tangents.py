"""Isogonal subdivision: the tangent polygon of a curve for a lattice of directions (paper §4.1, §4.2).

The curve falls into arcs that turn one way. On an arc the lattice directions follow each other step by
step. Where two arcs meet, at an inflection or a straight part, one edge goes through the inflection
point (the middle of the straight part) with the nearest lattice direction, and the sequence goes on
from it: tangents of equal direction on the two sides are parallel and are never intersected
(geometry §2). What the lattices of the arcs are is decided in `arc_lattices`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.curves.curve import PlanarCurve
from isomould.curves.turning import Arcs, Spans, arcs, tangency
from isomould.errors import Refused
from isomould.form.lattice import Lattice
from isomould.form.polygon import Edges, Role
from isomould.ties import FINE, first_least

_ON_LATTICE = 1e-9
_NOISE = 0.01


@dataclass(frozen=True)
class _Pivot:
    """The one edge through an inflection or straight part: direction (rad) with its number, contact, role."""

    index: float
    direction: float
    piece: int
    parameter: float
    role: Role


def tangent_edges(curve: PlanarCurve, turns: Spans, lattices: Sequence[Lattice], field: str) -> Edges:
    """Find the edges of the tangent polygon, from the first span to the last.

    Parameters
    ----------
    curve, turns
        The curve and its monotone spans in walking order. Closed spans must start at an inflection or straight part.
    lattices
        The admissible directions of every arc (`arcs(turns)`), straight parts included; spans must lie in their
        range, and the lattices of neighbours must share the direction between them.
    field
        Name of the project's table, for errors.

    Raises
    ------
    Refused
        If an arc turns too little for the lattice, or is noise.
    """
    runs = arcs(turns)
    refuse_noise(curve, turns, lattices, field)
    pivots = [_pivot_before(curve, turns, runs, run, lattices) for run in range(len(runs.sign))]
    pivots.append(_turned_round(pivots[0], turns))
    edges: list[Edges] = []
    for run, sign in enumerate(runs.sign):
        if sign == 0:
            edges.append(_pivot_edge(curve, _straight_pivot(curve, turns, runs, run, lattices[run])))
            continue
        before, after = pivots[run], pivots[run + 1]
        if before is not None and before.role is Role.INFLECTION:
            edges.append(_pivot_edge(curve, before))
        numbers = _numbers(turns, runs, run, lattices[run], before, after, field)
        edges.append(_tangents(curve, turns, runs, run, numbers, lattices[run]))
    return join(edges)


def _pivot_before(curve: PlanarCurve, turns: Spans, runs: Arcs, run: int, lattices: Sequence[Lattice]) -> _Pivot | None:
    if run == 0 and not turns.closed:
        return None
    for neighbour in (max(run - 1, 0), run):
        if runs.sign[neighbour] == 0:
            return _straight_pivot(curve, turns, runs, neighbour, lattices[neighbour])
    span = int(runs.first[run])
    number, direction = nearest(lattices[max(run - 1, 0)], turns.theta0[span])
    return _Pivot(number, direction, int(turns.piece[span]), float(turns.t0[span]), Role.INFLECTION)


def _turned_round(first: _Pivot | None, turns: Spans) -> _Pivot | None:
    """Give the pivot that a closed curve ends with: its first one, after the whole turn."""
    full = float((turns.theta1 - turns.theta0).sum())
    return None if first is None else replace(first, direction=first.direction + full)


def _straight_pivot(curve: PlanarCurve, turns: Spans, runs: Arcs, run: int, lattice: Lattice) -> _Pivot:
    first, last = int(runs.first[run]), int(runs.last[run])
    ends = curve.point(turns.piece[[first, last]], np.array([turns.t0[first], turns.t1[last]]))
    middle = ends.mean(axis=0)
    span, parameter = _on_straight(curve, turns, first, last, middle)
    number, direction = nearest(lattice, turns.theta0[first])
    return _Pivot(number, direction, int(turns.piece[span]), parameter, Role.STRAIGHT)


def _on_straight(curve: PlanarCurve, turns: Spans, first: int, last: int, point: Floats) -> tuple[int, float]:
    """Span and parameter of a point of a straight run (its pieces are linear in their parameter)."""
    rows = np.arange(first, last + 1)
    start = curve.point(turns.piece[rows], turns.t0[rows])
    chord = curve.point(turns.piece[rows], turns.t1[rows]) - start
    share = np.einsum("ij,ij->i", point - start, chord) / np.einsum("ij,ij->i", chord, chord)
    row = first_least(np.abs(share - 0.5), FINE)
    t0, t1 = turns.t0[rows[row]], turns.t1[rows[row]]
    return int(rows[row]), float(t0 + np.clip(share[row], 0, 1) * (t1 - t0))


def nearest(lattice: Lattice, direction: float) -> tuple[float, float]:
    """Give number and direction (rad) of the lattice direction that is nearest, counted in steps."""
    number = np.rint(np.round(lattice.index(np.array([direction])), 9))
    return float(number[0]), float(lattice.direction(number)[0])


def _numbers(
    turns: Spans,
    runs: Arcs,
    run: int,
    lattice: Lattice,
    before: _Pivot | None,
    after: _Pivot | None,
    field: str,
) -> Ints:
    """Lattice numbers of the tangent lines of one curved arc, between the pivots beside it."""
    sign = int(runs.sign[run])
    ends = np.array([turns.theta0[runs.first[run]], turns.theta1[runs.last[run]]])
    first, last = sign * lattice.index(ends)
    low = np.ceil(first - _ON_LATTICE) if before is None else sign * _number(lattice, before) + 1
    high = np.floor(last + _ON_LATTICE) if after is None else sign * _number(lattice, after) - 1
    if before is not None and after is not None and high < low - 1:
        _refuse_short_arc(float(runs.turning[run]), lattice, field)
    return (sign * np.arange(low, high + 1)).astype(np.int64)


def _number(lattice: Lattice, pivot: _Pivot) -> float:
    return nearest(lattice, pivot.direction)[0]


def _tangents(curve: PlanarCurve, turns: Spans, runs: Arcs, run: int, numbers: Ints, lattice: Lattice) -> Edges:
    """Tangent lines of one curved arc with the given lattice numbers."""
    sign = runs.sign[run]
    rows = np.arange(runs.first[run], runs.last[run] + 1)
    index = numbers.astype(np.float64)
    direction = lattice.direction(index)
    place = np.searchsorted(sign * turns.theta1[rows], sign * direction, side="left")
    span = rows[np.minimum(place, len(rows) - 1)]
    parameter = tangency(curve, turns, span, direction)
    piece = turns.piece[span]
    contact = curve.point(piece, parameter)
    return Edges(index, direction, contact, piece, parameter, (Role.TANGENT,) * len(index))


def _pivot_edge(curve: PlanarCurve, pivot: _Pivot) -> Edges:
    piece, parameter = np.array([pivot.piece]), np.array([pivot.parameter])
    index, direction = np.array([pivot.index]), np.array([pivot.direction])
    return Edges(index, direction, curve.point(piece, parameter), piece, parameter, (pivot.role,))


def join(pieces: list[Edges]) -> Edges:
    """Put runs of edges end to end."""
    arrays = (
        np.concatenate([getattr(piece, name) for piece in pieces])
        for name in ("index", "direction", "contact", "piece", "parameter")
    )
    return Edges(*arrays, role=tuple(role for piece in pieces for role in piece.role))


def split_at_inflections(edges: Edges) -> Edges:
    """Put a flat node at every inflection point: the edge through it becomes two (paper §4.4)."""
    twice = [2 if role is Role.INFLECTION else 1 for role in edges.role]
    return edges.take(np.repeat(np.arange(len(edges.role)), twice))


def refuse_noise(curve: PlanarCurve, turns: Spans, lattices: Sequence[Lattice], field: str) -> None:
    """Refuse curves whose curvature flickers (failure mode B5); an arc cut near its end is none."""
    runs = arcs(turns)
    ends = np.stack([turns.theta0[runs.first], turns.theta1[runs.last]], axis=1)
    turned = np.array([abs(np.diff(lattice.index(pair))[0]) for lattice, pair in zip(lattices, ends, strict=True)])
    if curve.closed and not turns.closed and runs.sign[0] == runs.sign[-1]:
        # cut open inside an arc: its two parts are one
        turned[[0, -1]] = turned[0] + turned[-1]
    noisy = np.flatnonzero((turned < _NOISE) & (turned > _ON_LATTICE) & (runs.sign != 0))
    if len(noisy) and len(runs.sign) > 1:
        span = runs.first[noisy[0]]
        x, y = curve.point(turns.piece[[span]], turns.t0[[span]])[0]
        raise Refused(
            "E-CURVE-NOISE",
            f"{field}.curve",
            f"{len(noisy)} arcs turn by less than a hundredth of the turning angle, the first of them "
            f"at ({x:.3f}, {y:.3f}) mm",
            "curvature that does not flicker around zero",
            "Refit the curve with fewer control points.",
        )


def _refuse_short_arc(turning: float, lattice: Lattice, field: str) -> None:
    step = np.degrees(np.diff(lattice.direction(np.array([0.0, 1.0])))[0])
    raise Refused(
        "E-CURVE-ARC",
        f"{field}.divide",
        f"an arc between inflections turns by {abs(np.degrees(turning)):.4f}°, too little for a node of {step:.4f}°",
        "every arc turns by at least about one turning angle",
        f"Choose a turning angle of at most {abs(np.degrees(turning)):.4f}°, or more nodes.",
    )
