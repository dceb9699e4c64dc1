"""Part lists made from a seed, and hypothesis strategies for small ones."""

import numpy as np
from hypothesis import strategies as st

from isomould.arrays import Floats, round_um
from isomould.nesting.layout import Part
from isomould.nesting.settings import SheetStock, StockSettings

GLASS = SheetStock(name="glass", width=6000, height=3210)


def trapezoid(a: float, h: float, left: float, right: float) -> Floats:
    return round_um(np.array([(0.0, 0.0), (a, 0.0), (a - right, h), (left, h)]))


def rows_of_trapezoids(seed: int, rows: int, strips: int, *, unequal: bool = False) -> tuple[Part, ...]:
    """Make a vault: every row of one height, nearly rectangular panels."""
    chance = np.random.default_rng(seed)
    heights = chance.uniform(800, 1600, rows)
    widths = chance.uniform(700, 2000, strips)
    legs = chance.uniform(1, 15, (rows, strips + 1 if unequal else 1)) * np.ones((rows, strips + 1))
    return tuple(
        Part(f"P{i}-{j}", trapezoid(widths[j] + 20 * i, heights[i], legs[i, j], legs[i, j + 1]), row=i)
        for i in range(rows)
        for j in range(strips)
    )


def convex_polygon(seed: int, size: float) -> Floats:
    """Make a polygon with its corners on an ellipse."""
    chance = np.random.default_rng(seed)
    angles = np.sort(chance.uniform(0, 2 * np.pi, chance.integers(3, 8)) + np.linspace(0, 6, 1))
    spread = np.linspace(0, 2 * np.pi, len(angles), endpoint=False) + 0.3 * np.sin(angles)
    return round_um(size * np.column_stack([np.cos(spread), chance.uniform(0.3, 1) * np.sin(spread)]))


@st.composite
def outlines(draw: st.DrawFn) -> Floats:
    kind = draw(st.sampled_from(["isosceles", "unequal", "right", "lean", "triangle", "rectangle", "polygon"]))
    a, h = draw(st.integers(80, 700)), draw(st.integers(60, 300))
    slant = draw(st.integers(1, a // 3)) + draw(st.integers(0, 999)) / 1000
    legs = {
        "isosceles": (slant, slant),
        "unequal": (slant, slant / 3),
        "right": (0, slant),
        "lean": (slant, -slant),
        "rectangle": (0, 0),
    }
    if kind in legs:
        return trapezoid(a, h, *legs[kind])
    if kind == "triangle":
        return round_um(np.array([(0.0, 0.0), (a, 0.0), (slant, h)]))
    return convex_polygon(draw(st.integers(0, 1000)), a / 2)


@st.composite
def part_lists(draw: st.DrawFn) -> tuple[Part, ...]:
    drawn = draw(st.lists(st.tuples(outlines(), st.integers(1, 5), st.sampled_from([None, 0, 1])), max_size=7))
    parts = [Part(f"P{k:02}", outline, quantity, row) for k, (outline, quantity, row) in enumerate(drawn)]
    return tuple(located(part) for part in parts) if draw(st.booleans()) else tuple(parts)


def located(part: Part) -> Part:
    places = tuple(f"{part.id}-{k}" for k in range(part.quantity))
    return Part(part.id, part.outline, part.quantity, part.row, places)


@st.composite
def racks(draw: st.DrawFn) -> StockSettings:
    gap = draw(st.sampled_from([0.0, 1.0, 5.0, 7.7, 1 / 3]))
    large = SheetStock(name="large", width=2000, height=1500, price=draw(st.sampled_from([0.0, 80.0])))
    small = SheetStock(
        name="small",
        width=900,
        height=850,
        price=30,
        quantity=draw(st.sampled_from([None, 1, 2])),
        grain=draw(st.booleans()),
    )
    return StockSettings(
        sheets=draw(st.sampled_from([(large,), (large, small), (small, large)])),
        gap=gap,
        kerf=draw(st.sampled_from([0.0, gap, gap / 2])),
        trim=draw(st.sampled_from([0.0, 10.0, 12.3456])),
        turning=draw(st.sampled_from(["none", "half", "quarter"])),
        turn_over=draw(st.booleans()),
        guillotine=draw(st.booleans()),
    )
