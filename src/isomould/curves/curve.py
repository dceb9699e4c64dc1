"""A planar curve: a chain of pieces, checked once when it is joined, then only evaluated."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Protocol, Self

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.curves.bezier import Bezier
from isomould.curves.pieces import Catenary, Ellipse, Line, Piece, Sine, tuples
from isomould.errors import Note, Refused

JOINT_GAP = 1e-6
"""Pieces whose ends are this near join, mm."""
LEAST_SPEED = 1e-9
"""A derivative below this share of the piece's length is a cusp."""
REMOTEST = 1e10
"""Coordinates beyond this carry no thousandth of a millimetre, mm."""
SMALLEST, SMALL, LARGE, LARGEST = 0.5, 500.0, 2e6, 2e9
"""Sizes (diagonals) that are refused, noted, noted, refused, mm (failure mode A3)."""

_KINDS: dict[str, type[Piece]] = {kind.kind: kind for kind in (Line, Ellipse, Sine, Catenary, Bezier)}


class AnyPiece(Protocol):
    """What a piece in the plane and a piece in space have in common."""

    kind: ClassVar[str]

    def point(self, t: Floats) -> Floats: ...  # noqa: D102
    def splits(self) -> Floats: ...  # noqa: D102
    def least_speed(self) -> float: ...  # noqa: D102


class Curve(Protocol):
    """What a curve in the plane and a curve in space have in common; points have 2 or 3 coordinates."""

    @property
    def pieces(self) -> Sequence[AnyPiece]: ...  # noqa: D102
    @property
    def closed(self) -> bool: ...  # noqa: D102
    def point(self, index: Ints, t: Floats) -> Floats: ...  # noqa: D102
    def derivative(self, index: Ints, t: Floats) -> Floats: ...  # noqa: D102


class _Stack(NamedTuple):
    """Pieces whose rows have one shape, evaluated together."""

    kind: type[Piece]
    rows: Floats
    members: Ints


@dataclass(frozen=True)
class PlanarCurve:
    """A chain of pieces, mm. Place k is (index[k], t[k]): a piece index and its parameter in [0, 1].

    Made by `join_pieces`, which checks; the type itself trusts its maker.
    """

    pieces: tuple[Piece, ...]
    closed: bool

    def point(self, index: Ints, t: Floats) -> Floats:
        """Give the points (n, 2), mm, at places index (n,), t (n,)."""
        return self._evaluate(index, t, 0)

    def derivative(self, index: Ints, t: Floats) -> Floats:
        """Give dP/dt (n, 2), mm, by the parameter of each place's own piece."""
        return self._evaluate(index, t, 1)

    def second(self, index: Ints, t: Floats) -> Floats:
        """Give d²P/dt² (n, 2), mm."""
        return self._evaluate(index, t, 2)

    def reversed(self) -> Self:
        """Give the same curve in the opposite direction; place (i, t) becomes (k − 1 − i, 1 − t)."""
        return type(self)(tuple(piece.reversed() for piece in self.pieces[::-1]), self.closed)

    def mapped(self, matrix: Floats, offset: Floats) -> Self:
        """Give the affine image: P becomes matrix (2, 2) @ P + offset (2,)."""
        return type(self)(tuple(piece.mapped(matrix, offset) for piece in self.pieces), self.closed)

    def describe(self) -> list[dict[str, Any]]:
        """Give the JSON descriptors of the pieces in order."""
        return [piece.describe() for piece in self.pieces]

    def _evaluate(self, index: Ints, t: Floats, order: int) -> Floats:
        index, t = np.broadcast_arrays(np.asarray(index), np.asarray(t, float))
        result = np.empty((t.size, 2))
        for number, stack in enumerate(self._stacks):
            here = np.flatnonzero(self._stack_of[index] == number)
            result[here] = stack.kind.evaluate(stack.rows[self._slot_of[index[here]]], t[here], order)
        return result

    @cached_property
    def _stacks(self) -> tuple[_Stack, ...]:
        rows = [piece.row for piece in self.pieces]
        families: dict[tuple[type[Piece], tuple[int, ...]], list[int]] = {}
        for k, piece in enumerate(self.pieces):
            families.setdefault((type(piece), rows[k].shape), []).append(k)
        return tuple(
            _Stack(kind, np.stack([rows[k] for k in members]), np.array(members))
            for (kind, _), members in families.items()
        )

    @cached_property
    def _stack_of(self) -> Ints:
        result = np.empty(len(self.pieces), np.int64)
        for number, stack in enumerate(self._stacks):
            result[stack.members] = number
        return result

    @cached_property
    def _slot_of(self) -> Ints:
        result = np.empty(len(self.pieces), np.int64)
        for stack in self._stacks:
            result[stack.members] = np.arange(stack.members.size)
        return result


def piece_from(descriptor: Mapping[str, Any]) -> Piece:
    """Read a piece from its JSON descriptor.

    Raises
    ------
    KeyError, TypeError, ValueError
        If the descriptor is not one that `Piece.describe` writes.
    """
    fields = {name: tuples(value) for name, value in descriptor.items() if name != "kind"}
    return _KINDS[descriptor["kind"]](**fields)


