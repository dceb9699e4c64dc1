"""Bounds against sheets that were full from the start: no bound exceeds what any layout reaches."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nesting_examples import trapezoid

from isomould.arrays import Floats
from isomould.nesting import portfolio
from isomould.nesting.checker import check_layout
from isomould.nesting.layout import Part
from isomould.nesting.nest import nest_sheets
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings, Turning

SIZE = (1000, 600)
GAP = 10


def cuts(draw: st.DrawFn, length: int) -> list[int]:
    """Divide a length into pieces that stand apart by the gap."""
    pieces = draw(st.lists(st.integers(80, 400), min_size=1, max_size=4))
    ends = np.cumsum([piece + GAP for piece in pieces]) - GAP
    return [piece for piece, end in zip(pieces, ends.tolist(), strict=True) if end <= length]


@st.composite
def cut_sheets(draw: st.DrawFn) -> tuple[int, tuple[Part, ...]]:
    """Cut sheets into strips along either side, strips into rectangles; some of these are frames that hold another."""
    parts: list[Part] = []
    sheets = draw(st.integers(1, 3))
    for _ in range(sheets):
        across = draw(st.booleans())
        length, height = SIZE[::-1] if across else SIZE
        for strip in cuts(draw, height):
            for width in cuts(draw, length):
                parts += framed(f"P{len(parts)}", (strip, width) if across else (width, strip), draw(st.booleans()))
    return sheets, tuple(parts)


def framed(name: str, size: tuple[int, int], hollow: bool) -> list[Part]:
    """Give a rectangle, or a frame 20 wide and what is cut from its middle."""
    outline = rectangle(*size)
    if not hollow or min(size) < 150:
        return [Part(name, outline)]
    hole = rectangle(size[0] - 40, size[1] - 40) + 20
    inner = rectangle(size[0] - 40 - 2 * GAP, size[1] - 40 - 2 * GAP)
    return [Part(name, outline, holes=(hole,)), Part(f"{name}-inner", inner)]


def rectangle(width: float, height: float) -> Floats:
    return trapezoid(width, height, 0, 0)


@settings(max_examples=60, deadline=None)
@given(cut_sheets(), st.sampled_from(["none", "half", "quarter"]), st.booleans())
def test_no_bound_exceeds_what_is_known_to_do(
    made: tuple[int, tuple[Part, ...]], turning: Turning, generated: bool
) -> None:
    """Bounds of patterns hold for strips along either side, not for parts that lie in others' holes."""
    sheets, parts = made
    stock = StockSettings(
        sheets=(SheetStock(name="s", width=SIZE[0], height=SIZE[1]),), gap=GAP, turning=turning, trim=0
    )
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(portfolio, "LOSS", 0.0 if generated else portfolio.LOSS)
        layout = nest_sheets(parts, stock, Search("normal"))
    assert check_layout(parts, stock, layout) == ()
    assert layout.bound <= sheets
    if not any(part.holes for part in parts):
        assert (layout.pattern_bound or 0) <= sheets


@pytest.mark.parametrize("turning", ["none", "half", "quarter"])
def test_the_first_cut_runs_along_either_side(turning: Turning) -> None:
    """Columns of 300 + 300 and of 200 three times fill the sheet's height, no strip of one height its length."""
    heights = [300, 300, 200, 200, 200]
    stock = StockSettings(sheets=(SheetStock(name="s", width=1000, height=600),), gap=0, turning=turning)
    parts = [Part(f"{k}", rectangle(510 if h == 300 else 490, h), 6) for k, h in enumerate(heights)]
    layout = nest_sheets(parts, stock, Search("normal"))
    assert (len(layout.sheets), layout.bound) == (6, 6)
    assert {item.rotation_deg for item in layout.placements} <= {0, 180} or turning == "quarter"
