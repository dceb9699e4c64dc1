"""Curves in space: tables and drawings, exact evaluation, what is refused."""

import ezdxf
import numpy as np
import pytest
from pydantic import TypeAdapter
from scipy.interpolate import BSpline, CubicSpline

from isomould.curves.lengths import length, parameter_at
from isomould.curves.settings import CurveSettings
from isomould.curves.spatial_settings import build_spatial_curve
from isomould.errors import Refused
from isomould.verify.curve import distance_to, evaluate

POINTS = [[0, 0, 0], [3, 1, 0.5], [6, 1.5, 2], [9, -1, 2.5], [13, -2, 1]]


def build(folder=None, **table):
    return build_spatial_curve(TypeAdapter(CurveSettings).validate_python(table), folder, "rail.curve").curve


def dense(curve, count=60):
    piece = np.repeat(np.arange(len(curve.pieces)), count)
    return piece, np.tile(np.linspace(0, 1, count), len(curve.pieces))


def test_a_spline_is_the_cubic_through_its_points():
    curve = build(kind="spline", units="m", points=POINTS)
    points = np.array(POINTS) * 1000
    at = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    piece, t = dense(curve)
    expected = CubicSpline(at, points, bc_type="natural")(at[piece] + t * np.diff(at)[piece])
    np.testing.assert_allclose(curve.point(piece, t), expected, atol=1e-8)


def test_a_bspline_with_weights():
    weights = [1, 2, 1, 0.5, 1]
    curve = build(kind="bspline", degree=2, points=[[1000 * c for c in p] for p in POINTS], weights=weights)
    rows = np.column_stack([np.array(POINTS) * 1000 * np.array(weights)[:, None], weights])
    piece, t = dense(curve)
    homogeneous = BSpline([0, 0, 0, 1, 2, 3, 3, 3], rows, 2)(piece + t)
    np.testing.assert_allclose(curve.point(piece, t), homogeneous[:, :3] / homogeneous[:, 3:], atol=1e-8)


def test_derivatives_and_lengths():
    curve = build(kind="spline", units="m", points=POINTS, closed=True)
    piece, t = dense(curve, 9)
    h = 1e-6
    numeric = (curve.point(piece, t + h) - curve.point(piece, t - h)) / (2 * h)
    np.testing.assert_allclose(curve.derivative(piece, t), numeric, rtol=1e-5, atol=1e-2)
    fine = curve.point(*dense(curve, 20_000))
    assert length(curve) == pytest.approx(np.linalg.norm(np.diff(fine, axis=0), axis=1).sum(), rel=1e-7)
    halves = curve.point(*parameter_at(curve, np.array([0.0, length(curve)])))
    np.testing.assert_allclose(halves[0], halves[1], atol=1e-6)


def test_an_upright_line_has_a_length():
    curve = build(kind="polyline", points=[[0, 0, 0], [0, 0, 4000], [3000, 0, 4000]])
    assert length(curve) == pytest.approx(7000)


@pytest.mark.parametrize("kind", ["spline", "polyline", "bspline"])
def test_descriptors_mean_the_same_to_the_verifier(kind):
    curve = build(kind=kind, units="m", points=POINTS)
    t = np.linspace(0, 1, 7)
    for k, piece in enumerate(curve.describe()):
        place = np.full(7, k)
        np.testing.assert_allclose(evaluate(piece, t)[0], curve.point(place, t), atol=1e-8)
        np.testing.assert_allclose(evaluate(piece, t)[1], curve.derivative(place, t), atol=1e-7)
    beside = curve.point(np.array([1]), np.array([0.4])) + np.array([0, 0, 2e-3])
    assert 0 < distance_to(tuple(curve.describe()), beside)[0] <= 2e-3 + 1e-9


def drawn(path, draw, units=6):
    document = ezdxf.new()
    document.header["$INSUNITS"] = units
    document.layers.add("RAIL")
    draw(document.modelspace(), {"layer": "RAIL"})
    document.saveas(path)
    return path


def read(path, **more):
    return build(path.parent, kind="dxf", file=path.name, layer="RAIL", drawn="world", **more)


def test_a_polyline_drawn_in_space(tmp_path):
    path = drawn(tmp_path / "rail.dxf", lambda space, on: space.add_polyline3d(POINTS, dxfattribs=on))
    curve = read(path)
    every = np.arange(len(curve.pieces))
    np.testing.assert_allclose(curve.point(every, 0 * every), np.array(POINTS[:-1]) * 1000)
    assert not curve.closed


def test_a_spline_drawn_in_space(tmp_path):
    path = drawn(tmp_path / "rail.dxf", lambda space, on: space.add_open_spline(POINTS, degree=3, dxfattribs=on))
    curve, table = read(path), build(kind="bspline", units="m", points=POINTS)
    piece, t = dense(table)
    np.testing.assert_allclose(curve.point(piece, t), table.point(piece, t), atol=1e-6)


def test_lines_and_an_arc_in_any_order_and_plane(tmp_path):
    """An arc in the upright plane x = 5 m joins two lines, drawn out of order and backwards; one end may be off."""

    def draw(space, on, gap=0.0):
        space.add_line((5, 5, 9 + gap), (2, 5, 9), dxfattribs=on)
        space.add_line((0, 0, 4), (5, 0, 4), dxfattribs=on)
        space.add_arc((0, 9, 5), 5, 270, 0, dxfattribs={**on, "extrusion": (1, 0, 0)})

    curve = read(drawn(tmp_path / "joined.dxf", draw))
    assert len(curve.pieces) == 3
    assert length(curve) == pytest.approx(8000 + 2500 * np.pi)
    with pytest.raises(Refused, match=r"E-DRAWN-CURVES.*nearest ends are 0.02 mm"):
        read(drawn(tmp_path / "parted.dxf", lambda space, on: draw(space, on, 2e-5)))
    near = read(drawn(tmp_path / "near.dxf", lambda space, on: draw(space, on, 5e-6)))
    assert len(near.pieces) == 3
    assert length(near) == pytest.approx(length(curve), abs=0.01)


def test_a_closed_spline_through_fit_points(tmp_path):
    def draw(space, on):
        space.add_spline([*POINTS, POINTS[0]], dxfattribs={**on, "flags": 9})

    curve = read(drawn(tmp_path / "rail.dxf", draw))
    assert curve.closed


@pytest.mark.parametrize(
    ("table", "code"),
    [
        ({"kind": "spline", "points": [[0, 0, 0]]}, "E-CURVE-POINTS"),
        ({"kind": "polyline", "points": [[0, 0, 0], [0, 0, 0]]}, "E-CURVE"),
        ({"kind": "polyline", "points": [[0, 0, 0], [9000, 0, 0], [0, 0, 0]]}, "E-CURVE-CLOSED"),
        ({"kind": "polyline", "points": [[0, 0, 0], [0.1, 0, 0.1]]}, "E-CURVE-SIZE"),
        ({"kind": "bspline", "degree": 3, "points": [[0, 0, 0], [9000, 0, 1]]}, "E-SPLINE-POINTS"),
        ({"kind": "bspline", "degree": 2, "points": [[0, 0, 0], [9000, 0, 0], [0, 0, 1e-9]]}, "E-CURVE-C"),
        ({"kind": "dxf", "file": "rail.dxf", "layer": "RAIL"}, "E-CURVE-PLANAR rail.curve.drawn"),
        ({"kind": "sine", "amplitude": 1000, "wavelength": 9000, "waves": 1}, "E-CURVE-PLANAR"),
    ],
)
def test_refused(table, code, tmp_path):
    with pytest.raises(Refused, match=code):
        build(tmp_path, **table)
