import numpy as np
import pytest
from curve_strategies import nurbs_curve, quick, splines
from hypothesis import given
from scipy.integrate import simpson
from scipy.special import ellipe

from isomould.curves import shapes
from isomould.curves.curve import join_pieces
from isomould.curves.lengths import length, parameter_at
from isomould.curves.pieces import Ellipse, Line


def test_catenary_length():
    piece = shapes.catenary(24000.0, 9000.0)
    a = abs(piece.across[1])
    curve, _ = join_pieces((piece,), closed=False)
    assert length(curve) == pytest.approx(2 * a * np.sinh(12000.0 / a), rel=1e-13)


@pytest.mark.parametrize("minor", [1000.0, 10.0, 0.1])
def test_ellipse_length(minor):
    piece = Ellipse((0.0, 0.0), (1000.0, 0.0), (0.0, minor), 0.3, 0.3 + 2 * np.pi)
    curve, _ = join_pieces((piece,), closed=True)
    assert length(curve) == pytest.approx(4000 * ellipe(1 - (minor / 1000) ** 2), rel=1e-12)


def test_parabola_length():
    p, h = 10000.0, 7500.0
    k = 2 * h / p
    expected = p * (np.sqrt(1 + k * k) + np.arcsinh(k) / k)
    curve, _ = join_pieces((shapes.parabola(2 * p, h),), closed=False)
    assert length(curve) == pytest.approx(expected, rel=1e-13)


def test_stations_of_a_line_and_an_arc():
    quarter = Ellipse((1000.0, 500.0), (500.0, 0.0), (0.0, 500.0), -np.pi / 2, 0.0)
    curve, _ = join_pieces((Line((0.0, 0.0), (1000.0, 0.0)), quarter), closed=False)
    index, t = parameter_at(curve, np.array([0.0, 250.0, 1000.0 + 125 * np.pi, 1000.0 + 250 * np.pi]))
    np.testing.assert_allclose(index + t, [0, 0.25, 1.5, 2], atol=1e-12)


@quick
@given(splines())
def test_stations_are_as_far_as_asked(spline):
    curve = nurbs_curve(spline, closed=False)
    asked = np.linspace(0, length(curve), 7)
    index, t = parameter_at(curve, asked)
    for k in (2, 5):
        chain = (*curve.pieces[: index[k]],)
        part = curve.pieces[index[k]]
        samples = np.linspace(0, t[k], 4001)
        speed = np.hypot(*part.derivative(samples).T)
        rest = simpson(speed, x=samples)
        whole = length(join_pieces(chain, closed=False)[0]) if chain else 0.0
        assert whole + rest == pytest.approx(asked[k], rel=1e-6)


def test_a_station_beyond_the_end_is_an_error():
    curve, _ = join_pieces((Line((0.0, 0.0), (1000.0, 0.0)),), closed=False)
    with pytest.raises(ValueError, match="stations from"):
        parameter_at(curve, np.array([1000.1]))
