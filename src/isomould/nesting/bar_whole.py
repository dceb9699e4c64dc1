"""Whole numbers of patterns: among the best that a programme knows, or among all that there are."""

from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp

from isomould.arrays import Bools, Floats, Ints
from isomould.nesting.bar_columns import SLIGHT, Programme, Shares, fits
from isomould.nesting.bar_near import near_patterns
from isomould.nesting.bar_rack import BarRack, Need, Pattern, copies_of, sum_of
from isomould.ties import FINE, first_least, in_order

BRANCHES, MANY = 50, 1_000
"""Branches that whole numbers may take of the best patterns, and of all."""

CHOICE, NEAR = 400, 3_000
"""Patterns among which whole numbers are chosen: of those that are known, and of all that can be part of the best."""

STATES = 1_000
"""Needs, less than a given one or equal, that are solved one after another."""

CUTTINGS = 10_000
"""Ways to cut the longest bar up to which all patterns are listed."""

Fits = Callable[[Ints], Bools]
"""Tells for pieces of every size (n,) whether they fit each kind of bar (k,)."""


def choose_whole(programme: Programme, need: Need, shares: Shares) -> list[Pattern]:
    """Give the cheapest bars, as far as few branches tell; or none.

    They are chosen among all patterns that can be part of the best, or where these are too many, among the known
    patterns that gain the most.
    """
    patterns = near_patterns(programme, need, shares)
    patterns = _best_known(programme, need, shares) if patterns is None else patterns[:NEAR]
    if not patterns:
        return []
    takes, kinds = np.array([pattern.takes for pattern in patterns]), [pattern.kind for pattern in patterns]
    return _trimmed(_numbers((takes, kinds), need, programme.costs[kinds], BRANCHES), patterns, need)


def _best_known(programme: Programme, need: Need, shares: Shares) -> list[Pattern]:
    known = [pattern for pattern, fit in zip(programme.patterns, fits(programme, need), strict=True) if fit]
    gains = [float(p.takes @ shares.worth - programme.costs[p.kind] - shares.tolls[p.kind]) for p in known]
    return [known[k] for k in in_order(-np.array(gains), FINE)[:CHOICE]]


def choose_best(rack: BarRack, need: Need, fits: Fits | None = None) -> list[Pattern]:
    """Give the bars of all patterns that hold the most pieces, at the least cost, and the fewest at that.

    None if there are too many patterns. Where the sizes of a rack are the least that pieces may take, `fits` tells
    which patterns fit.
    """
    patterns = _all_patterns(rack, need) if fits is None else _those_that_fit(rack, need, fits)
    if not patterns:
        return []
    all_are_cut = sum_of(rack, patterns).all() and np.prod(need.counts + 1.0) <= STATES
    bars = _step_by_step(rack, need, patterns) if all_are_cut else []
    short = np.bincount([bar.kind for bar in bars], minlength=len(need.limits)) > need.limits
    return bars if bars and not short.any() else _searched(rack, need, patterns)


def _step_by_step(rack: BarRack, need: Need, patterns: Sequence[Pattern]) -> list[Pattern]:
    """Solve what is needed after what is less, as if there were bars enough."""
    takes = np.array([pattern.takes for pattern in patterns])
    strides = np.append(np.cumprod(need.counts[::-1] + 1)[-2::-1], 1)
    states = np.stack([axis.ravel() for axis in np.indices(tuple(need.counts + 1))], axis=1)
    weights = rack.costs[[pattern.kind for pattern in patterns]] * (need.counts.sum() + 1.0) + 1.0
    least, chosen = np.zeros(len(states)), np.zeros(len(states), dtype=np.int64)
    for state, wanted in enumerate(states[1:], start=1):
        fit = np.flatnonzero(takes[:, np.argmax(wanted > 0)])
        weight = weights[fit] + least[np.maximum(wanted - takes[fit], 0) @ strides]
        least[state], chosen[state] = weight.min(), fit[first_least(weight)]
    return _traced(need, patterns, chosen, strides)


def _traced(need: Need, patterns: Sequence[Pattern], chosen: Ints, strides: Ints) -> list[Pattern]:
    """Follow the chosen patterns from all that is needed down to nothing."""
    left, bars = need.counts, list[Pattern]()
    while left.any():
        pattern = patterns[int(chosen[left @ strides])]
        bars.append(Pattern(pattern.kind, np.minimum(pattern.takes, left)))
        left = left - bars[-1].takes
    return bars


