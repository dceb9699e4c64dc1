"""Chains of parts of one height whose slopes all differ: who follows whom is chosen, at the true loss of the joint.

Two legs that meet with slopes s and t in a strip of height h lose h |s - t| / 2. So parts stand in an order in which
neighbours' legs are alike, and a programme finds the best chain that keeps to it and leaves some of them out.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.nesting.shapes import turn_half

if TYPE_CHECKING:
    from isomould.nesting.strips import Grid, Item, Kind

AHEAD = 6
"""How far behind a part in the order the next of its chain may stand."""


@dataclass(frozen=True, eq=False)
class Links:
    """What chains of some items take, in grid steps; the first axis is how the item that is added lies.

    Attributes
    ----------
    start, end : (ways, n) int
        An item with its outer leg at the left end; the outer leg at the right end, with the gap behind it.
    joint : (ways, n, n) int
        The second item behind the first, which lies the other way where half turns are allowed.
    """

    start: Ints
    end: Ints
    joint: Ints

    @property
    def ways(self) -> int:
        """How many ways an item may lie."""
        return len(self.start)

    def before(self, way: int) -> int:
        """Give how the neighbour lies of an item that lies in a way."""
        return self.ways - 1 - way


def measure_links(items: Sequence["Item"], grid: "Grid") -> Links:
    """Measure all joints and ends of items of one height."""
    height = items[0].shape.height
    mean = np.array([item.shape.mean for item in items])
    slopes = np.array([(item.shape.left, item.shape.right) for item in items]).T
    left, right = (slopes, slopes[::-1]) if grid.flips else (slopes[:1], slopes[1:])
    beside = right[::-1] if grid.flips else right
    meeting = beside[:, :, None], left[:, None, :]
    loss = np.abs(meeting[0] - meeting[1]) * height / 2
    between = grid.gap * np.hypot(1.0, np.maximum(*np.abs(np.broadcast_arrays(*meeting))))
    return Links(
        start=_up(mean + np.abs(left) * height / 2, grid),
        end=_up(np.abs(right) * height / 2 + grid.gap, grid),
        # A micrometre more, for the places of pieces are rounded up to it.
        joint=_up(mean + loss + between + 1, grid),
    )


def _up(lengths: Floats, grid: "Grid") -> Ints:
    return np.ceil(lengths / grid.step - 1e-9).astype(np.int64)


@dataclass(frozen=True, eq=False)
class LinkedLayer:
    """What the programme found for the items of one kind.

    Attributes
    ----------
    base : (lengths,) float
        The best without the kind.
    worth : (n, ways, lengths) float
        The best chain that ends with an item in a way.
    """

    kind: "Kind"
    items: list["Item"]
    values: list[float]
    links: Links
    base: Floats
    worth: Floats


def link_layer(kind: "Kind", items: list["Item"], best: Floats, values: Floats, grid: "Grid") -> LinkedLayer:
    """Take up the best chain into `best` (lengths,), in place."""
    ordered = [items[k] for k in chain_order(items)]
    links = measure_links(ordered, grid)
    worth = np.full((len(ordered), links.ways, len(best)), -np.inf)
    own = [float(values[item.part]) for item in ordered]
    for last in range(len(ordered)):
        for way in range(links.ways):
            for length, before in _ways_there(links, best, worth, (last, way)):
                _raise(worth[last, way], before, length)
            worth[last, way] += own[last]
    base = best.copy()
    for last, way in np.ndindex(worth.shape[:2]):
        _raise(best, worth[last, way], int(links.end[way, last]))
    return LinkedLayer(kind, ordered, own, links, base, worth)


def _ways_there(links: Links, base: Floats, worth: Floats, to: tuple[int, int]) -> Iterator[tuple[int, Floats]]:
    """Give what an item takes at the end of a chain, and the worth of what is before it: nothing, or another chain."""
    last, way = to
    yield int(links.start[way, last]), base
    for before in range(max(last - AHEAD, 0), last):
        yield int(links.joint[way, before, last]), worth[before, links.before(way)]


def _raise(worth: Floats, before: Floats, length: int) -> None:
    """Take what is before and a length behind it where that is worth more, in place."""
    if length == 0:
        np.maximum(worth, before, out=worth)
    elif length < len(worth):
        np.maximum(worth[length:], before[:-length], out=worth[length:])


def trace_linked(layer: LinkedLayer, room: int) -> tuple[tuple["Item", ...], int]:
    """Give the chain that is part of the best in a room, left to right and every item as it lies, and the rest.

    Of chains that are worth the same, the shortest.
    """
    found = list(_chains(layer, room))
    best = max((worth for worth, _, _ in found), default=-np.inf)
    if best <= layer.base[room]:
        return (), room
    length, state = min(
        (_shortest(layer, state, room - end, best) + end, state) for worth, end, state in found if worth == best
    )
    return _trace_chain(layer, state, length - int(layer.links.end[state[1], state[0]]))


def _chains(layer: LinkedLayer, room: int) -> Iterator[tuple[float, int, tuple[int, int]]]:
    """Give the worth of the best chain with every last item in a room, what its end takes, and the item and its way."""
    for last, way in np.ndindex(layer.worth.shape[:2]):
        end = int(layer.links.end[way, last])
        if room >= end:
            yield float(layer.worth[last, way, room - end]), end, (last, way)


def _shortest(layer: LinkedLayer, state: tuple[int, int], room: int, worth: float) -> int:
    """Give the least length that is worth as much: worths never fall with the length."""
    return int(np.searchsorted(layer.worth[state][: room + 1], worth))


def _trace_chain(layer: LinkedLayer, state: tuple[int, int], room: int) -> tuple[tuple["Item", ...], int]:
    chain: list[Item] = []
    found: tuple[int, int] | None = state
    while found is not None:
        last, way = found
        chain.append(lying(layer.items[last], way))
        found, room = _previous(layer, found, room)
    return tuple(reversed(chain)), room


def _previous(layer: LinkedLayer, state: tuple[int, int], room: int) -> tuple[tuple[int, int] | None, int]:
    """Find what stands before an item, None for nothing, and the room that is left for it."""
    last, way = state
    worth, first = layer.worth[last, way, room], max(last - AHEAD, 0)
    for number, (length, before) in enumerate(_ways_there(layer.links, layer.base, layer.worth, state)):
        if room >= length and before[room - length] + layer.values[last] == worth:
            return None if number == 0 else (first + number - 1, layer.links.before(way)), room - length
    message = "a chain without a beginning"
    raise AssertionError(message)


def lying(item: "Item", way: int) -> "Item":
    """Give an item as it lies: as it is, or turned by half, for good."""
    return replace(item, shape=turn_half(item.shape) if way else item.shape, fixed=True)


def chain_order(items: Sequence["Item"]) -> list[int]:
    """Order items so that legs that meet are alike: right legs in pairs, and left legs in pairs of others.

    To pair neighbours in the order of their slopes loses least in all; the pairs of right legs and those of left legs
    make paths and rings, which are walked one after another.
    """
    left, right = ([_slope(item, side) for item in items] for side in (0, 1))
    by_right = sorted(range(len(items)), key=lambda k: (right[k], left[k], k))
    by_left = sorted(range(len(items)), key=lambda k: (left[k], right[k], k))
    mates = _pairs(by_right), _pairs(by_left)
    loose = [k for k in by_right if k not in mates[0] or k not in mates[1]]
    seen = set[int]()
    return [k for first in (*loose, *by_right) for k in _walk(first, mates, seen)]


def _slope(item: "Item", side: int) -> float:
    return round((item.shape.left, item.shape.right)[side], 9)


def _pairs(order: Sequence[int]) -> dict[int, int]:
    pairs = list(zip(order[::2], order[1::2], strict=False))
    return dict(pairs) | {other: one for one, other in pairs}


def _walk(first: int, mates: tuple[Mapping[int, int], Mapping[int, int]], seen: set[int]) -> Iterator[int]:
    """Follow right and left pairs in turn to the end of a path, or once around a ring."""
    place: int | None = first
    side = 0 if first in mates[0] else 1
    while place is not None and place not in seen:
        seen.add(place)
        yield place
        place = mates[side].get(place)
        side = 1 - side
