"""Lengths at which a bar is looked at: all that its pieces can have together where these are few, else a grid."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Ints
from isomould.nesting.bar_rack import BarRack, copies_of, step_of

RUNGS = 60_000
"""Different sums of pieces up to which all are looked at."""

STEPS, CELLS = 120_000, 16_000_000
"""Steps into which the longest bar is divided at most, and pieces times steps that a pricing may look at."""


@dataclass(frozen=True, eq=False)
class Ladder:
    """Rungs from 0 to the longest bar; what remains of a bar is on the highest rung that is not longer.

    Attributes
    ----------
    count
        Of the rungs.
    first : (n,) int
        The lowest rung that holds a piece of every size.
    below : (n,) arrays of int, or None on a grid, where these rungs follow each other from 0
        For every rung from `first` up the one on which the rest of such a bar is.
    tops : (k,) int
        The rung of every kind of bar.
    """

    count: int
    first: Ints
    below: tuple[Ints, ...] | None
    tops: Ints

    def rests(self, size: int) -> slice | Ints:
        """Give the rungs of what remains of all bars from `first` up without a piece of a size."""
        return slice(0, max(self.count - int(self.first[size]), 0)) if self.below is None else self.below[size]

    def rest(self, rungs: Ints, size: int) -> Ints:
        """Give the rungs of what remains of bars on some rungs."""
        places = rungs - self.first[size]
        return places if self.below is None else self.below[size][places]


@dataclass(frozen=True, eq=False)
class Ladders:
    """The ladder of a rack that holds all lengths, or else grids of some finenesses."""

    rack: BarRack
    exact: Ladder | None
    finenesses: tuple[int, ...]

    def __call__(self, counts: Ints, fineness: int) -> Ladder:
        """Give a ladder for pieces of some counts (n,); a grid is so many times as fine as the coarsest."""
        return self.exact or grid(self.rack, grid_step(self.rack, counts, fineness))


def exact_ladder(rack: BarRack, counts: Ints) -> Ladder | None:
    """Give all lengths that pieces of some counts (n,) can have together; None if there are too many."""
    sums = _sums(rack, copies_of(rack, counts))
    if sums is None:
        return None
    first = np.searchsorted(sums, rack.sizes)
    below = [np.searchsorted(sums, sums[k:] - size, "right") - 1 for k, size in zip(first, rack.sizes, strict=True)]
    return Ladder(len(sums), first, tuple(below), np.searchsorted(sums, rack.rooms, "right") - 1)


def _sums(rack: BarRack, copies: Ints) -> Ints | None:
    """Give all sums of pieces that the longest bar holds, ascending; None if there are too many.

    Bit k of `reached` is set if some pieces are k steps long together, in steps of what divides all sizes.
    """
    step = max(int(np.gcd.reduce(rack.sizes)), 1)
    room = int(rack.rooms.max()) // step
    mask, reached = (1 << (room + 1)) - 1, 1
    for size in np.repeat(rack.sizes // step, copies)[::-1].tolist():
        reached |= (reached << size) & mask
        if reached.bit_count() > RUNGS:
            return None
    bits = np.frombuffer(reached.to_bytes(room // 8 + 1, "little"), dtype=np.uint8)
    return np.flatnonzero(np.unpackbits(bits, bitorder="little")).astype(np.int64) * step


def grid(rack: BarRack, step: int) -> Ladder:
    """Give steps of one length. Sizes are rounded up to them, so that whatever fits there fits the bar."""
    tops = rack.rooms // step
    return Ladder(int(tops.max()) + 1, -(-rack.sizes // step), None, tops)


def grid_step(rack: BarRack, counts: Ints, fineness: int) -> int:
    """Give the step of a grid so many times as fine as the coarsest on which pieces of some counts are priced."""
    pieces = int(copies_of(rack, counts).sum())
    return step_of(rack, fineness * min(STEPS, CELLS // max(pieces, 1)))
