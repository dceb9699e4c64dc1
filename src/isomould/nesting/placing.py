"""Coordinates for a planned sheet, snapped to 0.001 mm so that no gap falls short, and the cuts between.

A strip's blocks stand apart by the gap, box beside box; inside a block all items have one height and
every neighbour is set at its true distance. Hence every strip, block and piece is freed by cuts that go
from edge to edge.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from isomould.arrays import Floats, Ints, read_only
from isomould.nesting.layout import CutTree
from isomould.nesting.shapes import UM, Shape, advance, rotate, turn_half
from isomould.nesting.sheets import Run, SheetPlan, Strip, Zone, strip_height
from isomould.nesting.strips import Block

Line = list[list[float]]


@dataclass(frozen=True, eq=False)
class Placed:
    """A piece on its sheet; `points` (n, 2) int, micrometres from the corner of the room inside the trim."""

    part: int
    points: Ints
    rotation_deg: int
    turned_over: bool

    @cached_property
    def points_mm(self) -> Floats:
        """The same in mm."""
        return read_only(self.points / UM)


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
    laid = _lay_stack(plan.strips, saw)
    return _turn_down(laid, length) if plan.frame.turned else laid


Laid = tuple[list[Placed], CutTree]
"""Pieces and the cuts that free them; placements count from 0."""


def _lay_stack(strips: Sequence[Strip], saw: Saw) -> Laid:
    """Stack strips on y = 0 and cut them off, the lowest first; the rest is above the last."""
    heights = [strip_height(strip) for strip in strips]
    bottoms = np.cumsum([0] + [height + saw.step for height in heights]).tolist()
    laid = [_raise(_lay_strip(strip, saw), y) for strip, y in zip(strips, bottoms, strict=False)]
    lines = [_level(y + height + saw.gap / 2) for y, height in zip(bottoms, heights, strict=False)]
    firsts = np.cumsum([0] + [len(placed) for placed, _ in laid]).tolist()
    trees = [map_tree(tree, lambda line: line, first) for (_, tree), first in zip(laid, firsts, strict=False)]
    return [item for placed, _ in laid for item in placed], {"lines": lines, "pieces": [*trees, {}]}


def _lay_strip(strip: Strip, saw: Saw) -> Laid:
    if isinstance(strip, Zone):
        return _turn_down(_lay_stack(strip.runs, saw), strip.height)
    blocks = _lay_run(strip, saw)
    return [_placed(piece) for block in blocks for piece in block], _cut_run(blocks, saw)


def _raise(laid: Laid, y: int) -> Laid:
    placed, tree = laid
    up = [replace(item, points=item.points + np.array([0, y])) for item in placed]
    return up, map_tree(tree, lambda line: [[one, other + y] for one, other in line], 0)


def _turn_down(laid: Laid, length: int) -> Laid:
    """Turn by a quarter clockwise: what began at the left of a strip begins at the top, `length` up."""
    placed, tree = laid
    down = [
        replace(
            item,
            points=rotate(item.points, 270) + np.array([0, length]),
            rotation_deg=(item.rotation_deg + 270) % 360,
        )
        for item in placed
    ]
    return down, map_tree(tree, lambda line: [[y, length - x] for x, y in line], 0)


def _lay_run(run: Run, saw: Saw) -> list[list[_Piece]]:
    blocks: list[list[_Piece]] = []
    x = 0
    for block in run:
        blocks.append(_lay_block(block, saw, x))
        x = blocks[-1][-1].end + saw.step
    return blocks


def _lay_block(block: Block, saw: Saw, start: int) -> list[_Piece]:
    """Set a block's items beside each other; of both ways to begin a chain of an even number, the shorter."""
    laid = _lay_chain(block, saw, start, 0)
    if not saw.flips or len(block) % 2 or block[0].fixed:
        return laid
    return min(laid, _lay_chain(block, saw, start, 1), key=lambda pieces: pieces[-1].end)


def _lay_chain(block: Block, saw: Saw, start: int, first: int) -> list[_Piece]:
    """Lay a chain; with `first` 1 its first item makes a half turn, with 0 its second does."""
    turned = [saw.flips and bool((first + k) % 2) and not item.fixed for k, item in enumerate(block)]
    shapes = [turn_half(item.shape) if half else item.shape for item, half in zip(block, turned, strict=True)]
    steps = [advance(one, other, saw.gap) for one, other in pairwise(shapes)]
    places = np.cumsum([start] + [step for step, _ in steps])
    normals = [np.array([1.0, 0.0])] + [normal for _, normal in steps]
    rows = zip(block, shapes, places, normals, strict=True)
    return [_Piece(item.part, shape, int(x), normal) for item, shape, x, normal in rows]


def _placed(piece: _Piece) -> Placed:
    shape = piece.shape
    return Placed(piece.part, shape.points + np.array([piece.x, 0]), shape.rotation_deg, shape.turned_over)


def _cut_run(run: list[list[_Piece]], saw: Saw) -> CutTree:
    """Cut the blocks off, the leftmost first; the rest is right of the last."""
    firsts = np.cumsum([0] + [len(block) for block in run]).tolist()
    ends = [block[-1].end + saw.gap / 2 for block in run]
    top = max(block[0].shape.height for block in run)
    pieces = [_cut_low_block(block, number, top, saw) for block, number in zip(run, firsts, strict=False)]
    return {"lines": [[[x, 0.0], [x, 1.0]] for x in ends], "pieces": [*pieces, {}]}


def _cut_low_block(block: list[_Piece], first: int, strip_top: int, saw: Saw) -> CutTree:
    """Cut off what is above a block that is lower than its strip."""
    top = block[0].shape.height
    tree = _cut_block(block, first)
    return {"lines": [_level(top + saw.gap / 2)], "pieces": [tree, {}]} if top < strip_top else tree


def _cut_block(block: list[_Piece], first: int) -> CutTree:
    """Cut the pieces apart along their legs."""
    leaves: list[CutTree] = [{"placement": first + k} for k in range(len(block))]
    lines = [_leg_cut(one, other) for one, other in pairwise(block)]
    return {"lines": lines, "pieces": leaves} if lines else leaves[0]


def _leg_cut(one: _Piece, other: _Piece) -> list[list[float]]:
    """Give the line half-way between two neighbours, upwards."""
    normal = other.normal
    level = (float((one.hull @ normal).max()) + float((other.hull @ normal).min())) / 2
    return [[float(level - normal[1] * v) / float(normal[0]), float(v)] for v in (0, one.shape.height)]


def _level(y: float) -> list[list[float]]:
    """Give a line that has what lies below it at its left."""
    return [[1.0, y], [0.0, y]]


def map_tree(tree: CutTree, move: Callable[[Line], Line], first: int) -> CutTree:
    """Move the lines of a cut tree and count its placements from `first`."""
    if "placement" in tree:
        return {"placement": tree["placement"] + first}
    if "lines" not in tree:
        return {}
    pieces = [map_tree(piece, move, first) for piece in tree["pieces"]]
    return {"lines": [move(line) for line in tree["lines"]], "pieces": pieces}
