"""The master programme of column generation: which strips and which stacks of them, in fractions.

A column is a strip, made of parts and lying in a slot; or a stack, the slots of one sheet, at the sheet's cost; or
a link that makes a lower slot of a taller one. A slot is a height on a frame. Slots of every kind must suffice for
the strips. Solved by HiGHS, each time from its last basis (nesting, "What works", 4).
"""

from bisect import bisect
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import highspy
import numpy as np

from isomould.arrays import Floats, Ints
from isomould.nesting.sheets import Frame, SheetPlan, Strip, strip_height, strip_parts
from isomould.nesting.solver import quiet_solver

Slot = tuple[int, bool, int]
"""Stock, whether turned, height in micrometres."""

Way = tuple[int, bool]
"""Stock and whether turned."""

Stack = tuple[Slot, ...]
"""The slots of a sheet."""


@dataclass(frozen=True, eq=False)
class Column:
    """A strip in its slot, a stack (`strip` empty) or a link (both empty); `takes` are pieces per part."""

    strip: Strip
    stack: Stack
    takes: tuple[tuple[int, int], ...] = ()


@dataclass(eq=False)
class Master:
    """A growing programme; columns in the order in which the solver knows them."""

    counts: Ints
    solver: Any = field(default_factory=quiet_solver)
    slots: dict[Slot, int] = field(default_factory=dict[Slot, int])
    heights: dict[Way, list[int]] = field(default_factory=dict[Way, list[int]])
    columns: list[Column] = field(default_factory=list[Column])
    known: set[object] = field(default_factory=set[object])


@dataclass(frozen=True, eq=False)
class Solution:
    """Least cost in fractions, worth of a piece of every part (parts,) and of every slot, and uses of every column."""

    cost: float
    worth: Floats
    slots: dict[Slot, float]
    uses: Floats


def make_master(counts: Ints) -> Master:
    """Set up a programme with a row for every part and no column yet."""
    master = Master(counts)
    master.solver.setOptionValue("threads", 1)
    for count in counts.tolist():
        master.solver.addRow(float(count), highspy.kHighsInf, 0, [], [])
    return master


def add_plans(master: Master, plans: Sequence[SheetPlan]) -> None:
    """Add the strips and the stacks of sheets."""
    for plan in plans:
        for strip in plan.strips:
            add_strip(master, plan.frame, strip)
        add_stack(master, plan.frame, [strip_height(strip) for strip in plan.strips])


def add_strip(master: Master, frame: Frame, strip: Strip) -> None:
    """Add a strip in the slot of its height."""
    slot, takes = (frame.stock, frame.turned, strip_height(strip)), Counter(strip_parts(strip))
    _add(master, Column(strip, (slot,), tuple(takes.items())), 0.0, {**takes, _row(master, slot): -1})


def add_stack(master: Master, frame: Frame, heights: Sequence[int]) -> None:
    """Add a sheet with slots of some heights."""
    slots = tuple((frame.stock, frame.turned, height) for height in sorted(heights))
    _add(master, Column((), slots), frame.cost, Counter(_row(master, slot) for slot in slots))


def _row(master: Master, slot: Slot) -> int:
    if slot not in master.slots:
        master.slots[slot] = master.solver.getNumRow()
        master.solver.addRow(0.0, highspy.kHighsInf, 0, [], [])
        _link(master, slot)
    return master.slots[slot]


def _link(master: Master, slot: Slot) -> None:
    """Link a new slot with the next taller and the next lower one of its frame."""
    way, height = slot[:2], slot[2]
    heights = master.heights.setdefault(way, [])
    place = bisect(heights, height)
    for tall, low in ((heights[place : place + 1], [height]), ([height], heights[:place][-1:])):
        if tall and low:
            _add(master, Column((), ()), 0.0, {master.slots[*way, tall[0]]: -1, master.slots[*way, low[0]]: 1})
    heights.insert(place, height)


def _add(master: Master, column: Column, cost: float, entries: dict[int, int]) -> None:
    key = (cost, *sorted(entries.items()))
    if key not in master.known:
        master.known.add(key)
        rows = np.array(sorted(entries), dtype=np.int32)
        values = np.array([entries[row] for row in rows.tolist()], dtype=np.float64)
        master.solver.addCol(cost, 0.0, highspy.kHighsInf, len(rows), rows, values)
        master.columns.append(column)


def solve(master: Master, left: Ints) -> Solution:
    """Solve for the pieces that are left; strips that take more of a part than that are barred."""
    counts = left.tolist()
    # row by row: HiGHS 1.12 and older cannot change many at once
    for part, count in enumerate(counts):
        master.solver.changeRowBounds(part, float(count), highspy.kHighsInf)
    barred = [any(counts[part] < count for part, count in column.takes) for column in master.columns]
    upper = np.where(barred, 0.0, highspy.kHighsInf)
    columns = np.arange(len(upper), dtype=np.int32)
    master.solver.changeColsBounds(len(upper), columns, np.zeros(len(upper)), upper)
    master.solver.run()
    found = master.solver.getSolution()
    worth = np.maximum(np.array(found.row_dual), 0.0)
    slots = dict(zip(master.slots, worth[list(master.slots.values())].tolist(), strict=True))
    return Solution(
        master.solver.getInfo().objective_function_value, worth[: len(left)], slots, np.array(found.col_value)
    )
