"""The best patterns of bars for given worths: bounded knapsacks over the rungs of a ladder of lengths."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Bools, Floats, Ints
from isomould.nesting.bar_ladder import Ladder
from isomould.nesting.bar_rack import BarRack, Need, Pattern, copies_of
from isomould.ties import FINE, in_order

SLIGHT = 1e-7
"""Gain of a pattern below which it is none, in costs of the dearest bar."""

COLUMNS = 200
"""Patterns that a round of pricing adds at most, of all kinds of bars together."""


@dataclass(frozen=True, eq=False)
class Values:
    """What pieces of every size (n,) are priced by, and what they are worth; what a bar of every kind (k,) costs.

    The cost includes the toll of a scarce kind.
    """

    priced: Floats
    worth: Floats
    charges: Floats


def price(rack: BarRack, need: Need, values: Values, ladder: Ladder) -> tuple[list[Pattern], Floats]:
    """Give patterns worth more than their bars, the best first, and the most that every kind (k,) holds as priced.

    The patterns are the best around every size, for every kind: one dynamic programme over the lengths tells them all.
    """
    copies = _worthy(rack, need, values.priced)
    items = np.repeat(np.arange(len(copies)), copies)
    best, taken = _take_all(items, ladder, values.priced)
    found = list[Pattern]()
    for kind in np.flatnonzero(need.limits > 0).tolist():
        takes = _patterns(int(ladder.tops[kind]), np.flatnonzero(copies), (items, taken), ladder)
        gain = takes @ values.worth - values.charges[kind]
        order = in_order(-gain, FINE)
        order = order[(gain[order] > SLIGHT) & (takes[order] <= need.counts).all(axis=1)]
        found += [Pattern(kind, takes[row]) for row in order[: max(COLUMNS // len(rack.rooms), 1)]]
    return found, best[ladder.tops]


def most_worth(rack: BarRack, need: Need, worth: Floats, ladder: Ladder) -> Floats:
    """Give the most that a bar of every kind (k,) can hold, as far as the ladder is exact."""
    best = np.zeros(ladder.count)
    took = np.zeros(ladder.count, dtype=np.bool_)
    for item in np.repeat(np.arange(len(worth)), _worthy(rack, need, worth)).tolist():
        _take(best, (int(ladder.first[item]), ladder.rests(item)), float(worth[item]), took)
    return best[ladder.tops]


def _worthy(rack: BarRack, need: Need, worth: Floats) -> Ints:
    """Give how many pieces of every size the longest bar may hold, of those that are worth anything."""
    return np.where(worth > 0, copies_of(rack, need.counts), 0)


def _take_all(items: Ints, ladder: Ladder, worth: Floats) -> tuple[Floats, Bools]:
    """Solve the bounded knapsack for every rung: the most worth, and whether an item is taken, (items, rungs)."""
    best = np.zeros(ladder.count)
    taken = np.zeros((len(items), ladder.count), dtype=np.bool_)
    for row, item in zip(taken, items.tolist(), strict=True):
        _take(best, (int(ladder.first[item]), ladder.rests(item)), float(worth[item]), row)
    return best, taken


def _take(best: Floats, rungs: tuple[int, slice | Ints], worth: float, took: Bools) -> None:
    """Let every rung from the first that holds an item take it or leave it; ties leave it."""
    first, rests = rungs
    with_it = best[rests] + worth
    np.greater(with_it, best[first:] + 1e-12, out=took[first:])
    np.copyto(best[first:], with_it, where=took[first:])


def _patterns(top: int, asked: Ints, table: tuple[Ints, Bools], ladder: Ladder) -> Ints:
    """Trace the best pattern of a bar, and the best ones that hold each size asked; (patterns, sizes)."""
    sizes = asked[ladder.first[asked] <= top]
    takes = np.zeros((len(sizes) + 1, len(ladder.first)), dtype=np.int64)
    takes[np.arange(len(sizes)), sizes] = 1
    rungs = np.array([*(int(ladder.rest(np.array([top]), size)[0]) for size in sizes.tolist()), top])
    for item, row in zip(table[0][::-1].tolist(), table[1][::-1], strict=True):
        took = row[rungs]
        takes[took, item] += 1
        rungs[took] = ladder.rest(rungs[took], item)
    return takes
