"""Slanted ends of pieces of flat bars, head to tail: sizes that hold for any order, and the order that loses the least.

A piece is sawn through along the closest line past either end; `run` is how far that line leans over the bar's width.
Neighbours whose runs differ lose half the difference, the ends of the bar half the run beside them. A piece may be
turned end for end and upside down, so that only the sizes of its runs count: every piece joins two points of a line,
and a bar is a closed walk from 0 over all its pieces (the rural postman on a line). It crosses a point of the line an
even number of times, and at least twice if a piece lies beyond: what pieces do not cross is lost, and what joins
those that pass over one another without meeting.
"""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Ints
from isomould.nesting.layout import Turned
from isomould.nesting.shapes import leg, stand


@dataclass(frozen=True)
class Blank:
    """A piece as it is sawn; all in micrometres.

    Attributes
    ----------
    length
        From end to end of the part.
    start, end
        Where the saw's lines cross the middle of the bar, from the part's left end.
    runs
        x at the top less x at the bottom of both lines, even numbers.
    depth
        Width of the bar.
    true
        Part of the width over which the ends are as straight as their lines, at least.
    """

    length: int
    start: int
    end: int
    runs: tuple[int, int]
    depth: int
    true: float = 1.0

    @property
    def mean(self) -> int:
        """Length along the middle of the bar."""
        return self.end - self.start

    @property
    def least(self) -> int:
        """The same without what rounding added."""
        return self.mean - 2 if any(self.runs) else self.mean

    @property
    def stretch(self) -> float:
        """What the steeper saw cut takes along the bar, times the kerf."""
        return float(np.hypot(1.0, max(abs(run) for run in self.runs) / self.depth))


@dataclass(frozen=True)
class Laid:
    """A piece of a bar: its number, how it is turned, and its left end in micrometres from the end of the trim."""

    piece: int
    turned: Turned
    start: int


def square(length: int) -> Blank:
    """Give a piece that is cut square."""
    return Blank(length, 0, length, (0, 0), 1)


def blank(outline: Sequence[tuple[float, float]]) -> Blank:
    """Give the saw's lines past both ends of an outline (mm), rounded so that it stays inside."""
    shape = stand(np.array(outline), 0)
    depth, hull = shape.height, shape.hull
    lines = [_line(hull, side, depth) for side in (-1, 1)]
    (left, start, one), (right, end, other) = lines
    return Blank(shape.width, start, end, (left, right), depth, min(one, other))


def _line(hull: Ints, side: int, depth: int) -> tuple[int, int, float]:
    """Give run and middle of the closest line past one side, and the part of the depth that lies on it."""
    slope, _ = leg(hull, side)
    run = 2 * round(slope * depth / 2)
    reach = side * (hull[:, 0] - (run / depth) * (hull[:, 1] - depth / 2))
    on = hull[reach >= reach.max() - 1.0, 1] - depth / 2
    straight = 2 * float(min(-on.min(), on.max(), depth / 2)) / depth
    return run, side * int(np.ceil(reach.max() - 1e-6)), max(straight, 0.0)


def runs_lost(blanks: Iterable[Blank]) -> float:
    """Give what the least order of pieces on one bar loses, micrometres."""
    return sum(width * added for _, width, added in _gaps([blank.runs for blank in blanks])) / 2


def _gaps(runs: Sequence[tuple[int, int]]) -> list[tuple[int, int, int]]:
    """Give start, width and added crossings of the stretches between all sizes of runs."""
    ends = np.sort(np.abs(np.array(runs, dtype=np.int64).reshape(-1, 2)), axis=1)
    points = np.unique(np.append(ends, 0))
    found: list[tuple[int, int, int]] = []
    for low, high in zip(points[:-1].tolist(), points[1:].tolist(), strict=True):
        crossing = int(np.count_nonzero((ends[:, 0] <= low) & (ends[:, 1] >= high)))
        found.append((low, high - low, crossing % 2 if crossing else 2))
    return _joined(found, ends.tolist())


def _joined(gaps: Sequence[tuple[int, int, int]], ends: Sequence[tuple[int, int]]) -> list[tuple[int, int, int]]:
    """Cross the narrowest stretches twice more where pieces pass over points without joining them to the rest."""
    group = {low: low for low in [0, *(low + width for low, width, _ in gaps)]}
    for one, other in [*ends, *((low, low + width) for low, width, added in gaps if added)]:
        _join(group, one, other)
    joined = {low for low, width, _ in sorted(gaps, key=lambda gap: gap[1]) if _join(group, low, low + width)}
    return [(low, width, 2 if low in joined else added) for low, width, added in gaps]


