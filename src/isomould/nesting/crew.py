"""Sheets filled side by side, by processes that all know the rack: what each is told, and tells, is small."""

from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from itertools import groupby

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.nesting.cover import Rack, fill_sheets
from isomould.nesting.sheets import Run, SheetPlan
from isomould.nesting.strips import Item
from isomould.workers import Spread, one_by_one, workers


@dataclass(frozen=True, eq=False)
class Order:
    """Pieces to place.

    Attributes
    ----------
    counts : (parts,) int
    values : (parts,) float
        What a piece is worth.
    stock : (sheets,) int
        Sheets that may be taken.
    limit
        Cost after which to give up.
    """

    counts: Ints
    values: Floats
    stock: Ints
    limit: float = np.inf


Crew = Callable[[Sequence[Order]], list[list[SheetPlan]]]
"""Fills sheets for every order, in their sequence."""

_Name = tuple[int, int]
"""Part and rotation: an item of a frame."""

_Strips = tuple[tuple[tuple[_Name, ...], ...], ...]
"""Strips are blocks, blocks items by their names."""

_Told = list[tuple[int, _Strips, int]]
"""Frame and strips of every sheet, and how often it comes: equal sheets stay one plan."""


@contextmanager
def gather(rack: Rack, jobs: int | None) -> Generator[Crew]:
    """Give a crew of `jobs` processes; None takes one per core. How many changes the time, never the result."""
    with workers(jobs, partial(_learn, rack)) as spread:
        yield partial(_alone, rack) if spread is one_by_one else partial(_share_out, rack, spread)


def _alone(rack: Rack, orders: Sequence[Order]) -> list[list[SheetPlan]]:
    return [_fill(rack, order) for order in orders]


def _fill(rack: Rack, order: Order) -> list[SheetPlan]:
    return fill_sheets(replace(rack, stock=order.stock), order.counts, order.values, order.limit)


def _share_out(rack: Rack, spread: Spread, orders: Sequence[Order]) -> list[list[SheetPlan]]:
    return [_understand(rack, told) for told in spread(_report, orders)]


_KNOWN = dict[str, Rack]()
"""What a process of a crew was told when it was hired."""


def _learn(rack: Rack) -> None:
    _KNOWN["rack"] = rack


def _report(order: Order) -> _Told:
    rack = _KNOWN["rack"]
    places = {(frame.stock, frame.turned): number for number, frame in enumerate(rack.frames)}
    runs = [list(equal) for _, equal in groupby(_fill(rack, order), key=id)]
    return [(places[run[0].frame.stock, run[0].frame.turned], _named(run[0]), len(run)) for run in runs]


def _named(plan: SheetPlan) -> _Strips:
    runs: list[Run] = [strip for strip in plan.strips if isinstance(strip, tuple)]
    return tuple(tuple(tuple(map(_name, block)) for block in run) for run in runs)


def _name(item: Item) -> _Name:
    return item.part, item.shape.rotation_deg


def _understand(rack: Rack, told: _Told) -> list[SheetPlan]:
    return [plan for number, strips, times in told for plan in [_plan(rack, number, strips)] * times]


def _plan(rack: Rack, number: int, strips: _Strips) -> SheetPlan:
    frame = rack.frames[number]
    named = frame.named
    return SheetPlan(frame, tuple(tuple(tuple(named[name] for name in block) for block in run) for run in strips))
