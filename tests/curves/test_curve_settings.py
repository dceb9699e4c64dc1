from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from isomould.curves.construction import build_curve
from isomould.curves.curve import ends
from isomould.curves.plane import PlaneSettings, build_plane, project
from isomould.curves.settings import CurveSettings
from isomould.curves.turning import arcs, spans
from isomould.errors import Refused

ADAPTER = TypeAdapter(CurveSettings)
HERE = Path()


def built(**table):
    return build_curve(ADAPTER.validate_python(table), HERE, field="rail.curve")[0]


def samples(curve, count=9):
    every = np.arange(len(curve.pieces))
    index, t = np.repeat(every, count), np.tile(np.linspace(0, 1, count), every.size)
    return curve.point(index, t)


SQUARE = [[0, 0], [9, 0], [9, 9], [0, 9]]


def test_arc_by_radius_and_angles():
    curve = built(kind="arc", radius="9 m", start_deg=30, end_deg=120, centre=[1, 2], units="m")
    points = samples(curve)
    np.testing.assert_allclose(np.hypot(*(points - [1000, 2000]).T), 9000, rtol=1e-14)
    assert points[0] == pytest.approx([1000 + 9000 * np.cos(np.pi / 6), 6500])
    assert arcs(spans(curve)).turning == pytest.approx([np.pi / 2])
    backwards = built(kind="arc", radius="9 m", start_deg=120, end_deg=30)
    assert arcs(spans(backwards)).turning == pytest.approx([-np.pi / 2])


@pytest.mark.parametrize("key", ["span", "chord"])
@pytest.mark.parametrize("rise", [3000.0, 12000.0, 0.01, -3000.0])
def test_arch_by_span_and_rise(key, rise):
    curve = built(kind="arc", **{key: "24 m"}, rise=rise)
    points = samples(curve)
    np.testing.assert_allclose([points[0], points[-1]], [[-12000, 0], [12000, 0]], atol=1e-7)
    assert points[4] == pytest.approx([0, rise], abs=1e-7)
    radius = (12000**2 + rise**2) / (2 * rise)
    np.testing.assert_allclose(np.hypot(*(points - [0, rise - radius]).T), abs(radius), rtol=1e-12)


def test_circle_and_ellipse_are_closed():
    assert built(kind="circle", radius=9000).closed
    curve = built(kind="ellipse", semi_axes=["12 m", 5000], rotation_deg=90, centre=[1000, 0])
    points = samples(curve, 5)
    expected = [[1000, 12000], [-4000, 0], [1000, -12000], [6000, 0]]
    np.testing.assert_allclose(points[:4], expected, atol=1e-9)
    assert curve.closed
    half = built(kind="ellipse", semi_axes=[9000, 4000], start_deg=0, end_deg=180)
    assert not half.closed
    np.testing.assert_allclose(ends(half)[1], [[-9000, 0]], atol=1e-9)


@pytest.mark.parametrize("kind", ["parabola", "catenary"])
@pytest.mark.parametrize("rise", [7500.0, -7500.0, 0.5, 90000.0])
def test_arches(kind, rise):
    curve = built(kind=kind, span="20 m", rise=rise)
    points = samples(curve)
    np.testing.assert_allclose(points[[0, 4, -1]], [[-10000, 0], [0, rise], [10000, 0]], atol=1e-7)
    assert arcs(spans(curve)).sign.tolist() == [-np.sign(rise)]


def test_parabola_is_one_and_the_catenary_is_another():
    x, y = samples(built(kind="parabola", span=20000, rise=7500)).T
    np.testing.assert_allclose(y, 7500 * (1 - (x / 10000) ** 2), atol=1e-9)
    curve = built(kind="catenary", span=20000, rise=7500)
    x, y = samples(curve).T
    a = curve.pieces[0].along[0]
    np.testing.assert_allclose(y, 7500 + a - a * np.cosh(x / a), atol=1e-9)
    assert a * (np.cosh(10000 / a) - 1) == pytest.approx(7500, rel=1e-14)


def test_sine_starts_at_x_zero_with_its_phase():
    curve = built(kind="sine", amplitude="1 m", wavelength="12 m", waves=1.5, phase_deg=30)
    x, y = samples(curve).T
    assert (x[0], x[-1]) == pytest.approx((0, 18000))
    np.testing.assert_allclose(y, 1000 * np.sin(2 * np.pi * x / 12000 + np.pi / 6), atol=1e-9)


