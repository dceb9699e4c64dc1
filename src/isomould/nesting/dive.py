"""Many different parts: column generation over strips and stacks, then a dive into whole sheets.

A round of generation is a whole cover of the parts: sheets filled one after another by what pieces are worth in
the master programme. The strips of a cover complement each other, so that a few covers do what hundreds of
single columns would. The dive fixes the sheets that are used most, and generates anew for what is left.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.nesting.cover import Rack, cost_of, pieces_of
from isomould.nesting.crew import Crew, Order
from isomould.nesting.master import Column, Master, Slot, Solution, Stack, add_plans, make_master, solve
from isomould.nesting.patterns import bound_pattern
from isomould.nesting.search import Effort, Found, Search
from isomould.nesting.sheets import SheetPlan

MOST = 2000
"""Different parts up to which the master programme pays."""

ROUNDS: dict[Effort, int] = {"quick": 0, "normal": 8, "best": 16}
"""Covers that are generated before the dive, by effort."""

AGAIN = 2
"""Covers of what is left, after each step of the dive."""

CHUNK = 100
"""Pieces that a cover sees at a time, drawn by lot."""

LAST = 400
"""Pieces left from which a cover sees all of them."""

SHARE = 0.15
"""Part of the sheets still to come that a step fixes."""

SPREAD = 0.02
"""Relative standard deviation of what a piece is worth to a cover, against its worth in the programme."""

LEAST_WORTH = 0.5
"""What a piece is worth at least, by its area in sheets: nothing is left until the end."""

USED = 1e-6
"""Columns used less than this are not used."""


@dataclass(eq=False)
class _Dive:
    """What a dive knows; `worth` is the running mean of what the pieces are worth."""

    rack: Rack
    crew: Crew
    master: Master
    worth: Floats
    chance: np.random.Generator


@dataclass(eq=False)
class _Use:
    """A column, and how much of its fractional use is not yet fixed."""

    column: Column
    amount: float


def dive(rack: Rack, first: list[SheetPlan], counts: Ints, task: Search, crew: Crew) -> Found:
    """Better a first filling, for stock without limits."""
    state = _Dive(rack, crew, make_master(counts), rack.areas, np.random.default_rng(0))
    add_plans(state.master, first)
    best = first
    for done in range(ROUNDS[task.effort]):
        if task.stops or len(best) <= rack.goal:
            return Found(best, not task.stops)
        task.tell(done, ROUNDS[task.effort], len(best), rack.goal)
        _learn(state, solve(state.master, counts), done)
        best = min(best, _cover(state, counts), key=cost_of)
    bound = bound_pattern(rack, counts, state.worth, zones=False)
    return replace(_sink(state, counts, best, task), pattern_bound=bound)


def _learn(state: _Dive, solution: Solution, done: int) -> None:
    """Move towards the worth in the programme; from the first worth, which has another scale, at once."""
    mean = (state.worth + solution.worth) / 2 if done else solution.worth
    state.worth = np.maximum(mean, LEAST_WORTH * state.rack.areas)


def _cover(state: _Dive, counts: Ints) -> list[SheetPlan]:
    """Cover the counts chunk by chunk, and add what comes of it to the programme."""
    spread = 1 + SPREAD * state.chance.standard_normal(len(counts))
    orders = [Order(share, state.worth * spread, state.rack.stock) for share in _shares(state, counts)]
    plans = [plan for filled in state.crew(orders) for plan in filled]
    add_plans(state.master, plans)
    return plans


def _shares(state: _Dive, counts: Ints) -> list[Ints]:
    pieces = state.chance.permutation(np.repeat(np.arange(len(counts)), counts))
    chunks = 1 if len(pieces) <= LAST else round(len(pieces) / CHUNK)
    return [np.bincount(pieces[k::chunks], minlength=len(counts)) for k in range(chunks)]


def _sink(state: _Dive, left: Ints, best: list[SheetPlan], task: Search) -> Found:
    """Fix sheets step by step until nothing is left or the best cannot be bettered any more."""
    fixed: list[SheetPlan] = []
    solution = solve(state.master, left)
    while left.any() and len(best) > state.rack.goal:
        new = _fix(state, solution, left)
        if task.stops or not new or _least(state.rack, fixed, solution) >= cost_of(best) - USED:
            return Found(best, not task.stops)
        task.tell(len(fixed), len(best), len(best), state.rack.goal)
        fixed, left = fixed + new, left - pieces_of(new, len(left))
        for _ in range(AGAIN):
            _learn(state, solution, done=1)
            best = min(best, fixed + _cover(state, left), key=cost_of)
            solution = solve(state.master, left)
    return Found(best, True)


def _least(rack: Rack, fixed: list[SheetPlan], solution: Solution) -> float:
    """Give the cost to be expected of a dive from here: a whole number of sheets if all are alike."""
    cost = cost_of(fixed) + solution.cost
    return math.ceil(cost - USED) if len(rack.stock) == 1 else cost


def _fix(state: _Dive, solution: Solution, left: Ints) -> list[SheetPlan]:
    """Give the sheets that are used most, filled with the strips that are used most."""
    stacks, strips = _used(state.master, solution)
    plans: list[SheetPlan] = []
    while stacks and len(plans) < max(1, int(SHARE * solution.cost)):
        stack = max(stacks, key=lambda use: use.amount)
        chosen = _choose(stack.column.stack, strips, left)
        stack.amount -= 1
        if len(chosen) < len(stack.column.stack):
            stacks.remove(stack)
            continue
        left = left - _taken(chosen, len(left))
        plans.append(_sheet(state.rack, stack.column.stack, chosen))
    return plans


def _used(master: Master, solution: Solution) -> tuple[list[_Use], dict[Slot, list[_Use]]]:
    """Give the used stacks, and the used strips by their slots."""
    pairs = zip(master.columns, solution.uses.tolist(), strict=True)
    uses = [_Use(column, amount) for column, amount in pairs if amount > USED]
    strips = dict[Slot, list[_Use]]()
    for use in uses:
        if use.column.strip:
            strips.setdefault(use.column.stack[0], []).append(use)
    return [use for use in uses if not use.column.strip], strips


def _choose(stack: Stack, strips: dict[Slot, list[_Use]], left: Ints) -> list[_Use]:
    """Give a strip for every slot of which all pieces are left; fewer if there is none for a slot."""
    chosen: list[_Use] = []
    for slot in stack:
        room = left - _taken(chosen, len(left))
        fitting = [use for use in strips.get(slot, []) if all(room[part] >= many for part, many in use.column.takes)]
        if not fitting:
            break
        chosen.append(max(fitting, key=lambda use: use.amount - chosen.count(use)))
    return chosen


def _taken(chosen: list[_Use], parts: int) -> Ints:
    taken = np.zeros(parts, dtype=np.int64)
    for use in chosen:
        for part, many in use.column.takes:
            taken[part] += many
    return taken


def _sheet(rack: Rack, stack: Stack, chosen: list[_Use]) -> SheetPlan:
    for use in chosen:
        use.amount -= 1
    frame = next(frame for frame in rack.frames if (frame.stock, frame.turned) == stack[0][:2])
    return SheetPlan(frame, tuple(use.column.strip for use in chosen))
