"""Parts turned over: mirror images are one kind where they may be."""

import numpy as np
import pytest
from nesting_examples import trapezoid

from isomould.nesting.checker import check_layout
from isomould.nesting.layout import Part
from isomould.nesting.nest import nest_blanks
from isomould.nesting.settings import StockSettings
from isomould.nesting.shapes import stand, turn_over

LEFT, RIGHT = trapezoid(1000, 800, -300, 300), trapezoid(1000, 800, 300, -300)


def used(*, turned: bool) -> tuple[float, int]:
    """Length of the blanks for left and right panels, and the pieces turned over."""
    parts = [Part("L", LEFT), Part("R", RIGHT)]
    stock = StockSettings(gap=5, turn_over=turned)
    layout = nest_blanks(parts, stock)
    assert check_layout(parts, stock, layout) == ()
    return sum(sheet.width for sheet in layout.sheets), sum(item.turned_over for item in layout.placements)


def test_mirror_images_nest_as_one_kind() -> None:
    """Leg to leg, where each would take its box."""
    (apart, none), (together, some) = used(turned=False), used(turned=True)
    assert (none, some) == (0, 1)
    assert apart - together > 280


@pytest.mark.parametrize("rotation_deg", [0, 90, 180, 270])
def test_turning_over_twice_gives_the_shape_back(rotation_deg: int) -> None:
    shape = stand(LEFT, rotation_deg)
    again = turn_over(turn_over(shape))
    assert (again.rotation_deg, again.turned_over) == (rotation_deg, False)
    assert np.array_equal(again.points, shape.points)
    assert (turn_over(shape).left, turn_over(shape).right) == (-shape.right, -shape.left)