def test_bsplines():
    clamped = built(kind="bspline", points=[[0, 0], [9, 9], [18, 0], [27, 9]], units="m")
    np.testing.assert_allclose(samples(clamped)[[0, -1]], [[0, 0], [27000, 9000]], atol=1e-9)
    knots = [0, 0, 0, 1, 2, 2, 2]
    given = built(kind="bspline", degree=2, points=SQUARE, knots=knots, weights=[1, 2, 2, 1], units="m")
    assert len(given.pieces) == 2
    closed = built(kind="bspline", degree=2, points=SQUARE, closed=True, units="m")
    assert arcs(spans(closed)).turning == pytest.approx([2 * np.pi])


def test_nurbs_circle_is_the_circle():
    w = np.sqrt(0.5)
    points = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]]
    knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
    table = {"kind": "bspline", "degree": 2, "points": points, "weights": [1, w] * 4 + [1], "units": "m"}
    with pytest.raises(Refused, match="E-CURVE-CLOSED"):
        built(**table, knots=knots)
    table |= {"points": points[:5], "weights": [1, w, 1, w, 1]}
    half = built(**table, knots=[0, 0, 0, 1, 1, 2, 2, 2])
    np.testing.assert_allclose(np.hypot(*samples(half).T), 1000, rtol=1e-14)
    assert arcs(spans(half)).turning == pytest.approx([np.pi], abs=1e-14)


def test_splines_pass_their_points():
    closed = built(kind="spline", points=SQUARE, closed=True, units="ft")
    np.testing.assert_allclose(ends(closed)[0], np.array(SQUARE) * 304.8)
    opened = built(kind="spline", points=SQUARE, ends="not-a-knot", units="m")
    np.testing.assert_allclose(ends(opened)[1], np.array(SQUARE[1:]) * 1000)


def test_repeated_points_of_a_spline_are_noted():
    points = [*SQUARE, [0, 9], [0, 0]]
    table = {"kind": "spline", "points": points, "closed": True, "units": "m"}
    curve, notes = build_curve(ADAPTER.validate_python(table), HERE, field="rail.curve")
    assert len(curve.pieces) == 4
    assert [n.text for n in notes] == ["2 exactly repeated point(s) left out"]


def test_polylines_with_bulges():
    curve = built(kind="polyline", points=[[0, 0], [9000, 0]], bulges=[1, 1], closed=True)
    points = samples(curve)
    np.testing.assert_allclose(np.hypot(*(points - [4500, 0]).T), 4500, rtol=1e-13)
    assert arcs(spans(curve)).turning == pytest.approx([2 * np.pi])
    kinked = built(kind="polyline", points=SQUARE, units="m")
    assert spans(kinked).kink_angle == pytest.approx([np.pi / 2] * 2)


@pytest.mark.parametrize("bulge", [1e-9, -3e-6, 0.99e-5, 1.01e-5, 0.3, 1.0, 2.5, -2.5])
def test_bulges_of_every_size_are_arcs(bulge):
    curve = built(kind="polyline", points=[[-5000, 0], [5000, 0]], bulges=[bulge])
    points = samples(curve, 3)
    np.testing.assert_allclose(points, [[-5000, 0], [0, -5000 * bulge], [5000, 0]], atol=1e-6)
    turning = spans(curve)
    assert np.sum(turning.theta1 - turning.theta0) == pytest.approx(4 * np.arctan(bulge), rel=1e-6)


