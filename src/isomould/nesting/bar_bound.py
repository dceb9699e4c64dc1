"""What no cutting of the same pieces can beat, in number of bars and in cost."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp

from isomould.arrays import Floats, Ints
from isomould.nesting.bar_columns import SLIGHT, generate, make_programme, whole
from isomould.nesting.bar_ladder import Ladder, exact_ladder, grid, grid_step
from isomould.nesting.bar_pricing import most_worth
from isomould.nesting.bar_rack import BarRack, Need, Pattern
from isomould.nesting.layout import BoundKind
from isomould.nesting.stop import Stops, never
from isomould.ties import first_least

ROUNDS = 60
"""Rounds of pricing."""

MIXES = 100_000
"""Numbers of bars of every kind that are listed; of more the best are searched."""


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


@dataclass(frozen=True, eq=False)
class Hint:
    """What a search knows: good patterns, worths (n,) of its sizes, and the cost that patterns can meet at best.

    The worths are the `best` if they come from all patterns of the proof's own rack. A search that `stops` looks for no
    better worths: what any worths prove holds.
    """

    patterns: Sequence[Pattern]
    worth: Floats | None = None
    enough: float = np.inf
    best: bool = False
    stops: Stops = never


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


def linear_bound(proof: Proof, hint: Hint, need: Need, known: BarBound, fineness: int) -> tuple[BarBound, Demand]:
    """Better a bound by the worths of two programmes, for costs and for bars.

    Unless lengths are few, sizes are rounded down to a grid and patterns may hold whatever fits then: what is proved
    there holds. Bars of one length need no programme where the worths of the hint prove enough.
    """
    rack, ladder = _below(proof.rack, need, fineness)
    ones, worth = np.ones(len(rack.costs)), hint.worth
    if worth is not None and len(ones) == 1:
        found = _bounded(proof, need, known, [(worth, most_worth(rack, need, worth, ladder))])
        if hint.best or found[0].cost >= hint.enough:
            return found
    worth = worth if worth is not None and hint.best else _worth(rack, need, rack.costs, hint, ladder)
    worths = [worth, *([_worth(rack, need, ones, hint, ladder)] if len(ones) > 1 else [])]
    return _bounded(proof, need, known, [(worth, most_worth(rack, need, worth, ladder)) for worth in worths])


def _below(rack: BarRack, need: Need, fineness: int) -> tuple[BarRack, Ladder]:
    """Give a rack in which every cutting fits, and a ladder that is exact for it."""
    ladder = exact_ladder(rack, need.counts)
    if ladder is not None:
        return rack, ladder
    step = grid_step(rack, need.counts, fineness)
    rough = BarRack(rack.sizes // step, rack.rooms // step, rack.costs)
    return rough, grid(rough, 1)


def _worth(rack: BarRack, need: Need, costs: Floats, hint: Hint, ladder: Ladder) -> Floats:
    programme = make_programme(rack, costs, hint.patterns, hint.stops)
    return generate(programme, need, ROUNDS, ladder).proof


def _bounded(
    proof: Proof, need: Need, known: BarBound, worths: Sequence[tuple[Floats, Floats]]
) -> tuple[BarBound, Demand]:
    """Bound by some worths of the sizes (n,), each with the most worth that bars of every kind (k,) hold."""
    demand = _demand(proof, need, worths)
    bars, _ = least_bars(demand, np.ones(len(proof.rack.costs)))
    cost, numbers = least_bars(demand, proof.rack.costs)
    kind: BoundKind = "lp" if bars > known.bars else known.kind
    fewest = known.fewest if numbers is None else int(numbers.sum())
    return BarBound(max(whole(bars), known.bars), max(float(whole(cost)), known.cost), kind, fewest), demand


def _demand(proof: Proof, need: Need, worths: Sequence[tuple[Floats, Floats]]) -> Demand:
    rows = np.array([proof.rack.rooms.astype(np.float64), *(most for _, most in worths)])
    length = float(proof.rack.sizes @ need.counts) + proof.lost
    asked = np.array([length, *(float(worth @ need.counts) for worth, _ in worths)])
    scale = np.maximum(rows.max(axis=1), 1e-12)
    return Demand(rows / scale[:, None], asked / scale, np.minimum(need.limits, need.counts.sum()))


def least_bars(demand: Demand, costs: Floats, dearer: Ints | None = None) -> tuple[float, Ints | None]:
    """Give the least cost of whole numbers of bars that hold a demand, and the fewest at that cost (k,).

    They cost more, or as much and are more, than others if these are given. Of a single kind of bar the numbers
    are Farley's bound (1990). The cost is 0 if there are too few bars.
    """
    if len(costs) == 1:
        return _least_alike(demand, float(costs[0]), dearer)
    tie = 0.5 / max(int(demand.limits.sum()), 1)
    weights = costs + tie
    above = 0.0 if dearer is None else float(weights @ dearer) + tie / 2
    few = np.prod(demand.limits + 1.0) <= MIXES
    numbers = (_least_listed if few else _least_searched)(demand, weights, above)
    return (0.0, None) if numbers is None else (float(costs @ numbers), numbers)


def _least_listed(demand: Demand, weights: Floats, above: float) -> Ints | None:
    """Look at all numbers of bars (k,) that there are."""
    mixes = np.stack([axis.ravel() for axis in np.indices(tuple(demand.limits + 1))])
    weight = weights @ mixes
    held = (demand.rows @ mixes >= demand.asked[:, None] - SLIGHT).all(axis=0) & (weight >= above)
    return mixes[:, held][:, first_least(weight[held])] if held.any() else None


def _least_searched(demand: Demand, weights: Floats, above: float) -> Ints | None:
    enough = LinearConstraint(demand.rows, demand.asked - SLIGHT, np.inf)
    dear = LinearConstraint(weights[None, :], above, np.inf)
    integers = np.ones(len(weights), dtype=np.int64)
    limits = Bounds(0, demand.limits.astype(np.float64))
    found = milp(weights, integrality=integers, bounds=limits, constraints=[enough, dear], options={"mip_rel_gap": 0.0})
    return None if found.x is None else np.rint(found.x).astype(np.int64)


def _least_alike(demand: Demand, cost: float, dearer: Ints | None) -> tuple[float, Ints | None]:
    """Give the same of bars of one kind."""
    held = demand.rows[:, 0] > 0
    bars = max((whole(float(x)) for x in demand.asked[held] / demand.rows[held, 0]), default=0)
    bars = bars if dearer is None else max(bars, int(dearer[0]) + 1)
    return (cost * bars, np.array([bars])) if bars <= demand.limits[0] else (0.0, None)