def _join(group: dict[int, int], one: int, other: int) -> bool:
    """Join two points; tell whether they were apart."""
    here, there = group[one], group[other]
    for point in [point for point, name in group.items() if name == there]:
        group[point] = here
    return here != there


def lay(blanks: Sequence[Blank], kerf: int) -> list[Laid]:
    """Lay the pieces of one bar from its left end in the order that loses the least, kerf (micrometres) kept."""
    laid: list[Laid] = []
    edge, lean = None, 0
    for piece, backwards in _walk([blank.runs for blank in blanks]):
        this = blanks[piece]
        here = this.runs[1] if backwards else this.runs[0]
        over = here * lean < 0
        turned = _TURNED[backwards, over]
        left, right, middles = _turned(this, turned)
        start = 0 if edge is None else _beside(edge, this, (left, middles[0]), kerf)
        laid.append(Laid(piece, turned, start))
        edge, lean = (this, right, start + middles[1]), right
    return laid


_TURNED: dict[tuple[bool, bool], Turned] = {
    (False, False): "none",
    (True, False): "end_for_end",
    (False, True): "upside_down",
    (True, True): "both",
}


def _turned(this: Blank, turned: Turned) -> tuple[int, int, tuple[int, int]]:
    """Give left and right run of a turned piece, and where its lines cross the middle."""
    left, right = this.runs
    start, end = this.start, this.end
    if turned in {"end_for_end", "both"}:
        left, right, start, end = right, left, this.length - end, this.length - start
    return (-left, -right, (start, end)) if turned in {"upside_down", "both"} else (left, right, (start, end))


def _beside(edge: tuple[Blank, int, int], this: Blank, left: tuple[int, int], kerf: int) -> int:
    """Give the start of a piece whose saw cut, and that of its neighbour, are as wide as the kerf everywhere."""
    before, run, middle = edge
    cut = int(np.ceil(kerf * max(np.hypot(1.0, run / before.depth), np.hypot(1.0, left[0] / this.depth)) - 1e-6))
    return middle + abs(run - left[0]) // 2 + cut - left[1]


def _walk(runs: Sequence[tuple[int, int]]) -> list[tuple[int, bool]]:
    """Give a closed walk from 0 over all pieces: their numbers, and whether from end to start (Hierholzer)."""
    roads: defaultdict[int, list[tuple[int, int]]] = defaultdict(list)
    for piece, (start, end) in enumerate(runs):
        roads[abs(start)].append((piece, abs(end)))
        roads[abs(end)].append((piece, abs(start)))
    joins = [(low, low + width) for low, width, added in _gaps(runs) for _ in range(added)]
    for number, (low, high) in enumerate(joins, start=len(runs)):
        roads[low].append((number, high))
        roads[high].append((number, low))
    walked = _circuit(roads, len(runs) + len(joins))
    return [(piece, abs(runs[piece][0]) != here) for piece, here in walked if piece < len(runs)]


def _circuit(roads: dict[int, list[tuple[int, int]]], count: int) -> list[tuple[int, int]]:
    """Walk every road once and come back to 0; roads by number, with the point that each is entered from."""
    used = [False] * count
    stack: list[tuple[int, int, int]] = [(0, -1, 0)]
    walked: list[tuple[int, int]] = []
    while stack:
        here, road, came = stack[-1]
        while roads[here] and used[roads[here][-1][0]]:
            roads[here].pop()
        if roads[here]:
            number, there = roads[here].pop()
            used[number] = True
            stack.append((there, number, here))
        else:
            walked.append((road, came))
            stack.pop()
    return [step for step in walked[::-1] if step[0] >= 0]


def surely_lost(blanks: Sequence[Blank], sizes: Sequence[int], room: int, always: int) -> int:
    """Give what all bars together lose in any order, micrometres: too few pieces cross every point of the line.

    What every bar `always` loses is counted elsewhere. A bar with a piece whose run is larger loses twice what no
    piece crosses, once what one piece crosses; `sizes` and `room` tell how many bars those pieces need at least.
    """
    ends = np.sort(np.abs(np.array([this.runs for this in blanks])), axis=1) * min(this.true for this in blanks)
    points, lengths = np.unique(np.maximum(np.append(ends, 0.0), always)), np.array(sizes)
    lost = 0.0
    for low, high in zip(points[:-1].tolist(), points[1:].tolist(), strict=True):
        bars = -(-int(lengths[ends[:, 1] >= high].sum()) // room)
        crossing = np.count_nonzero((ends[:, 0] <= low) & (ends[:, 1] >= high))
        lost += (high - low) * max(2 * bars - crossing, 0) / 2
    return int(lost)