@pytest.mark.parametrize(
    ("table", "code", "field"),
    [
        ({"kind": "polyline", "points": []}, "E-CURVE-POINTS", "points"),
        ({"kind": "polyline", "points": [[0, 0]]}, "E-CURVE-POINTS", "points"),
        ({"kind": "polyline", "points": SQUARE, "bulges": [0, 0]}, "E-CURVE-COUNT", "bulges"),
        ({"kind": "spline", "points": [[0, 0], [0, 0]]}, "E-CURVE-POINTS", "points"),
        ({"kind": "spline", "points": [[0, 0], [9, 9]], "closed": True}, "E-CURVE-POINTS", "points"),
        ({"kind": "bspline", "points": SQUARE, "weights": [1, 1]}, "E-CURVE-COUNT", "weights"),
        ({"kind": "bspline", "points": SQUARE, "weights": [1, 0, 1, 1]}, "E-SPLINE-WEIGHTS", "weights"),
        ({"kind": "bspline", "points": SQUARE[:3]}, "E-SPLINE-POINTS", "points"),
        ({"kind": "bspline", "points": SQUARE[:3], "closed": True}, "E-CURVE-POINTS", "points"),
        ({"kind": "bspline", "points": SQUARE, "knots": [0, 1]}, "E-SPLINE-KNOTS", "knots"),
        ({"kind": "bspline", "points": SQUARE, "degree": 99}, "E-SPLINE-DEGREE", "degree"),
        ({"kind": "arc", "radius": 9000, "start_deg": 0, "end_deg": 360}, "E-CURVE-RANGE", "end_deg"),
        ({"kind": "arc", "radius": 9000, "start_deg": 5, "end_deg": 5}, "E-CURVE-RANGE", "end_deg"),
        ({"kind": "arc", "span": 9000, "rise": 0}, "E-CURVE-RISE", "rise"),
        ({"kind": "parabola", "span": 9000, "rise": 0}, "E-CURVE-RISE", "rise"),
        ({"kind": "dxf", "file": "a.dxf", "layer": "RAIL", "drawn": "world"}, "E-DRAWN-PLANE", "drawn"),
    ],
)
def test_refusals_name_the_key(table, code, field):
    with pytest.raises(Refused) as refusal:
        built(**table)
    assert refusal.value.code == code
    assert refusal.value.field == f"rail.curve.{field}"


def test_a_curve_that_is_much_too_small_is_refused():
    with pytest.raises(Refused, match=r"E-CURVE-SIZE rail\.curve: 0\.0282843 mm across"):
        built(kind="circle", radius=0.01)


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ({"kind": "clothoid"}, "clothoid"),
        ({"kind": "circle", "radius": "9 yards"}, "not a length"),
        ({"kind": "circle", "radius": -9}, "greater than zero"),
        ({"kind": "circle", "radius": True}, "not a length"),
        ({"kind": "circle", "radius": 9, "units": "m"}, "bare number beside units = 'm'"),
        ({"kind": "ellipse", "semi_axes": ["9 m", 4], "units": "m"}, "bare number"),
        ({"kind": "circle", "radius": 9, "colour": 3}, "Extra inputs"),
        ({"kind": "arc", "radius": 9}, "an arc takes"),
        ({"kind": "arc", "radius": 9, "start_deg": 0, "end_deg": 9, "rise": 4}, "an arc takes"),
        ({"kind": "arc", "span": 9, "chord": 9, "rise": 4}, "an arc takes"),
        ({"kind": "ellipse", "semi_axes": [9, 4], "start_deg": 4}, "both start_deg and end_deg"),
        ({"kind": "bspline", "points": SQUARE, "closed": True, "knots": [1]}, "takes no knots"),
        ({"kind": "polyline", "points": [[0, float("nan")], [1, 1]]}, "finite number"),
        ({"kind": "polyline", "points": [[0, "1 m"], [1, 1]]}, "valid number"),
        ({"kind": "sine", "amplitude": 1, "wavelength": 9, "waves": 0}, "greater than zero"),
    ],
)
def test_wrong_tables_are_invalid(table, says):
    with pytest.raises(ValidationError, match=says):
        ADAPTER.validate_python(table)


PLANE = TypeAdapter(PlaneSettings)


def test_planes():
    for name, normal in (("xy", [0, 0, 1]), ("xz", [0, -1, 0]), ("yz", [1, 0, 0])):
        plane = build_plane(PLANE.validate_python(name))
        np.testing.assert_array_equal(np.cross(plane.x_axis, plane.y_axis), normal)
    table = {"origin": ["1 m", 0, 0], "x_axis": [3, 4, 0], "y_axis": [0, 0, 2]}
    plane = build_plane(PLANE.validate_python(table))
    flat, away = project(plane, np.array([[1003.0, 4.0, 7.0], [1004.0, -3.0, 0.0]]))
    np.testing.assert_allclose(flat, [[5, 7], [0, 0]], atol=1e-12)
    np.testing.assert_allclose(away, [0, 5], atol=1e-12)


@pytest.mark.parametrize(
    ("x", "y", "says"), [([1, 0, 0], [1e-8, 1, 0], "axes at 89.99"), ([0, 0, 0], [0, 1, 0], "length 0")]
)
def test_planes_with_bad_axes_are_refused(x, y, says):
    with pytest.raises(Refused, match=says):
        build_plane(PLANE.validate_python({"x_axis": x, "y_axis": y}), "rail.plane")