def join_pieces(pieces: tuple[Piece, ...], closed: bool, field: str = "curve") -> tuple[PlanarCurve, tuple[Note, ...]]:
    """Join pieces to a curve; the one door through which curves come in.

    Pieces of length zero (a point given twice) are left out with a note.

    Raises
    ------
    Refused
        E-CURVE-EMPTY nothing left, -NUMBER not finite or too far from the origin, -SHORT a piece of no
        length, -GAP between pieces, -CLOSED ends that meet
        on a curve said to be open, -CUSP a vanishing derivative, -SIZE implausible.
    """
    _refuse_wild_numbers(pieces, field)
    kept = tuple(piece for piece in pieces if not _is_repeated_point(piece))
    curve = PlanarCurve(kept, closed)
    return curve, (*_repeated(len(pieces) - len(kept), field), *check_chain(curve, field))


def check_chain(curve: Curve, field: str) -> tuple[Note, ...]:
    """Refuse a chain with gaps, ends that meet unsaid, cusps or an implausible size (see `join_pieces`)."""
    _refuse_nothing(curve.pieces, field)
    _refuse_gaps(curve, field)
    _refuse_unsaid_closure(curve, field)
    _refuse_cusps(curve, field)
    return _weigh_size(curve, field)


def ends(curve: Curve) -> tuple[Floats, Floats]:
    """Give the start and the end points of all pieces, each (k, 2 or 3), mm."""
    every = np.arange(len(curve.pieces))
    return curve.point(every, np.zeros(every.size)), curve.point(every, np.ones(every.size))


def _refuse_wild_numbers(pieces: tuple[Piece, ...], field: str) -> None:
    for k, piece in enumerate(pieces):
        biggest = float(np.abs(piece.row).max())
        if not biggest < REMOTEST:
            raise Refused(
                code="E-CURVE-NUMBER",
                field=field,
                found=f"{biggest:g} in piece {k} ({piece.kind})",
                limit=f"finite coordinates below {REMOTEST:g} mm",
                way_out="Draw the curve near the origin.",
            )


def _refuse_nothing(pieces: Sequence[AnyPiece], field: str) -> None:
    if not pieces:
        raise Refused(
            code="E-CURVE-EMPTY",
            field=field,
            found="no piece with a length",
            limit="at least one",
            way_out="Draw a curve.",
        )


def _is_repeated_point(piece: Piece) -> bool:
    row = piece.row
    return isinstance(piece, Line | Bezier) and not np.any(row[1:, :2] - (row[:1] if len(row) == 2 else 0))


def _repeated(count: int, field: str) -> tuple[Note, ...]:
    text = f"{count} exactly repeated point(s) left out"
    return (Note("W-CURVE-REPEATED", field, text),) if count else ()


def _refuse_gaps(curve: Curve, field: str) -> None:
    starts, finishes = ends(curve)
    following = np.roll(starts, -1, axis=0) if curve.closed else starts[1:]
    gaps = np.linalg.norm(following - finishes[: len(following)], axis=1)
    if gaps.size and not gaps.max() <= JOINT_GAP:
        worst = int(gaps.argmax())
        place = ", ".join(f"{coordinate:.6g}" for coordinate in finishes[worst])
        raise Refused(
            code="E-CURVE-GAP",
            field=field,
            found=f"a gap of {gaps[worst]:.6g} mm after piece {worst} at ({place})",
            limit=f"{JOINT_GAP:g} mm",
            way_out="Join the ends of the pieces, or do not declare the curve closed.",
        )


def _refuse_unsaid_closure(curve: Curve, field: str) -> None:
    starts, finishes = ends(curve)
    if not curve.closed and np.linalg.norm(finishes[-1] - starts[0]) <= JOINT_GAP:
        raise Refused(
            code="E-CURVE-CLOSED",
            field=field,
            found="an open curve whose ends meet",
            limit=f"ends more than {JOINT_GAP:g} mm apart",
            way_out="Set closed = true and leave out the repeated point, or part the ends.",
        )


def _refuse_cusps(curve: Curve, field: str) -> None:
    t = np.linspace(0, 1, 17)
    for k, piece in enumerate(curve.pieces):
        length = float(np.linalg.norm(np.diff(piece.point(t), axis=0), axis=1).sum())
        _refuse_short(length, k, field)
        if not piece.least_speed() >= LEAST_SPEED * length:
            raise Refused(
                code="E-CURVE-CUSP",
                field=field,
                found=f"the derivative of piece {k} ({piece.kind}) vanishes: a cusp or a collapsed curve",
                limit=f"{LEAST_SPEED:g} of the piece's length",
                way_out="Spread the control points, or part the curve there.",
            )


def _refuse_short(length: float, k: int, field: str) -> None:
    if not length > JOINT_GAP:
        raise Refused(
            code="E-CURVE-SHORT",
            field=field,
            found=f"piece {k} is {length:.3g} mm long",
            limit=f"more than {JOINT_GAP:g} mm",
            way_out="Leave the piece out.",
        )


def _weigh_size(curve: Curve, field: str) -> tuple[Note, ...]:
    every, t = np.divmod(np.arange(9 * len(curve.pieces)), 9)
    size = float(np.linalg.norm(np.ptp(curve.point(every, t / 8), axis=0)))
    if not SMALLEST <= size <= LARGEST:
        raise Refused(
            code="E-CURVE-SIZE",
            field=field,
            found=f"{size:g} mm across",
            limit=f"{SMALLEST:g} mm to {LARGEST:g} mm",
            way_out="Check the units.",
        )
    text = f"{size:g} mm across, an unusual size for a building: check the units"
    return () if SMALL <= size <= LARGE else (Note("W-CURVE-SIZE", field, text),)
