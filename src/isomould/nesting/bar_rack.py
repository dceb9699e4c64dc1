"""What a search for bars sees: sizes, rooms and costs, without names."""

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
    """One bar: its kind, and how many pieces of every size (n,) are cut from it."""

    kind: int
    takes: Ints


def cost_of(rack: BarRack, patterns: list[Pattern]) -> float:
    """Give the cost of bars."""
    return float(sum(rack.costs[pattern.kind] for pattern in patterns))


def merit(rack: BarRack, patterns: list[Pattern]) -> tuple[int, float, int]:
    """Give what is the least for the best bars: more pieces, then less cost, then fewer bars."""
    return -sum(int(pattern.takes.sum()) for pattern in patterns), cost_of(rack, patterns), len(patterns)


def sum_of(rack: BarRack, patterns: list[Pattern]) -> Ints:
    """Give how many pieces of every size (n,) some bars hold."""
    return sum((pattern.takes for pattern in patterns), np.zeros(len(rack.sizes), dtype=np.int64))


def less(need: Need, patterns: list[Pattern]) -> Need:
    """Give what is left of a need after some bars."""
    counts, limits = need.counts.copy(), need.limits.copy()
    for pattern in patterns:
        counts -= pattern.takes
        limits[pattern.kind] -= 1
    return Need(counts, limits)


def step_of(rack: BarRack, steps: int) -> int:
    """Give what a step of a grid of so many steps is, or more if a common divisor makes it exact."""
    return max(int(np.gcd.reduce(rack.sizes)), -(-int(rack.rooms.max()) // max(steps, 1)))
