"""The best patterns of bars for given worths: bounded knapsacks over whole steps of length."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Bools, Floats, Ints
from isomould.nesting.bar_rack import BarRack, Need, Pattern, step_of

SLIGHT = 1e-7
"""Gain of a pattern below which it is none, in costs of the dearest bar."""

STEPS, CELLS = 120_000, 16_000_000
"""Steps into which the longest bar is divided at most, and pieces times steps that a pricing may look at."""

COLUMNS = 200
"""Patterns that a round of pricing adds at most, of all kinds of bars together."""


@dataclass(frozen=True, eq=False)
class Values:
    """What a piece of every size (n,) is worth; what a bar of every kind (k,) costs, toll of a scarce one included."""

    worth: Floats
    charges: Floats


def price(rack: BarRack, need: Need, values: Values, fineness: int | None) -> list[Pattern]:
    """Give the patterns worth more than their bars, the best first: the best around every size, for every kind.

    One dynamic programme over the lengths tells them all. Sizes are rounded up to its grid, so that every pattern
    fits its bar; without a fineness the lengths of the rack are whole steps.
    """
    copies = copies_of(rack, need.counts, values.worth)
    step = 1 if fineness is None else grid_of(rack, int(copies.sum()), fineness)
    sizes = -(-rack.sizes // step)
    items = np.repeat(np.arange(len(sizes)), copies)
    table = items, _take_all(items, sizes, values.worth, int(rack.rooms.max()) // step)
    found = list[Pattern]()
    for kind in np.flatnonzero(need.limits > 0).tolist():
        takes = _patterns(int(rack.rooms[kind]) // step, np.flatnonzero(copies), table, sizes)
        gain = takes @ values.worth - values.charges[kind]
        best = np.argsort(-gain, kind="stable")
        best = best[(gain[best] > SLIGHT) & (takes[best] <= need.counts).all(axis=1)]
        found += [Pattern(kind, takes[row]) for row in best[: max(COLUMNS // len(rack.rooms), 1)]]
    return found


def grid_of(rack: BarRack, pieces: int, fineness: int) -> int:
    """Give what a step of a grid is on which so many pieces are priced: so many times as fine as the coarsest."""
    return step_of(rack, fineness * min(STEPS, CELLS // max(pieces, 1)))


def most_worth(rack: BarRack, need: Need, worth: Floats) -> Floats:
    """Give the most that a bar of every kind (k,) can hold, exactly: the rack's steps are the programme's."""
    best = np.zeros(int(rack.rooms.max()) + 1)
    took = np.zeros(len(best), dtype=np.bool_)
    copies = copies_of(rack, need.counts, worth)
    for item in np.repeat(np.arange(len(copies)), copies).tolist():
        _take(best, int(rack.sizes[item]), float(worth[item]), took)
    return best[rack.rooms]


def copies_of(rack: BarRack, counts: Ints, worth: Floats) -> Ints:
    """Give how many pieces of every size the longest bar may hold, of those that are worth anything."""
    most = np.where(rack.sizes > 0, rack.rooms.max() // np.maximum(rack.sizes, 1), counts)
    return np.where(worth > 0, np.minimum(counts, most), 0)


def _take_all(items: Ints, sizes: Ints, worth: Floats, room: int) -> Bools:
    """Solve the bounded knapsack for every room up to this: whether an item is taken, (items, room + 1)."""
    best = np.zeros(room + 1)
    taken = np.zeros((len(items), room + 1), dtype=np.bool_)
    for row, item in zip(taken, items.tolist(), strict=True):
        _take(best, int(sizes[item]), float(worth[item]), row)
    return taken


def _take(best: Floats, size: int, worth: float, took: Bools) -> None:
    """Let every room take an item or leave it; ties leave it."""
    with_it = best[: len(best) - size] + worth
    np.greater(with_it, best[size:] + 1e-12, out=took[size:])
    np.copyto(best[size:], with_it, where=took[size:])


def _patterns(room: int, asked: Ints, table: tuple[Ints, Bools], sizes: Ints) -> Ints:
    """Trace the best pattern of a room, and the best ones that hold each size asked; (patterns, sizes)."""
    first = asked[sizes[asked] <= room]
    takes = np.zeros((len(first) + 1, len(sizes)), dtype=np.int64)
    takes[np.arange(len(first)), first] = 1
    left = np.append(room - sizes[first], room)
    for item, row in zip(table[0][::-1].tolist(), table[1][::-1], strict=True):
        took = row[left]
        takes[took, item] += 1
        left[took] -= sizes[item]
    return takes
