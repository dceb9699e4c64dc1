"""The methods for bars, tried in turn until the bound is met: two greedy ones, then patterns and a dive.

Patterns that know all lengths are cheap; where they need a grid, bars are filled again before.
"""

from collections.abc import Callable
from functools import partial

import numpy as np

from isomould.arrays import Ints
from isomould.nesting.bar_bound import ROUNDS, BarBound, Demand, Hint, Proof, least_bars, length_bound, linear_bound
from isomould.nesting.bar_columns import SLIGHT, Programme, Shares, generate, make_programme, whole
from isomould.nesting.bar_greedy import first_fit, largest_first
from isomould.nesting.bar_ladder import Ladder, Ladders, exact_ladder
from isomould.nesting.bar_rack import BarRack, Need, Pattern, cost_of, less, merit, sum_of
from isomould.nesting.bar_squeeze import pack, squeeze
from isomould.nesting.bar_whole import Fits, choose_best, choose_whole
from isomould.nesting.search import Effort

MOST: dict[Effort, int] = {"quick": 100, "normal": 2_000, "best": 2_000}
"""Different sizes up to which patterns pay, by effort."""

GRIDS: dict[Effort, tuple[int, ...]] = {"quick": (1,), "normal": (1, 4, 16), "best": (1, 4, 16)}
"""Finenesses of the grids on which patterns are priced, one after another where that may prove or save a bar."""

AGAIN = 6
"""Rounds of pricing after each step of the dive."""

SHARE = 0.1
"""Part of the bars still to come that a step of the dive fixes, if none is used whole."""

FEW = 15.0
"""Bars still to come of which whole numbers are chosen at once."""

MIXES = 12
"""Mixes of bars that are tried."""

FEWER = 1e-4
"""What a bar costs beside its price, in costs of the dearest."""


def find_bars(
    rack: BarRack, need: Need, proof: Proof | None = None, fits: Fits | None = None, effort: Effort = "normal"
) -> tuple[list[Pattern], BarBound]:
    """Cut a need from bars at the least cost; pieces may be left if there are too few bars.

    Bounds hold for the rack of the proof if it is another; then `fits` knows of a few pieces what fits truly.
    """
    proof = proof or Proof(rack)
    patterns, bound = _find(rack, need, proof, effort)
    if fits is not None and not _meets(rack, patterns, need, bound):
        patterns = _best(rack, [patterns, choose_best(proof.rack, need, fits)])
    placed = Need(sum_of(rack, patterns), need.limits)
    return patterns, bound if _serves(patterns, need) else _bound(proof, placed, patterns, MOST[effort])


def _find(rack: BarRack, need: Need, proof: Proof, effort: Effort) -> tuple[list[Pattern], BarBound]:
    bound = length_bound(proof, need.counts)
    patterns = _best(rack, [first_fit(rack, need), largest_first(rack, need)])
    if _meets(rack, patterns, need, bound):
        return patterns, bound
    ladders = Ladders(rack, exact_ladder(rack, need.counts), GRIDS[effort])
    if ladders.exact is None:
        patterns = _squeezed(rack, patterns, need, bound)
    if not _meets(rack, patterns, need, bound) and len(rack.sizes) <= MOST[effort]:
        patterns, bound = _by_columns(proof, ladders, need, patterns, bound)
    return patterns, bound


def _by_columns(
    proof: Proof, ladders: Ladders, need: Need, patterns: list[Pattern], bound: BarBound
) -> tuple[list[Pattern], BarBound]:
    """Bound by patterns, and better some bars by the cheapest mixes that may hold all, or by a dive."""
    rack = ladders.rack
    programme = make_programme(rack, rack.costs, patterns)
    bound, demand, fineness = _settle(programme, ladders, proof, need, bound)
    if demand is not None and len(rack.costs) > 1 and not _meets(rack, patterns, need, bound):
        patterns = _mixed(rack, need, patterns, demand)
    if not _meets(rack, patterns, need, bound):
        patterns = _dive(_counting(programme), partial(ladders, fineness=fineness), need, patterns, bound)
    if not _meets(rack, patterns, need, bound):
        patterns = _best(rack, [patterns, choose_best(rack, need)])
    return _squeezed(rack, patterns, need, bound), bound


def _settle(
    programme: Programme, ladders: Ladders, proof: Proof, need: Need, bound: BarBound
) -> tuple[BarBound, Demand | None, int]:
    """Refine the grid until patterns can meet the bound in fractions, or are proved to cost more."""
    demand, several = None, len(programme.costs) > 1
    for fineness in ladders.finenesses:
        shares = generate(programme, need, ROUNDS, ladders(need.counts, fineness))
        least = whole(programme.top * shares.cost)
        if least > bound.cost or several:
            best = ladders.exact is not None and _alike(proof.rack, programme.rack)
            hint = Hint(_used(programme, shares), shares.proof, least, best)
            bound, demand = linear_bound(proof, hint, need, bound, fineness)
        if least <= bound.cost or several or ladders.exact:
            return bound, demand, fineness
    return bound, demand, ladders.finenesses[-1]


