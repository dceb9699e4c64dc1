from itertools import pairwise

import numpy as np
import pytest
from curve_strategies import convex_closed, nurbs_curve, quick, splines
from hypothesis import given
from hypothesis import strategies as st

from isomould.curves import shapes
from isomould.curves.bezier import Bezier
from isomould.curves.curve import PlanarCurve, join_pieces
from isomould.curves.pieces import Ellipse, Line
from isomould.curves.turning import arcs, spans, tangency


def curve_of(*pieces, closed=False):
    return join_pieces(pieces, closed)[0]


def places(curve, directions):
    """Points where a curve that turns one way has these unwrapped directions."""
    turns = spans(curve)
    order = np.sign(turns.theta1[-1] - turns.theta0[0])
    span = np.searchsorted(order * turns.theta1, order * directions).clip(0, turns.sign.size - 1)
    t = tangency(curve, turns, span, directions)
    return curve.point(turns.piece[span], t)


def residuals(curve, turns, span, theta):
    t = tangency(curve, turns, span, theta)
    T = curve.derivative(turns.piece[span], t)
    return np.abs(T[:, 0] * np.sin(theta) - T[:, 1] * np.cos(theta)) / np.hypot(*T.T)


def test_circle():
    circle = Ellipse((10.0, 20.0), (700.0, 0.0), (0.0, 700.0), 0.3, 0.3 + 2 * np.pi)
    curve = curve_of(circle, closed=True)
    turns = spans(curve)
    theta = turns.theta0[0] + np.linspace(0, 2 * np.pi, 17)
    expected = np.array([10, 20]) + 700 * np.column_stack([np.sin(theta), -np.cos(theta)])
    np.testing.assert_allclose(places(curve, theta), expected, atol=1e-9)
    assert turns.theta1[-1] == turns.theta0[0] + 2 * np.pi
    assert arcs(turns).turning == pytest.approx([2 * np.pi], abs=1e-14)


def test_parabola_tangency_is_the_closed_form():
    # y = rise (1 − (2x/span)²): slope −8·rise·x/span²
    span, rise = 20000.0, 7500.0
    slopes = np.linspace(1.49, -1.49, 19)
    found = places(curve_of(shapes.parabola(span, rise)), np.arctan(slopes))
    np.testing.assert_allclose(found[:, 0], -slopes * span**2 / (8 * rise), atol=1e-8)


def test_sine_turns_between_its_inflections():
    curve = curve_of(shapes.sine(1000.0, 12000.0, 2, 0.0))
    turns = spans(curve)
    slope = np.arctan(2 * np.pi / 12)
    found = arcs(turns)
    assert found.sign.tolist() == [-1, 1, -1, 1]
    np.testing.assert_allclose(found.turning, 2 * slope * found.sign, atol=1e-14)
    np.testing.assert_allclose(curve.point(turns.piece, turns.t0)[:, 0], [0, 6000, 12000, 18000], atol=1e-9)


def test_sine_from_a_crest_has_half_arcs_at_its_ends():
    found = arcs(spans(curve_of(shapes.sine(1000.0, 12000.0, 1, np.pi / 2))))
    slope = np.arctan(2 * np.pi / 12)
    np.testing.assert_allclose(found.turning, [-slope, 2 * slope, -slope], atol=1e-14)


def test_straight_parts_are_arcs_of_their_own():
    line = Line((0.0, 0.0), (1000.0, 0.0))
    left = Ellipse((1000.0, 500.0), (500.0, 0.0), (0.0, 500.0), -np.pi / 2, 0.0)
    raised = Bezier(((1500.0, 500.0), (1500.0, 900.0), (1500.0, 1100.0), (1500.0, 1500.0)), (1.0,) * 4)
    turns = spans(curve_of(line, left, raised))
    found = arcs(turns)
    assert found.sign.tolist() == [0, 1, 0]
    np.testing.assert_allclose(found.turning, [0, np.pi / 2, 0], atol=1e-15)
    assert turns.kink_span.size == 0
    assert turns.theta0[1] == turns.theta1[0]