def _searched(rack: BarRack, need: Need, patterns: Sequence[Pattern]) -> list[Pattern]:
    """Choose among patterns and pieces that are left, each of which costs more than all bars."""
    kinds = [pattern.kind for pattern in patterns]
    left = np.full(len(need.counts), need.counts.sum() + 1.0)
    takes = np.vstack([np.array([pattern.takes for pattern in patterns]), np.eye(len(left), dtype=np.int64)])
    costs, ones = np.append(rack.costs[kinds] / rack.costs.max(), left), np.append(np.ones(len(kinds)), left)
    cheapest = _numbers((takes, kinds), need, costs, MANY)
    if len(rack.costs) > 1 and cheapest.any():
        cheap = LinearConstraint(costs[None, :], 0, float(costs @ cheapest) + SLIGHT)
        cheapest = _numbers((takes, kinds), need, ones, MANY, [cheap])
    return _trimmed(cheapest[: len(kinds)], patterns, need)


def _all_patterns(rack: BarRack, need: Need) -> list[Pattern]:
    """Give all patterns to which no piece can be added; none if there are too many."""
    takes, kinds = _cuttings(rack, need, CUTTINGS), np.flatnonzero(need.limits > 0).tolist()
    found = [Pattern(kind, row) for kind in kinds for row in _full(takes, rack, need, kind)]
    return found if len(found) <= CHOICE else []


def _those_that_fit(rack: BarRack, need: Need, fits: Fits) -> list[Pattern]:
    takes = [row for row in _cuttings(rack, need, CHOICE) if row.any()]
    return [Pattern(int(kind), row) for row in takes for kind in np.flatnonzero(fits(row) & (need.limits > 0))]


def _cuttings(rack: BarRack, need: Need, most: int) -> Ints:
    """Give all ways to cut the longest bar; none if there are more than so many."""
    takes = np.zeros((1, 0), dtype=np.int64)
    for size, many in enumerate(copies_of(rack, need.counts).tolist()):
        takes = np.column_stack([np.repeat(takes, many + 1, axis=0), np.tile(np.arange(many + 1), len(takes))])
        takes = takes[takes @ rack.sizes[: size + 1] <= rack.rooms.max()]
        if len(takes) > most:
            return np.zeros((0, len(need.counts)), dtype=np.int64)
    return takes


def _full(takes: Ints, rack: BarRack, need: Need, kind: int) -> Ints:
    """Give the patterns of a kind of bar that leave no room for a piece more."""
    rest = rack.rooms[kind] - takes @ rack.sizes
    more = ((takes < need.counts) & (rest[:, None] >= rack.sizes)).any(axis=1)
    return takes[(rest >= 0) & ~more & takes.any(axis=1)]


def _numbers(
    patterns: tuple[Ints, Sequence[int]],
    need: Need,
    costs: Floats,
    branches: int,
    besides: Sequence[LinearConstraint] = (),
) -> Ints:
    """Give the cheapest whole numbers of what is taken, (patterns, sizes), to cover a need; or zeros.

    Those beyond the kinds take no bar. So many branches may not suffice to tell.
    """
    takes, kinds = patterns
    bars = np.array([np.equal(kinds, kind) for kind in range(len(need.limits))], dtype=np.float64)
    bars = np.pad(bars, ((0, 0), (0, len(takes) - len(kinds))))
    found = milp(
        costs,
        integrality=np.ones(len(takes), dtype=np.int64),
        bounds=Bounds(0, np.inf),
        constraints=[LinearConstraint(takes.T, need.counts, np.inf), LinearConstraint(bars, 0, need.limits), *besides],
        options={"node_limit": branches, "mip_rel_gap": 0.0},
    )
    return np.zeros(len(takes), dtype=np.int64) if found.x is None else np.rint(found.x).astype(np.int64)


def _trimmed(numbers: Ints, patterns: Sequence[Pattern], need: Need) -> list[Pattern]:
    """Take away what patterns cut too much."""
    left, bars = need.counts, list[Pattern]()
    for k in np.repeat(np.arange(len(patterns)), numbers).tolist():
        takes = np.minimum(patterns[k].takes, left)
        left = left - takes
        bars += [Pattern(patterns[k].kind, takes)] if takes.any() else []
    return bars
