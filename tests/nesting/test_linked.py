"""Chains of parts whose slopes all differ."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nesting_examples import racks, trapezoid

from isomould.nesting.checker import check_layout
from isomould.nesting.layout import Part
from isomould.nesting.linked import chain_order, link_layer, trace_linked
from isomould.nesting.nest import nest_blanks, nest_sheets
from isomould.nesting.rack import classes_by_kind, sort_classes
from isomould.nesting.search import Effort, Search
from isomould.nesting.settings import SheetStock, StockSettings, Turning
from isomould.nesting.strips import Grid

STOCK = StockSettings(sheets=(SheetStock(name="s", width=2000, height=1000),), gap=5)


def triangle(name: str, base: float, height: float, quantity: int = 1) -> Part:
    return Part(name, trapezoid(base, height, 0, base)[:3], quantity)


@st.composite
def slanted_lists(draw: st.DrawFn) -> tuple[Part, ...]:
    """Draw parts of two heights, legs leaning either way, some with no short side."""
    parts: list[Part] = []
    for k in range(draw(st.integers(2, 12))):
        a, h = draw(st.integers(100, 700)), draw(st.sampled_from([200, 310]))
        left = draw(st.integers(-200, a - 1)) + draw(st.integers(0, 999)) / 1000
        right = draw(st.one_of(st.just(a - left), st.integers(-200, int(a - left))))
        corners = trapezoid(a, h, left, float(right))
        outline = corners[:3] if abs(a - left - right) < 0.01 else corners
        parts.append(Part(f"P{k:02}", outline, draw(st.integers(1, 3))))
    return tuple(parts)


@settings(max_examples=25, deadline=None)
@given(slanted_lists(), racks(), st.sampled_from(["quick", "normal"]))
def test_chains_of_all_slopes_are_proved(parts: tuple[Part, ...], stock: StockSettings, effort: Effort) -> None:
    fitting = tuple(part for part in parts if np.ptp(part.outline[:, 0]) < 800)
    layout = nest_sheets(fitting, stock, Search(effort))
    assert check_layout(fitting, stock, layout) == ()
    assert not layout.unplaced
    blanks = stock.model_copy(update={"sheets": ()})
    assert check_layout(fitting, blanks, nest_blanks(fitting, blanks)) == ()


def test_right_triangles_pair_with_the_nearest() -> None:
    """Four triangles are two rectangles, as wide as the wider of each pair and the gap along its slope."""
    parts = [triangle(f"{base}", base, 400) for base in (500, 300, 520, 330)]
    layout = nest_blanks(parts, StockSettings(gap=5))
    pairs = 520 + 330 + 5 * (np.hypot(1, 520 / 400) + np.hypot(1, 330 / 400) + 1)
    assert [sheet.width for sheet in layout.sheets] == [pytest.approx(pairs, abs=1)]


def test_forty_right_triangles_take_half_their_boxes() -> None:
    parts = [triangle(f"{k}", 400 + 11.3 * k, 490) for k in range(40)]
    boxes = sum(float(np.prod(np.ptp(part.outline, axis=0))) for part in parts) / (2000 * 1000)
    layout = nest_sheets(parts, STOCK, Search("quick"))
    assert boxes > 6
    assert len(layout.sheets) == 4


@pytest.mark.parametrize("turning", ["none", "half"])
def test_the_best_chain_is_found_among_all_that_keep_the_order(turning: Turning) -> None:
    """Five parts whose worth is their number: as many as fit, against every choice in order and way by hand."""
    parts = [Part(f"{k}", trapezoid(300 + 40 * k, 300, 20 + 31 * k, 90 - 43 * k)) for k in range(5)]
    grid = Grid(1000, 5000.0, flips=turning == "half")
    kind = next(kind for kind in classes_by_kind(sort_classes(parts), lambda _: (0,), grid) if kind.links)
    best = np.zeros(1101)
    layer = link_layer(kind, list(kind.items), best, np.ones(5), grid)
    chain, rest = trace_linked(layer, 1100)
    assert (len(chain), rest >= 0) == (most_in_order(layer.links, 1100), True)
    assert best[-1] == len(chain)
    assert [item.part for item in chain] == [item.part for item in layer.items if item.part in {c.part for c in chain}]


def most_in_order(links: object, room: int) -> int:
    """Try every subset in order and both ways to begin."""
    most, (ways, count) = 0, links.start.shape  # type: ignore[attr-defined]
    for subset in range(1, 2**count):
        chosen = [k for k in range(count) if subset >> k & 1]
        for first in range(ways):
            lie = [(first + n) % ways for n in range(len(chosen))]
            length = links.start[lie[0], chosen[0]] + links.end[lie[-1], chosen[-1]]  # type: ignore[attr-defined]
            steps = zip(pairwise(chosen), lie[1:], strict=True)
            length += sum(links.joint[way, one, other] for (one, other), way in steps)  # type: ignore[attr-defined]
            most = max(most, len(chosen) if length <= room else 0)
    return most


def test_neighbours_in_the_order_have_like_legs() -> None:
    """Right legs meet in pairs of neighbours by slope, and so do left legs: 0-1, 2-3 and 0-2, 1-3."""
    legs = [(10.0, 10.0), (50.0, 12.0), (13.0, 80.0), (56.0, 90.0)]
    parts = [Part(f"{k}", trapezoid(400, 200, *pair)) for k, pair in enumerate(legs)]
    grid = Grid(1000, 1000.0, flips=False)
    items = [item for kind in classes_by_kind(sort_classes(parts), lambda _: (0,), grid) for item in kind.items]
    ring = [sorted(items, key=lambda item: item.part)[k].part for k in chain_order(sorted(items, key=lambda i: i.part))]
    assert {frozenset(pair) for pair in pairwise([*ring, ring[0]])} == {
        frozenset(pair) for pair in ((0, 1), (2, 3), (0, 2), (1, 3))
    }
