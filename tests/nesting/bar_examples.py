"""Members and bars drawn by lot, and the best cutting of a few by trying all."""

from collections.abc import Sequence
from functools import cache

import numpy as np
import shapely

from isomould.nesting.layout import Member
from isomould.nesting.settings import BarStock, StockSettings

DEPTH = 200.0

Outline = tuple[tuple[float, float], ...]

Best = tuple[int, float, int]
"""Pieces left, cost and number of bars."""


def plate(length: float, left: float, right: float, tongue: float = 0.0) -> Outline:
    """A plate with slanted ends: `left` and `right` are x at the top less x at the bottom, tongues lower than it."""
    h = DEPTH / 2
    t = h - tongue
    start, end = abs(left) / 2, length - abs(right) / 2
    outer = [(start + y * left / DEPTH, y) for y in (t, -t)], [(end + y * right / DEPTH, y) for y in (-t, t)]
    inner = [(start + 30, -h), (end - 30, -h)], [(end - 30, h), (start + 30, h)]
    points = [*outer[0], *inner[0], *outer[1], *inner[1]] if tongue else [*outer[0], *outer[1]]
    low = min(x for x, _ in points)
    return tuple((round(x - low, 3), y) for x, y in points)


def random_bars(seed: int) -> tuple[list[Member], StockSettings]:
    """Up to six members of one or two sections and up to three lengths of bars of each, every option by lot."""
    chance = np.random.default_rng(seed)
    sections, style = ["P", "Q"][: chance.integers(1, 3)], int(chance.integers(4))
    members = [_member(chance, mark, str(chance.choice(sections)), style) for mark in range(chance.integers(7))]
    bars = tuple(bar for section in sections for bar in _bars(chance, section, hundreds=style == 0))
    stock = StockSettings(
        bars=bars,
        bar_kerf=float(chance.choice([0.0, 0.001, 2.5, 3.0])),
        bar_trim=float(chance.choice([0.0, 2.5, 15.0])),
        bar_ends="square" if chance.random() < 0.5 else "head-to-tail",
    )
    return members, stock


def _member(chance: np.random.Generator, mark: int, section: str, style: int) -> Member:
    """Whole hundreds, whole millimetres, micrometres or up to longer than many a bar; slanted or square."""
    low, high = ((100, 2900), (100, 2900), (100, 3000), (1000, 4200))[style]
    length = round(float(chance.uniform(low, high)), (-2, 0, 3, 0)[style])
    count, outline = int(chance.integers(1, 7)), ()
    if length > 200 and chance.random() < 0.7:
        steep = int(chance.choice([5, 30, 90]))
        left, right = chance.integers(-steep, steep + 1, 2).tolist()
        outline = plate(length, left, right, float(chance.choice([0.0, 3.0])))
        length = round(max(x for x, _ in outline), 3)
    locations = tuple(f"{mark}-{k}" for k in range(count)) if chance.random() < 0.5 else ()
    return Member(f"M{mark}", section, length, count, locations, outline)


def _bars(chance: np.random.Generator, section: str, *, hundreds: bool) -> list[BarStock]:
    every = np.arange(3000, 9001, 100 if hundreds else 1)
    lengths = chance.choice(every, chance.integers(1, 4), replace=False).tolist()
    prices = chance.choice([0.0, 0.0, 0.1, 7.0, 11.5, 12.0], len(lengths)).tolist()
    quantities = [(None, 1, 2, 3)[k] for k in chance.integers(4, size=len(lengths))]
    return [
        BarStock(section=section, length=float(length), price=price, quantity=quantity)
        for length, price, quantity in zip(lengths, prices, quantities, strict=True)
    ]


def few_pieces(seed: int, most: int, *, slanted: bool) -> tuple[list[Member], StockSettings]:
    """Up to so many pieces, often nearly as long together as a bar."""
    chance = np.random.default_rng(seed)
    members = list[Member]()
    steep, style = int(chance.choice([10, 60, 150])), int(chance.integers(3))
    left = int(chance.integers(1, most + 1))
    while left > 0:
        count = int(chance.integers(1, min(left, 3) + 1))
        length = round(float(chance.uniform(400, 2900)), (-2, 0, 3)[style])
        ends = chance.integers(-steep, steep + 1, 2).tolist()
        outline = plate(length, *ends, float(chance.choice([0.0, 3.0]))) if slanted else ()
        length = round(max((x for x, _ in outline), default=length), 3)
        members.append(Member(len(members), "P", length, count, (), outline))
        left -= count
    bars = [_near_sum(bar, members, chance) for bar in _bars(chance, "P", hundreds=style == 0)]
    bars = list({bar.length: bar for bar in bars}.values())
    ends = "head-to-tail" if slanted else "square"
    kerf, trim = float(chance.choice([0.0, 2.5, 3.0])), float(chance.choice([0.0, 15.0]))
    return members, StockSettings(bars=tuple(bars), bar_kerf=kerf, bar_trim=trim, bar_ends=ends)


