"""Patterns that a best cutting may hold: those whose worth comes near enough to what their bar costs.

Let a programme in fractions cost z, and let a cutting in whole numbers be wanted that costs no more than t. Then no
pattern of that cutting is worth less than its bar by more than t - z (fixing by reduced costs, Nemhauser and Wolsey
1988, section II.5.2). Where t - z is small these patterns are few, and the choice among them is exact.
"""

import numpy as np

from isomould.arrays import Bools, Floats, Ints
from isomould.nesting.bar_columns import Programme, Shares, whole
from isomould.nesting.bar_rack import BarRack, Need, Pattern, copies_of

STEPS = 5_000
"""Steps of the longest bar in which the most that a rest may still hold is looked up."""

PARTIAL = 20_000
"""Patterns begun, up to which all are followed."""

SAFE = 1e-6
"""Added to what a pattern may lack, in costs of the dearest bar: worths are not exact."""


def near_patterns(programme: Programme, need: Need, shares: Shares) -> list[Pattern] | None:
    """Give all full patterns of which the cheapest whole numbers may consist, the worthiest first.

    None if there are too many.
    """
    wanted = whole(programme.top * shares.cost) / programme.top
    lack = wanted - shares.cost + SAFE
    asked = need.counts > 0
    rack = BarRack(programme.rack.sizes[asked], programme.rack.rooms, programme.rack.costs)
    few, worth = Need(need.counts[asked], need.limits), shares.worth[asked]
    found: list[tuple[float, Pattern]] = []
    for kind in np.flatnonzero(need.limits > 0).tolist():
        least = float(programme.costs[kind] + shares.tolls[kind]) - lack
        rows = _worth_at_least(rack, few, kind, worth, least)
        if rows is None:
            return None
        takes = np.zeros((len(rows), len(asked)), dtype=np.int64)
        takes[:, asked] = rows
        found += [(float(row @ shares.worth), Pattern(kind, row)) for row in takes]
    ranked = sorted(found, key=lambda pair: (-round(pair[0], 9), pair[1].takes.tolist()))
    return [pattern for _, pattern in ranked]


def _worth_at_least(rack: BarRack, need: Need, kind: int, worth: Floats, least: float) -> Ints | None:
    """Give the full patterns (m, n) of a kind of bar that are worth so much; None if too many are begun.

    Size after size, every pattern begun takes none, one, two … pieces; it is followed as long as the rest of its bar,
    filled as well as it can be, may still reach what is asked.
    """
    most, step = _most_from(rack, need, kind, worth)
    copies = copies_of(rack, need.counts)
    takes = np.zeros((1, 0), dtype=np.int64)
    rest, value = rack.rooms[kind : kind + 1], np.zeros(1)
    for size, (length, many) in enumerate(zip(rack.sizes.tolist(), copies.tolist(), strict=True)):
        branches = np.minimum(rest // length, many) + 1
        parent = np.repeat(np.arange(len(rest)), branches)
        first_child = np.repeat(np.cumsum(branches) - branches, branches)
        pieces = np.arange(len(parent)) - first_child
        rest = rest[parent] - pieces * length
        value = value[parent] + pieces * worth[size]
        hopeful = value + most[size + 1][rest // step] >= least
        takes = np.column_stack([takes[parent], pieces])[hopeful]
        rest, value = rest[hopeful], value[hopeful]
        if len(rest) > PARTIAL:
            return None
    return takes[_full(rack, need, takes, rest)]


def _full(rack: BarRack, need: Need, takes: Ints, rest: Ints) -> Bools:
    """Tell of every pattern (m, n) whether no piece that is left fits its rest (m,)."""
    more = (takes < need.counts) & (rest[:, None] >= rack.sizes)
    return np.count_nonzero(more, axis=1) == 0


def _most_from(rack: BarRack, need: Need, kind: int, worth: Floats) -> tuple[Floats, int]:
    """Give what the sizes from each on are worth at most on so many steps, (n + 1, steps + 1), and the step.

    Sizes are rounded down to steps, so that no true filling is worth more.
    """
    room = int(rack.rooms[kind])
    step = max(int(np.gcd.reduce(rack.sizes)), -(-room // STEPS))
    most = np.zeros((len(rack.sizes) + 1, room // step + 1))
    steps = (rack.sizes // step).tolist()
    for size in range(len(steps) - 1, -1, -1):
        best = most[size + 1].copy()
        fits = len(best) > steps[size]  # shorter bars do not hold the longest pieces
        for _ in range(int(copies_of(rack, need.counts)[size]) if fits else 0):
            with_one = best[: len(best) - steps[size]] + worth[size]
            best[steps[size] :] = np.maximum(best[steps[size] :], with_one)
        most[size] = best
    return most, step
