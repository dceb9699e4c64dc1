"""The methods for bars, tried in turn until the bound is met: two greedy ones, then patterns and a dive.

Patterns that know all lengths are cheap; where they need a grid, bars are filled again before.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from isomould.arrays import Ints
from isomould.nesting.bar_bound import ROUNDS, BarBound, Demand, Hint, Proof, least_bars, length_bound, linear_bound
from isomould.nesting.bar_columns import SLIGHT, Programme, Shares, generate, make_programme, whole
from isomould.nesting.bar_greedy import first_fit, largest_first
from isomould.nesting.bar_ladder import Ladder, Ladders, exact_ladder
from isomould.nesting.bar_rack import BarRack, Need, Pattern, bars_in, cost_of, less, merit, sum_of
from isomould.nesting.bar_squeeze import pack, squeeze
from isomould.nesting.bar_whole import Fits, choose_best, choose_whole
from isomould.nesting.search import Effort, Search
from isomould.ties import FINE, in_order

MOST: dict[Effort, int] = {"quick": 100, "normal": 2_000, "best": 2_000}
"""Different sizes up to which patterns pay, by effort."""

GRIDS: dict[Effort, tuple[int, ...]] = {"quick": (1,), "normal": (1, 4, 16), "best": (1, 4, 16)}
"""Finenesses of the grids on which patterns are priced, one after another where that may prove or save a bar."""

AGAIN = 6
"""Rounds of pricing after each step of the dive."""

DIVES: dict[Effort, int] = {"quick": 1, "normal": 4, "best": 11}
"""Dives that are tried where nothing meets the bound: a hasty one, then patient ones."""

LEAST = 0.7
"""Of its use, what a bar is taken for at least where a dive goes by chance."""

MIXES = 12
"""Mixes of bars that are tried."""

SQUEEZED = 2_000
"""Bars up to which some are saved by filling all others again; of more, patterns alone decide."""

FEWER = 1e-4
"""What a bar costs beside its price, in costs of the dearest."""


@dataclass(frozen=True)
class _Manner:
    """How a dive goes.

    Attributes
    ----------
    share
        Part of the bars still to come that a step fixes, if none is used whole.
    few
        Bars still to come of which whole numbers are chosen at once; of half as many again, and so on.
    chance
        Lets a dive fix others of the bars that are used much; None fixes those that are used most.
    """

    share: float
    few: float
    chance: np.random.Generator | None = None


def _manner(number: int) -> _Manner:
    """Give the manner of a dive by its number: most cuttings need no more than the hasty first one."""
    if number == 0:
        return _Manner(share=0.1, few=15.0)
    return _Manner(share=0.02, few=45.0, chance=np.random.default_rng(number) if number > 1 else None)


@dataclass(frozen=True, eq=False)
class _Case:
    """What is asked: a need of a rack, what bounds may assume of it, and how long to search."""

    rack: BarRack
    need: Need
    proof: Proof
    task: Search

    def serves(self, patterns: Sequence[Pattern]) -> bool:
        """Tell whether all pieces have a place."""
        pieces = sum(int(pattern.takes.sum()) * pattern.times for pattern in patterns)
        return pieces == int(self.need.counts.sum())

    def meets(self, patterns: Sequence[Pattern], bound: BarBound) -> bool:
        """Tell whether nothing can be better: all pieces, at the bound of the cost, and the fewest bars at that."""
        worth = cost_of(self.rack, patterns), bars_in(patterns)
        return self.serves(patterns) and worth <= (bound.cost, bound.fewest)

    def best(self, *plans: list[Pattern]) -> list[Pattern]:
        """Give the best of several plans, the first of equal ones."""
        return min(plans, key=lambda patterns: merit(self.rack, patterns))

    def is_done(self, patterns: Sequence[Pattern], bound: BarBound) -> bool:
        """Tell whether to stop: nothing can be better, or no time is left."""
        return self.meets(patterns, bound) or self.task.stops


def find_bars(
    rack: BarRack, need: Need, proof: Proof | None = None, fits: Fits | None = None, task: Search | None = None
) -> tuple[list[Pattern], BarBound]:
    """Cut a need from bars at the least cost; pieces may be left if there are too few bars.

    Bounds hold for the rack of the proof if it is another; then `fits` knows of a few pieces what fits truly. A search
    that is told to stop gives the best bars so far.
    """
    case = _Case(rack, need, proof or Proof(rack), task or Search())
    patterns, bound = _find(case)
    if fits is not None and not case.is_done(patterns, bound):
        patterns = case.best(patterns, choose_best(case.proof.rack, need, fits))
    return patterns, bound if case.serves(patterns) else _bound_of_placed(case, patterns)


def _find(case: _Case) -> tuple[list[Pattern], BarBound]:
    rack, need, effort = case.rack, case.need, case.task.effort
    bound = length_bound(case.proof, need.counts)
    patterns = case.best(first_fit(rack, need), largest_first(rack, need))
    if case.is_done(patterns, bound):
        return patterns, bound
    ladders = Ladders(rack, exact_ladder(rack, need.counts), GRIDS[effort])
    if ladders.exact is None and bars_in(patterns) <= SQUEEZED:
        patterns = _squeezed(case, patterns, bound)
    if not case.is_done(patterns, bound) and len(rack.sizes) <= MOST[effort]:
        patterns, bound = _by_columns(case, ladders, patterns, bound)
    return patterns, bound


def _by_columns(
    case: _Case, ladders: Ladders, patterns: list[Pattern], bound: BarBound
) -> tuple[list[Pattern], BarBound]:
    """Bound by patterns, and better some bars by the cheapest mixes that may hold all, or by a dive."""
    rack = case.rack
    programme = make_programme(rack, rack.costs, patterns, lambda: case.task.stops)
    bound, demand, fineness = _settle(case, programme, ladders, bound)
    if demand is not None and len(rack.costs) > 1 and not case.is_done(patterns, bound):
        patterns = _mixed(case, patterns, demand)
    counting, ladder = _counting(programme), partial(ladders, fineness=fineness)
    for number in range(DIVES[case.task.effort]):
        if not case.is_done(patterns, bound):
            patterns = _dive(case, counting, ladder, (patterns, bound), _manner(number))
    if not case.is_done(patterns, bound):
        patterns = case.best(patterns, choose_best(rack, case.need))
    return _squeezed(case, patterns, bound), bound


def _settle(
    case: _Case, programme: Programme, ladders: Ladders, bound: BarBound
) -> tuple[BarBound, Demand | None, int]:
    """Refine the grid until patterns can meet the bound in fractions, or are proved to cost more."""
    proof, need = case.proof, case.need
    demand, several = None, len(programme.costs) > 1
    for fineness in ladders.finenesses:
        shares = generate(programme, need, ROUNDS, ladders(need.counts, fineness))
        least = whole(programme.top * shares.cost)
        if least > bound.cost or several:
            best = ladders.exact is not None and _alike(proof.rack, programme.rack)
            hint = Hint(_used(programme, shares), shares.proof, least, best, programme.stops)
            bound, demand = linear_bound(proof, hint, need, bound, fineness)
        if least <= bound.cost or several or ladders.exact or programme.stops():
            return bound, demand, fineness
    return bound, demand, ladders.finenesses[-1]


def _mixed(case: _Case, best: list[Pattern], demand: Demand) -> list[Pattern]:
    """Try the cheapest whole numbers of bars that may hold all, one after another."""
    rack, numbers = case.rack, None
    for _ in range(MIXES):
        cost, numbers = least_bars(demand, rack.costs, numbers)
        if numbers is None or case.task.stops:
            break
        if case.serves(best) and (cost, numbers.sum()) >= merit(rack, best)[1:]:
            break
        if bars := pack(rack, case.need, numbers, lambda: case.task.stops):
            return bars
    return best


def _squeezed(case: _Case, patterns: list[Pattern], bound: BarBound) -> list[Pattern]:
    """Save bars where it matters: in number if all cost the same."""
    matters = len(case.rack.costs) == 1 and bars_in(patterns) <= SQUEEZED
    if not matters or not case.serves(patterns) or case.is_done(patterns, bound):
        return patterns
    return squeeze(case.rack, patterns, bound.bars, lambda: case.task.stops)


def _bound_of_placed(case: _Case, patterns: list[Pattern]) -> BarBound:
    """Bound what found a place by length, and by patterns if there are not too many sizes."""
    placed, proof = Need(sum_of(case.rack, patterns), case.need.limits), Proof(case.proof.rack)
    bound = length_bound(proof, placed.counts)
    if case.task.stops or not 0 < len(placed.counts) <= MOST[case.task.effort]:
        return bound
    return linear_bound(proof, Hint(patterns), placed, bound, 1)[0]


def _dive(
    case: _Case,
    programme: Programme,
    ladder: Callable[[Ints], Ladder],
    known: tuple[list[Pattern], BarBound],
    manner: _Manner,
) -> list[Pattern]:
    """Fix bars step by step, fill the rest each time, and end when nothing better can come."""
    rack, left = programme.rack, case.need
    best, bound = known
    fixed, few = list[Pattern](), manner.few
    while left.counts.any() and not case.is_done(best, bound):
        shares = generate(programme, left, AGAIN if fixed else ROUNDS, ladder(left.counts))
        if case.serves(best) and _to_come(programme, shares, fixed) >= merit(rack, best)[1:]:
            break
        if (to_come := float(shares.uses.sum())) <= few:
            few = to_come / 2
            best = case.best(best, fixed + choose_whole(programme, left, shares))
        new = _fix(programme, shares, left, manner)
        if not new:
            break
        fixed, left = fixed + new, less(left, new)
        best = case.best(best, fixed, fixed + first_fit(rack, left), fixed + largest_first(rack, left))
    return best


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


def _to_come(programme: Programme, shares: Shares, fixed: list[Pattern]) -> tuple[float, int]:
    """Give the least cost and number of bars that can come of what is fixed."""
    costs = programme.rack.costs[[pattern.kind for pattern in programme.patterns[: len(shares.uses)]]]
    cost = whole(cost_of(programme.rack, fixed) + float(shares.uses @ costs))
    return cost, bars_in(fixed) + whole(float(shares.uses.sum()))


def _fix(programme: Programme, shares: Shares, left: Need, manner: _Manner) -> list[Pattern]:
    """Give the bars that are used whole, or else those that are used most; by chance, not all of them."""
    uses = shares.uses
    if manner.chance is not None:
        uses = uses * manner.chance.uniform(LEAST, 1.0, len(uses))
    entire = np.floor(uses + SLIGHT).astype(np.int64)
    if entire.any():
        chosen = [(int(k), int(entire[k])) for k in np.flatnonzero(entire)]
        return _as_far_as_wanted(programme, chosen, left)
    most = in_order(-uses, FINE)[: np.count_nonzero(uses > SLIGHT)]
    enough = max(1, round(manner.share * float(uses.sum())))
    return _as_far_as_wanted(programme, [(int(k), 1) for k in most], left)[:enough]


def _as_far_as_wanted(programme: Programme, chosen: Sequence[tuple[int, int]], left: Need) -> list[Pattern]:
    """Give patterns so many times each, but no more bars and pieces than are left."""
    new: list[Pattern] = []
    for index, asked in chosen:
        pattern = programme.patterns[index]
        used = pattern.takes > 0
        wanted = int((left.counts[used] // pattern.takes[used]).min())
        times = min(asked, wanted, int(left.limits[pattern.kind]))
        if times > 0:
            new.append(replace(pattern, times=times))
            left = less(left, new[-1:])
    return new
