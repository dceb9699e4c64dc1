"""Sheets filled one after another until all is placed: the cover that every search starts from and works with."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.nesting.sheets import Frame, SheetPlan, fill, narrow

PLENTY = 2**40
"""More sheets than anyone has."""


@dataclass(frozen=True, eq=False)
class Rack:
    """What the search works on.

    Attributes
    ----------
    stock : (sheets,) int
        Pieces of every stock sheet.
    areas : (parts,) float
        In shares of the largest sheet.
    goal
        Number of sheets that cannot be beaten.
    """

    frames: tuple[Frame, ...]
    stock: Ints
    areas: Floats
    goal: int = 0

    @property
    def exact(self) -> bool:
        """Tell whether the best strips are found, so that what they are worth bounds all others."""
        return not any(kind.links for frame in self.frames for kind in frame.kinds)


def without(rack: Rack, plans: Sequence[SheetPlan]) -> Rack:
    """Give the rack with the sheets of the plans taken out."""
    used = np.bincount([plan.frame.stock for plan in plans], minlength=len(rack.stock))
    return replace(rack, stock=rack.stock - used)


def fill_sheets(rack: Rack, counts: Ints, values: Floats, limit: float = np.inf) -> list[SheetPlan]:
    """Fill sheets until all is placed, the stock is used up or the cost exceeds the limit."""
    plans: list[SheetPlan] = []
    frames = [narrow(frame, counts) for frame in rack.frames]
    while counts.any() and cost_of(plans) <= limit:
        left = without(rack, plans).stock
        best = _best_sheet([frame for frame in frames if left[frame.stock] > 0], counts, values, rack)
        if best is None:
            break
        again = _times(best, counts, left[best.frame.stock], limit - cost_of(plans))
        plans += [best] * again
        counts = counts - again * pieces_of([best], len(counts))
    return plans


def _times(plan: SheetPlan, counts: Ints, stock: int, budget: float) -> int:
    """Tell how often the best sheet may be cut: it stays the best as long as there are pieces for another."""
    at_most = min(times_of(plan, counts), stock)
    return at_most if budget == np.inf else min(at_most, 1 + int(budget / plan.frame.cost))


def times_of(plan: SheetPlan, counts: Ints) -> int:
    """Tell for how many sheets there are pieces."""
    uses = pieces_of([plan], len(counts))
    used = uses > 0
    return int((counts[used] // uses[used]).min())


def _best_sheet(frames: Sequence[Frame], counts: Ints, values: Floats, rack: Rack) -> SheetPlan | None:
    """Give the sheet that places most area for its cost, None if nothing fits."""
    filled = (fill(frame, counts, values) for frame in frames)
    return max(
        (plan for plan in filled if plan.strips),
        key=lambda plan: area_of(rack, plan) / plan.frame.cost,
        default=None,
    )


def cost_of(plans: Sequence[SheetPlan]) -> float:
    """Give the cost in shares of the dearest or largest sheet."""
    return sum(plan.frame.cost for plan in plans)


def area_of(rack: Rack, plan: SheetPlan) -> float:
    """Give the area of the parts on a sheet, in shares of the largest sheet."""
    return float(rack.areas[plan.parts].sum())


def pieces_of(plans: Sequence[SheetPlan], parts: int) -> Ints:
    """Count the pieces of every part on some sheets; a plan that comes many times is counted once."""
    times = Counter(map(id, plans))
    total = np.zeros(parts, dtype=np.int64)
    for plan in {id(plan): plan for plan in plans}.values():
        np.add.at(total, plan.parts, times[id(plan)])
    return total