@pytest.mark.parametrize("start", range(6))
def test_a_run_across_the_start_of_a_closed_curve_is_one_arc(start):
    """A stadium: two straight sides, two half circles."""
    pieces = [
        Line((0.0, 0.0), (900.0, 0.0)),
        Line((900.0, 0.0), (2000.0, 0.0)),
        Ellipse((2000.0, 500.0), (500.0, 0.0), (0.0, 500.0), -np.pi / 2, np.pi / 4),
        Ellipse((2000.0, 500.0), (500.0, 0.0), (0.0, 500.0), np.pi / 4, np.pi / 2),
        Line((2000.0, 1000.0), (0.0, 1000.0)),
        Ellipse((0.0, 500.0), (500.0, 0.0), (0.0, 500.0), np.pi / 2, 3 * np.pi / 2),
    ]
    turns = spans(curve_of(*pieces[start:], *pieces[:start], closed=True))
    found = arcs(turns)
    assert sorted(found.sign) == [0, 0, 1, 1]
    np.testing.assert_allclose(found.turning, np.pi * found.sign, atol=1e-14)
    assert np.all(turns.sign[found.first] == found.sign)
    assert np.count_nonzero(found.first > found.last) == (start in (1, 3))
    np.testing.assert_array_equal((found.first[1:]), found.last[:-1] + 1)
    assert turns.theta1[-1] - turns.theta0[0] == pytest.approx(2 * np.pi, abs=1e-14)


def test_kinks_are_reported_with_place_and_angle():
    corner = (Line((0.0, 0.0), (1000.0, 0.0)), Line((1000.0, 0.0), (2000.0, 1000.0)))
    back = Line((2000.0, 1000.0), (0.0, 0.0))
    turns = spans(curve_of(*corner, back, closed=True))
    assert turns.kink_span.tolist() == [0, 1, 2]
    np.testing.assert_allclose(turns.kink_point, [(0, 0), (1000, 0), (2000, 1000)])
    assert turns.kink_angle.sum() == pytest.approx(2 * np.pi)
    assert turns.theta1[-1] + turns.kink_angle[0] == pytest.approx(turns.theta0[0] + 2 * np.pi)


@pytest.mark.parametrize(("bend", "kinks"), [(0.5e-9, 0), (3e-9, 1)])
def test_tiny_kinks_are_none(bend, kinks):
    away = (2000.0, 1000.0 * bend)
    turns = spans(curve_of(Line((0.0, 0.0), (1000.0, 0.0)), Line((1000.0, 0.0), away)))
    assert turns.kink_span.size == kinks
    assert arcs(turns).sign.tolist() == [0]


def test_a_flat_point_is_no_inflection():
    """y = x⁴ has no curvature at 0 and does not change sides."""
    powers = Bezier(
        ((-1000.0, 1000.0), (-500.0, -1000.0), (0.0, 1000.0), (500.0, -1000.0), (1000.0, 1000.0)), (1.0,) * 5
    )
    assert powers.point(np.array([0.75]))[0] == pytest.approx([500, 62.5])
    assert arcs(spans(curve_of(powers))).sign.tolist() == [1]


@quick
@given(splines())
def test_spans_are_monotone_and_add_up(spline):
    curve = nurbs_curve(spline, closed=False)
    turns = spans(curve)
    for k in range(turns.sign.size):
        t = np.linspace(turns.t0[k], turns.t1[k], 33)
        T = curve.derivative(np.full(33, turns.piece[k]), t)
        theta = np.unwrap(np.arctan2(T[:, 1], T[:, 0]))
        steps = np.diff(theta) * (turns.sign[k] or 1)
        assert steps.min() >= -2e-9
        assert theta[-1] - theta[0] == pytest.approx(turns.theta1[k] - turns.theta0[k], abs=2e-9)
    smooth = np.setdiff1d(np.arange(1, turns.sign.size), turns.kink_span)
    np.testing.assert_allclose(turns.theta0[smooth], turns.theta1[smooth - 1], atol=1e-9)


