"""Moving a spline's control points as little as possible until one angle divides all its arcs (beyond the paper)."""

from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

import numpy as np

from isomould.arrays import Bools, Floats, Ints
from isomould.curves.construction import build_curve
from isomould.curves.curve import PlanarCurve
from isomould.curves.settings import BsplineSettings, CurveSettings, SplineSettings
from isomould.curves.turning import arcs
from isomould.errors import Note, Refused
from isomould.form.deviation import curve_distance
from isomould.form.division import Request, smooth_spans, turning_angle
from isomould.form.settings import GeneratrixDivide
from isomould.ties import FINE, first_least
from isomould.units import MM_PER_UNIT

_SETTLED = 1e-12
"""Turning of an arc that may remain, rad."""
_STILL, _WIDTH = 1e-10, 1e-5
"""Last change of a coordinate, and step of the differences, as shares of the curve's size."""
_RANK = 1e-7
"""Singular values below this share are none: on a closed curve the arcs' turning adds up by itself."""
_ROUNDS = 50
_SAMPLES = np.linspace(0.0, 1.0, 33)

Splines = BsplineSettings | SplineSettings


def fit_curve(settings: CurveSettings, request: Request) -> tuple[CurveSettings, tuple[Note, ...]]:
    """Fit a curve's table to the division asked for, if `inflections = "fit"`; else leave it alone.

    The control points x + Δ with the least Σ|Δ|² whose arcs all turn by whole multiples of α.

    Raises
    ------
    Refused
        If the curve has no control points, or no small move does it.
    """
    if request.treatment.inflections != "fit":
        return settings, ()
    if not isinstance(settings, BsplineSettings | SplineSettings):
        _refuse_without_points(settings.kind, request.field)
    before = _built(settings, request)
    fitted = _moved(settings, _least_move(settings, request))
    return fitted, (_note(settings, fitted, before, _built(fitted, request), request.field),)


def _built(settings: Splines, request: Request) -> PlanarCurve:
    return build_curve(settings, Path(), None, f"{request.field}.curve")[0]


def _moved(settings: Splines, move: Floats) -> Splines:
    points = np.array(settings.points, dtype=np.float64) + move.reshape(-1, 2)
    return settings.model_copy(update={"points": tuple((float(x), float(y)) for x, y in points)})


def _least_move(settings: Splines, request: Request) -> Floats:
    """Solve min |Δ|² with all arcs at their targets, by Newton steps on the constraints (minimum norm)."""
    sign, turned = _turning(settings, request)
    target = _targets(settings, sign, turned, request)

    def miss(move: Floats) -> Floats:
        signs, angles = _turning(_moved(settings, move), request)
        if not np.array_equal(signs, sign):
            _refuse_unfit(request.field, "an inflection or straight part is lost on the way")
        return angles - target

    return _solve(miss, 2 * len(settings.points), float(np.ptp(np.array(settings.points))), request.field)


def _solve(miss: Callable[[Floats], Floats], count: int, size: float, field: str) -> Floats:
    """Project the origin on the linearised constraints until neither they nor the move change any more."""
    move, change = np.zeros(count), 0.0
    for _ in range(_ROUNDS):
        off = miss(move)
        if np.abs(off).max() <= _SETTLED and change <= _STILL * size:
            return move
        slope = _slope(miss, move, _WIDTH * size)
        onward = np.asarray(np.linalg.lstsq(slope, slope @ move - off, rcond=_RANK)[0], dtype=np.float64)
        move, change = onward, float(np.abs(onward - move).max())
    return _refuse_unfit(field, f"{np.degrees(np.abs(miss(move)).max()):.2g}° remain after {_ROUNDS} rounds")


def _slope(miss: Callable[[Floats], Floats], move: Floats, width: float) -> Floats:
    """Central differences (a, n) of what the arcs miss, by the coordinates."""
    aside = width * np.eye(len(move))
    return np.stack([(miss(move + step) - miss(move - step)) / (2 * width) for step in aside], axis=1)


