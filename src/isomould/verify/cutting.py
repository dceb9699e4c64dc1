"""Cutting trees replayed: a convex polygon is sawn along straight lines, and what falls has to hold its part."""

import math
from collections.abc import Iterator
from typing import Any

Point = tuple[float, float]
Loop = list[Point]
Line = tuple[Point, Point]


def saw(tree: dict[str, Any], piece: Loop, kerf: float) -> Iterator[tuple[int | None, Loop, float]]:
    """Saw a piece as a tree says.

    Yields
    ------
    tuple
        For every cut that meets its piece (None, [], its length in mm); for every piece that is left at the end
        the placement it is meant to hold (None: an offcut), its corners, and 0.
    """
    lines: list[Line] = [((a[0], a[1]), (b[0], b[1])) for a, b in tree.get("lines", [])]
    branches = tree.get("pieces", [])
    if not lines and not branches:
        yield tree.get("placement"), piece, 0.0
        return
    for line, branch in zip(lines, branches[:-1], strict=True):
        length = _length_inside(line, piece)
        if length > 0:
            yield None, [], length
        yield from saw(branch, _left_of(line, piece, kerf / 2), kerf)
        piece = _left_of((line[1], line[0]), piece, kerf / 2)
    yield from saw(branches[-1], piece, kerf)


def halves(line: Line, piece: Loop) -> tuple[Loop, Loop]:
    """Give what lies at the left and at the right of a line."""
    return _left_of(line, piece, 0.0), _left_of((line[1], line[0]), piece, 0.0)


def chords(tree: dict[str, Any], piece: Loop) -> Iterator[Line]:
    """Give the cuts of a tree from edge to edge of their pieces, in cutting order; nothing is lost to a kerf."""
    lines: list[Line] = [((a[0], a[1]), (b[0], b[1])) for a, b in tree.get("lines", [])]
    branches = tree.get("pieces", [])
    for line, branch in zip(lines, branches[:-1], strict=True):
        if _length_inside(line, piece) > 0:
            met = [point for point in halves(line, piece)[0] if abs(_height(line, point)) < 1e-6]
            yield max(((a, b) for a in met for b in met), key=lambda ends: math.dist(*ends))
        left, piece = halves(line, piece)
        yield from chords(branch, left)
    if branches:
        yield from chords(branches[-1], piece)


def reach(points: Loop, piece: Loop) -> float:
    """Tell how far points reach out of a convex piece, counter-clockwise, in mm."""
    edges = [(a, b) for a, b in zip(piece, piece[1:] + piece[:1], strict=True) if math.dist(a, b) > 1e-9]
    return max((-_height(edge, point) for edge in edges for point in points), default=math.inf)


def _height(line: Line, point: Point) -> float:
    """Give the distance of a point from a line, positive at its left."""
    (x, y), (u, v) = line
    return ((u - x) * (point[1] - y) - (v - y) * (point[0] - x)) / math.dist(*line)


def _left_of(line: Line, piece: Loop, off: float) -> Loop:
    """Keep what lies at the left of a line, further than `off` from it."""
    kept: Loop = []
    for a, b in zip(piece, piece[1:] + piece[:1], strict=True):
        one, other = _height(line, a) - off, _height(line, b) - off
        if one >= 0:
            kept.append(a)
        if (one >= 0) != (other >= 0):
            share = one / (one - other)
            kept.append((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])))
    return kept


def _length_inside(line: Line, piece: Loop) -> float:
    """Give the length of a line inside a piece; 0 if it passes by."""
    heights = [_height(line, point) for point in piece] or [0.0]
    if min(heights) >= -1e-9 or max(heights) <= 1e-9:
        return 0.0
    met = [point for point in _left_of(line, piece, 0.0) if abs(_height(line, point)) < 1e-6]
    return max(math.dist(a, b) for a in met for b in met)
