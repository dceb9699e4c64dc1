import numpy as np
import pytest
from curve_strategies import nurbs_curve, quick, splines
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline, CubicSpline

from isomould.curves.bezier import Bezier
from isomould.curves.bspline import (
    Nurbs,
    clamped_knots,
    interpolated,
    periodic,
    piece_of,
    segments,
)
from isomould.curves.curve import PlanarCurve, join_pieces
from isomould.curves.lengths import length
from isomould.curves.turning import arcs, spans, tangency
from isomould.errors import Refused


def evaluated(spline, at):
    """The spline's points by scipy, apart from ours."""
    w = spline.weights[:, None]
    homogeneous = BSpline(spline.knots, np.hstack([spline.points * w, w]), spline.degree)(at)
    return homogeneous[:, :2] / homogeneous[:, 2:]


@quick
@given(splines())
def test_segments_are_the_spline(spline):
    curve = nurbs_curve(spline, closed=False)
    fences = np.unique(spline.knots)
    for k, piece in enumerate(curve.pieces):
        t = np.linspace(0, 1, 7)
        at = fences[k] + t * (fences[k + 1] - fences[k])
        np.testing.assert_allclose(piece.point(t), evaluated(spline, at), atol=1e-8)


@quick
@given(st.integers(1, 5), st.integers(0, 99))
def test_a_periodic_spline_closes_smoothly(degree, seed):
    rng = np.random.default_rng(seed)
    points, weights = rng.normal(size=(8, 2)) * 1e4, rng.uniform(0.5, 2, 8)
    parts = segments(periodic(points, weights, degree), "curve")
    assert len(parts) == 8
    pieces = [piece_of(s) for s in parts]
    for before, after in zip(pieces, pieces[1:] + pieces[:1], strict=True):
        np.testing.assert_allclose(before.point(np.ones(1)), after.point(np.zeros(1)), atol=1e-9)
        if degree > 1:
            T = before.derivative(np.ones(1))[0], after.derivative(np.zeros(1))[0]
            assert abs(T[0][0] * T[1][1] - T[0][1] * T[1][0]) < 1e-9 * (T[0] @ T[0])


def test_degree_one_gives_lines():
    points = np.array([[0.0, 0.0], [9.0, 0.0], [9.0, 5.0]])
    parts = segments(Nurbs(1, points, np.ones(3), clamped_knots(3, 1)), "curve")
    assert [piece_of(s).kind for s in parts] == ["line", "line"]


def inserted(spline, knot):
    """Boehm's knot insertion."""
    p, u, w = spline.degree, spline.knots, spline.weights[:, None]
    d = np.hstack([spline.points * w, w])
    k = np.searchsorted(u, knot, side="right") - 1
    rows = []
    for i in range(len(d) + 1):
        a = np.clip((knot - u[i]) / (u[i + p] - u[i]), 0, 1) if k - p < i <= k else float(i <= k - p)
        rows.append((a * d[min(i, len(d) - 1)] if a else 0) + ((1 - a) * d[i - 1] if a < 1 else 0))
    d = np.array(rows)
    return Nurbs(p, d[:, :2] / d[:, 2:], d[:, 2], np.insert(u, k + 1, knot))


def elevated(piece):
    """The same piece, one degree higher."""
    w = np.array(piece.weights)[:, None]
    d = np.hstack([np.array(piece.points) * w, w])
    n = len(d)
    share = np.arange(n + 1)[:, None] / n
    up = share * np.vstack([d[:1], d]) + (1 - share) * np.vstack([d, d[-1:]])
    points = tuple(map(tuple, (up[:, :2] / up[:, 2:]).tolist()))
    return Bezier(points, tuple(up[:, 2].tolist()))


def tangencies(curve, shares):
    """Tangency points, tangents and curvatures of directions spread over every arc that really turns."""
    turns = spans(curve)
    runs = arcs(turns)
    span, theta = [np.empty(0, np.int64)], [np.empty(0)]
    for k in np.flatnonzero(np.abs(runs.turning) > 1e-2):
        rows = np.arange(runs.first[k], runs.last[k] + 1)
        theta.append(turns.theta0[rows[0]] + shares * runs.turning[k])
        later = np.searchsorted(runs.sign[k] * turns.theta1[rows], runs.sign[k] * theta[-1])
        span.append(rows[later.clip(0, rows.size - 1)])
    span, theta = np.concatenate(span), np.concatenate(theta)
    place = turns.piece[span], tangency(curve, turns, span, theta)
    T, B = curve.derivative(*place), curve.second(*place)
    bend = np.abs(cross(T, B)) / np.hypot(*T.T) ** 3
    return curve.point(*place), T / np.hypot(*T.T)[:, None], bend


