"""Curves of parts as polygons: on the side of the material, within 0.05 mm."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from isomould.curves.bezier import Bezier
from isomould.curves.pieces import Ellipse, Line, Piece
from isomould.intake.flattening import OUTWARD, polygon_around

DENSE = np.linspace(0.0, 1.0, 1501)[:-1]
ROUNDING = 0.001


def true_shape(pieces: list[Piece]) -> shapely.Polygon:
    return shapely.Polygon(np.concatenate([piece.point(DENSE) for piece in pieces]))


def backwards(pieces: list[Piece]) -> list[Piece]:
    return [piece.reversed() for piece in pieces[::-1]]


def farthest(polygon: shapely.Polygon, shape: shapely.Polygon) -> float:
    """Give how far corners and middles of sides are off the shape's edge."""
    corners = shapely.get_coordinates(polygon.exterior)
    points = np.vstack([corners, (corners[1:] + corners[:-1]) / 2])
    return float(shapely.distance(shapely.points(points), shape.exterior).max())


def assert_safe(pieces: list[Piece]) -> None:
    """An outline's polygon holds it, a hole's lies in it, and neither is off by more than 0.05 mm."""
    shape = true_shape(pieces)
    assert shape.is_valid
    around = shapely.Polygon(polygon_around(pieces))
    within = shapely.Polygon(polygon_around(backwards(pieces)))
    sliver = ROUNDING * shape.length
    assert shape.difference(around).area < sliver
    assert within.difference(shape).area < sliver
    assert farthest(around, shape) < OUTWARD + 2 * ROUNDING
    assert farthest(within, shape) < OUTWARD + 2 * ROUNDING


@settings(max_examples=6, deadline=None)
@given(st.floats(1, 500), st.floats(0.05, 1.0), st.floats(0, 360))
def test_ellipses(radius: float, ratio: float, turn: float) -> None:
    along = radius * np.array([np.cos(turn), np.sin(turn)])
    across = ratio * np.array([-along[1], along[0]])
    assert_safe([Ellipse((10.0, 20.0), tuple(along.tolist()), tuple(across.tolist()), 0.0, 2 * np.pi)])


@settings(max_examples=4, deadline=None)
@given(st.lists(st.floats(0.6, 1.4), min_size=4, max_size=9), st.floats(5, 500))
def test_splines_that_bulge_in_and_out(reach: list[float], size: float) -> None:
    """A closed chain of cubics through points around a centre, tangents by Catmull and Rom: star-shaped enough."""
    angles = 2 * np.pi * np.arange(len(reach)) / len(reach)
    points = size * np.array(reach)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    tangents = (np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)) / 6
    following = zip(points, tangents, np.roll(points, -1, axis=0), np.roll(tangents, -1, axis=0), strict=True)
    pieces: list[Piece] = [
        Bezier(tuple(map(tuple, np.array([p, p + d, q - e, q]).tolist())), (1.0,) * 4) for p, d, q, e in following
    ]
    assert_safe(pieces)


def test_a_spline_whose_end_points_are_doubled() -> None:
    curve = Bezier(((0.0, 0.0), (0.0, 0.0), (200.0, 300.0), (400.0, 0.0), (400.0, 0.0)), (1.0,) * 5)
    assert_safe([Line((0.0, 0.0), (400.0, 0.0)), curve.reversed()])


@pytest.mark.parametrize("turn", [-1.0, 1.0])
def test_a_straight_spline_stays_straight(turn: float) -> None:
    spline = Bezier(((0.0, 0.0), (100.0, 0.0), (200.0, 0.0), (300.0, 0.0)), (1.0,) * 4)
    rest: list[Piece] = [Line((300.0, 0.0), (150.0, turn * 200)), Line((150.0, turn * 200), (0.0, 0.0))]
    pieces = [spline, *rest] if turn > 0 else backwards([spline, *rest])
    assert shapely.Polygon(polygon_around(pieces)).area == pytest.approx(30_000, abs=1)
