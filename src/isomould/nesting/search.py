"""The search: fill sheet after sheet, then empty some bad ones and fill them again.

All limits are in iterations, and the only chance is a generator with a fixed seed: the same parts give
the same sheets.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from isomould.arrays import Ints
from isomould.nesting.cover import (
    PLENTY,
    Rack,
    area_of,
    cost_of,
    fill_sheets,
    pieces_of,
    times_of,
    without,
)
from isomould.nesting.crew import Crew, Order
from isomould.nesting.sheets import SheetPlan

Effort = Literal["quick", "normal", "best"]

ROUNDS: dict[Effort, float] = {"quick": 0.5, "normal": 2, "best": 2}
"""Re-fillings per sheet."""

POOL = 700
"""Pieces that a filling sees at a time; each pool has all heights."""

SMALL_POOL = 150
"""The same in a hasty search."""

MOST_ROUNDS = 60
"""Re-fillings of a hasty search at most, and of very many pieces."""

MASSES = 20_000
"""Pieces from which there are very many: a few sheets of thousands filled again gain next to nothing."""

HASTY = 2000
"""Different parts from which a quick search is hasty."""

KEPT = 0.7
"""Part of the sheets of a pool that stay, the fullest ones; what lies on the others goes into the next pool."""

LANES = 2
"""Pools that are filled side by side, if there are enough pieces."""

HASTE = 60
"""Pieces that it sees once the search was told to stop."""

WINDOW = 6
"""Sheets emptied at a time."""

WINDOWS = 2
"""Such windows that are filled again side by side."""

SPREAD = 0.05
"""Relative standard deviation of the worth of a part in a re-filling."""

FAVOUR = 0.3
"""How much more than by its area a large part is worth in the last pool, so that small ones are left to fill up."""

POOL_FAVOUR = 0.1
"""The same in pools of which only the fullest sheets stay."""

MOST_FAVOUR = 0.8
"""The same at most, in a re-filling."""

Progress = Callable[[int, int, int, int], None]
"""Called with (iterations done, iterations in all, sheets so far, lower bound)."""


@dataclass(frozen=True)
class Search:
    """How long to search, whom to tell, and whom to ask whether to stop.

    `jobs` processes (None: one per core) change the time, never the result.
    """

    effort: Effort = "normal"
    progress: Progress | None = None
    should_stop: Callable[[], bool] | None = None
    jobs: int | None = 1

    @property
    def stops(self) -> bool:
        """True once the search should stop."""
        return self.should_stop is not None and self.should_stop()

    def hastens(self, different: int) -> bool:
        """Tell whether so many different parts want a coarser grid and smaller pools to be nested quickly."""
        return self.effort == "quick" and different > HASTY

    def tell(self, done: int, total: int, sheets: int, bound: int) -> None:
        """Tell whoever wants to know how far the search has come."""
        if self.progress is not None:
            self.progress(done, total, sheets, bound)


@dataclass(frozen=True, eq=False)
class Found:
    """Sheets that were found, whether the search ran to its end, and a bound for sheets of their pattern."""

    plans: list[SheetPlan]
    ended: bool
    pattern_bound: int | None = None


def improve(rack: Rack, plans: list[SheetPlan], counts: Ints, task: Search, crew: Crew) -> Found:
    """Fill sheets anew until the rounds of the effort are over or the goal is met."""
    chance = np.random.default_rng(0)
    total, windows = _rounds(plans, task, counts), _windows_at_once(rack, plans)
    for done in range(0, total, windows):
        if len(plans) <= rack.goal:
            break
        if task.stops:
            return Found(plans, ended=False)
        plans = _refill(rack, plans, counts, chance, crew)
        task.tell(min(done + windows, total), total, len(plans), rack.goal)
    return Found(plans, ended=True)


def _rounds(plans: Sequence[SheetPlan], task: Search, counts: Ints) -> int:
    rounds = round(ROUNDS[task.effort] * _different(plans))
    few = task.hastens(len(counts)) or counts.sum() > MASSES
    return min(rounds, MOST_ROUNDS) if few else rounds


def _different(plans: Sequence[SheetPlan]) -> int:
    """Count the sheets that are not cut like another: to fill a hundred equal ones anew is to fill one anew."""
    return len({id(plan) for plan in plans})


def first_sheets(rack: Rack, counts: Ints, task: Search, crew: Crew) -> list[SheetPlan]:
    """Fill pool by pool; once told to stop, small ones that are done in no time.

    The fullest sheets of a pool stay, as many times as there are pieces for them. What lies on the others is drawn
    again, when there is more to choose from.
    """
    plans: list[SheetPlan] = []
    left = counts
    while left.sum() > POOL and rack.stock.min() >= PLENTY and not task.stops:
        worth = rack.areas ** (1 + POOL_FAVOUR)
        pools = _pools(left, SMALL_POOL if task.hastens(len(counts)) else POOL)
        filled = crew([Order(pool, worth, rack.stock) for pool in pools[:LANES]])
        full = [plan for made in filled for plan in _fullest(rack, made)]
        together = _times(full, left)
        taken = full * together
        taken += _again(full, left - pieces_of(taken, len(counts)), len(pools) // LANES - together)
        plans += taken
        left = left - pieces_of(taken, len(counts))
    return _fill_up(rack, plans, left, task)


def _times(plans: list[SheetPlan], left: Ints) -> int:
    """Tell how often there are pieces for all of some sheets."""
    uses = pieces_of(plans, len(left))
    return int((left[uses > 0] // uses[uses > 0]).min())


def _again(plans: Sequence[SheetPlan], left: Ints, most: int) -> list[SheetPlan]:
    """Take each sheet up to `most` times more, as long as there are pieces: what is scarce stops only those with it."""
    again: list[SheetPlan] = []
    for plan in plans:
        times = max(min(most, times_of(plan, left)), 0)
        again += [plan] * times
        left = left - times * pieces_of([plan], len(left))
    return again


def _fill_up(rack: Rack, plans: list[SheetPlan], left: Ints, task: Search) -> list[SheetPlan]:
    """Place all that is left."""
    while left.any():
        pool = _pools(left, HASTE if task.stops else POOL)[0]
        plans = plans + fill_sheets(without(rack, plans), pool, rack.areas ** (1 + FAVOUR))
        left = left - pool
    return plans


def _pools(counts: Ints, size: int) -> list[Ints]:
    """Deal the pieces out in pools of about `size`."""
    pieces = np.repeat(np.arange(len(counts)), counts)
    pools = -(-len(pieces) // size)
    return [np.bincount(pieces[first::pools], minlength=len(counts)) for first in range(pools)]


def _fullest(rack: Rack, plans: Sequence[SheetPlan]) -> list[SheetPlan]:
    """Keep the sheets that place most area for their cost."""
    ranked = sorted(plans, key=lambda plan: -area_of(rack, plan) / plan.frame.cost)
    return ranked[: max(1, round(KEPT * len(ranked)))]


def _refill(
    rack: Rack, plans: list[SheetPlan], counts: Ints, chance: np.random.Generator, crew: Crew
) -> list[SheetPlan]:
    """Empty some sheets and fill them again with other worths, window by window; keep the better ones."""
    numbers = _windows(rack, plans, chance)
    windows = [[plans[k] for k in window] for window in numbers]
    drawn = {k for window in numbers for k in window}
    spare = without(rack, plans)
    kept = [plan for k, plan in enumerate(plans) if k not in drawn]
    missing = counts - pieces_of(plans, len(counts))
    orders = [_order(spare, window, missing * (k == 0), chance) for k, window in enumerate(windows)]
    for old, new in zip(windows, crew(orders), strict=True):
        kept = kept + (new if _merit(rack, new) >= _merit(rack, old) else old)
    return kept


def _order(spare: Rack, window: list[SheetPlan], more: Ints, chance: np.random.Generator) -> Order:
    """Ask for the pieces of a window and `more`, which found no place so far, at no higher cost than now."""
    spread = 1 + SPREAD * chance.standard_normal(len(spare.areas))
    worth = spread * spare.areas ** (1 + chance.uniform(0, MOST_FAVOUR))
    used = np.bincount([plan.frame.stock for plan in window], minlength=len(spare.stock))
    return Order(pieces_of(window, len(more)) + more, worth, spare.stock + used, cost_of(window))


def _windows_at_once(rack: Rack, plans: Sequence[SheetPlan]) -> int:
    """Give how many windows are emptied at once; one where sheets are limited, for both might take the last."""
    return WINDOWS if rack.stock.min() >= PLENTY and len(plans) > WINDOWS * WINDOW else 1


def _windows(rack: Rack, plans: Sequence[SheetPlan], chance: np.random.Generator) -> list[list[int]]:
    """Draw sheets, the emptier the likelier; their numbers."""
    waste = np.array([1 - area_of(rack, plan) / plan.frame.area for plan in plans])
    weight = np.maximum(waste, 0) ** 2 + 1e-3
    windows = _windows_at_once(rack, plans)
    drawn = chance.choice(len(plans), min(windows * WINDOW, len(plans)), replace=False, p=weight / weight.sum())
    return [sorted(drawn[first::windows].tolist()) for first in range(windows)]


def _merit(rack: Rack, plans: Sequence[SheetPlan]) -> tuple[float, float, float]:
    """More pieces placed, then less cost, then waste gathered on few sheets."""
    gathered = sum(area_of(rack, plan) ** 2 / plan.frame.cost for plan in plans)
    return sum(len(plan.parts) for plan in plans), -cost_of(plans), gathered
