"""Chains head to tail: what their two ends take."""

import pytest
from nesting_examples import trapezoid

from isomould.nesting.layout import Part
from isomould.nesting.nest import nest_blanks, nest_sheets
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings

STOCK = StockSettings(sheets=(SheetStock(name="s", width=2500, height=1500),), gap=5)
RIGHT = Part("R", trapezoid(1000, 700, 0, 600), 40)


@pytest.mark.parametrize(
    ("part", "sheets"),
    [
        (RIGHT, 7),
        (Part("I", trapezoid(1000, 700, 300, 300), 40), 7),
        (Part("T", trapezoid(800, 600, 0, 800)[:3], 20), 2),
    ],
    ids=["right", "isosceles", "triangle"],
)
def test_three_to_a_strip_and_two_strips_to_a_sheet(part: Part, sheets: int) -> None:
    assert len(nest_sheets([part], STOCK, Search("quick")).sheets) == sheets


def test_a_pair_of_right_trapezoids_is_a_rectangle() -> None:
    """Long and short side beside each other, 1000 + 400, and 5 mm square to a leg of 600 in 700."""
    pair = Part("R", RIGHT.outline, 2)
    joint = 5 * (1 + (600 / 700) ** 2) ** 0.5
    layout = nest_blanks([pair], StockSettings(gap=5, max_blank_length=1410))
    assert [sheet.width for sheet in layout.sheets] == [pytest.approx(1400 + joint, abs=0.005)]


def test_without_half_turns_a_chain_ends_with_one_leg_of_each() -> None:
    """Parallelograms stand in each other's lee whatever their number."""
    lean = Part("L", trapezoid(600, 700, 200, -200), 4)
    layout = nest_blanks([lean], StockSettings(gap=5, turning="none"))
    joint = 5 * (1 + (200 / 700) ** 2) ** 0.5
    assert layout.sheets[0].width == pytest.approx(4 * 600 + 3 * joint + 200, abs=0.005)
