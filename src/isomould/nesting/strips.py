"""Strips of parts head to tail: which parts go into one is a knapsack.

n trapezoids of one height h and one pair of leg slopes, every other one turned by 180 degrees, need the
length sum(mean widths) + gaps along the legs between them + what the two end legs stand out from their
middles, whatever their order. Hence a size per item and a set-up cost per kind in the strip.

Where parts make half turns, a chain of an even number ends with two equal legs, which may be the less
slanted ones: it stands out by h tan(less). One of an odd number ends with one of each: h (tan + tan) / 2.
So a kind has two set-ups, and the knapsack counts odd and even (`Ends`).

Slopes that differ a little inside a kind cost h |difference| / 2 at a joint, which is charged to the two
items against the kind's reference slopes. All bounds are rounded up, never down.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from isomould.arrays import Bools, Floats, Ints
from isomould.nesting.linked import LinkedLayer, link_layer, lying, trace_linked
from isomould.nesting.shapes import Shape, round_away, turn_half, turn_over


@dataclass(frozen=True, eq=False)
class Item:
    """A part (by its index) in one position; `size` in grid steps.

    A `fixed` one lies as it is; of others in a chain every second makes a half turn.
    """

    part: int
    shape: Shape
    size: int
    fixed: bool = False


PARITY = 3
"""Grid steps by which the ends of odd and even chains differ at least, so that they are counted apart."""

LONE = 3
"""Pieces of a kind up to which they are linked to others with other slopes."""

SLANTED = 0.03
"""Overhang of a part against its width from which that pays."""

Block = tuple[Item, ...]
"""Items of one kind head to tail, or a single item in its box; blocks stand apart by the gap."""


@dataclass(frozen=True)
class Ends:
    """What a chain needs beside the sizes of its items, in grid steps, by whether their number is even or odd."""

    even: int
    odd: int

    @property
    def differ(self) -> bool:
        """Tell whether it pays to count odd and even."""
        return self.odd - self.even >= PARITY


@dataclass(frozen=True, eq=False)
class Kind:
    """Items that nest head to tail; `height` in micrometres.

    A kind without `ends` holds items that stand in their boxes, or if it has `links` items whose legs differ, to be
    measured by that grid.
    """

    height: int
    ends: Ends | None
    items: tuple[Item, ...]
    links: "Grid | None" = None

    @property
    def lying(self) -> Iterator[Item]:
        """All items in all the ways in which they may lie fixed, or be told to lie."""
        ways = (1 + self.links.flips) if self.links else 0
        return (lying(item, way) for item in self.items for way in range(ways)) if ways else iter(self.items)


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


_Shapes = list[tuple[int, Shape]]
"""Parts, by their indices, as they stand."""


def sort_kinds(shapes: Sequence[tuple[int, Shape]], pieces: Sequence[int], grid: Grid) -> tuple[Kind, ...]:
    """Group (part, shape) into kinds, ascending in height; a kind of one piece counts as its box."""
    poised = [(part, _poised(shape, grid)) for part, shape in shapes]
    poised.sort(key=lambda pair: (pair[1].height, pair[1].left, pair[1].right, pair[0]))
    groups = (list(group) for _, group in groupby(poised, key=lambda pair: pair[1].height))
    return tuple(kind for group in groups for kind in _kinds(list(_alike(group, grid.gap)), pieces, grid))


def _kinds(alike: list[_Shapes], pieces: Sequence[int], grid: Grid) -> Iterator[Kind]:
    """Give the kinds of one height: what has few of its kind and much slant is linked, whatever its slopes."""
    lone = [shapes for shapes in alike if _is_lone(shapes, pieces)]
    if len(lone) >= 2:
        yield _linked([pair for shapes in lone for pair in shapes], grid)
        alike = [shapes for shapes in alike if not _is_lone(shapes, pieces)]
    yield from (_kind(shapes, pieces, grid) for shapes in alike)


def _is_lone(alike: _Shapes, pieces: Sequence[int]) -> bool:
    slanted = max(shape.overhang / shape.mean for _, shape in alike) > SLANTED
    return slanted and sum(pieces[part] for part, _ in alike) <= LONE


def _linked(shapes: _Shapes, grid: Grid) -> Kind:
    items = (Item(part, shape, grid.up(shape.mean + grid.gap)) for part, shape in shapes)
    return Kind(shapes[0][1].height, None, tuple(items), links=grid)


def _poised(shape: Shape, grid: Grid) -> Shape:
    """Turn a shape so that its left leg leans further to the right than its right leg, and both more than to the left.

    Mirror images thus become one kind where parts may be turned over.
    """
    if grid.turns_over and shape.left + shape.right < 0:
        shape = turn_over(shape)
    return turn_half(shape) if grid.flips and shape.left < shape.right else shape


def _alike(group: _Shapes, gap: float) -> Iterator[_Shapes]:
    """Split shapes of one height where the legs differ by more than the gap."""
    while group:
        first = group[0][1]
        near = [pair for pair in group if _difference(first, pair[1]) <= max(gap, 2.0)]
        yield near
        group = [pair for pair in group if _difference(first, pair[1]) > max(gap, 2.0)]


def _difference(one: Shape, other: Shape) -> float:
    return max(abs(one.left - other.left), abs(one.right - other.right)) * one.height


def _kind(alike: _Shapes, pieces: Sequence[int], grid: Grid) -> Kind:
    slopes = np.array([(shape.left, shape.right) for _, shape in alike])
    if not slopes.any() or sum(pieces[part] for part, _ in alike) == 1:
        return _boxes(alike, grid)
    height = alike[0][1].height
    middle = np.median(slopes, axis=0) if grid.flips else np.full(2, np.median(slopes))
    steepest = np.abs(slopes).max(axis=0)
    # Of the joint at each of its legs an item is charged a half; without half turns both legs meet there.
    joints = grid.gap * np.hypot(1.0, steepest if grid.flips else np.full(2, steepest.max()))
    loss = np.abs(slopes - middle).sum(axis=1) * height / 2 + joints.mean() + 1
    sizes = [grid.up(shape.mean + float(more)) for (_, shape), more in zip(alike, loss, strict=True)]
    items = tuple(Item(part, shape, size) for (part, shape), size in zip(alike, sizes, strict=True))
    return Kind(height, _ends(height * steepest, joints, grid), items)


def _ends(wedges: Floats, joints: Floats, grid: Grid) -> Ends:
    """Give what ends need: half a wedge at either, one whole gap to the next block, less the joints charged there.

    Parameters
    ----------
    wedges : (2,) float, micrometres
        The left and the right leg, seen in plan.
    joints : (2,) float, micrometres
        What a gap takes along each of them.
    """
    outside = wedges - joints + grid.gap
    odd = max(grid.up(float(outside.mean())), 0)
    even = max(grid.up(float(outside.min())), 0)
    return Ends(min(even, odd) if grid.flips else odd, odd)


def _boxes(alike: _Shapes, grid: Grid) -> Kind:
    return Kind(alike[0][1].height, None, tuple(grid.box(part, shape) for part, shape in alike))


@dataclass(frozen=True, eq=False)
class _Layer:
    """What the programme decided for one kind.

    Attributes
    ----------
    taken
        Of every item: whether it is taken at a length, in a chain of an even (row 0) and an odd (row 1) number with
        it; a single row where numbers are not told apart.
    closed
        Lengths at which a chain pays that ends with the row's number.
    """

    kind: Kind
    items: list[Item]
    taken: list[Bools]
    closed: list[Bools]


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
    layers: list[_Layer | LinkedLayer]


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
    layers: list[_Layer | LinkedLayer] = []
    worth: list[float] = []
    tables: list[Floats] = []
    for kind in kinds:
        items = [item for item in kind.items for _ in range(_copies(item, counts, capacity))]
        if items:
            linked = link_layer(kind, items, best, values, kind.links) if kind.links else None
            layers.append(linked or _layer(kind, items, best, values))
            worth.append(float(best[-1]))
            tables += [best.copy()] if all_lengths else []
    heights = np.array([layer.kind.height for layer in layers], dtype=np.int64)
    return Priced(heights, np.array(worth), tables, layers)


def _copies(item: Item, counts: Ints, capacity: int) -> int:
    left = int(counts[item.part])
    return left if left <= 1 else min(left, capacity // item.size)


def _layer(kind: Kind, items: list[Item], best: Floats, values: Floats) -> _Layer:
    """Take up one kind into `best`, in place."""
    if kind.ends is None:
        return _Layer(kind, items, [_take(best[None], item.size, values[item.part]) for item in items], [])
    opened = _open(best, kind.ends)
    taken = [_take(opened, item.size, values[item.part]) for item in items]
    closed = [_close(best, chains, setup) for chains, setup in zip(opened, _setups(kind.ends), strict=True)]
    return _Layer(kind, items, taken, closed)


def _open(best: Floats, ends: Ends) -> Floats:
    """Begin chains: with no item yet their number is even."""
    return np.stack([best, np.full(len(best), -np.inf)]) if ends.differ else best[None].copy()


def _setups(ends: Ends) -> tuple[int, ...]:
    """Give what the ends of chains need, row by row."""
    return (ends.even, ends.odd) if ends.differ else (ends.odd,)


def _take(best: Floats, size: int, value: float) -> Bools:
    """Take an item or not, in place; of two rows the one is the other with an item more."""
    if size >= best.shape[1]:
        return np.zeros((len(best), 0), dtype=np.bool_)
    with_it = best[::-1, :-size] + value
    taken = with_it > best[:, size:]
    np.maximum(best[:, size:], with_it, out=best[:, size:])
    return taken


def _close(best: Floats, chains: Floats, setup: int) -> Bools:
    """End chains where that pays, in place."""
    closed = chains[: max(len(best) - setup, 0)]
    pays = closed > best[setup:]
    np.maximum(best[setup:], closed, out=best[setup:])
    return pays


def trace(priced: Priced, index: int, capacity: int) -> list[Block]:
    """Give the blocks of the best strip of height class `index`, the tallest first."""
    blocks: list[Block] = []
    for layer in reversed(priced.layers[: index + 1]):
        found, capacity = _trace_layer(layer, capacity)
        blocks += found
    return [block for block in blocks if block]


def _trace_layer(layer: _Layer | LinkedLayer, room: int) -> tuple[list[Block], int]:
    if isinstance(layer, LinkedLayer):
        chain, room = trace_linked(layer, room)
        return [chain], room
    if layer.kind.ends is None:
        items, room = _trace_items(layer, room, 0)
        return [(item,) for item in items], room
    # Odd chains were the last to be ended: where they pay, they are what is best.
    for row, setup in reversed(list(enumerate(_setups(layer.kind.ends)))):
        if room >= setup and layer.closed[row][room - setup]:
            items, room = _trace_items(layer, room - setup, row)
            return [tuple(items)], room
    return [], room


def _trace_items(layer: _Layer, room: int, row: int) -> tuple[list[Item], int]:
    chosen: list[Item] = []
    for item, taken in zip(reversed(layer.items), reversed(layer.taken), strict=True):
        if room >= item.size and taken[row, room - item.size]:
            chosen.append(item)
            room -= item.size
            row = len(taken) - 1 - row
    return chosen, room
