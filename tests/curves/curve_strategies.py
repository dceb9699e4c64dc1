"""Curves for property tests."""

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st

from isomould.curves.bspline import Nurbs, clamped_knots, periodic, piece_of, segments
from isomould.curves.curve import PlanarCurve, join_pieces

quick = settings(max_examples=20, deadline=None)


def nurbs_curve(spline: Nurbs, closed: bool) -> PlanarCurve:
    return join_pieces(tuple(piece_of(s) for s in segments(spline, "curve")), closed)[0]


@st.composite
def splines(draw):
    """Wandering open splines that go forward in x, so that they have no cusps, with many inflections."""
    degree = draw(st.integers(2, 5))
    count = draw(st.integers(degree + 1, degree + 7))
    number = st.floats(-1, 1, allow_subnormal=False)
    heights = np.array(draw(st.lists(number, min_size=count, max_size=count)))
    weights = [draw(st.floats(0.3, 3)) for _ in range(count)] if draw(st.booleans()) else np.ones(count)
    points = np.column_stack([1000.0 * np.arange(count), 3000.0 * heights])
    return Nurbs(degree, points, np.array(weights), clamped_knots(count, degree))


@st.composite
def convex_closed(draw):
    """Closed convex splines: their control polygons have sorted directions on an oval."""
    count = draw(st.integers(5, 12))
    gaps = np.array(draw(st.lists(st.floats(0.5, 1.5), min_size=count, max_size=count)))
    angles = 2 * np.pi * np.cumsum(gaps) / gaps.sum()
    a, b = draw(st.floats(2000, 20000)), draw(st.floats(2000, 20000))
    points = np.column_stack([a * np.cos(angles), b * np.sin(angles)])
    return nurbs_curve(periodic(points, np.ones(count), draw(st.integers(2, 4))), closed=True)
