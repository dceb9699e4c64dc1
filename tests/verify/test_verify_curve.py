"""The verifier's own curves: derivatives by differences, turning by tangents, distances by search."""

import numpy as np
import pytest

from isomould.verify.curve import distance_to, evaluate, turned_at, turned_within
from isomould.verify.rules import Unreadable

PIECES = [
    {"kind": "line", "start": [1, 2], "end": [5, -1]},
    {"kind": "ellipse", "centre": [1, 2], "major": [5, 1], "minor": [-0.5, 2], "start": 0.3, "end": 2.9},
    {"kind": "ellipse", "centre": [1, 2], "major": [5, 1], "minor": [-0.5, 2], "start": 2.0, "end": -1.0},
    {"kind": "sine", "origin": [0, 1], "along": [2, 0.1], "across": [0, 3], "start": -1.0, "end": 4.0},
    {"kind": "catenary", "origin": [0, 1], "along": [2, 0], "across": [0, -2], "start": -1.5, "end": 1.0},
    {"kind": "bezier", "points": [[0, 0], [1, 3], [4, 3], [6, -1]], "weights": [1, 0.7, 1.4, 1]},
    {"kind": "bezier", "points": [[0, 0], [1, 3]], "weights": [1, 1]},
]
NAMES = [f"{piece['kind']} {number}" for number, piece in enumerate(PIECES)]
T = np.linspace(0.05, 0.95, 13)


@pytest.mark.parametrize("piece", PIECES, ids=NAMES)
def test_derivatives_are_those_of_the_points(piece):
    h = 1e-4
    before, here, after = (evaluate(piece, T + k * h) for k in (-1, 0, 1))
    np.testing.assert_allclose((after[0] - before[0]) / (2 * h), here[1], rtol=0, atol=1e-5)
    np.testing.assert_allclose((after[1] - before[1]) / (2 * h), here[2], rtol=0, atol=1e-4)


@pytest.mark.parametrize("piece", PIECES, ids=NAMES)
def test_integral_of_curvature_is_the_turning_of_the_tangent(piece):
    tangents = evaluate(piece, np.linspace(0, 0.8, 400))[1]
    theta = np.unwrap(np.arctan2(tangents[:, 1], tangents[:, 0]))
    assert turned_within(piece, 0.8) == pytest.approx(theta[-1] - theta[0], abs=1e-11)


def test_a_circle_of_two_arcs_turns_once_with_its_joints():
    arcs = tuple({**PIECES[1], "start": a, "end": a + np.pi} for a in (0.2, 0.2 + np.pi))
    angles, whole = turned_at(arcs, [(0, 0.0), (1, 0.0), (1, 1.0)], closed=True)
    assert whole == pytest.approx(2 * np.pi, abs=1e-12)
    assert angles == pytest.approx([0, np.pi, 2 * np.pi], abs=1e-12)


def test_a_cusp_is_no_curve():
    cusp = {"kind": "bezier", "points": [[0, 0], [1, 1], [0, 1], [1, 0]], "weights": [1, 1, 1, 1]}
    with pytest.raises(Unreadable, match="does not integrate"):
        turned_within(cusp, 1.0)


def test_distance_to_a_circle():
    circle = ({"kind": "ellipse", "centre": [0, 0], "major": [3, 0], "minor": [0, 3], "start": 0, "end": 2 * np.pi},)
    points = np.array([[4.0, 1.0], [0.5, -0.2], [-3.0, 0.001]])
    assert distance_to(circle, points) == pytest.approx(abs(np.hypot(*points.T) - 3), abs=1e-12)
