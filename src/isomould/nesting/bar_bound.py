"""What no cutting of the same pieces can beat, in number of bars and in cost."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp

from isomould.arrays import Floats, Ints
from isomould.nesting.bar_columns import SLIGHT, generate, make_programme, whole
from isomould.nesting.bar_pricing import copies_of, grid_of, most_worth
from isomould.nesting.bar_rack import BarRack, Need, Pattern
from isomould.nesting.layout import BoundKind

ROUNDS = 60
"""Rounds of pricing."""


@dataclass(frozen=True)
class BarBound:
    """No cutting of the same pieces takes fewer bars, or costs less, or costs as little with fewer than `fewest`.

    `kind` tells what proves the number.
    """

    bars: int
    cost: float
    kind: BoundKind
    fewest: int


@dataclass(frozen=True, eq=False)
class Proof:
    """What bounds may assume: a rack in which every cutting fits, and what all bars lose besides (micrometres)."""

    rack: BarRack
    lost: int = 0


@dataclass(frozen=True, eq=False)
class Demand:
    """What whole numbers of bars must hold together: every row (m, k) of what each kind holds, as much as asked (m,).

    Whatever a piece of every size is worth, bars must be able to hold what all are worth together: a row for the
    lengths and one for each of some worths. `limits` (k,) is how many there are of every kind.
    """

    rows: Floats
    asked: Floats
    limits: Ints


def length_bound(proof: Proof, counts: Ints) -> BarBound:
    """Bound by lengths, long pieces counted apart; every bar costs as much as the cheapest."""
    room, sizes = int(proof.rack.rooms.max()), np.repeat(proof.rack.sizes, counts)
    limits = np.unique(np.append(sizes[2 * sizes <= room], 0))
    bars = max(_bound_from(sizes, room, int(limit)) for limit in limits)
    bars = max(bars, -(-(int(sizes.sum()) + proof.lost) // room))
    return BarBound(bars, bars * float(proof.rack.costs.min()), "area", bars)


def _bound_from(sizes: Ints, room: int, limit: int) -> int:
    """Count pieces above room - limit as full bars, leave out those below limit, spread the others.

    Martello and Toth 1990, bound L2.
    """
    alone = int(np.count_nonzero(sizes > room - limit))
    large = sizes[(2 * sizes > room) & (sizes <= room - limit)]
    small = int(sizes[(sizes >= limit) & (2 * sizes <= room)].sum())
    over = small - (len(large) * room - int(large.sum()))
    return alone + len(large) + max(-(-over // room), 0)


def linear_bound(
    proof: Proof, patterns: Sequence[Pattern], need: Need, known: BarBound, fineness: int
) -> tuple[BarBound, Demand]:
    """Better a bound by the worths of two programmes, for costs and for bars, on a grid.

    Sizes are rounded down to the grid and patterns may hold whatever fits then, so what is proved there holds.
    """
    ones = np.ones(len(proof.rack.costs))
    copies = copies_of(proof.rack, need.counts, np.ones(len(need.counts)))
    step = grid_of(proof.rack, int(copies.sum()), fineness)
    grid = BarRack(proof.rack.sizes // step, proof.rack.rooms // step, proof.rack.costs)
    asked = [grid.costs, ones] if len(ones) > 1 else [grid.costs]
    worths = [generate(make_programme(grid, costs, patterns), need, ROUNDS, None).worth for costs in asked]
    demand = _demand(proof, need, worths, [most_worth(grid, need, worth) for worth in worths])
    bars, _ = least_bars(demand, ones)
    cost, numbers = least_bars(demand, proof.rack.costs)
    kind: BoundKind = "lp" if bars > known.bars else known.kind
    fewest = known.fewest if numbers is None else int(numbers.sum())
    return BarBound(max(whole(bars), known.bars), max(float(whole(cost)), known.cost), kind, fewest), demand


def _demand(proof: Proof, need: Need, worths: Sequence[Floats], most: Sequence[Floats]) -> Demand:
    rows = np.array([proof.rack.rooms.astype(np.float64), *most])
    length = float(proof.rack.sizes @ need.counts) + proof.lost
    asked = np.array([length, *(float(worth @ need.counts) for worth in worths)])
    scale = np.maximum(rows.max(axis=1), 1e-12)
    return Demand(rows / scale[:, None], asked / scale, np.minimum(need.limits, need.counts.sum()))


def least_bars(demand: Demand, costs: Floats, dearer: Ints | None = None) -> tuple[float, Ints | None]:
    """Give the least cost of whole numbers of bars that hold a demand, and the fewest at that cost (k,).

    They cost more, or as much and are more, than others if these are given. Of a single kind of bar the numbers
    are Farley's bound (1990). The cost is 0 if there are too few bars.
    """
    tie = 0.5 / max(int(demand.limits.sum()), 1)
    weights = costs + tie
    above = 0.0 if dearer is None else float(weights @ dearer) + tie / 2
    enough = LinearConstraint(demand.rows, demand.asked - SLIGHT, np.inf)
    dear = LinearConstraint(weights[None, :], above, np.inf)
    integers = np.ones(len(costs), dtype=np.int64)
    limits = Bounds(0, demand.limits.astype(np.float64))
    found = milp(weights, integrality=integers, bounds=limits, constraints=[enough, dear], options={"mip_rel_gap": 0.0})
    if found.x is None:
        return 0.0, None
    numbers = np.rint(found.x).astype(np.int64)
    return float(costs @ numbers), numbers
