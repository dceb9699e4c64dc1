"""Cutting patterns of bars by column generation (Gilmore and Gomory 1961), with the bound that it proves.

Every round prices the best pattern around each size at once: one dynamic programme over the lengths tells them
all. Sizes are rounded up to a grid, so that every pattern fits its bar; for the bound they are rounded down.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import highspy
import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp

from isomould.arrays import Bools, Floats, Ints
from isomould.nesting.bar_rack import BarRack, Need, Pattern

FINEST = 120_000
"""Steps into which the longest bar is divided at most for patterns."""

TABLE = 16_000_000
"""Pieces times steps that a pricing may look at."""

PROOF = 20 * TABLE
"""The same for a bound, of which there are few."""

CLOSE = 1_000
"""Steps per piece for a bound: rounding down costs half a thousandth of a bar in all."""

MISSING = 100.0
"""What a piece costs that no pattern cuts, in costs of the dearest bar."""

PRIMAL = 4
"""The solver's primal simplex: new columns leave the last basis feasible."""

SLIGHT = 1e-7
"""Gain of a pattern below which it is none, in costs of the dearest bar."""


@dataclass(eq=False)
class Programme:
    """A growing linear programme: a row for every size and one for every kind; columns as the solver has them.

    `costs` are in costs `top` of the dearest kind.
    """

    rack: BarRack
    costs: Floats
    top: float
    solver: Any = field(default_factory=highspy.Highs)
    patterns: list[Pattern] = field(default_factory=list[Pattern])
    known: set[tuple[int, bytes]] = field(default_factory=set[tuple[int, bytes]])


@dataclass(frozen=True, eq=False)
class Shares:
    """Least cost in fractions, uses of every pattern, worth of a piece of every size, toll of every kind."""

    cost: float
    uses: Floats
    worth: Floats
    tolls: Floats


def make_programme(rack: BarRack, costs: Floats, first: Sequence[Pattern]) -> Programme:
    """Set up a programme from first patterns; the dearest kind of bar counts one."""
    programme = Programme(rack, costs / costs.max(), float(costs.max()))
    programme.solver.setOptionValue("output_flag", False)
    programme.solver.setOptionValue("threads", 1)
    programme.solver.setOptionValue("simplex_strategy", PRIMAL)
    for _ in range(len(rack.sizes)):
        programme.solver.addRow(0.0, highspy.kHighsInf, 0, [], [])
    for _ in range(len(rack.rooms)):
        programme.solver.addRow(-highspy.kHighsInf, 0.0, 0, [], [])
    for row in range(len(rack.sizes)):
        _add_column(programme, MISSING, [row], [1.0])
    add_patterns(programme, first)
    return programme


def add_patterns(programme: Programme, patterns: Sequence[Pattern]) -> None:
    """Add the patterns that are not known yet."""
    for pattern in patterns:
        key = (pattern.kind, pattern.takes.tobytes())
        if key not in programme.known:
            programme.known.add(key)
            programme.patterns.append(pattern)
            rows = np.append(np.flatnonzero(pattern.takes), len(pattern.takes) + pattern.kind)
            values = np.append(pattern.takes[pattern.takes > 0], 1)
            _add_column(programme, float(programme.costs[pattern.kind]), rows, values)


def _add_column(programme: Programme, cost: float, rows: object, values: object) -> None:
    entries = np.asarray(rows, dtype=np.int32), np.asarray(values, dtype=np.float64)
    programme.solver.addCol(cost, 0.0, highspy.kHighsInf, len(entries[0]), *entries)


def generate(programme: Programme, need: Need, rounds: int, *, up: bool = True) -> Shares:
    """Price patterns for what is left until no more can save a whole bar; at most so many rounds.

    Sizes are rounded up to a grid, or else down: then those are kept that fit their bars truly.
    """
    _ask(programme, need)
    shares = _solve(programme, need)
    for _ in range(rounds):
        known = len(programme.patterns)
        patterns = _price(programme, need, shares, up=up)
        add_patterns(programme, patterns)
        if len(programme.patterns) == known or _is_settled(programme, shares, patterns):
            break
        shares = _solve(programme, need)
    return shares


def _is_settled(programme: Programme, shares: Shares, patterns: Sequence[Pattern]) -> bool:
    """Tell whether the worths, scaled until no pattern holds more than it costs, prove the same whole cost."""
    over = max(
        float((pattern.takes @ shares.worth - shares.tolls[pattern.kind]) / max(programme.costs[pattern.kind], SLIGHT))
        for pattern in patterns
    )
    cost = programme.top * shares.cost
    return math.ceil(cost / max(over, 1.0) - SLIGHT) >= math.ceil(cost - SLIGHT)


def _ask(programme: Programme, need: Need) -> None:
    """Ask for what is left; patterns that take more of a size than that are barred."""
    sizes, kinds = len(need.counts), len(need.limits)
    endless = np.full(sizes, highspy.kHighsInf)
    lower = np.concatenate([need.counts.astype(float), np.full(kinds, -highspy.kHighsInf)])
    upper = np.concatenate([endless, need.limits.astype(float)])
    programme.solver.changeRowsBounds(sizes + kinds, np.arange(sizes + kinds, dtype=np.int32), lower, upper)
    barred = [bool((pattern.takes > need.counts).any()) for pattern in programme.patterns]
    most = np.concatenate([endless, np.where(barred, 0.0, highspy.kHighsInf)])
    columns = np.arange(len(most), dtype=np.int32)
    programme.solver.changeColsBounds(len(most), columns, np.zeros(len(most)), most)


