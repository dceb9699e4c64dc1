"""What a search for bars sees: sizes, rooms and costs, without names."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints

ENDLESS = 2**40
"""Limit of a bar of which there are as many as wanted."""


@dataclass(frozen=True, eq=False)
class BarRack:
    """Sizes to cut and bars to cut them from.

    Attributes
    ----------
    sizes : (n,) int, micrometres
        One kerf included, descending.
    rooms : (k,) int, micrometres
        Of every kind of bar, one kerf added, descending.
    costs : (k,) float
        Of every kind of bar, multiples of 1.
    """

    sizes: Ints
    rooms: Ints
    costs: Floats


@dataclass(frozen=True, eq=False)
class Need:
    """Pieces that are left of every size (n,), and bars that are left of every kind (k,)."""

    counts: Ints
    limits: Ints


@dataclass(frozen=True, eq=False)
class Pattern:
    """Bars that are cut alike: their kind, the pieces of every size (n,) on each, and how many bars."""

    kind: int
    takes: Ints
    times: int = 1


def bars_in(patterns: Sequence[Pattern]) -> int:
    """Count bars."""
    return sum(pattern.times for pattern in patterns)


def one_by_one(patterns: Sequence[Pattern]) -> list[Pattern]:
    """Give every bar as a pattern of its own."""
    return [Pattern(pattern.kind, pattern.takes) for pattern in patterns for _ in range(pattern.times)]


def cost_of(rack: BarRack, patterns: Sequence[Pattern]) -> float:
    """Give the cost of bars."""
    return float(sum(rack.costs[pattern.kind] * pattern.times for pattern in patterns))


def merit(rack: BarRack, patterns: Sequence[Pattern]) -> tuple[int, float, int]:
    """Give what is the least for the best bars: more pieces, then less cost, then fewer bars."""
    pieces = int(sum_of(rack, patterns).sum())
    return -pieces, cost_of(rack, patterns), bars_in(patterns)


def sum_of(rack: BarRack, patterns: Sequence[Pattern]) -> Ints:
    """Give how many pieces of every size (n,) some bars hold."""
    pieces = np.zeros(len(rack.sizes), dtype=np.int64)
    for pattern in patterns:
        pieces += pattern.takes * pattern.times
    return pieces


def less(need: Need, patterns: Sequence[Pattern]) -> Need:
    """Give what is left of a need after some bars."""
    counts, limits = need.counts.copy(), need.limits.copy()
    for pattern in patterns:
        counts -= pattern.takes * pattern.times
        limits[pattern.kind] -= pattern.times
    return Need(counts, limits)


def copies_of(rack: BarRack, counts: Ints) -> Ints:
    """Give how many pieces of every size (n,) the longest bar may hold."""
    most = np.where(rack.sizes > 0, rack.rooms.max() // np.maximum(rack.sizes, 1), counts)
    return np.minimum(counts, most)


def step_of(rack: BarRack, steps: int) -> int:
    """Give what a step of a grid of so many steps is, or more if a common divisor makes it exact."""
    return max(int(np.gcd.reduce(rack.sizes)), -(-int(rack.rooms.max()) // max(steps, 1)))