def _mixed(rack: BarRack, need: Need, best: list[Pattern], demand: Demand) -> list[Pattern]:
    """Try the cheapest whole numbers of bars that may hold all, one after another."""
    numbers = None
    for _ in range(MIXES):
        cost, numbers = least_bars(demand, rack.costs, numbers)
        if numbers is None or (_serves(best, need) and (cost, numbers.sum()) >= merit(rack, best)[1:]):
            break
        if bars := pack(rack, need, numbers):
            return bars
    return best


def _squeezed(rack: BarRack, patterns: list[Pattern], need: Need, bound: BarBound) -> list[Pattern]:
    """Save bars where it matters: in number if all cost the same."""
    if len(rack.costs) > 1 or not _serves(patterns, need) or _meets(rack, patterns, need, bound):
        return patterns
    return squeeze(rack, patterns, bound.bars)


def _alike(one: BarRack, other: BarRack) -> bool:
    return np.array_equal(one.sizes, other.sizes) and np.array_equal(one.rooms, other.rooms)


def _used(programme: Programme, shares: Shares) -> list[Pattern]:
    return [programme.patterns[k] for k in np.flatnonzero(shares.uses > SLIGHT)]


def _counting(programme: Programme) -> Programme:
    """Let every bar cost a little more than its price, so that of equal prices the fewer bars are taken."""
    if len(programme.costs) == 1:
        return programme
    rack = programme.rack
    return make_programme(rack, rack.costs + FEWER * rack.costs.max(), programme.patterns)


def _best(rack: BarRack, plans: list[list[Pattern]]) -> list[Pattern]:
    return min(plans, key=lambda patterns: merit(rack, patterns))


def _meets(rack: BarRack, patterns: list[Pattern], need: Need, bound: BarBound) -> bool:
    """Tell whether nothing can be better: all pieces, at the bound of the cost, and the fewest bars at that."""
    return _serves(patterns, need) and (cost_of(rack, patterns), len(patterns)) <= (bound.cost, bound.fewest)


def _serves(patterns: list[Pattern], need: Need) -> bool:
    return sum(int(pattern.takes.sum()) for pattern in patterns) == need.counts.sum()


def _bound(proof: Proof, need: Need, patterns: list[Pattern], most: int) -> BarBound:
    """Bound what found a place by length, and by patterns if there are not too many sizes."""
    proof = Proof(proof.rack)
    bound = length_bound(proof, need.counts)
    small = 0 < len(need.counts) <= most
    return linear_bound(proof, Hint(patterns), need, bound, 1)[0] if small else bound


def _dive(
    programme: Programme, ladder: Callable[[Ints], Ladder], need: Need, best: list[Pattern], bound: BarBound
) -> list[Pattern]:
    """Fix bars step by step, fill the rest each time, and end when nothing better can come."""
    rack, left = programme.rack, need
    fixed, few = list[Pattern](), FEW
    while left.counts.any() and not _meets(rack, best, need, bound):
        shares = generate(programme, left, AGAIN if fixed else ROUNDS, ladder(left.counts))
        if _serves(best, need) and _to_come(programme, shares, fixed) >= merit(rack, best)[1:]:
            break
        if (to_come := float(shares.uses.sum())) <= few:
            few = to_come / 2
            best = _best(rack, [best, fixed + choose_whole(programme, left, shares)])
        new = _fix(programme, shares, left)
        if not new:
            break
        fixed, left = fixed + new, less(left, new)
        best = _best(rack, [best, fixed, fixed + first_fit(rack, left), fixed + largest_first(rack, left)])
    return best


def _to_come(programme: Programme, shares: Shares, fixed: list[Pattern]) -> tuple[float, int]:
    """Give the least cost and number of bars that can come of what is fixed."""
    costs = programme.rack.costs[[pattern.kind for pattern in programme.patterns[: len(shares.uses)]]]
    cost = whole(cost_of(programme.rack, fixed) + float(shares.uses @ costs))
    return cost, len(fixed) + whole(float(shares.uses.sum()))


def _fix(programme: Programme, shares: Shares, left: Need) -> list[Pattern]:
    """Give the bars that are used whole, or else those that are used most."""
    entire = np.repeat(np.arange(len(shares.uses)), np.floor(shares.uses + SLIGHT).astype(np.int64))
    most = np.argsort(-shares.uses, kind="stable")[: np.count_nonzero(shares.uses > SLIGHT)]
    enough = len(entire) or max(1, round(SHARE * float(shares.uses.sum())))
    new: list[Pattern] = []
    for index in (entire if len(entire) else most).tolist():
        pattern = programme.patterns[index]
        if len(new) < enough and left.limits[pattern.kind] > 0 and (pattern.takes <= left.counts).all():
            new.append(pattern)
            left = less(left, [pattern])
    return new
