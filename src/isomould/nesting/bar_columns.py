"""Cutting patterns of bars by column generation (Gilmore and Gomory 1961), with the bound that it proves."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import linprog

from isomould.arrays import Bools, Floats, Ints

GRID = 12_000
"""Steps into which a bar is divided at most; exact if the sizes have a divisor that is coarse enough."""

ROUNDS = 400
"""Patterns that are priced at most."""

MOST_SIZES = 200
"""Different sizes up to which patterns pay."""


@dataclass(frozen=True, eq=False)
class Demand:
    """What one kind of bar has to give: `sizes` and `room` in micrometres, `counts` of each size."""

    sizes: Ints
    counts: Ints
    room: int

    @property
    def step(self) -> int:
        """Micrometres to a grid step."""
        exact = int(np.gcd.reduce(self.sizes))
        return max(exact, -(-self.room // GRID))


def find_patterns(demand: Demand, known: Ints) -> tuple[list[Ints], int]:
    """Give patterns (pieces of every size on a bar) that cover the demand, and a bound for their number.

    `known` (sizes, bars) are the patterns of a first layout of the whole demand: the search starts from them.
    """
    columns = _columns(demand, np.unique(known, axis=1))
    worth = _solve(columns, demand.counts)[1]
    return _round(columns, demand), _bound(demand, worth)


def _columns(demand: Demand, columns: Ints) -> Ints:
    """Price patterns until none is worth more than its bar, or could save a whole one; one column per pattern."""
    up = -(-demand.sizes // demand.step)
    for _ in range(ROUNDS):
        worth = _solve(columns, demand.counts)[1]
        pattern = _best_pattern(worth, up, demand)
        if math.ceil(_share(worth, pattern, demand)) >= math.ceil(worth @ demand.counts - 1e-6):
            break
        columns = np.column_stack([columns, pattern])
    return columns


def _solve(columns: Ints, counts: Ints) -> tuple[Floats, Floats]:
    """Give the uses of every pattern and the worth of a piece of every size."""
    result = linprog(np.ones(columns.shape[1]), A_ub=-columns, b_ub=-counts, method="highs-ds")
    return np.asarray(result.x), np.maximum(-np.asarray(result.ineqlin.marginals), 0.0)


def _best_pattern(worth: Floats, sizes: Ints, demand: Demand) -> Ints:
    """Solve the bounded knapsack of one bar."""
    best = np.zeros(demand.room // demand.step + 1)
    copies = np.minimum(demand.counts, (len(best) - 1) // sizes)
    items = [index for index, count in enumerate(copies) for _ in range(count) if worth[index] > 0]
    taken = [_take(best, int(sizes[index]), float(worth[index])) for index in items]
    pattern, room = np.zeros(len(sizes), dtype=np.int64), len(best) - 1
    for index, took in zip(reversed(items), reversed(taken), strict=True):
        if took[room]:
            pattern[index] += 1
            room -= int(sizes[index])
    return pattern


def _take(best: Floats, size: int, worth: float) -> Bools:
    with_it = np.full(len(best), -np.inf)
    with_it[size:] = best[: len(best) - size] + worth
    took = with_it > best + 1e-12
    best[took] = with_it[took]
    return took


def _bound(demand: Demand, worth: Floats) -> int:
    """Give Farley's bound: the worth of all pieces by that of the best bar, sizes rounded down."""
    pattern = _best_pattern(worth, demand.sizes // demand.step, demand)
    return math.ceil(_share(worth, pattern, demand))


def _share(worth: Floats, pattern: Ints, demand: Demand) -> float:
    return float(worth @ demand.counts / max(worth @ pattern, 1.0) - 1e-6)


def _round(columns: Ints, demand: Demand) -> list[Ints]:
    """Fix the whole uses of patterns, or else the likeliest one, and price anew for what is left."""
    patterns: list[Ints] = []
    while demand.counts.any():
        uses = _solve(columns, demand.counts)[0]
        for index in _fixed(uses):
            pattern = np.minimum(columns[:, index], demand.counts)
            patterns += [pattern] if pattern.any() else []
            demand = replace(demand, counts=demand.counts - pattern)
        columns = _columns(demand, np.minimum(columns, demand.counts[:, None]))
    return patterns


def _fixed(uses: Floats) -> Ints:
    """Give the patterns to cut now, each as often as it is used."""
    whole = np.floor(uses + 1e-6).astype(np.int64)
    return np.repeat(np.arange(len(uses)), whole) if whole.any() else np.array([np.argmax(uses)])


def worth_trying(sizes: Sequence[int]) -> bool:
    """Tell whether there are few enough sizes for patterns to pay."""
    return 0 < len(set(sizes)) <= MOST_SIZES
