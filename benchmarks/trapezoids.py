"""Part lists of 240 different parts of twelve heights, from a seed, as trimmed and triangulated skins leave them.

`isosceles` have equal legs, `right` an upright one, `triangles` an upright leg and no short side, `skew` two legs of
their own. No two parts of a list have equal slopes.
"""

import numpy as np

from isomould.arrays import round_um
from isomould.nesting.layout import Part
from isomould.nesting.settings import SheetStock, StockSettings

SHAPES = ("isosceles", "right", "triangles", "skew")
STOCK = StockSettings(sheets=(SheetStock(name="sheet", width=3000, height=1500),), gap=5, trim=10)
HEIGHTS, EACH = 12, 20


def trapezoids(shape: str, seed: int) -> tuple[Part, ...]:
    """Make 240 parts, lengths in mm."""
    chance = np.random.default_rng([seed, SHAPES.index(shape)])
    heights = np.round(chance.uniform(260, 700, HEIGHTS))
    return tuple(
        Part(f"P{row:02}-{k:02}", one(shape, chance, float(height)), row=row)
        for row, height in enumerate(heights)
        for k in range(EACH)
    )


def one(shape: str, chance: np.random.Generator, height: float) -> np.ndarray:
    """Draw the outline of one part."""
    long = chance.uniform(450, 1100)
    lost = long * chance.uniform(0.1, 0.6)
    share = chance.uniform(0.1, 0.9)
    left = {"isosceles": lost / 2, "right": 0.0, "triangles": 0.0, "skew": share * lost}[shape]
    right = long if shape == "triangles" else lost - left
    corners = [(0.0, 0.0), (long, 0.0), (long - right, height), (left, height)]
    return round_um(np.array(corners[:3] if shape == "triangles" else corners))