def cross(a, b):
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


SHARES = np.linspace(0.2, 0.8, 5)


@quick
@given(splines(), st.floats(0.01, 0.99))
def test_another_representation_has_the_same_tangency_points(spline, share):
    """The tangent lines are the same; the points too, unless the curve is flat there (a line has many)."""
    curve, size = nurbs_curve(spline, closed=False), np.ptp(spline.points)
    points, tangents, bend = tangencies(curve, SHARES)
    refined = nurbs_curve(inserted(spline, share * spline.knots[-1]), closed=False)
    higher = PlanarCurve(tuple(elevated(piece) for piece in curve.pieces), closed=False)
    for other, step in ((refined, 1), (higher, 1), (curve.reversed(), -1)):
        away = tangencies(other, SHARES)[0][::step] - points
        assert np.all(np.abs(cross(away, tangents)) <= 1e-9 * size)
        assert np.all(np.abs(away[bend * size > 1e-3]) <= 1e-9 * size)


def test_interpolation_passes_its_points_and_is_scipy_s():
    points = np.array([[0, 0], [3000, 2000], [9000, 1000], [12000, 5000], [15000, 0]], float)
    at = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    for ends in ("natural", "not-a-knot"):
        expected = CubicSpline(at, points, bc_type=ends)
        for k, segment in enumerate(interpolated(points, ends)):
            t = np.linspace(0, 1, 5)
            np.testing.assert_allclose(piece_of(segment).point(t), expected(at[k] + t * (at[k + 1] - at[k])), atol=1e-9)


def test_interpolation_has_no_kinks_and_its_curvature_is_continuous():
    points = np.array([[0, 0], [9000, -2000], [12000, 4000], [3000, 9000], [0, 0]], float)
    curve, _ = join_pieces(tuple(piece_of(s) for s in interpolated(points, "periodic")), closed=True)
    assert spans(curve).kink_span.size == 0
    index = np.arange(4)
    bends = []
    for i, t in ((index, np.ones(4)), ((index + 1) % 4, np.zeros(4))):
        T, B = curve.derivative(i, t), curve.second(i, t)
        bends.append((T[:, 0] * B[:, 1] - T[:, 1] * B[:, 0]) / np.hypot(*T.T) ** 3)
    np.testing.assert_allclose(bends[0], bends[1], rtol=1e-10)


def test_natural_ends_are_no_inflections():
    points = np.array([[0, 0], [5000, 3000], [10000, 3000], [15000, 0]], float)
    curve, _ = join_pieces(tuple(piece_of(s) for s in interpolated(points, "natural")), closed=False)
    assert arcs(spans(curve)).sign.tolist() == [-1]
    assert length(curve) > 15000


GOOD = Nurbs(2, np.array([[0, 0], [1, 1], [2, 0], [3, 1]], float) * 1000, np.ones(4), clamped_knots(4, 2))


@pytest.mark.parametrize(
    ("change", "code", "field", "says"),
    [
        ({"degree": 0}, "DEGREE", "degree", "degree 0"),
        ({"degree": 16}, "DEGREE", "degree", "degree 16"),
        ({"degree": 4}, "POINTS", "points", "4 control points"),
        ({"weights": np.ones(3)}, "WEIGHTS", "weights", "3 weights"),
        ({"weights": np.array([1, 0, 1, 1.0])}, "WEIGHTS", "weights", "least 0"),
        ({"weights": np.array([1, -1, 1, 1.0])}, "WEIGHTS", "weights", "least -1"),
        ({"weights": np.array([1, np.nan, 1, 1.0])}, "WEIGHTS", "weights", "nan"),
        ({"knots": np.arange(6.0)}, "KNOTS", "knots", "6 knots"),
        ({"knots": np.array([0, 0, 0, 2, 1, 3, 3.0])}, "KNOTS", "knots", "fall"),
        ({"knots": np.array([0, 0, 0, np.nan, 2, 2, 2.0])}, "KNOTS", "knots", "not finite"),
        ({"knots": np.array([0, 0, 0, 0, 1, 1, 1.0])}, "KNOTS", "knots", "too often"),
        ({"knots": np.array([0, 0, 0, 1, 1, 1, 1.0])}, "KNOTS", "knots", "too often"),
        ({"knots": np.zeros(7)}, "KNOTS", "knots", "no span"),
    ],
)
def test_what_is_no_spline_is_refused(change, code, field, says):
    with pytest.raises(Refused) as refusal:
        segments(GOOD._replace(**change), "rail.curve")
    assert refusal.value.code == f"E-SPLINE-{code}"
    assert refusal.value.field == f"rail.curve.{field}"
    assert says in refusal.value.found
