"""A bar saved by filling others again, more closely: what they waste gathers on a heap until that fits one bar less."""

from collections.abc import Iterator, Sequence

import numpy as np

from isomould.arrays import Ints
from isomould.nesting.bar_greedy import fill, largest_first
from isomould.nesting.bar_rack import BarRack, Need, Pattern, one_by_one, sum_of
from isomould.nesting.stop import Stops, never

STEPS = 1_000_000
"""Steps into which a bar is divided at most."""

TOGETHER = 3
"""Bars that are filled again at once with the pieces of the heap."""

SWEEPS = 6
"""How often all bars take their turn before it is given up."""


def squeeze(rack: BarRack, patterns: list[Pattern], enough: int, stops: Stops = never) -> list[Pattern]:
    """Give fewer bars, as long as the pieces of the two emptiest come to fit one of them, and down to enough."""
    bars = sorted(one_by_one(patterns), key=lambda bar: load(rack, bar.takes) / int(rack.rooms[bar.kind]))
    while len(bars) > max(enough, 2 + TOGETHER):
        heap, kind = bars[0].takes + bars[1].takes, min(bar.kind for bar in bars[:2])
        fewer = _gather(rack, bars[2:], heap, kind, stops)
        if not fewer:
            break
        bars = fewer
    return bars


def pack(rack: BarRack, need: Need, numbers: Ints, stops: Stops = never) -> list[Pattern]:
    """Cut a need from so many bars (k,) of every kind; empty if that does not come about."""
    kind = int(np.flatnonzero(numbers)[0])
    limits = numbers - np.bincount([kind], minlength=len(numbers))
    bars = one_by_one(largest_first(rack, Need(need.counts, limits)))
    heap = need.counts - sum_of(rack, bars)
    return _gather(rack, bars, heap, kind, stops)


def load(rack: BarRack, takes: Ints) -> int:
    """Give the length of pieces (n,)."""
    return int(takes @ rack.sizes)


def _gather(rack: BarRack, bars: Sequence[Pattern], heap: Ints, kind: int, stops: Stops) -> list[Pattern]:
    """Fill bars again until the heap fits one more of a kind; empty if that fails."""
    bars, chance = list(bars), np.random.default_rng(0)
    for turn in (turn for _ in range(SWEEPS) for turn in _turns(len(bars), chance)):
        if load(rack, heap) <= rack.rooms[kind] or stops():
            break
        filled, heap = _fill_again(rack, [bars[k] for k in turn], heap)
        for k, bar in zip(turn, filled, strict=True):
            bars[k] = bar
    fits = load(rack, heap) <= rack.rooms[kind]
    return [*bars, *([Pattern(kind, heap)] if heap.any() else [])] if fits else []


def _turns(count: int, chance: np.random.Generator) -> Iterator[list[int]]:
    order = chance.permutation(count).tolist()
    return (order[k : k + TOGETHER] for k in range(0, count, TOGETHER))


def _fill_again(rack: BarRack, bars: Sequence[Pattern], heap: Ints) -> tuple[list[Pattern], Ints]:
    """Fill bars as closely as their pieces and those of the heap allow, if that makes the heap shorter."""
    pool = heap + sum(bar.takes for bar in bars)
    filled: list[Pattern] = []
    for bar in bars:
        takes = fill(rack, pool, bar.kind, STEPS)
        filled.append(Pattern(bar.kind, takes))
        pool = pool - takes
    better = load(rack, pool) < load(rack, heap)
    return (filled, pool) if better else (list(bars), heap)
