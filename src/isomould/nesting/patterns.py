"""Few classes with many pieces: whole sheets as columns, priced by a nested programme, then cut in whole numbers.

A sheet is a stack of strips, and a strip may be a zone: cut across, with runs that are turned by a quarter
(three stages). The programme knows the best run of every length and the best stack of runs in every zone,
so that it finds the best sheet for given worths of the pieces (Gilmore and Gomory 1965). HiGHS then picks
whole numbers of the sheets that were found.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, linprog, milp

from isomould.arrays import Floats, Ints
from isomould.nesting.cover import Rack, cost_of, pieces_of, times_of
from isomould.nesting.crew import Crew
from isomould.nesting.search import Found, Search
from isomould.nesting.sheets import Frame, SheetPlan, Zone, take_once
from isomould.nesting.strips import Priced, price, trace

FEW = 60
"""Classes up to which whole sheets pay."""

FEW_OF_MANY = 150
"""The same where there are very many pieces."""

VERY_MANY = 30
"""Pieces of a class from which there are."""

MANY = 6
"""Pieces of a class from which they do."""

ZONES = 250
"""Different zones that are tried per frame."""

LEVELS = 1500
"""Steps into which a stack of runs in a zone is divided at most."""

ROUNDS = 60
"""Times that sheets are priced."""

NODES = 2000
"""Nodes of the search for whole numbers."""

NOISE = 1e-12
"""Worths that differ by less are the same."""


def worth_trying(counts: Ints) -> bool:
    """Tell whether there are few enough classes with enough pieces for whole sheets to pay."""
    pieces = float(counts.mean()) if len(counts) else 0.0
    return pieces >= MANY and len(counts) <= (FEW_OF_MANY if pieces >= VERY_MANY else FEW)


@dataclass(frozen=True, eq=False)
class Stacks:
    """The best stacks of items of some heights for every room: one column per case.

    Attributes
    ----------
    worth : (room + 1, cases) float
    last : (room + 1, cases) int
        Item on top of the best stack, -1 where the room above the last stays empty.
    """

    heights: Ints
    worth: Floats
    last: Ints

    def trace(self, case: int, room: int | None = None) -> list[int]:
        """Give the items of the best stack in a room, by default the whole."""
        room, chosen = len(self.last) - 1 if room is None else room, list[int]()
        while room > 0:
            item = int(self.last[room, case])
            chosen += [item] if item >= 0 else []
            room -= int(self.heights[item]) if item >= 0 else 1
        return chosen


def stack_up(heights: Ints, worth: Floats, room: int) -> Stacks:
    """Solve the unbounded knapsack of heights (k,) ascending, with a worth (k, cases) each, in grid steps.

    Levels that are nearer to each other than the least height do not build on each other: they are solved at once.
    """
    best = np.zeros((room + 1, worth.shape[1]))
    last = np.full(best.shape, -1, dtype=np.int64)
    step = int(heights[0]) if len(heights) else room + 1
    for low in range(step, room + 1, step):
        high = min(low + step, room + 1)
        _put_on_top(heights, worth, best, last, (low, high))
        below = np.maximum.accumulate(best[low - 1 : high], axis=0)
        last[low:high][best[low:high] <= below[:-1] + NOISE] = -1
        best[low:high] = below[1:]
    return Stacks(heights, best, last)


def _put_on_top(heights: Ints, worth: Floats, best: Floats, last: Ints, levels: tuple[int, int]) -> None:
    """Find the best item on top at some levels, in place."""
    low, high = levels
    fitting = int(np.searchsorted(heights, high - 1, side="right"))
    # Low items leave few levels at a time: then it takes less time to compare all items at once.
    if (high - low) * best.shape[1] < fitting:
        _compare(heights[:fitting], worth[:fitting], best, last, levels)
        return
    for item, height in enumerate(heights[:fitting].tolist()):
        start = max(low, height)
        with_it = best[start - height : high - height] + worth[item]
        better = with_it > best[start:high] + NOISE
        np.copyto(best[start:high], with_it, where=better)
        np.copyto(last[start:high], item, where=better)


def _compare(heights: Ints, worth: Floats, best: Floats, last: Ints, levels: tuple[int, int]) -> None:
    """Do the same with all items (k,) at once, in arrays of (k, levels, cases)."""
    low, high = levels
    below = np.arange(low, high) - heights[:, None]
    with_it = best[np.maximum(below, 0)] + worth[:, None]
    with_it[below < 0] = -np.inf
    most = with_it.max(axis=0)
    first = np.argmax(with_it >= most - NOISE, axis=0)
    better = most > best[low:high] + NOISE
    np.copyto(best[low:high], most, where=better)
    np.copyto(last[low:high], first, where=better)


def find_sheets(rack: Rack, first: list[SheetPlan], counts: Ints, task: Search, _: Crew) -> Found:
    """Better a first filling, for stock without limits."""
    plans, mean = list({id(plan): plan for plan in first}.values()), np.zeros(0)
    for done in range(ROUNDS):
        if task.stops or len(first) <= rack.goal:
            return Found(first, not task.stops)
        task.tell(done, ROUNDS, len(first), rack.goal)
        worth = _worth(plans, counts)
        mean = (mean + worth) / 2 if len(mean) else worth
        new = _gaining(_priced_sheets(rack, counts, mean), worth) or _gaining(
            _priced_sheets(rack, counts, worth), worth
        )
        if not new:
            break
        plans = plans + new
    bound = bound_pattern(rack, counts, _worth(plans, counts)) if rack.exact else None
    return Found(_whole(plans, counts, first), True, bound)


def _gaining(plans: Sequence[SheetPlan], worth: Floats) -> list[SheetPlan]:
    """Keep the sheets that are worth more than they cost."""
    return [plan for plan in plans if worth[plan.parts].sum() > plan.frame.cost * (1 + 1e-6)]


def _matrix(plans: Sequence[SheetPlan], parts: int) -> Ints:
    return np.column_stack([pieces_of([plan], parts) for plan in plans])


def _worth(plans: Sequence[SheetPlan], counts: Ints) -> Floats:
    cost = np.array([plan.frame.cost for plan in plans])
    result = linprog(cost, A_ub=-_matrix(plans, len(counts)), b_ub=-counts, method="highs-ds")
    return np.maximum(-np.asarray(result.ineqlin.marginals), 0.0)


def _whole(plans: Sequence[SheetPlan], counts: Ints, first: list[SheetPlan]) -> list[SheetPlan]:
    """Cover the counts by whole numbers of sheets and drop what is too much, if that is better than the first."""
    cost = np.array([plan.frame.cost for plan in plans])
    found = milp(
        cost,
        constraints=LinearConstraint(_matrix(plans, len(counts)), counts, np.inf),
        integrality=np.ones(len(plans), dtype=np.int64),
        bounds=Bounds(0, np.inf),
        options={"node_limit": NODES},
    )
    if found.x is None:
        return first
    left = counts.copy()
    times = np.rint(found.x).astype(np.int64).tolist()
    sheets = [sheet for plan, many in zip(plans, times, strict=True) for sheet in _cut_often(plan, many, left)]
    return min(first, [sheet for sheet in sheets if sheet.strips], key=cost_of)


def _cut_often(plan: SheetPlan, times: int, left: Ints) -> list[SheetPlan]:
    """Cut a sheet many times, whole as long as there are pieces for it, and count these off `left`."""
    whole = min(times, times_of(plan, left)) if times else 0
    left -= whole * pieces_of([plan], len(left))
    return [plan] * whole + [_cut_down(plan, left) for _ in range(times - whole)]


def _cut_down(plan: SheetPlan, left: Ints) -> SheetPlan:
    strips = [take_once(strip, left) for strip in plan.strips]
    return SheetPlan(plan.frame, tuple(strip for strip in strips if strip))


def _priced_sheets(rack: Rack, counts: Ints, worth: Floats) -> list[SheetPlan]:
    """Give the best sheet of every frame."""
    priced = [price(f.kinds, counts, worth, f.capacity, all_lengths=True) for f in rack.frames]
    pairs = list(zip(rack.frames, priced, strict=True))
    sheets = [_best_sheet(frame, own, _zones(frame, pairs)) for frame, own in pairs]
    return [_cut_down(sheet, counts.copy()) for sheet in sheets]


@dataclass(frozen=True, eq=False)
class _Zones:
    """Zones of some sizes (height in grid steps), each with the best stack of runs in it; `make` gives one."""

    sizes: Ints
    worth: Floats
    make: Callable[[int], Zone]


def _zones(frame: Frame, pairs: Sequence[tuple[Frame, Priced]], *, least: bool = False) -> _Zones:
    """Fill zones of every size with runs of the frame that cuts the same sheet the other way, if there is one."""
    for other, priced in pairs if frame.zones else ():
        if other.stock == frame.stock and other.turned != frame.turned and priced.tables:
            sizes = _sizes(min(frame.room // frame.step, other.capacity))
            step = other.step * -(-other.room // (other.step * LEVELS))
            heights = _steps(priced.heights + other.gap, step, least=least)
            stacks = stack_up(heights, np.array(priced.tables)[:, sizes], _room(other, step, least=least))
            filled = np.flatnonzero(stacks.worth[-1] > 0)
            make = partial(_zone, frame, (sizes, filled), stacks, priced)
            return _Zones(sizes[filled], stacks.worth[-1, filled], make)
    return _Zones(np.zeros(0, dtype=np.int64), np.zeros(0), lambda _: Zone(0, ()))


def _zone(frame: Frame, cases: tuple[Ints, Ints], stacks: Stacks, priced: Priced, index: int) -> Zone:
    """Give a zone; `cases` are the sizes that were tried, and which of them hold anything."""
    sizes, filled = cases
    size = int(sizes[filled[index]])
    runs = [tuple(trace(priced, level, size)) for level in stacks.trace(int(filled[index]))]
    return Zone(size * frame.step - frame.gap, tuple(run for run in runs if run))


def _sizes(room: int) -> Ints:
    coarse = -(-room // ZONES)
    return np.arange(room % coarse or coarse, room + 1, coarse)


def _steps(heights: Ints, step: int, *, least: bool) -> Ints:
    """Give the steps that heights take: the least that bounds them, or enough to hold them."""
    return np.maximum(heights // step, 1) if least else -(-heights // step)


def _room(frame: Frame, step: int, *, least: bool) -> int:
    return -(-frame.room // step) if least else frame.room // step


def _best_stack(frame: Frame, own: Priced, zones: _Zones, *, least: bool = False) -> tuple[Stacks, Ints]:
    """Stack runs and zones; the items of the stack are those of `own`, then the zones, in the order given beside.

    With `least` heights are rounded down and the room up, so that no sheet is worth more than the stack.
    """
    heights = np.append(_steps(own.heights + frame.gap, frame.step, least=least), zones.sizes)
    order = np.argsort(heights, kind="stable")
    worth = np.append(own.worth, zones.worth)[order]
    room = _room(frame, frame.step, least=least)
    return stack_up(heights[order], worth[:, None], room), order


def _best_sheet(frame: Frame, own: Priced, zones: _Zones) -> SheetPlan:
    """Give the best stack of runs and zones."""
    stacks, order = _best_stack(frame, own, zones)
    found, runs = order[stacks.trace(0)].tolist(), len(own.heights)
    strips = [tuple(trace(own, k, frame.capacity)) if k < runs else zones.make(k - runs) for k in found]
    return SheetPlan(frame, tuple(strips))


def bound_pattern(rack: Rack, counts: Ints, worth: Floats) -> int:
    """Bound the cost of sheets that are stacks of strips and zones, along either side, lengths on the grid (Farley).

    Whatever pieces are worth: if no sheet holds more than its cost times v, all pieces together need their worth
    divided by v.
    """
    priced = [price(f.kinds, counts, worth, f.capacity, all_lengths=True) for f in rack.frames]
    pairs = list(zip(rack.frames, priced, strict=True))
    most = [_most_worth(frame, own, pairs) / frame.cost for frame, own in pairs]
    return math.ceil(float(worth @ counts) / max(most) - 1e-6)


def _most_worth(frame: Frame, own: Priced, pairs: Sequence[tuple[Frame, Priced]]) -> float:
    stacks, _ = _best_stack(frame, own, _zones(frame, pairs, least=True), least=True)
    return float(stacks.worth[-1, 0])