@quick
@given(splines(), st.integers(0, 2**32 - 1))
def test_tangency_residual(spline, seed):
    curve = nurbs_curve(spline, closed=False)
    turns = spans(curve)
    span = np.repeat(np.flatnonzero(turns.sign), 6)
    share = np.concatenate([[0, 1], np.random.default_rng(seed).uniform(size=4)])
    share = np.tile(share, span.size // 6)
    theta = turns.theta0[span] * (1 - share) + turns.theta1[span] * share
    inside = np.abs(theta - turns.theta0[span]) > 1e-8
    inside &= np.abs(theta - turns.theta1[span]) > 1e-8
    errors = residuals(curve, turns, span, theta)
    assert np.all(errors[inside] <= 1e-12)
    assert np.all(errors <= 2e-9)
    t = tangency(curve, turns, span, theta)
    assert np.all((t >= turns.t0[span]) & (t <= turns.t1[span]))


@quick
@given(convex_closed())
def test_a_closed_convex_curve_turns_once(curve):
    turns = spans(curve)
    assert set(turns.sign) == {1}
    assert turns.theta1[-1] == turns.theta0[0] + 2 * np.pi
    assert arcs(turns).turning == pytest.approx([2 * np.pi], abs=1e-12)


@quick
@given(convex_closed(), st.integers(0, 11))
def test_start_point_and_direction_of_drawing_do_not_matter(curve, shift):
    theta = np.linspace(0.1, 6.2, 23)
    shift %= len(curve.pieces)
    moved = PlanarCurve(curve.pieces[shift:] + curve.pieces[:shift], closed=True)
    expected = places(curve, onto(curve, theta))
    size = np.ptp(expected)
    np.testing.assert_allclose(places(moved, onto(moved, theta)), expected, atol=1e-9 * size)
    back = curve.reversed()
    np.testing.assert_allclose(places(back, onto(back, theta + np.pi)), expected, atol=1e-9 * size)


def onto(curve, theta):
    """The same directions, modulo a turn, in the closed curve's own range."""
    turns = spans(curve)
    return turns.theta0[0] + (theta - turns.theta0[0]) % (2 * np.pi * np.sign(turns.theta1[-1] - turns.theta0[0]))


def test_directions_outside_the_span_are_errors_and_rounding_is_not():
    curve = curve_of(shapes.parabola(20000.0, 7500.0))
    turns = spans(curve)
    end = turns.theta0[:1]
    assert tangency(curve, turns, np.array([0]), end + 5e-10) == turns.t0[0]
    with pytest.raises(ValueError, match="is not in span 0"):
        tangency(curve, turns, np.array([0]), end + 1e-8)


def test_near_an_inflection_the_residual_holds():
    curve = curve_of(shapes.sine(1000.0, 12000.0, 2, 0.0))
    turns = spans(curve)
    span = np.array([0, 1, 1, 2])
    theta = np.array([turns.theta1[0] + 1e-12, turns.theta0[1] + 1e-12, turns.theta1[1] - 1e-7, turns.theta0[2] - 1e-7])
    assert residuals(curve, turns, span, theta).max() < 1e-12


def test_many_pieces_do_not_let_the_turning_drift():
    angles = np.linspace(0, 2 * np.pi, 3001)
    pieces = [Ellipse((0.0, 0.0), (9000.0, 0.0), (0.0, 9000.0), a, b) for a, b in pairwise(angles)]
    turns = spans(curve_of(*pieces, closed=True))
    np.testing.assert_allclose(turns.theta0, np.pi / 2 + angles[:-1], atol=2e-12)
