"""Many different parts: column generation over strips and stacks, then a dive into whole sheets.

First come whole covers of the parts: sheets filled one after another by what pieces are worth in the master
programme. The strips of a cover complement each other, so that a few covers do what hundreds of single columns
would. Then strips and stacks are priced exactly, by worths that stay near those of the best bound (Wentges 1997).
The dive fixes the sheets that are used most, and prices anew where what is left would cost a sheet more.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.nesting.choosing import choose_sheets, worth_choosing
from isomould.nesting.cover import Rack, area_of, cost_of, pieces_of
from isomould.nesting.crew import Crew, Order
from isomould.nesting.master import Column, Master, Slot, Solution, Stack, add_plans, make_master, solve
from isomould.nesting.pricing import add_offer, make_offers
from isomould.nesting.search import Effort, Found, Search
from isomould.nesting.sheets import SheetPlan

MOST = 2000
"""Different parts up to which the master programme pays."""

COVERS = 3
"""Covers that are generated before the dive."""

ROUNDS: dict[Effort, int] = {"quick": 0, "normal": 30, "best": 60}
"""Times that columns are priced before the dive, by effort."""

AGAIN = 3
"""Times that they are priced again in a step of the dive that would cost a sheet."""

CALM = 0.8
"""How near the worth for pricing stays to that of the best bound; the rest is the worth in the programme."""

CHUNK = 100
"""Pieces that a cover sees at a time, drawn by lot."""

LAST = 400
"""Pieces left from which a cover sees all of them."""

SHARE = 0.15
"""Part of the sheets still to come that a step fixes."""

SPREAD = 0.02
"""Relative standard deviation of what a piece is worth to a cover, against its worth in the programme."""

LEAST_WORTH = 0.5
"""What a piece is worth at least to a cover, by its area in sheets: nothing is left until the end."""

STILL = 0.001
"""Fall of the cost per round, in sheets, below which pricing more columns does not pay."""

SEEN = 5
"""Rounds that it is watched for."""

USED = 1e-6
"""Columns used less than this are not used."""


@dataclass(eq=False)
class _Dive:
    """What a dive knows; `worth` is that of the best `bound` on what is left."""

    rack: Rack
    crew: Crew
    master: Master
    worth: Floats
    chance: np.random.Generator
    bound: float = 0.0


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
    _price(state, counts, rack.areas, {})
    costs: list[float] = []
    for done in range(ROUNDS[task.effort]):
        if task.stops or len(best) <= rack.goal:
            return Found(best, not task.stops)
        task.tell(done, ROUNDS[task.effort], len(best), rack.goal)
        solution = solve(state.master, counts)
        costs.append(solution.cost)
        if done < COVERS:
            best = min(best, _cover(state, counts, solution), key=cost_of)
        elif _still(costs) or _proved(state, best) or not _generate(state, counts, solution):
            break
    bound = math.ceil(state.bound - USED) if rack.exact else None
    least = state.bound
    found = _sink(state, counts, best, task)
    return replace(_chosen(state, counts, found, least), pattern_bound=bound)


def _chosen(state: _Dive, counts: Ints, found: Found, least: float) -> Found:
    """Choose whole numbers of the columns where that may save a sheet of few pieces; `least` is their bound."""
    best, alike = cost_of(found.plans), len(state.rack.stock) == 1
    most = best - 1 if alike else best - USED
    if most < max(least, state.rack.goal) - USED or not found.ended or not worth_choosing(counts, len(found.plans)):
        return found
    plans = choose_sheets(state.rack, state.master, counts, most)
    better = (pieces_of(plans, len(counts)) == counts).all() and cost_of(plans) < best - USED
    return Found(plans, True) if better else found


def _still(costs: Sequence[float]) -> bool:
    return len(costs) > COVERS + SEEN and costs[-SEEN - 1] - costs[-1] < SEEN * STILL


def _proved(state: _Dive, best: list[SheetPlan]) -> bool:
    """Tell whether no sheets of strips can be fewer than the best."""
    alike = len(state.rack.stock) == 1 and state.rack.exact
    return alike and math.ceil(state.bound - USED) >= len(best)


def _generate(state: _Dive, counts: Ints, solution: Solution) -> bool:
    """Price new columns, calmly if that finds any; tell whether there are."""
    worths = (calm * state.worth + (1 - calm) * solution.worth for calm in (CALM, CALM / 2, 0.0))
    return any(_price(state, counts, worth, solution.slots) for worth in worths)


def dive_part(rack: Rack, plans: list[SheetPlan], counts: Ints, task: Search, crew: Crew, sheets: int) -> Found:
    """Better a filling by a dive into its emptiest sheets, `sheets` of them."""
    ranked = sorted(plans, key=lambda plan: area_of(rack, plan) / plan.frame.cost)
    part, kept = ranked[:sheets], ranked[sheets:]

    def tell(done: int, total: int, sheets: int, _: int) -> None:
        task.tell(done, total, len(kept) + sheets, rack.goal)

    own = replace(task, progress=tell)
    goal = max(rack.goal - len(kept), 0)
    found = dive(replace(rack, goal=goal), part, pieces_of(part, len(counts)), own, crew)
    return Found(kept + found.plans, found.ended)


def _price(state: _Dive, counts: Ints, worth: Floats, slots: Mapping[Slot, float]) -> bool:
    """Add what pays for some worths, and remember them if they give the best bound."""
    offers = make_offers(state.rack, counts, worth, slots)
    most = max(offer.most for offer in offers)
    if float(worth @ counts) / most > state.bound:
        state.worth, state.bound = worth / most, float(worth @ counts) / most
    before = len(state.master.columns)
    for offer in offers:
        add_offer(state.master, offer)
    return len(state.master.columns) > before


def _cover(state: _Dive, counts: Ints, solution: Solution) -> list[SheetPlan]:
    """Cover the counts chunk by chunk, and add what comes of it to the programme."""
    spread = 1 + SPREAD * state.chance.standard_normal(len(counts))
    worth = np.maximum(solution.worth, LEAST_WORTH * state.rack.areas) * spread
    orders = [Order(share, worth, state.rack.stock) for share in _shares(state, counts)]
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
    while left.any() and len(best) > state.rack.goal:
        solution = _settle(state, fixed, left, best)
        new = _fix(state, solution, left)
        if task.stops or not new or _least(state.rack, fixed, solution) >= cost_of(best) - USED:
            return Found(best, not task.stops)
        task.tell(len(fixed), len(best), len(best), state.rack.goal)
        fixed, left = fixed + new, left - pieces_of(new, len(left))
        best = min(best, fixed + _cover(state, left, solution), key=cost_of)
    return Found(best, True)


def _settle(state: _Dive, fixed: list[SheetPlan], left: Ints, best: list[SheetPlan]) -> Solution:
    """Solve for what is left, with new columns while the best would not be bettered otherwise."""
    state.bound = 0.0
    solution = solve(state.master, left)
    for _ in range(AGAIN):
        if _least(state.rack, fixed, solution) < cost_of(best) - USED or not _generate(state, left, solution):
            break
        solution = solve(state.master, left)
    return solution


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
    uses = [_Use(column, amount) for column, amount in pairs if amount > USED and column.stack]
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
        fitting = [
            use
            for own in _no_taller(slot, strips)
            for use in strips[own]
            if use.amount - chosen.count(use) > USED and all(room[part] >= many for part, many in use.column.takes)
        ]
        if not fitting:
            break
        chosen.append(max(fitting, key=lambda use: (use.column.stack[0][2], use.amount - chosen.count(use))))
    return chosen


def _no_taller(slot: Slot, strips: dict[Slot, list[_Use]]) -> list[Slot]:
    return [own for own in strips if own[:2] == slot[:2] and own[2] <= slot[2]]


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
