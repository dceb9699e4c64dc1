"""Bars filled one after another: first fit decreasing, and the largest first with exact subset sums behind it.

Bars that come out alike are filled at once, so that the work grows with different lengths and not with pieces.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from isomould.arrays import Ints
from isomould.nesting.bar_rack import BarRack, Need, Pattern, copies_of, step_of

FINEST = 60_000
"""Steps into which a bar is divided at most for subset sums, unless a common divisor makes fewer exact."""


@dataclass(frozen=True)
class _Open:
    """Bars alike that are still being filled: what room is left on each, and the sizes that it holds so far."""

    kind: int
    room: int
    times: int
    held: tuple[tuple[int, int], ...] = ()

    def with_pieces(self, size: tuple[int, int], many: int, times: int) -> "_Open":
        """Put so many pieces of a size, given with its number, on each of so many of the bars."""
        number, length = size
        room = self.room - many * length
        return replace(self, room=room, times=times, held=(*self.held, (number, many)))


def first_fit(rack: BarRack, need: Need) -> list[Pattern]:
    """Put every piece, the longest first, on the first bar with room; a new bar is the longest left."""
    limits = need.limits.tolist()
    bars: list[_Open] = []
    sizes = enumerate(rack.sizes.tolist())
    for (number, length), asked in zip(sizes, need.counts.tolist(), strict=True):
        bars, left = _fill_open(bars, (number, length), asked)
        while left and (kinds := _fitting(rack, limits, length)):
            # Bars for as many pieces as fill them whole, then one for the rest.
            kind, room = kinds[0], int(rack.rooms[kinds[0]])
            most = _most(room, length, left)
            new = _Open(kind, room, min(max(left // most, 1), limits[kind]))
            opened, left = _fill_open([new], (number, length), left)
            bars += opened
            limits[kind] -= new.times
    return [Pattern(bar.kind, _takes(rack, bar.held), bar.times) for bar in bars]


def _fill_open(bars: Sequence[_Open], size: tuple[int, int], left: int) -> tuple[list[_Open], int]:
    """Fill bars in their order with pieces of a size; give them, and the pieces that found no room."""
    filled: list[_Open] = []
    for bar in bars:
        most = _most(bar.room, size[1], left)
        whole = min(left // most, bar.times) if most else 0
        last = left - whole * most if most and whole < bar.times else 0
        untouched = bar.times - whole - (last > 0)
        filled += [bar.with_pieces(size, most, whole)] if whole else []
        filled += [bar.with_pieces(size, last, 1)] if last else []
        filled += [replace(bar, times=untouched)] if untouched else []
        left -= whole * most + last
    return filled, left


def _most(room: int, length: int, left: int) -> int:
    """Give how many pieces of a length a room holds, of those that are left."""
    return min(room // length, left) if length else left


def _takes(rack: BarRack, held: Sequence[tuple[int, int]]) -> Ints:
    takes = np.zeros(len(rack.sizes), dtype=np.int64)
    for number, many in held:
        takes[number] = many
    return takes


def largest_first(rack: BarRack, need: Need) -> list[Pattern]:
    """Put the longest piece left on a bar and fill the rest of it by an exact subset sum."""
    patterns: list[Pattern] = []
    left, limits = need.counts.copy(), need.limits.tolist()
    grid = _grid(rack)
    while left.any() and (kinds := _fitting(rack, limits, int(rack.sizes[np.argmax(left > 0)]))):
        choices = [Pattern(kind, _fill_behind(rack, left, kind, grid)) for kind in kinds]
        chosen = min(choices, key=lambda choice: _waste(rack, choice))
        again = replace(chosen, times=min(_repeats(rack, left, chosen), limits[chosen.kind]))
        patterns.append(again)
        limits[again.kind] -= again.times
        left -= again.takes * again.times
    return patterns


def fill(rack: BarRack, counts: Ints, kind: int, steps: int) -> Ints:
    """Give the pieces (n,) of some that fill a bar most closely, on a grid of so many steps."""
    step = step_of(rack, steps)
    sizes = (-(-rack.sizes // step)).tolist()
    return _fullest(rack, counts, int(rack.rooms[kind]) // step, sizes)


def _repeats(rack: BarRack, left: Ints, chosen: Pattern) -> int:
    """Give how often the same choice comes again: as long as a bar could not use more of what it takes."""
    used = chosen.takes > 0
    spare = np.maximum(left - copies_of(rack, left), 0)
    return 1 + int((spare[used] // chosen.takes[used]).min())


def _fitting(rack: BarRack, limits: Sequence[int], size: int) -> list[int]:
    """Give the kinds of bars that are left and hold a size."""
    return [kind for kind, room in enumerate(rack.rooms.tolist()) if limits[kind] > 0 and room >= size]


def _waste(rack: BarRack, choice: Pattern) -> float:
    """Give the cost of a filled bar by the length of its pieces."""
    return float(rack.costs[choice.kind] / (choice.takes @ rack.sizes))


def _grid(rack: BarRack) -> tuple[int, list[int]]:
    """Give the grid of the subset sums, exact if the sizes have a coarse common divisor, and the sizes on it."""
    step = step_of(rack, FINEST)
    return step, (-(-rack.sizes // step)).tolist()


def _fill_behind(rack: BarRack, left: Ints, kind: int, grid: tuple[int, list[int]]) -> Ints:
    """Fill one bar behind the longest piece left; give the pieces (n,) with that one."""
    step, sizes = grid
    first = int(np.argmax(left > 0))
    others = left.copy()
    others[first] -= 1
    takes = _fullest(rack, others, int(rack.rooms[kind]) // step - sizes[first], sizes)
    takes[first] += 1
    return takes


def _fullest(rack: BarRack, counts: Ints, room: int, sizes: Sequence[int]) -> Ints:
    """Give the pieces (n,) that fill a room most closely; sizes and room in steps of one grid."""
    pieces = np.repeat(np.arange(len(counts)), copies_of(rack, counts)).tolist()
    reaches = _reach(pieces, room, sizes)
    chosen = [pieces[place] for place in _trace(pieces, reaches, sizes)]
    return np.bincount(chosen, minlength=len(counts)).astype(np.int64)


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
