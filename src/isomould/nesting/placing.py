"""Coordinates for a planned sheet, snapped to 0.001 mm so that no gap falls short, and the cuts between.

A strip's blocks stand apart by the gap, box beside box; inside a block all items have one height and
every neighbour is set at its true distance. Hence every strip, block and piece is freed by cuts that go
from edge to edge.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.nesting.layout import CutTree
from isomould.nesting.shapes import Shape, advance, rotate, turn_half
from isomould.nesting.sheets import SheetPlan, Strip, strip_height
from isomould.nesting.strips import Block

Line = list[list[float]]


@dataclass(frozen=True, eq=False)
class Placed:
    """A piece on its sheet; `points` (n, 2) int, micrometres from the corner of the room inside the trim."""

    part: int
    points: Ints
    rotation_deg: int


@dataclass(frozen=True, eq=False)
class _Piece:
    """A shape in its strip, and the normal of the cut at its left."""

    part: int
    shape: Shape
    x: int
    normal: Floats

    @property
    def end(self) -> int:
        return self.x + self.shape.width

    @property
    def hull(self) -> Ints:
        return self.shape.hull + np.array([self.x, 0])


@dataclass(frozen=True)
class Saw:
    """What lies between pieces, micrometres, and whether every other piece of a block makes a half turn."""

    gap: float
    step: int
    flips: bool


def place(plan: SheetPlan, saw: Saw, length: int) -> tuple[list[Placed], CutTree]:
    """Give the pieces of a sheet and its cut tree, whose placements count from 0, in micrometres.

    Parameters
    ----------
    length
        Room for a strip; strips of a turned frame start at the top and go down.
    """
    strips = [_lay_strip(strip, saw) for strip in plan.strips]
    bottoms = np.cumsum([0] + [strip_height(strip) + saw.step for strip in plan.strips[:-1]]).tolist()
    rows = [(piece, y) for strip, y in zip(strips, bottoms, strict=True) for block in strip for piece in block]
    tree = _cut_sheet(strips, bottoms, saw)
    if not plan.frame.turned:
        return [_placed(piece, y) for piece, y in rows], tree
    return [_turn_down(_placed(piece, y), length) for piece, y in rows], _turn_tree(tree, length)


def _lay_strip(strip: Strip, saw: Saw) -> list[list[_Piece]]:
    blocks: list[list[_Piece]] = []
    x = 0
    for block in strip:
        blocks.append(_lay_block(block, saw, x))
        x = blocks[-1][-1].end + saw.step
    return blocks


def _lay_block(block: Block, saw: Saw, start: int) -> list[_Piece]:
    shapes = [turn_half(item.shape) if saw.flips and k % 2 else item.shape for k, item in enumerate(block)]
    steps = [advance(one, other, saw.gap) for one, other in pairwise(shapes)]
    places = np.cumsum([start] + [step for step, _ in steps])
    normals = [np.array([1.0, 0.0])] + [normal for _, normal in steps]
    rows = zip(block, shapes, places, normals, strict=True)
    return [_Piece(item.part, shape, int(x), normal) for item, shape, x, normal in rows]


def _placed(piece: _Piece, y: int) -> Placed:
    return Placed(piece.part, piece.shape.points + np.array([piece.x, y]), piece.shape.rotation_deg)


def _turn_down(placed: Placed, length: int) -> Placed:
    points = rotate(placed.points, 270) + np.array([0, length])
    return Placed(placed.part, points, (placed.rotation_deg + 270) % 360)


def _cut_sheet(strips: list[list[list[_Piece]]], bottoms: list[int], saw: Saw) -> CutTree:
    """Cut the strips off, the lowest first; the rest is above the last."""
    sizes = [sum(len(block) for block in strip) for strip in strips]
    firsts = np.cumsum([0, *sizes]).tolist()
    rows = list(zip(strips, bottoms, firsts, strict=False))
    lines = [_level(y + _top(strip) + saw.gap / 2) for strip, y, _ in rows]
    return {"lines": lines, "pieces": [_cut_strip(*row, saw) for row in rows] + [{}]}


def _cut_strip(strip: list[list[_Piece]], y: int, first: int, saw: Saw) -> CutTree:
    """Cut the blocks off, the leftmost first; the rest is right of the last."""
    firsts = np.cumsum([first] + [len(block) for block in strip]).tolist()
    ends = [block[-1].end + saw.gap / 2 for block in strip]
    blocks = zip(strip, firsts, strict=False)
    pieces = [_cut_low_block(block, y, number, _top(strip), saw) for block, number in blocks]
    return {"lines": [[[x, 0.0], [x, 1.0]] for x in ends], "pieces": [*pieces, {}]}


def _cut_low_block(block: list[_Piece], y: int, first: int, strip_top: int, saw: Saw) -> CutTree:
    """Cut off what is above a block that is lower than its strip."""
    top = block[0].shape.height
    tree = _cut_block(block, y, first)
    return {"lines": [_level(y + top + saw.gap / 2)], "pieces": [tree, {}]} if top < strip_top else tree


def _cut_block(block: list[_Piece], y: int, first: int) -> CutTree:
    """Cut the pieces apart along their legs."""
    leaves: list[CutTree] = [{"placement": first + k} for k in range(len(block))]
    lines = [_leg_cut(one, other, y) for one, other in pairwise(block)]
    return {"lines": lines, "pieces": leaves} if lines else leaves[0]


def _leg_cut(one: _Piece, other: _Piece, y: int) -> list[list[float]]:
    """Give the line half-way between two neighbours, upwards."""
    normal = other.normal
    level = (float((one.hull @ normal).max()) + float((other.hull @ normal).min())) / 2
    return [[float(level - normal[1] * v) / float(normal[0]), float(v + y)] for v in (0, one.shape.height)]


def _level(y: float) -> list[list[float]]:
    """Give a line that has what lies below it at its left."""
    return [[1.0, y], [0.0, y]]


def _top(strip: list[list[_Piece]]) -> int:
    return max(piece.shape.height for block in strip for piece in block)


def _turn_tree(tree: CutTree, length: int) -> CutTree:
    return map_tree(tree, lambda line: [[y, length - x] for x, y in line], 0)


def map_tree(tree: CutTree, move: Callable[[Line], Line], first: int) -> CutTree:
    """Move the lines of a cut tree and count its placements from `first`."""
    if "placement" in tree:
        return {"placement": tree["placement"] + first}
    if "lines" not in tree:
        return {}
    pieces = [map_tree(piece, move, first) for piece in tree["pieces"]]
    return {"lines": [move(line) for line in tree["lines"]], "pieces": pieces}
