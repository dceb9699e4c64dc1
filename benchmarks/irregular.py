"""Sheets for concave parts by their hulls and in each other's hollows: the table in docs/nesting.md.

    python benchmarks/irregular.py [quick|normal|best]

Five lists of our own, sheets of 3000 x 1500 mm, gap 5 mm, trim 10 mm, quarter turns. Bound: by the areas of the parts.
Every layout is proved by the checker before it is counted. Seconds are the processor's, of the engine's processes too.
"""

import os
import sys

import numpy as np
import shapely

from isomould.nesting.checker import check_layout
from isomould.nesting.irregular import nest_parts
from isomould.nesting.layout import Part
from isomould.nesting.nest import nest_sheets
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings

STOCK = StockSettings(sheets=(SheetStock(name="3000 x 1500", width=3000, height=1500),), gap=5, trim=10)

Corners = list[tuple[float, float]]


def angle(width: float, height: float, leg: float) -> Corners:
    return [(0, 0), (width, 0), (width, leg), (leg, leg), (leg, height), (0, height)]


def channel(width: float, height: float, leg: float) -> Corners:
    inside = [(width - leg, height), (width - leg, leg), (leg, leg), (leg, height)]
    return [(0, 0), (width, 0), (width, height), *inside, (0, height)]


def zed(width: float, height: float, leg: float) -> Corners:
    across = (width - leg) / 2
    lower = [(0, 0), (across + leg, 0), (across + leg, height - leg), (width, height - leg)]
    return [*lower, (width, height), (across, height), (across, leg), (0, leg)]


def tee(width: float, height: float, leg: float) -> Corners:
    left, right = (width - leg) / 2, (width + leg) / 2
    stem = [(left, 0), (right, 0), (right, height - leg)]
    return [*stem, (width, height - leg), (width, height), (0, height), (0, height - leg), (left, height - leg)]


def sickle(radius: float, width: float) -> Corners:
    """Half a ring."""
    turns = np.linspace(0, np.pi, 33)
    arc = np.column_stack([np.cos(turns), np.sin(turns)])
    return [tuple(point) for point in np.round(np.vstack([radius * arc, (radius - width) * arc[::-1]]), 3).tolist()]


def star(reach: float, tips: int) -> Corners:
    turns = np.pi * np.arange(2 * tips) / tips
    radii = np.where(np.arange(2 * tips) % 2, 0.45, 1.0) * reach
    return [
        tuple(point) for point in np.round(radii[:, None] * np.column_stack([np.cos(turns), np.sin(turns)]), 3).tolist()
    ]


INSTANCES: dict[str, list[tuple[Corners, int]]] = {
    "angles": [(angle(900, 900, 200), 12), (angle(700, 500, 150), 18)],
    "channels": [(channel(800, 500, 120), 16), (channel(500, 500, 100), 16)],
    "zeds and tees": [(zed(700, 500, 150), 18), (tee(600, 500, 140), 18), (angle(400, 300, 100), 20)],
    "half rings": [(sickle(450, 120), 18), (sickle(250, 90), 24)],
    "stars and gussets": [(star(350, 5), 14), (star(200, 6), 20), ([(0, 0), (600, 0), (150, 150), (0, 600)], 20)],
}


def main() -> None:
    effort = sys.argv[1] if len(sys.argv) > 1 else "quick"
    print("| instance | pieces | hulls over parts | by hulls | interlocked | bound | yield % | seconds |")
    print("| --- " * 8 + "|")
    for name, shapes in INSTANCES.items():
        print(line(name, shapes, effort), flush=True)


def line(name: str, shapes: list[tuple[Corners, int]], effort: str) -> str:
    parts = [Part(f"P{k}", np.array(corners, dtype=float), count) for k, (corners, count) in enumerate(shapes)]
    polygons = [shapely.Polygon(part.outline) for part in parts for _ in range(part.quantity)]
    waste = sum(polygon.convex_hull.area for polygon in polygons) / sum(polygon.area for polygon in polygons) - 1
    hulls = nest_sheets(parts, STOCK, Search(effort))
    start = sum(os.times()[:4])
    found = nest_parts(parts, STOCK, Search(effort))
    seconds = sum(os.times()[:4]) - start
    findings = check_layout(parts, found.stock, found.layout)
    assert not findings, findings[0]
    layout = found.layout
    counts = (len(polygons), f"+{100 * waste:.0f} %", len(hulls.sheets), len(layout.sheets), layout.bound)
    cells = (name, *counts, f"{layout.yield_percent:.1f}", f"{seconds:.0f}")
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


if __name__ == "__main__":
    main()
