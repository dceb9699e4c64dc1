"""Neighbours in a strip against shapely's distances."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from nesting_examples import outlines

from isomould.arrays import Floats
from isomould.nesting.shapes import UM, Shape, advance, stand, turn_half

GAPS = st.sampled_from([0.0, 1.0, 5.0, 7.7])
TURNS = st.sampled_from([0, 90, 180, 270])


def polygon(shape: Shape, x: int = 0) -> shapely.Polygon:
    return shapely.Polygon((shape.points + np.array([x, 0])) / UM)


@settings(max_examples=100, deadline=None)
@given(outlines(), outlines(), GAPS, TURNS)
def test_neighbours_keep_the_gap_and_waste_none_along_a_leg(one: Floats, other: Floats, gap: float, turn: int) -> None:
    left, right = stand(one, turn), stand(other, 0)
    step, normal = advance(left, right, gap * UM)
    distance = polygon(left).distance(polygon(right, step))
    assert distance >= gap - 1e-6
    along = (right.hull @ normal).min() + step * normal[0] - (left.hull @ normal).max()
    assert abs(along / np.hypot(*normal) / UM - gap) < 0.001


@given(outlines(), GAPS)
def test_head_to_tail_copies_stand_exactly_the_gap_apart(outline: Floats, gap: float) -> None:
    one = stand(outline, 0)
    step, _ = advance(one, turn_half(one), gap * UM)
    shifted = polygon(turn_half(one), step)
    assert polygon(one).distance(shifted) >= gap - 1e-6
    assert step <= one.width + gap * UM + 1


@given(outlines(), TURNS)
def test_shape_stands_in_its_trapezoid(outline: Floats, turn: int) -> None:
    shape = stand(outline, turn)
    assert shape.points.min(axis=0).tolist() == [0, 0]
    half = shape.height / 2
    left = shape.points[:, 0] - shape.left * (shape.points[:, 1] - half)
    right = shape.points[:, 0] - shape.right * (shape.points[:, 1] - half)
    assert right.max() - left.min() <= shape.mean + 1e-6 * shape.width
    assert turn_half(turn_half(shape)).points.tolist() == shape.points.tolist()
