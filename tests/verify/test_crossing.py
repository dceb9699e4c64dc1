"""V13's own geometry: against cases known by hand, and against the maker's, which asks for separating axes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from isomould.form.clash import Polygons, clashes
from isomould.verify.checks.crossing import _common

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float) * 100
UPRIGHT = SQUARE[:, [0, 2, 1]]
CASES = {  # the second polygon, and the length or root of the area that both share
    "upright, half way": (np.add(UPRIGHT, [60, 50, -50]), 40),
    "upright, inside": (np.add(UPRIGHT / 4, [30, 50, -10]), 25),
    "upright, standing on it": (np.add(UPRIGHT, [0, 50, 0]), 0),
    "in its plane": (np.add(SQUARE, [50, 50, 0]), 50),
    "beside it": (np.add(SQUARE, [100, 0, 0]), 0),
    "over it": (np.add(SQUARE, [0, 0, 0.001]), 0),
    "upright beside it": (np.add(UPRIGHT, [100.001, 50, -50]), 0),
}


@pytest.mark.parametrize("case", CASES)
def test_what_two_squares_share(case):
    other, length = CASES[case]
    assert _common(np.stack([SQUARE, other])[None]) == pytest.approx([length], abs=1e-9)


def test_a_repeated_corner_changes_nothing():
    triangle = np.array([[10, 50, -50], [90, 50, -50], [50, 50, 50], [50, 50, 50]], float)
    assert _common(np.stack([SQUARE, triangle])[None]) == pytest.approx([40])


@settings(max_examples=150, deadline=None)
@given(st.lists(st.floats(-1, 1), min_size=6, max_size=6))
def test_maker_and_checker_agree(numbers):
    shift, axis = 80 * np.array(numbers[:3]), 3 * np.array(numbers[3:])
    angle = np.linalg.norm(axis)
    k = np.cross(np.eye(3), axis / angle) if angle > 1e-3 else np.zeros((3, 3))
    other = SQUARE @ (np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k) + shift
    pair = np.stack([SQUARE, other])
    _, depths = clashes(Polygons(pair, np.arange(8).reshape(2, 4)))
    (common,) = _common(pair[None])
    if depths.size and depths[0] > 1e-3:
        assert common > 0
    if common > 0.1:
        assert depths.size
