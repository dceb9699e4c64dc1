"""Scored glass: the lines along which sheets are scored and broken, each once, in the order of the cutting tree.

A line runs from edge to edge of the piece that it breaks. A part that does not fill the piece that the tree frees for
it is scored free along its own sides, so that it has to be convex.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from isomould.arrays import Floats, round_um
from isomould.errors import Refused
from isomould.nesting.layout import Layout, Part
from isomould.nesting.settings import StockSettings

_ON = 2e-3
"""A side so near to the edge of its piece lies on it: both are rounded to 0.001 mm, mm."""


def refuse_unscorable(parts: Sequence[Part], stock: StockSettings) -> None:
    """Refuse parts with corners that point inwards where sheets are scored.

    Raises
    ------
    Refused
        E-NEST-04: no line from edge to edge frees such a corner.
    """
    for part in parts if stock.scored else ():
        side = np.roll(part.outline, -1, axis=0) - part.outline
        turn = side[:, 0] * np.roll(side, -1, axis=0)[:, 1] - side[:, 1] * np.roll(side, -1, axis=0)[:, 0]
        lengths = np.hypot(*side.T)
        inwards = turn * np.sign(turn.sum()) < -_ON * np.minimum(lengths, np.roll(lengths, -1))
        if inwards.any():
            x, y = part.outline[(int(np.argmax(inwards)) + 1) % len(side)].tolist()
            found = f"its corner at {x:.3f}, {y:.3f} mm points inwards"
            limit = "convex parts where gap = 0 mm: glass is scored from edge to edge"
            raise Refused("E-NEST-04", f"part {part.id}", found, limit, "Give a gap, or divide the part.")


def score_lines(layout: Layout, stock: StockSettings) -> dict[str, Floats]:
    """Give for every sheet the lines to score, (k, 2, 2) mm, in cutting order; the trim is cut off first."""
    found = dict[str, Floats]()
    for sheet in layout.sheets:
        low, right, top = stock.trim, sheet.width - stock.trim, sheet.height - stock.trim
        room = np.array([[low, low], [right, low], [right, top], [low, top]])
        lines = [round_um(line) for line in _scored(layout.cut_trees[sheet.id], room, layout)]
        found[sheet.id] = np.array([line for line in lines if (line[0] != line[1]).any()]).reshape(-1, 2, 2)
    return found


def _scored(tree: dict[str, Any], piece: Floats, layout: Layout) -> Iterator[Floats]:
    """Break a piece as its tree says; of a line, what lies at its left is broken on first."""
    lines, branches = tree.get("lines", []), tree.get("pieces", [])
    if not branches:
        if "placement" in tree:
            yield from _freed(piece, layout.placements[tree["placement"]].points)
        return
    for line, branch in zip(np.array(lines, dtype=float), branches, strict=False):
        left, right, chord = _broken(piece, line)
        yield from chord
        yield from _scored(branch, left, layout)
        piece = right
    yield from _scored(branches[-1], piece, layout)


def _freed(piece: Floats, points: Floats) -> Iterator[Floats]:
    """Break off what a piece has beyond the sides of its part."""
    x, y = (points - points[0]).T
    loop = points if x @ np.roll(y, -1) > y @ np.roll(x, -1) else points[::-1]
    for side in zip(loop, np.roll(loop, -1, axis=0), strict=True):
        line = np.array(side)
        if _heights(piece, line).min() < -_ON:
            piece, _, chord = _broken(piece, line)
            yield from chord


def _broken(piece: Floats, line: Floats) -> tuple[Floats, Floats, list[Floats]]:
    """Break a convex piece (n, 2) along a line (2, 2): what is left and right of it, and the line inside the piece."""
    height = _heights(piece, line)
    after, beyond = np.roll(piece, -1, axis=0), np.roll(height, -1)
    crossing = (height > 0) != (beyond > 0)
    share = np.divide(height, height - beyond, out=np.zeros_like(height), where=crossing)
    met = piece + share[:, None] * (after - piece)
    walk = np.stack([piece, met], axis=1).reshape(-1, 2)
    left = walk[np.stack([height > 0, crossing], axis=1).ravel()]
    right = walk[np.stack([height <= 0, crossing], axis=1).ravel()]
    inside = height.min(initial=0.0) < -1e-9 and height.max(initial=0.0) > 1e-9
    return left, right, [met[crossing]] if inside else []


def _heights(piece: Floats, line: Floats) -> Floats:
    """Give the distances (n,) of points from a line, positive at its left."""
    along = (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
    away = piece - line[0]
    return along[0] * away[:, 1] - along[1] * away[:, 0]