def _turning(settings: Splines, request: Request) -> tuple[Ints, Floats]:
    """Signs of all arcs and straight parts, and the |turning| (a,) rad of the arcs."""
    runs = arcs(smooth_spans(_built(settings, request), request.field))
    return runs.sign, np.abs(runs.turning[runs.sign != 0])


def _targets(settings: Splines, sign: Ints, turned: Floats, request: Request) -> Floats:
    """Whole multiples of α (a,) rad, near to how the arcs turn, that the division can have (geometry §2)."""
    divide, sense = request.divide, sign[sign != 0]
    if isinstance(divide, GeneratrixDivide) and divide.per_arc is not None:
        return np.full(len(turned), float(turned.mean()))
    if settings.closed:
        return _closed_targets(turned, sense != np.sign(sense @ turned), request)
    step = turning_angle(_built(settings, request), request)
    if divide.nodes is None:
        return np.maximum(np.rint(turned / step), 1) * step
    return _shared_out(turned / step, divide.nodes, request.field) * step


def _closed_targets(turned: Floats, back: Bools, request: Request) -> Floats:
    """Let n₊ − n₋ = k with α = 2π/k, and n₊ + n₋ the count asked for; `back` marks the arcs of n₋."""
    total, around = request.divide.nodes, float(turned.sum() / (2 * np.pi))
    if total is not None:
        count = max(round(total * (1 - 1 / around) / 2), int(back.sum()))
        ahead = total - count
    else:
        around = round(360 / (request.divide.angle_deg or 360))
        count = max(round(float(turned[back].sum()) * around / (2 * np.pi)), int(back.sum()))
        ahead = around + count
    if ahead - count < 3:
        _refuse_unfit(request.field, f"{ahead} nodes to the one side and {count} to the other do not go round")
    step, counts = 2 * np.pi / (ahead - count), np.zeros(len(turned))
    counts[back] = _shared_out(turned[back] / step, count, request.field)
    counts[~back] = _shared_out(turned[~back] / step, ahead, request.field)
    return counts * step


def _shared_out(wanted: Floats, total: int, field: str) -> Floats:
    """Whole numbers (a,), one at least, near to those wanted, that add up to the total."""
    if total < len(wanted):
        _refuse_unfit(field, f"{total} nodes for {len(wanted)} arcs")
    counts = np.maximum(np.rint(np.round(wanted, 9)), 1)
    while counts.size and counts.sum() != total:
        step = np.sign(total - counts.sum())
        cost = np.where(counts + step >= 1, np.abs(wanted - counts - step) - np.abs(wanted - counts), np.inf)
        counts[first_least(cost, FINE)] += step
    return counts


def _note(settings: Splines, fitted: Splines, before: PlanarCurve, after: PlanarCurve, field: str) -> Note:
    move = np.array(fitted.points) - np.array(settings.points)
    furthest = float(np.hypot(*move.T).max()) * MM_PER_UNIT[settings.units or "mm"]
    piece = np.repeat(np.arange(len(after.pieces)), len(_SAMPLES))
    away = curve_distance(before, after.point(piece, np.tile(_SAMPLES, len(after.pieces))))
    text = f"fitted to whole steps: the curve moved by up to {away:.3f} mm, its points by up to {furthest:.3f} mm"
    return Note("W-CURVE-FITTED", f"{field}.curve", text)


def _refuse_without_points(kind: str, field: str) -> NoReturn:
    raise Refused(
        "E-CURVE-FIT",
        f"{field}.inflections",
        f"'fit' for a curve of the kind {kind}",
        "a bspline or spline, whose points can move",
        "Give the curve as one of these, or choose inflections = 'nearest' or 'residual'.",
    )


def _refuse_unfit(field: str, found: str) -> NoReturn:
    raise Refused(
        "E-CURVE-FIT",
        f"{field}.inflections",
        f"no small move of the points divides all arcs: {found}",
        f"arcs within {_SETTLED:g} rad of whole steps",
        "Choose another turning angle, give the curve more points, or choose inflections = 'residual'.",
    )
