"""The methods for bars, tried in turn until the bound is met: two greedy ones, then patterns and a dive."""

import math
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.nesting.bar_columns import Programme, Shares, bound_cost, generate, make_programme
from isomould.nesting.bar_greedy import first_fit, largest_first
from isomould.nesting.bar_rack import BarRack, Need, Pattern, area_bound, cost_of, less, merit, sum_of
from isomould.nesting.layout import BoundKind

MOST = 2_000
"""Different sizes up to which patterns pay."""

ROUNDS = 60
"""Rounds of pricing before the dive."""

AGAIN = 6
"""Rounds of pricing after each step of the dive."""

SHARE = 0.1
"""Part of the bars still to come that a step of the dive fixes, if none is used whole."""

SLIGHT = 1e-6

FEWER = 1e-4
"""What a bar costs beside its price, in costs of the dearest."""


@dataclass(frozen=True)
class BarBound:
    """No cutting of the same pieces takes fewer bars or costs less; `kind` tells what proves the number."""

    bars: int
    cost: float
    kind: BoundKind


def find_bars(rack: BarRack, need: Need) -> tuple[list[Pattern], BarBound]:
    """Cut a need from bars at the least cost; pieces may be left if there are too few bars."""
    patterns = _best(rack, [first_fit(rack, need), largest_first(rack, need)])
    bound = _length_bound(rack, need.counts)
    if not _meets(rack, patterns, need, bound) and len(rack.sizes) <= MOST:
        programme = make_programme(rack, rack.costs, patterns)
        bound = _linear_bound(programme, need, bound)
        if not _meets(rack, patterns, need, bound):
            patterns = _dive(_counting(programme), need, patterns, bound)
    placed = Need(sum_of(rack, patterns), need.limits)
    return patterns, bound if _serves(patterns, need) else _bound(rack, placed, patterns)


def _counting(programme: Programme) -> Programme:
    """Let every bar cost a little more than its price, so that of equal prices the fewer bars are taken."""
    if len(programme.costs) == 1:
        return programme
    rack = programme.rack
    return make_programme(rack, rack.costs + FEWER * rack.costs.max(), programme.patterns)


def _best(rack: BarRack, plans: list[list[Pattern]]) -> list[Pattern]:
    return min(plans, key=lambda patterns: merit(rack, patterns))


def _meets(rack: BarRack, patterns: list[Pattern], need: Need, bound: BarBound) -> bool:
    """Tell whether nothing can be better: all pieces, at the bound of the cost, and no bar more than its own bound."""
    return _serves(patterns, need) and cost_of(rack, patterns) <= bound.cost and len(patterns) <= bound.bars


def _serves(patterns: list[Pattern], need: Need) -> bool:
    return sum(int(pattern.takes.sum()) for pattern in patterns) == need.counts.sum()


def _bound(rack: BarRack, need: Need, patterns: list[Pattern]) -> BarBound:
    """Bound by length, and by patterns if there are not too many sizes."""
    bound = _length_bound(rack, need.counts)
    small = 0 < len(rack.sizes) <= MOST
    return _linear_bound(make_programme(rack, rack.costs, patterns), need, bound) if small else bound


def _length_bound(rack: BarRack, counts: Ints) -> BarBound:
    bars = area_bound(rack, counts)
    return BarBound(bars, bars * float(rack.costs.min()), "area")


def _linear_bound(programme: Programme, need: Need, known: BarBound) -> BarBound:
    """Better a bound by the programme's worths, and by those of another that counts bars if they differ in cost."""
    rack, ones = programme.rack, np.ones(len(programme.costs))
    worths = [_worth(programme, need)]
    if len(ones) > 1:
        worths.append(_worth(make_programme(rack, ones, programme.patterns), need))
    cost, bars = (_whole(bound_cost(rack, costs, need, worths)) for costs in (rack.costs, ones))
    kind: BoundKind = "lp" if bars > known.bars else "area"
    return BarBound(max(bars, known.bars), max(float(cost), known.cost), kind)


def _worth(programme: Programme, need: Need) -> Floats:
    """Give what a piece of every size is worth, priced more closely if that may prove more."""
    shares = generate(programme, need, ROUNDS)
    costs = programme.top * programme.costs
    if _whole(bound_cost(programme.rack, costs, need, [shares.worth])) < _whole(programme.top * shares.cost):
        shares = generate(programme, need, ROUNDS, up=False)
    return shares.worth


def _whole(cost: float) -> int:
    return max(math.ceil(cost - SLIGHT), 0)


def _dive(programme: Programme, need: Need, best: list[Pattern], bound: BarBound) -> list[Pattern]:
    """Fix bars step by step, fill the rest greedily each time, and end when nothing better can come."""
    rack, left = programme.rack, need
    fixed: list[Pattern] = []
    while left.counts.any() and not _meets(rack, best, need, bound):
        shares = generate(programme, left, AGAIN if fixed else ROUNDS)
        new = _fix(programme, shares, left)
        if not new or (_serves(best, need) and _to_come(programme, shares, fixed) >= merit(rack, best)[1:]):
            break
        fixed, left = fixed + new, less(left, new)
        best = _best(rack, [best, fixed, fixed + first_fit(rack, left), fixed + largest_first(rack, left)])
    return best


def _to_come(programme: Programme, shares: Shares, fixed: list[Pattern]) -> tuple[float, int]:
    """Give the least cost and number of bars that can come of what is fixed."""
    costs = programme.rack.costs[[pattern.kind for pattern in programme.patterns[: len(shares.uses)]]]
    cost = _whole(cost_of(programme.rack, fixed) + float(shares.uses @ costs))
    return cost, len(fixed) + _whole(float(shares.uses.sum()))


def _fix(programme: Programme, shares: Shares, left: Need) -> list[Pattern]:
    """Give the bars that are used whole, or else those that are used most."""
    whole = np.repeat(np.arange(len(shares.uses)), np.floor(shares.uses + SLIGHT).astype(np.int64))
    most = np.argsort(-shares.uses, kind="stable")[: np.count_nonzero(shares.uses > SLIGHT)]
    enough = len(whole) or max(1, round(SHARE * float(shares.uses.sum())))
    new: list[Pattern] = []
    for index in (whole if len(whole) else most).tolist():
        pattern = programme.patterns[index]
        if len(new) < enough and left.limits[pattern.kind] > 0 and (pattern.takes <= left.counts).all():
            new.append(pattern)
            left = less(left, [pattern])
    return new
