"""A curve in space: every piece is two planar pieces with one parameter, its images on the xy and the xz plane.

All kinds of piece are closed under affine maps, so both images are exact, and whatever evaluates planar curves
evaluates these.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.curves.curve import PlanarCurve, check_chain
from isomould.curves.pieces import Piece
from isomould.curves.spatial import Shape, piece_on
from isomould.errors import Note

_VECTORS = ("start", "end", "centre", "major", "minor")


@dataclass(frozen=True, eq=False)
class SpatialPiece:
    """A shape in space with t in [0, 1]."""

    plan: Piece
    """Its x and y."""
    side: Piece
    """Its x and z."""
    kind: ClassVar[str] = "in space"

    def point(self, t: Floats) -> Floats:
        """Give the points at t (n,) as (n, 3), mm."""
        return np.hstack([self.plan.point(t), self.side.point(t)[:, 1:]])

    def derivative(self, t: Floats) -> Floats:
        """Give dP/dt at t (n,) as (n, 3), mm."""
        return np.hstack([self.plan.derivative(t), self.side.derivative(t)[:, 1:]])

    def splits(self) -> Floats:
        """Give none: a curve in space is measured, and not asked how it turns."""
        return np.empty(0)

    def least_speed(self) -> float:
        """Give the least |dP/dt|, mm, of 65 places."""
        t = np.linspace(0.0, 1.0, 65)
        return float(np.linalg.norm(self.derivative(t), axis=1).min())

    def reversed(self) -> "SpatialPiece":
        """Give the same points in the opposite direction."""
        return SpatialPiece(self.plan.reversed(), self.side.reversed())

    def describe(self) -> dict[str, Any]:
        """Give the JSON descriptor of the planar piece with points of three coordinates."""
        plan, side = self.plan.describe(), self.side.describe()
        return {key: _merged(key, value, side[key]) for key, value in plan.items()}


def _merged(key: str, plan: Any, side: Any) -> Any:
    if key == "points":
        return [[*a, b[1]] for a, b in zip(plan, side, strict=True)]
    return [*plan, side[1]] if key in _VECTORS and isinstance(plan, list) else plan


@dataclass(frozen=True, eq=False)
class SpatialCurve:
    """A chain of pieces in space, mm, with places as on a `PlanarCurve`. Made by `join_shapes`, which checks."""

    pieces: tuple[SpatialPiece, ...]
    closed: bool

    def point(self, index: Ints, t: Floats) -> Floats:
        """Give the points (n, 3), mm, at places index (n,), t (n,)."""
        return np.hstack([self._plan.point(index, t), self._side.point(index, t)[:, 1:]])

    def derivative(self, index: Ints, t: Floats) -> Floats:
        """Give dP/dt (n, 3), mm, by the parameter of each place's own piece."""
        return np.hstack([self._plan.derivative(index, t), self._side.derivative(index, t)[:, 1:]])

    def describe(self) -> list[dict[str, Any]]:
        """Give the JSON descriptors of the pieces in order."""
        return [piece.describe() for piece in self.pieces]

    @cached_property
    def _plan(self) -> PlanarCurve:
        return PlanarCurve(tuple(piece.plan for piece in self.pieces), self.closed)

    @cached_property
    def _side(self) -> PlanarCurve:
        return PlanarCurve(tuple(piece.side for piece in self.pieces), self.closed)


def piece_in_space(shape: Shape) -> SpatialPiece:
    """Give the piece of a shape by its two images."""
    return SpatialPiece(piece_on(shape, shape.anchors[:, :2]), piece_on(shape, shape.anchors[:, ::2]))


def join_in_space(pieces: tuple[SpatialPiece, ...], closed: bool, field: str) -> tuple[SpatialCurve, tuple[Note, ...]]:
    """Join pieces to a curve in space; the one door through which such curves come in.

    Raises
    ------
    Refused
        As `join_pieces` does for curves in a plane.
    """
    curve = SpatialCurve(pieces, closed)
    return curve, check_chain(curve, field)