def _near_sum(bar: BarStock, members: Sequence[Member], chance: np.random.Generator) -> BarStock:
    """Make every other bar about as long as some of the pieces."""
    some = sum(member.length * int(chance.integers(member.quantity + 1)) for member in members)
    near = round(some + float(chance.integers(-150, 30)))
    return bar.model_copy(update={"length": float(near)}) if chance.random() < 0.5 and near > 3100 else bar


def best_cutting(
    members: Sequence[Member], stock: StockSettings, *, least: str = "cost", slanted: bool = False
) -> Best:
    """Try every way to cut all pieces of one section: most pieces, then least cost (or bars), then fewest bars."""
    pieces = [member for member in members for _ in range(member.quantity)]
    extents = _slanted_extents(pieces, stock) if slanted else _square_extents(pieces, stock)
    priced = any(bar.price for bar in stock.bars)
    costs = [1.0 if least == "bars" else bar.price if priced else bar.length for bar in stock.bars]
    rooms = [bar.length - 2 * stock.bar_trim + 1e-6 for bar in stock.bars]

    @cache
    def best(group: int, left: tuple[int, ...]) -> Best:
        if not group:
            return 0, 0.0, 0
        first = group & -group
        others = group ^ first
        dropped = best(others, left)
        found = [(dropped[0] + 1, dropped[1], dropped[2])]
        for kind in [kind for kind, many in enumerate(left) if many]:
            after = (*left[:kind], left[kind] - 1, *left[kind + 1 :])
            with_first = (first | some for some in _parts_of(others))
            for cut in [cut for cut in with_first if extents[cut] <= rooms[kind]]:
                rest = best(group ^ cut, after)
                found.append((rest[0], rest[1] + costs[kind], rest[2] + 1))
        return min(found)

    many = tuple(len(pieces) if bar.quantity is None else min(bar.quantity, len(pieces)) for bar in stock.bars)
    return best((1 << len(pieces)) - 1, many)


def _parts_of(group: int) -> list[int]:
    parts, part = [group], group
    while part:
        part = (part - 1) & group
        parts.append(part)
    return parts


def _square_extents(pieces: Sequence[Member], stock: StockSettings) -> list[float]:
    """What every group of pieces (bits) takes of a bar."""
    long = [0.0]
    for piece in pieces:
        long += [before + piece.length + stock.bar_kerf for before in long]
    return [0.0, *(length - stock.bar_kerf for length in long[1:])]


def _slanted_extents(pieces: Sequence[Member], stock: StockSettings) -> list[float]:
    """The same in the best of all orders and turnings, outlines a kerf apart."""
    ways = [(k, shape) for k, piece in enumerate(pieces) for shape in _turned(piece.outline)]
    steps = [[_step(one, other, stock.bar_kerf) for _, other in ways] for _, one in ways]
    ends = {(1 << piece, way): 0.0 for way, (piece, _) in enumerate(ways)}
    extents = [0.0] + [np.inf] * ((1 << len(pieces)) - 1)
    for group in range(1, 1 << len(pieces)):
        for way, start in [(way, ends[group, way]) for way in range(len(ways)) if (group, way) in ends]:
            extents[group] = min(extents[group], start + ways[way][1].bounds[2])
            for after, (piece, _) in enumerate(ways):
                if not group >> piece & 1:
                    key = group | 1 << piece, after
                    ends[key] = min(ends.get(key, np.inf), start + steps[way][after])
    return extents


def _turned(outline: Outline) -> list[shapely.Polygon]:
    points = [np.array(outline) * (x, y) for x in (1, -1) for y in (1, -1)]
    middles = [(p[:, 0].min(), (p[:, 1].min() + p[:, 1].max()) / 2) for p in points]
    return [shapely.Polygon(p - middle) for p, middle in zip(points, middles, strict=True)]


def _step(one: shapely.Polygon, other: shapely.Polygon, kerf: float) -> float:
    """The least distance between the left ends of neighbours, by halving."""
    near, far = max(0.0, one.bounds[2] - 400.0), one.bounds[2] + kerf
    for _ in range(30):
        middle = (near + far) / 2
        moved = shapely.transform(other, lambda points, middle=middle: points + np.array([middle, 0.0]))
        clear = one.distance(moved) >= kerf - 1e-7 and one.intersection(moved).area < 1e-6
        near, far = (near, middle) if clear else (middle, far)
    return far
