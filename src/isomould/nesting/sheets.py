"""Sheets of strips: stacking is an exact one-dimensional problem of heights over the best strips.

Between two uses the plan of a sheet is only who lies in which strip; `placing` gives it coordinates.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from isomould.arrays import Floats, Ints, read_only
from isomould.nesting.strips import Block, Item, Kind, Priced, price, trace

LOOK_AHEAD = 3
"""Strips that a stack is planned ahead."""


Run = tuple[Block, ...]
"""Blocks from left to right, the tallest first."""


@dataclass(frozen=True, eq=False)
class Zone:
    """A strip that is cut across: runs turned by a quarter, one beside the other; `height` in micrometres."""

    height: int
    runs: tuple[Run, ...]


Strip = Run | Zone


@dataclass(frozen=True, eq=False)
class Frame:
    """One way to cut one stock sheet: strips along its width, or (turned) along its height.

    `capacity` in grid steps and `room` in micrometres are length and height inside the trim, one gap added;
    `area` in shares of the largest sheet. `zones` tells whether strips may be cut across.
    """

    stock: int
    turned: bool
    capacity: int
    room: int
    gap: int
    step: int
    cost: float
    area: float
    kinds: tuple[Kind, ...]
    zones: bool = True

    @cached_property
    def named(self) -> dict[tuple[int, int], Item]:
        """All items by part and rotation."""
        return {(item.part, item.shape.rotation_deg): item for kind in self.kinds for item in kind.lying}


@dataclass(frozen=True, eq=False)
class SheetPlan:
    """The strips of a sheet, bottom to top."""

    frame: Frame
    strips: tuple[Strip, ...]

    @cached_property
    def parts(self) -> Ints:
        """Index of every piece's part."""
        return read_only(np.array([part for strip in self.strips for part in strip_parts(strip)], dtype=np.int64))


def narrow(frame: Frame, counts: Ints) -> Frame:
    """Leave out the kinds and items of which nothing is left."""
    left = counts > 0
    kept = ((kind, tuple(item for item in kind.items if left[item.part])) for kind in frame.kinds)
    return replace(frame, kinds=tuple(replace(kind, items=items) for kind, items in kept if items))


def fill(frame: Frame, counts: Ints, values: Floats) -> SheetPlan:
    """Fill a sheet with the best stack of strips, strip by strip.

    Parameters
    ----------
    counts : (parts,) int
        Pieces left.
    values : (parts,) float
        Worth of a piece.
    """
    strips: list[Run] = []
    counts, room = counts.copy(), frame.room
    while strip := _next_strip(frame, counts, values, room):
        strips.append(strip)
        np.subtract.at(counts, strip_parts(strip), 1)
        room -= strip_height(strip) + frame.gap
    return SheetPlan(frame, tuple(strips))


def strip_height(strip: Strip) -> int:
    """Give the height of the tallest item, or of the zone; micrometres."""
    return strip.height if isinstance(strip, Zone) else max(item.shape.height for block in strip for item in block)


def strip_parts(strip: Strip) -> list[int]:
    """Give the index of every piece's part."""
    runs = strip.runs if isinstance(strip, Zone) else (strip,)
    return [item.part for run in runs for block in run for item in block]


def take_once(strip: Strip, left: Ints) -> Strip:
    """Drop what there is no piece left of, and count the others off `left`; the strip may come back empty."""
    if not isinstance(strip, Zone):
        return once(strip, left)
    runs = (once(run, left) for run in strip.runs)
    kept = tuple(run for run in runs if run)
    return Zone(strip.height, kept) if kept else ()


def _next_strip(frame: Frame, counts: Ints, values: Floats, room: int) -> Run:
    kinds = [kind for kind in frame.kinds if kind.height + frame.gap <= room]
    priced = price(kinds, counts, values, frame.capacity)
    if not priced.worth.any():
        return ()
    return once(trace(priced, _best_class(priced, frame, room), frame.capacity), counts.copy())


def once(blocks: Sequence[Block], left: Ints) -> Run:
    """Drop what the knapsack took twice, once in each position."""
    kept = (tuple(item for item in block if _take_one(left, item.part)) for block in blocks)
    return tuple(block for block in kept if block)


def _take_one(left: Ints, part: int) -> bool:
    left[part] -= 1
    return bool(left[part] >= 0)


def _best_class(priced: Priced, frame: Frame, room: int) -> int:
    """Choose the height class that starts the best stack in the room."""
    worth = priced.worth
    steps = priced.heights + frame.gap
    better = np.flatnonzero(np.diff(worth, prepend=0.0) > 0)
    worth, steps = worth[better], steps[better]
    total = worth + _stack(worth, steps, room - steps, LOOK_AHEAD - 1)
    return int(better[np.argmax(total)])


def _stack(worth: Floats, steps: Ints, rooms: Ints, depth: int) -> Floats:
    """Give the worth of the best stack of at most `depth` strips in every room; steps and worth ascend."""
    if depth == 0:
        return np.zeros(len(rooms))
    single = np.append(0.0, worth)[np.searchsorted(steps, rooms, side="right")]
    if depth == 1:
        return single
    rest = (rooms[:, None] - steps).ravel()
    both = worth + _stack(worth, steps, rest, depth - 1).reshape(-1, len(steps))
    return np.maximum(single, np.where(rest.reshape(both.shape) >= 0, both, 0.0).max(axis=1))
