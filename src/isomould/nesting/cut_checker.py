"""Proves cutting trees by cutting: the sheet's polygon is cut line by line, apart from the search that drew the lines.

Every piece stays convex, so that a straight line through it goes from edge to edge. The saw takes half the kerf
on either side of its line. What is left at the end has to hold the part that the tree promises, and nothing else.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from isomould.arrays import Floats
from isomould.nesting.layout import CutTree, Layout

Polygon = Floats
"""Convex, counter-clockwise, (n, 2); n = 0 is nothing."""


@dataclass(frozen=True, eq=False)
class Freed:
    """What the cutting ends with: a piece of the sheet, and the placement that it is meant to hold or None."""

    piece: Polygon
    placement: int | None


@dataclass(frozen=True, eq=False)
class Replay:
    """The pieces in the order in which they fall, and the length in mm of every cut that met its piece."""

    freed: tuple[Freed, ...]
    cuts: tuple[float, ...]


def replay(tree: CutTree, sheet: Polygon, kerf: float) -> Replay:
    """Cut a sheet.

    Parameters
    ----------
    sheet : (4, 2) float, mm
        What is left inside the trim, counter-clockwise.

    Raises
    ------
    ValueError
        If the tree does not say what to cut.
    """
    freed: list[Freed] = []
    cuts: list[float] = []
    for event in _cut(tree, sheet, kerf / 2):
        if isinstance(event, Freed):
            freed.append(event)
        else:
            cuts.append(event)
    return Replay(tuple(freed), tuple(cuts))


def _cut(tree: dict[str, Any], piece: Polygon, half: float) -> Iterator[Freed | float]:
    """Cut one branch; of a line, what lies at its left falls, and the rest is cut on."""
    lines, branches = tree.get("lines"), tree.get("pieces", [])
    if lines is None or len(branches) != len(lines) + 1:
        yield _leaf(tree, piece)
        return
    for line, branch in zip(np.asarray(lines, dtype=np.float64).reshape(-1, 2, 2), branches, strict=False):
        normal, level = _across(line)
        chord = _chord(piece, normal, level)
        if chord > 0:
            yield chord
        yield from _cut(branch, _side(piece, normal, level + half), half)
        piece = _side(piece, -normal, half - level)
    yield from _cut(branches[-1], piece, half)


def _leaf(tree: dict[str, Any], piece: Polygon) -> Freed:
    if not tree.keys() <= {"placement"}:
        message = "lines and pieces do not match: there is one piece more than lines"
        raise ValueError(message)
    return Freed(piece, tree.get("placement"))


def _across(line: Floats) -> tuple[Floats, float]:
    """Give the unit normal to the left of a line and its level along it."""
    along = line[1] - line[0]
    normal = np.array([-along[1], along[0]]) / np.hypot(*along)
    return normal, float(line[0] @ normal)


def _side(piece: Polygon, normal: Floats, level: float) -> Polygon:
    """Keep what is at least at the level along the normal."""
    if not len(piece):
        return piece
    height = piece @ normal - level
    after, beyond = np.concatenate([piece[1:], piece[:1]]), np.concatenate([height[1:], height[:1]])
    crossing = (height < 0) != (beyond < 0)
    share = np.divide(height, height - beyond, out=np.zeros_like(height), where=crossing)
    met = piece + share[:, None] * (after - piece)
    both = np.stack([piece, met], axis=1).reshape(-1, 2)
    return both[np.stack([height >= 0, crossing], axis=1).ravel()]


def _chord(piece: Polygon, normal: Floats, level: float) -> float:
    """Give the length of a line inside a piece; 0 where it runs past or along an edge."""
    height = piece @ normal - level if len(piece) else np.zeros(1)
    if not height.min() < -1e-9 < 1e-9 < height.max():
        return 0.0
    edge = _side(piece, normal, level)
    on = edge[np.abs(edge @ normal - level) < 1e-6] @ np.array([normal[1], -normal[0]])
    return float(np.ptp(on))


def sheet_inside(layout: Layout, name: str, trim: float) -> Polygon:
    """Give the rectangle of a sheet inside its trim."""
    sheet = next(sheet for sheet in layout.sheets if sheet.id == name)
    low, right, top = trim, sheet.width - trim, sheet.height - trim
    return np.array([[low, low], [right, low], [right, top], [low, top]])


def stands_out(points: Floats, piece: Polygon) -> float:
    """Tell how far the points reach out of a convex piece, mm; infinite where the piece is nothing."""
    if len(piece) < 3:
        return np.inf
    along = np.roll(piece, -1, axis=0) - piece
    length = np.hypot(*along.T)
    outward = np.column_stack([along[:, 1], -along[:, 0]])[length > 1e-9] / length[length > 1e-9, None]
    return float((points @ outward.T - (piece[length > 1e-9] * outward).sum(axis=1)).max())
