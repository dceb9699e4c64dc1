"""Bars filled one after another: first fit decreasing, and the largest first with exact subset sums behind it."""

from collections.abc import Iterator, Sequence

import numpy as np

from isomould.arrays import Ints
from isomould.nesting.bar_rack import BarRack, Need, Pattern, step_of

FINEST = 60_000
"""Steps into which a bar is divided at most for subset sums, unless a common divisor makes fewer exact."""


def first_fit(rack: BarRack, need: Need) -> list[Pattern]:
    """Put every piece, the longest first, on the first bar with room; a new bar is the longest left."""
    limits = need.limits.copy()
    rows: list[tuple[int, list[int]]] = []
    rooms: list[int] = []
    sizes = rack.sizes.tolist()
    for piece in _pieces(need):
        index = next((k for k, room in enumerate(rooms) if room >= sizes[piece]), None)
        kind = next(iter(_fitting(rack, limits.tolist(), sizes[piece])), None)
        if index is None and kind is not None:
            index = len(rows)
            rows.append((kind, []))
            rooms.append(int(rack.rooms[kind]))
            limits[kind] -= 1
        if index is not None:
            rows[index][1].append(piece)
            rooms[index] -= sizes[piece]
    return [_pattern(rack, *row) for row in rows]


def largest_first(rack: BarRack, need: Need) -> list[Pattern]:
    """Put the longest piece left on a bar and fill the rest of it by an exact subset sum."""
    patterns: list[Pattern] = []
    left, limits = _pieces(need), need.limits.tolist()
    steps = _steps(rack)
    while left and (kinds := _fitting(rack, limits, int(rack.sizes[left[0]]))):
        chosen = [(kind, _fill(left, int(rack.rooms[kind]) // steps[0], steps[1])) for kind in kinds]
        kind, places = min(chosen, key=lambda choice: _waste(rack, choice[0], [left[k] for k in choice[1]]))
        patterns.append(_pattern(rack, kind, [left[place] for place in places]))
        limits[kind] -= 1
        used = set(places)
        left = [piece for place, piece in enumerate(left) if place not in used]
    return patterns


def fill(rack: BarRack, counts: Ints, kind: int, steps: int) -> Ints:
    """Give the pieces (n,) of some that fill a bar most closely, on a grid of so many steps."""
    step = step_of(rack, steps)
    sizes = (-(-rack.sizes // step)).tolist()
    pieces = np.repeat(np.arange(len(counts)), counts).tolist()
    reaches = _reach(pieces, int(rack.rooms[kind]) // step, sizes)
    chosen = [pieces[place] for place in _trace(pieces, reaches, sizes)]
    return np.bincount(chosen, minlength=len(counts)).astype(np.int64)


def _pieces(need: Need) -> list[int]:
    """Give the number of its size for every piece, the longest first."""
    return np.repeat(np.arange(len(need.counts)), need.counts).tolist()


def _fitting(rack: BarRack, limits: Sequence[int], size: int) -> list[int]:
    """Give the kinds of bars that are left and hold a size."""
    return [kind for kind, room in enumerate(rack.rooms.tolist()) if limits[kind] > 0 and room >= size]


def _waste(rack: BarRack, kind: int, pieces: list[int]) -> float:
    """Give the cost of a filled bar by the length of its pieces."""
    return float(rack.costs[kind] / rack.sizes[pieces].sum())


def _pattern(rack: BarRack, kind: int, pieces: Sequence[int]) -> Pattern:
    return Pattern(kind, np.bincount(pieces, minlength=len(rack.sizes)).astype(np.int64))


def _steps(rack: BarRack) -> tuple[int, list[int]]:
    """Give the grid of the subset sums, exact if the sizes have a coarse common divisor, and the sizes on it."""
    step = step_of(rack, FINEST)
    return step, (-(-rack.sizes // step)).tolist()


def _fill(left: Sequence[int], room: int, steps: Sequence[int]) -> list[int]:
    """Fill one bar, places in `left`, the first of them for certain."""
    reaches = _reach(left[1:], room - steps[left[0]], steps)
    return [0, *(place + 1 for place in _trace(left[1:], reaches, steps))]


def _reach(pieces: Sequence[int], room: int, steps: Sequence[int]) -> list[int]:
    """Bit k of a reach is set if the pieces so far can fill k steps exactly; until they fill the room."""
    mask = (1 << (max(room, 0) + 1)) - 1
    reaches = [1]
    for piece in pieces:
        if reaches[-1] >> max(room, 0):
            break
        reaches.append(reaches[-1] | (reaches[-1] << steps[piece]) & mask)
    return reaches


def _trace(pieces: Sequence[int], reaches: Sequence[int], steps: Sequence[int]) -> Iterator[int]:
    """Give the places of pieces that reach the farthest."""
    target = reaches[-1].bit_length() - 1
    for place in range(len(reaches) - 1, 0, -1):
        if not reaches[place - 1] >> target & 1:
            yield place - 1
            target -= steps[pieces[place - 1]]
