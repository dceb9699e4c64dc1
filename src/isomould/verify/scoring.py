"""Scored sheets replayed from their lines alone: every line breaks one piece in two, from edge to edge."""

import math
from dataclasses import dataclass

from isomould.verify.cutting import Line, Loop, halves, reach

NEAR = 5e-3
"""So near lies what is on a line, mm: ends of lines and corners of parts are rounded to 0.001 mm."""


@dataclass(frozen=True)
class Broken:
    """What is left after the last line, and the lines that broke nothing, in words."""

    pieces: tuple[Loop, ...]
    problems: tuple[str, ...]


def break_sheet(room: Loop, lines: list[Line]) -> Broken:
    """Break a sheet along lines in their order.

    A line that is there twice, or that ends inside a piece or crosses into another, breaks no piece from edge to edge.
    """
    pieces, problems = [room], list[str]()
    for number, line in enumerate(lines, start=1):
        hit = next((k for k, piece in enumerate(pieces) if _runs_through(piece, line)), None)
        if hit is None:
            problems.append(f"line {number} runs from edge to edge of no piece")
        else:
            pieces[hit : hit + 1] = halves(line, pieces[hit])
    return Broken(tuple(pieces), tuple(problems))


def _runs_through(piece: Loop, line: Line) -> bool:
    """Tell whether a line ends on the edges of a convex piece and lies inside it between."""
    middle = ((line[0][0] + line[1][0]) / 2, (line[0][1] + line[1][1]) / 2)
    ends = [reach([end], piece) for end in line]
    return reach([middle], piece) < -NEAR / 10 and max(map(abs, ends)) <= NEAR


def misfit(part: Loop, piece: Loop) -> float:
    """Tell how far corners of a part and of the piece that holds it lie apart at most, mm."""
    return max(_farthest(part, piece), _farthest(piece, part))


def _farthest(corners: Loop, loop: Loop) -> float:
    edges = list(zip(loop, loop[1:] + loop[:1], strict=True))
    return max(min(_away(corner, edge) for edge in edges) for corner in corners)


def _away(point: tuple[float, float], edge: Line) -> float:
    """Give the distance of a point from a segment."""
    (x, y), (u, v) = edge
    along = (u - x, v - y)
    square = along[0] ** 2 + along[1] ** 2
    share = 0.0 if square == 0 else ((point[0] - x) * along[0] + (point[1] - y) * along[1]) / square
    share = min(max(share, 0.0), 1.0)
    return math.dist(point, (x + share * along[0], y + share * along[1]))
