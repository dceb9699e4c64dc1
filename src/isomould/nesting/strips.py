"""Strips of parts head to tail: which parts go into one is a knapsack.

n trapezoids of one height h and one pair of leg slopes, every other one turned by 180 degrees, need the
length sum(mean widths) + (n - 1) gap / cos(slant) + h tan(slant), whatever their order (nesting, "What
works"). Hence a size per item and one set-up cost per kind in the strip. Slopes that differ a little
inside a kind cost h |difference| / 2 at a joint, which is charged to the two items against the kind's
reference slopes. All bounds are rounded up, never down.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from isomould.arrays import Bools, Floats, Ints
from isomould.nesting.shapes import Shape, round_away, turn_half, turn_over


@dataclass(frozen=True, eq=False)
class Item:
    """A part (by its index) in one position; `size` in grid steps."""

    part: int
    shape: Shape
    size: int


Block = tuple[Item, ...]
"""Items of one kind head to tail, or a single item in its box; blocks stand apart by the gap."""


@dataclass(frozen=True, eq=False)
class Kind:
    """Items that nest head to tail; `height` in micrometres, `setup` in grid steps.

    A kind without set-up cost holds items that stand in their boxes.
    """

    height: int
    setup: int
    items: tuple[Item, ...]


@dataclass(frozen=True)
class Grid:
    """How strips are measured, in micrometres rounded up to `step`, and which half turns and mirrorings are free."""

    step: int
    gap: float
    flips: bool
    turns_over: bool = False

    def up(self, length: float) -> int:
        """Give the grid steps that hold a length."""
        return int(np.ceil(length / self.step - 1e-9))

    def box(self, part: int, shape: Shape) -> Item:
        """Give an item that stands in its box."""
        return Item(part, shape, self.up(shape.width + round_away(self.gap)))


def sort_kinds(shapes: Sequence[tuple[int, Shape]], pieces: Sequence[int], grid: Grid) -> tuple[Kind, ...]:
    """Group (part, shape) into kinds, ascending in height; a kind of one piece counts as its box."""
    poised = [(part, _poised(shape, grid)) for part, shape in shapes]
    poised.sort(key=lambda pair: (pair[1].height, pair[1].left, pair[1].right, pair[0]))
    groups = (list(group) for _, group in groupby(poised, key=lambda pair: pair[1].height))
    return tuple(_kind(alike, pieces, grid) for group in groups for alike in _alike(group, grid.gap))


def _poised(shape: Shape, grid: Grid) -> Shape:
    """Turn a shape so that its left leg leans further to the right than its right leg, and both more than to the left.

    Mirror images thus become one kind where parts may be turned over.
    """
    if grid.turns_over and shape.left + shape.right < 0:
        shape = turn_over(shape)
    return turn_half(shape) if grid.flips and shape.left < shape.right else shape


def _alike(group: list[tuple[int, Shape]], gap: float) -> Iterator[list[tuple[int, Shape]]]:
    """Split shapes of one height where the legs differ by more than the gap."""
    while group:
        first = group[0][1]
        near = [pair for pair in group if _difference(first, pair[1]) <= max(gap, 2.0)]
        yield near
        group = [pair for pair in group if _difference(first, pair[1]) > max(gap, 2.0)]


def _difference(one: Shape, other: Shape) -> float:
    return max(abs(one.left - other.left), abs(one.right - other.right)) * one.height


def _kind(alike: list[tuple[int, Shape]], pieces: Sequence[int], grid: Grid) -> Kind:
    height, wedge = alike[0][1].height, max(shape.wedge for _, shape in alike)
    if wedge == 0 or sum(pieces[part] for part, _ in alike) == 1:
        return _boxes(alike, grid)
    slopes = np.array([(shape.left, shape.right) for _, shape in alike])
    middle = np.median(slopes, axis=0) if grid.flips else np.full(2, np.median(slopes))
    slant = grid.gap * float(np.hypot(1.0, np.abs(slopes).max()))
    loss = np.abs(slopes - middle).sum(axis=1) * height / 2 + slant + 1
    sizes = [grid.up(shape.mean + float(more)) for (_, shape), more in zip(alike, loss, strict=True)]
    items = tuple(Item(part, shape, size) for (part, shape), size in zip(alike, sizes, strict=True))
    return Kind(height, max(grid.up(wedge + grid.gap - slant), 1), items)


def _boxes(alike: list[tuple[int, Shape]], grid: Grid) -> Kind:
    return Kind(alike[0][1].height, 0, tuple(grid.box(part, shape) for part, shape in alike))


@dataclass(frozen=True, eq=False)
class _Layer:
    """What the programme decided for one kind: where opening it pays, and which items are then taken."""

    kind: Kind
    pays: Bools | None
    items: list[Item]
    taken: list[Bools]


@dataclass(frozen=True, eq=False)
class Priced:
    """The best strip of every height class, of full length: one programme over ascending heights.

    Attributes
    ----------
    heights : (k,) int, micrometres, ascending
    worth : (k,) float
    tables
        Worth of the best strip of every length in grid steps, one (capacity + 1,) per height; only if asked for.
    """

    heights: Ints
    worth: Floats
    tables: list[Floats]
    layers: list[_Layer]


def price(kinds: Sequence[Kind], counts: Ints, values: Floats, capacity: int, *, all_lengths: bool = False) -> Priced:
    """Solve the knapsack of every height class.

    Parameters
    ----------
    counts : (parts,) int
        Pieces left of every part.
    values : (parts,) float
        What a piece is worth: its area in the search, its dual price in column generation.
    """
    best = np.zeros(capacity + 1)
    layers: list[_Layer] = []
    worth: list[float] = []
    tables: list[Floats] = []
    for kind in kinds:
        items = [item for item in kind.items for _ in range(_copies(item, counts, capacity))]
        if items and kind.setup < capacity:
            layers.append(_layer(kind, items, best, values))
            worth.append(float(best[-1]))
            tables += [best.copy()] if all_lengths else []
    heights = np.array([layer.kind.height for layer in layers], dtype=np.int64)
    return Priced(heights, np.array(worth), tables, layers)


def _copies(item: Item, counts: Ints, capacity: int) -> int:
    left = int(counts[item.part])
    return left if left <= 1 else min(left, capacity // item.size)


def _layer(kind: Kind, items: list[Item], best: Floats, values: Floats) -> _Layer:
    """Take up one kind into `best`, in place."""
    if not kind.setup:
        return _Layer(kind, None, items, [_take(best, item.size, values[item.part]) for item in items])
    opened = best[: -kind.setup].copy()
    taken = [_take(opened, item.size, values[item.part]) for item in items]
    pays = opened > best[kind.setup :]
    np.maximum(best[kind.setup :], opened, out=best[kind.setup :])
    return _Layer(kind, pays, items, taken)


def _take(best: Floats, size: int, value: float) -> Bools:
    if size >= len(best):
        return np.zeros(0, dtype=np.bool_)
    with_it = best[:-size] + value
    taken = with_it > best[size:]
    np.maximum(best[size:], with_it, out=best[size:])
    return taken


def trace(priced: Priced, index: int, capacity: int) -> list[Block]:
    """Give the blocks of the best strip of height class `index`, the tallest first."""
    blocks: list[Block] = []
    for layer in reversed(priced.layers[: index + 1]):
        room = capacity - layer.kind.setup
        if layer.pays is None or (room >= 0 and layer.pays[room]):
            items, capacity = _trace_layer(layer, room)
            blocks += [items] if layer.kind.setup else [(item,) for item in items]
    return [block for block in blocks if block]


def _trace_layer(layer: _Layer, room: int) -> tuple[Block, int]:
    chosen: list[Item] = []
    for item, taken in zip(reversed(layer.items), reversed(layer.taken), strict=True):
        if room >= item.size and taken[room - item.size]:
            chosen.append(item)
            room -= item.size
    return tuple(chosen), room