def _solve(programme: Programme, need: Need) -> Shares:
    programme.solver.run()
    sizes, found = len(need.counts), programme.solver.getSolution()
    dual, cost = np.array(found.row_dual), programme.solver.getInfo().objective_function_value
    uses = np.array(found.col_value)[sizes:]
    return Shares(cost, uses, np.maximum(dual[:sizes], 0.0), np.maximum(-dual[sizes:], 0.0))


def _price(programme: Programme, need: Need, shares: Shares, *, up: bool) -> list[Pattern]:
    """Give the patterns that are worth more than their bars: the best of all and the best around every size."""
    rack = programme.rack
    copies = _copies(rack, need.counts, shares.worth)
    step = _step(rack, min(FINEST, TABLE // max(int(copies.sum()), 1)))
    sizes = -(-rack.sizes // step) if up else rack.sizes // step
    items = np.repeat(np.arange(len(sizes)), copies)
    table = items, _take_all(items, sizes, shares.worth, int(rack.rooms.max()) // step)
    found = list[Pattern]()
    for kind in np.flatnonzero(need.limits > 0).tolist():
        room = int(rack.rooms[kind])
        takes = _patterns(room // step, np.flatnonzero(copies), table, sizes)
        gain = takes @ shares.worth - programme.costs[kind] - shares.tolls[kind]
        fits = (takes @ rack.sizes <= room) & (takes <= need.counts).all(axis=1)
        found += [Pattern(kind, row) for row in takes[fits & (gain > SLIGHT)]]
    return found


def _copies(rack: BarRack, counts: Ints, worth: Floats) -> Ints:
    """Give how many pieces of every size the longest bar may hold, of those that are worth anything."""
    return np.where(worth > 0, np.minimum(counts, rack.rooms.max() // rack.sizes), 0)


def _step(rack: BarRack, steps: int) -> int:
    """Give micrometres to a step of a grid of so many steps, or more if a common divisor makes it exact."""
    return max(int(np.gcd.reduce(rack.sizes)), -(-int(rack.rooms.max()) // steps))


def _take_all(items: Ints, sizes: Ints, worth: Floats, room: int) -> Bools:
    """Solve the bounded knapsack for every room up to this: whether an item is taken, (items, room + 1)."""
    best = np.zeros(room + 1)
    taken = np.zeros((len(items), room + 1), dtype=np.bool_)
    for row, item in zip(taken, items.tolist(), strict=True):
        _take(best, int(sizes[item]), float(worth[item]), row)
    return taken


def _take(best: Floats, size: int, worth: float, took: Bools) -> None:
    """Let every room take an item or leave it; ties leave it."""
    with_it = best[: len(best) - size] + worth
    np.greater(with_it, best[size:] + 1e-12, out=took[size:])
    np.copyto(best[size:], with_it, where=took[size:])


def _patterns(room: int, asked: Ints, table: tuple[Ints, Bools], sizes: Ints) -> Ints:
    """Trace the best pattern of a room, and the best ones that hold each size asked; (patterns, sizes)."""
    first = asked[sizes[asked] <= room]
    takes = np.zeros((len(first) + 1, len(sizes)), dtype=np.int64)
    takes[np.arange(len(first)), first] = 1
    left = np.append(room - sizes[first], room)
    for item, row in zip(table[0][::-1].tolist(), table[1][::-1], strict=True):
        took = row[left]
        takes[took, item] += 1
        left[took] -= sizes[item]
    return takes


def bound_cost(rack: BarRack, costs: Floats, need: Need, worths: Sequence[Floats]) -> float:
    """Bound the cost of any bars that serve a need, by what pieces are worth.

    Whatever a piece of every size is worth, the bars must be able to hold what all are worth together. The least
    whole numbers of bars that can, for each of the worths and for the lengths, are a small integer programme; of a
    single kind of bar they are Farley's bound (1990). It is 0 if there are too few bars.
    """
    rows = [rack.rooms.astype(np.float64), *(_most_worth(rack, need, worth) for worth in worths)]
    asked = [float(worth @ need.counts) for worth in (rack.sizes, *worths)]
    scale = np.array([max(float(row.max()), 1e-12) for row in rows])
    enough = LinearConstraint(np.array(rows) / scale[:, None], np.array(asked) / scale - SLIGHT, np.inf)
    most = np.minimum(need.limits, need.counts.sum()).astype(np.float64)
    found = milp(costs, integrality=np.ones(len(costs), dtype=np.int64), bounds=Bounds(0, most), constraints=enough)
    return 0.0 if found.mip_dual_bound is None else float(found.mip_dual_bound)


def _most_worth(rack: BarRack, need: Need, worth: Floats) -> Floats:
    """Give the most that every kind of bar can hold; sizes are rounded down, so it may be a little more."""
    copies = _copies(rack, need.counts, worth)
    steps = max(FINEST, CLOSE * int(need.counts.sum()))
    step = _step(rack, min(steps, PROOF // max(int(copies.sum()), 1)))
    best = np.zeros(int(rack.rooms.max()) // step + 1)
    took = np.zeros(len(best), dtype=np.bool_)
    for item in np.repeat(np.arange(len(copies)), copies).tolist():
        _take(best, int(rack.sizes[item] // step), float(worth[item]), took)
    return best[rack.rooms // step]
