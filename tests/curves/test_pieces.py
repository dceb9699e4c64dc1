import json
from itertools import pairwise

import numpy as np
import pytest

from isomould.curves.bezier import Bezier
from isomould.curves.curve import piece_from
from isomould.curves.pieces import Catenary, Ellipse, Line, Sine
from isomould.curves.turning import turn

PIECES = [
    Line((1.0, 2.0), (30.0, -4.0)),
    Ellipse((5.0, 1.0), (20.0, 3.0), (1.0, 7.0), 0.4, 9.0),
    Ellipse((5.0, 1.0), (20.0, 0.0), (0.0, 7.0), 2.0, -1.0),
    Sine((0.0, 1.0), (3.0, 1.0), (-2.0, 9.0), -1.0, 8.0),
    Catenary((0.0, 1.0), (3.0, 1.0), (-2.0, 9.0), -1.0, 2.0),
    Bezier(((0.0, 0.0), (3.0, 9.0)), (1.0, 1.0)),
    Bezier(((0.0, 0.0), (3.0, 9.0)), (1.0, 3.0)),
    Bezier(((0.0, 0.0), (3.0, 9.0), (8.0, 1.0)), (1.0, 0.5, 2.0)),
    Bezier(((0.0, 0.0), (3.0, 9.0), (8.0, -9.0), (12.0, 1.0)), (1.0, 1.0, 1.0, 1.0)),
    Bezier(((0.0, 0.0), (3.0, 9.0), (8.0, -9.0), (12.0, 1.0), (14.0, 2.0)), (1.0, 2.0, 0.3, 1.0, 1.0)),
]
T = np.linspace(0, 1, 41)


@pytest.fixture(params=PIECES, ids=[f"{k}-{piece.kind}" for k, piece in enumerate(PIECES)])
def piece(request):
    return request.param


def test_derivatives_are_those_of_the_points(piece):
    t, h = T[1:-1], 1e-5
    slope = (piece.point(t + h) - piece.point(t - h)) / (2 * h)
    bend = (piece.derivative(t + h) - piece.derivative(t - h)) / (2 * h)
    size = np.abs(piece.derivative(t)).max()
    np.testing.assert_allclose(piece.derivative(t), slope, atol=1e-6 * size)
    np.testing.assert_allclose(piece.second(t), bend, atol=1e-6 * (size + np.abs(bend).max()))


def test_reversed_runs_backwards(piece):
    np.testing.assert_allclose(piece.reversed().point(T), piece.point(1 - T), atol=1e-13)
    assert piece.reversed().reversed() == piece


def test_mapped_maps_the_points(piece):
    matrix, offset = np.array([[2.0, 0.5], [-1.0, 0.7]]), np.array([100.0, -3.0])
    np.testing.assert_allclose(piece.mapped(matrix, offset).point(T), piece.point(T) @ matrix.T + offset, atol=1e-12)


def test_descriptor_survives_json(piece):
    assert piece_from(json.loads(json.dumps(piece.describe()))) == piece


def test_between_splits_the_tangent_turns_one_way_by_less_than_a_half_turn(piece):
    fences = np.concatenate([[0.0], piece.splits(), [1.0]])
    assert np.all(np.diff(fences) > 0)
    for low, high in pairwise(fences):
        tangents = piece.derivative(np.linspace(low, high, 201))
        steps = turn(tangents[:-1], tangents[1:])
        assert steps.min() > -1e-9 or steps.max() < 1e-9
        assert abs(steps.sum()) < np.pi


def test_least_speed_is_found_within_a_small_factor(piece):
    least = np.hypot(*piece.derivative(np.linspace(0, 1, 20001)).T).min()
    assert least / 4 <= piece.least_speed() <= least * 4


def test_a_descriptor_of_an_unknown_kind_is_an_error():
    with pytest.raises(KeyError):
        piece_from({"kind": "clothoid"})


def test_far_from_the_origin_a_bezier_keeps_its_shape():
    here = PIECES[-1]
    there = here.mapped(np.eye(2), np.array([4.0e6, 4.0e6]))
    np.testing.assert_allclose(there.derivative(T), here.derivative(T), atol=1e-7)
    assert there.splits().size == here.splits().size
