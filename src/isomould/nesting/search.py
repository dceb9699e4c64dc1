"""The search: fill sheet after sheet, then empty some bad ones and fill them again.

All limits are in iterations, and the only chance is a generator with a fixed seed: the same parts give
the same sheets.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from isomould.arrays import Ints
from isomould.nesting.cover import Rack, area_of, cost_of, fill_sheets, pieces_of, without
from isomould.nesting.sheets import SheetPlan

Effort = Literal["quick", "normal", "best"]

ROUNDS: dict[Effort, float] = {"quick": 0.5, "normal": 2, "best": 8}
"""Re-fillings per sheet."""

CHUNK = 700
"""Pieces that a first filling sees; each chunk sees all heights."""

HASTE = 60
"""Pieces that it sees once the search was told to stop."""

WINDOW = 6
"""Sheets emptied at a time."""

SPREAD = 0.05
"""Relative standard deviation of the worth of a part in a re-filling."""

FAVOUR = 0.3
"""How much more than by its area a large part is worth at first, so that small ones are left to fill up."""

MOST_FAVOUR = 0.8
"""The same at most, in a re-filling."""

Progress = Callable[[int, int, int, int], None]
"""Called with (iterations done, iterations in all, sheets so far, lower bound)."""


@dataclass(frozen=True)
class Search:
    """How long to search, whom to tell, and whom to ask whether to stop."""

    effort: Effort = "normal"
    progress: Progress | None = None
    should_stop: Callable[[], bool] | None = None

    @property
    def stops(self) -> bool:
        """True once the search should stop."""
        return self.should_stop is not None and self.should_stop()

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


def improve(rack: Rack, plans: list[SheetPlan], counts: Ints, task: Search) -> Found:
    """Fill sheets anew until the rounds of the effort are over or the goal is met."""
    chance = np.random.default_rng(0)
    total = round(ROUNDS[task.effort] * len(plans))
    for done in range(total):
        if len(plans) <= rack.goal:
            break
        if task.stops:
            return Found(plans, ended=False)
        plans = _refill(rack, plans, counts, chance)
        task.tell(done + 1, total, len(plans), rack.goal)
    return Found(plans, ended=True)


def first_sheets(rack: Rack, counts: Ints, task: Search) -> list[SheetPlan]:
    """Fill chunk by chunk; once told to stop, in chunks small enough to be done in no time."""
    plans: list[SheetPlan] = []
    while counts.any():
        chunk = _chunk(counts, HASTE if task.stops else CHUNK)
        plans += fill_sheets(without(rack, plans), chunk, rack.areas ** (1 + FAVOUR))
        counts = counts - chunk
    return plans


def _chunk(counts: Ints, size: int) -> Ints:
    """Give every k-th piece, about `size` of them."""
    pieces = np.repeat(np.arange(len(counts)), counts)
    return np.bincount(pieces[:: -(-len(pieces) // size)], minlength=len(counts))


def _refill(rack: Rack, plans: list[SheetPlan], counts: Ints, chance: np.random.Generator) -> list[SheetPlan]:
    """Empty some sheets and fill them again with other worths; keep the better ones."""
    picked = _pick(rack, plans, chance)
    kept = [plan for index, plan in enumerate(plans) if index not in picked]
    old = [plans[index] for index in sorted(picked)]
    spread = 1 + SPREAD * chance.standard_normal(len(rack.areas))
    worth = spread * rack.areas ** (1 + chance.uniform(0, MOST_FAVOUR))
    loose = counts - pieces_of(kept, len(counts))
    new = fill_sheets(without(rack, kept), loose, worth, cost_of(old))
    return kept + new if _merit(rack, new) >= _merit(rack, old) else plans


def _pick(rack: Rack, plans: Sequence[SheetPlan], chance: np.random.Generator) -> set[int]:
    """Draw sheets, the emptier the likelier."""
    waste = np.array([1 - area_of(rack, plan) / plan.frame.area for plan in plans])
    weight = np.maximum(waste, 0) ** 2 + 1e-3
    drawn = chance.choice(len(plans), min(WINDOW, len(plans)), replace=False, p=weight / weight.sum())
    return {int(index) for index in drawn}


def _merit(rack: Rack, plans: Sequence[SheetPlan]) -> tuple[float, float, float]:
    """More pieces placed, then less cost, then waste gathered on few sheets."""
    gathered = sum(area_of(rack, plan) ** 2 / plan.frame.cost for plan in plans)
    return sum(len(plan.parts) for plan in plans), -cost_of(plans), gathered
