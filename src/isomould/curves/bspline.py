"""B-splines, NURBS and interpolated splines, all turned into rational Bézier pieces, exactly.

The arrays may have any dimension, so that curves drawn in space can be projected afterwards.
"""

from typing import Any, Literal, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from isomould.arrays import Bools, Floats, Ints
from isomould.curves.bezier import Bezier
from isomould.curves.pieces import Line, Piece, tuples
from isomould.curves.settings import SplineEnds
from isomould.errors import Refused

LARGEST_DEGREE = 15
_EMPTY_SPAN = 1e-12
"""Knots nearer than this share of the whole range are one knot."""


class Nurbs(NamedTuple):
    """A spline as given: not yet checked."""

    degree: int
    points: Floats
    """(n, dim) control points, mm."""
    weights: Floats
    """(n,) positive."""
    knots: Floats
    """(n + degree + 1,) not decreasing."""


class Segment(NamedTuple):
    """One Bézier segment: points (degree + 1, dim) and weights (degree + 1,)."""

    points: Floats
    weights: Floats


def segments(spline: Nurbs, field: str) -> list[Segment]:
    """Part a spline into its Bézier segments by polar forms.

    Raises
    ------
    Refused
        E-SPLINE-DEGREE, -POINTS, -WEIGHTS or -KNOTS for a spline that is none (failure mode A6).
    """
    refuse_faults(spline, field)
    origin = spline.points[0]
    weights = spline.weights[:, None]
    homogeneous = np.hstack([(spline.points - origin) * weights, weights])
    controls = _controls(homogeneous, spline.knots, spline.degree)
    return [Segment(c[:, :-1] / c[:, -1:] + origin, c[:, -1]) for c in controls]


def interpolated(points: Floats, slopes: tuple[Floats, Floats] | SplineEnds | Literal["periodic"]) -> list[Segment]:
    """Lay a C2 cubic through points (n, dim), its parameter the chord length.

    Parameters
    ----------
    points
        Distinct consecutive points; for "periodic" the first point is repeated at the end.
    slopes
        How it ends: with the given derivatives, without curvature, or with one cubic over the last two spans.
    """
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    ends: Any = slopes if isinstance(slopes, str) else ((1, slopes[0]), (1, slopes[1]))
    at = np.concatenate([[0.0], np.cumsum(chords)])
    tangents = CubicSpline(at, points, bc_type=ends)(at, 1)
    third = chords[:, None] / 3
    inner = points[:-1] + third * tangents[:-1], points[1:] - third * tangents[1:]
    controls = np.stack([points[:-1], *inner, points[1:]], axis=1)
    return [Segment(c, np.ones(4)) for c in controls]


def piece_of(segment: Segment) -> Piece:
    """Make the piece of a segment in the plane; degree 1 becomes a line."""
    if len(segment.points) == 2:
        return Line(*tuples(segment.points))
    return Bezier(tuples(segment.points), tuples(segment.weights))


def clamped_knots(count: int, degree: int) -> Floats:
    """Give uniform knots, full at both ends, for a number of control points.

    >>> clamped_knots(4, 2)
    array([0., 0., 0., 1., 2., 2., 2.])
    """
    return np.clip(np.arange(count + degree + 1.0) - degree, 0.0, count - degree)


def periodic(points: Floats, weights: Floats, degree: int) -> Nurbs:
    """Give the closed uniform spline on control points (n, dim): the first `degree` come again at the end."""
    again = np.arange(len(points) + degree) % len(points)
    return Nurbs(degree, points[again], weights[again], np.arange(again.size + degree + 1.0))


def refuse_faults(spline: Nurbs, field: str) -> None:
    """Refuse what is no spline (failure mode A6)."""
    degree, count = spline.degree, len(spline.points)
    if not 1 <= degree <= LARGEST_DEGREE:
        _refuse("DEGREE", f"{field}.degree", f"degree {degree}", f"1 to {LARGEST_DEGREE}")
    if count < degree + 1:
        _refuse("POINTS", f"{field}.points", f"{count} control points", f"at least {degree + 1}")
    if spline.weights.size != count or not np.all((spline.weights > 0) & (spline.weights < np.inf)):
        found = f"{spline.weights.size} weights, least {np.min(spline.weights, initial=np.inf):g}"
        _refuse("WEIGHTS", f"{field}.weights", found, f"{count} finite weights above 0")
    _refuse_knots(spline.knots, count, degree, f"{field}.knots")


def _refuse_knots(knots: Floats, count: int, degree: int, field: str) -> None:
    if knots.size != count + degree + 1:
        _refuse("KNOTS", field, f"{knots.size} knots", f"{count + degree + 1} (points + degree + 1)")
    if not np.all(np.isfinite(knots)) or np.any(np.diff(knots) < 0):
        _refuse("KNOTS", field, "knots that fall or are not finite", "knots that never fall")
    if not np.any(_filled(knots, degree)):
        _refuse("KNOTS", field, "no span between different knots", "at least one")
    if np.any(knots[1:count] == knots[1 + degree : count + degree]):
        _refuse("KNOTS", field, "a knot repeated too often", f"{degree} times inside, {degree + 1} at the ends")


def _refuse(what: str, field: str, found: str, limit: str) -> None:
    raise Refused(
        code=f"E-SPLINE-{what}",
        field=field,
        found=found,
        limit=limit,
        way_out="Check the spline's definition.",
    )


def _filled(knots: Floats, degree: int) -> Bools:
    """Mark the spans of the domain that are not empty."""
    inner = knots[degree : knots.size - degree]
    return np.diff(inner) > _EMPTY_SPAN * (inner[-1] - inner[0])


def _controls(points: Floats, knots: Floats, degree: int) -> Floats:
    """Give the Bézier control points (s, degree + 1, dim) of each span as polar values f(a … a, b … b)."""
    span = degree + np.flatnonzero(_filled(knots, degree))
    low, high = knots[span][:, None], knots[span + 1][:, None]
    number = np.arange(degree)
    return np.stack(
        [_polar(points, knots, span, np.where(number < degree - c, low, high)) for c in range(degree + 1)],
        axis=1,
    )


def _polar(points: Floats, knots: Floats, span: Ints, arguments: Floats) -> Floats:
    """Evaluate the polar form of each span (s,) at its arguments (s, degree), by de Boor's algorithm."""
    degree = arguments.shape[1]
    values = points[span[:, None] + np.arange(-degree, 1)]
    for r in range(1, degree + 1):
        low = knots[span[:, None] + np.arange(r - degree, 1)]
        high = knots[span[:, None] + np.arange(1, degree + 2 - r)]
        share = ((arguments[:, r - 1 : r] - low) / (high - low))[..., None]
        values = (1 - share) * values[:, :-1] + share * values[:, 1:]
    return values[:, 0]
