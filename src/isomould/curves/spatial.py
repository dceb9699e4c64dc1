"""Shapes drawn in space, and laying them flat on the plane that they were drawn in."""

from typing import NamedTuple

import numpy as np

from isomould.arrays import Floats, read_only
from isomould.curves.bezier import Bezier
from isomould.curves.bspline import Segment
from isomould.curves.chains import Stroke
from isomould.curves.curve import JOINT_GAP, REMOTEST
from isomould.curves.pieces import Ellipse, Line, Piece, tuples
from isomould.curves.plane import Plane, project
from isomould.errors import Note, Refused

ROUNDING = 2e-6
"""What doubles lose of coordinates some thousand kilometres away, mm: limits are inclusive by it."""


_NOWHERE = read_only(np.zeros(3))


class Shape(NamedTuple):
    """A line, ellipse or Bézier in space: its points and the numbers that no affine map changes."""

    kind: type[Piece]
    anchors: Floats
    """(k, 3) mm: ends; or centre and the tips of two half diameters; or control points."""
    numbers: tuple[float, ...] = ()
    """Nothing; or the range of φ; or the weights."""


class Traced(NamedTuple):
    """An entity's shapes in its own direction, their anchors measured from `base`, and that from `far`."""

    name: str
    shapes: list[Shape]
    says_closed: bool
    base: Floats = _NOWHERE
    """(3,) mm: a place of the entity."""
    far: Floats = _NOWHERE
    """(3,) mm: whole metres near a remote drawing, else 0."""


def anchors(piece: Piece) -> tuple[Floats, tuple[float, ...]]:
    """Give the anchors (k, 2) and the numbers of a plane piece, as in `Shape`."""
    match piece:
        case Line():
            return np.array([piece.start, piece.end]), ()
        case Ellipse():
            centre = np.array(piece.centre)
            return np.array([centre, centre + piece.major, centre + piece.minor]), (piece.start, piece.end)
        case Bezier():
            return np.array(piece.points), piece.weights
        case _:
            raise TypeError(piece.kind)


def shapes_of(parts: list[Segment]) -> list[Shape]:
    """Give the shapes of a spline's segments; degree 1 becomes a line."""
    return [
        Shape(Line, p.points) if len(p.points) == 2 else Shape(Bezier, p.points, tuple(p.weights.tolist()))
        for p in parts
    ]


def laid_flat(
    traced: list[Traced], plane: Plane | None, field: str, join: float = JOINT_GAP
) -> tuple[list[Stroke[Piece]], tuple[Note, ...]]:
    """Give the plane coordinates of what was drawn, on a plane or, without one, as the drawing's x and y.

    The shapes are measured from one origin (`seen_from`), and so is the plane. Lines of length zero are left out, and
    heights within the tolerance `join` (mm) are laid flat, both with a note.

    Raises
    ------
    Refused
        E-CURVE-NUMBER for numbers that are not finite, E-DRAWN-PLANE for what leaves the plane by more than
        `join`, E-DRAWN-CURVES for a curve that says it is closed and is not.
    """
    refuse_wild(traced, field)
    ground = plane or _ground(traced)
    heights = _heights(traced, ground, join, plane is None, field)
    strokes = [_stroke(one, ground, join, field) for one in traced]
    kept = [stroke._replace(pieces=tuple(p for p in stroke.pieces if not _is_dot(p))) for stroke in strokes]
    gone = sum(len(s.pieces) for s in strokes) - sum(len(s.pieces) for s in kept)
    text = f"{gone} exactly repeated point(s) left out"
    left = [stroke for stroke in kept if stroke.pieces]
    _refuse_nothing(left, field)
    return left, (*heights, *((Note("W-CURVE-REPEATED", field, text),) if gone else ()))


def _ground(traced: list[Traced]) -> Plane:
    """Give the horizontal plane in the middle of all heights drawn."""
    heights = [height for one in traced for shape in one.shapes for height in _reach(shape)[:, 2]]
    middle = (min(heights) + max(heights)) / 2 if heights else 0.0
    return Plane(np.array([0.0, 0.0, middle]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))


def _reach(shape: Shape) -> Floats:
    """Give points that a shape keeps between: its control points, or places along an arc."""
    if shape.kind is not Ellipse:
        return shape.anchors
    centre, half = shape.anchors[0], shape.anchors[1:] - shape.anchors[0]
    start, end = shape.numbers
    angles = np.linspace(start, end, 33)
    return centre + np.column_stack([np.cos(angles), np.sin(angles)]) @ half


def _heights(traced: list[Traced], plane: Plane, join: float, flat: bool, field: str) -> tuple[Note, ...]:
    """Refuse what leaves the plane by more than the tolerance; note what is within it and not in the plane.

    In a flat drawing heights are compared with each other, above a plane with the plane.
    """
    away = [_largest_height(one, plane) for one in traced]
    spread = 2.0 if flat else 1.0
    worst = int(np.argmax(away)) if away else 0
    largest = spread * away[worst] if away else 0.0
    if not largest <= join + ROUNDING:
        _refuse_leaving(traced[worst].name, largest, join, flat, field)
    uneven = [height for height in away if spread * height > JOINT_GAP]
    if not uneven:
        return ()
    what = "the height of the drawing" if flat else "the plane"
    text = f"{len(uneven)} of {len(away)} entities laid flat, the farthest {largest:.3g} mm off {what}: "
    return (Note("W-DRAWN-FLAT", field, text + traced[worst].name),)


def _largest_height(one: Traced, plane: Plane) -> float:
    return max((float(project(plane, _reach(shape))[1].max()) for shape in one.shapes), default=0.0)


def _stroke(one: Traced, plane: Plane, join: float, field: str) -> Stroke[Piece]:
    pieces = tuple(piece_on(shape, project(plane, shape.anchors)[0]) for shape in one.shapes)
    _refuse_false_closure(one, pieces, join, field)
    return Stroke(one.name, pieces)


def piece_on(shape: Shape, points: Floats) -> Piece:
    """Give the piece in a plane that a shape is when its anchors have the plane's coordinates (k, 2)."""
    if shape.kind is Line:
        return Line(*tuples(points))
    if shape.kind is Ellipse:
        half = points[1:] - points[0]
        return Ellipse(*tuples([points[0], *half]), *shape.numbers)
    return Bezier(tuples(points), shape.numbers)


def _is_dot(piece: Piece) -> bool:
    return isinstance(piece, Line) and piece.start == piece.end


def refuse_wild(traced: list[Traced], field: str) -> None:
    """Refuse numbers that are not finite or too far from the origin."""
    for one in traced:
        _refuse_wild(one, field)


def _refuse_wild(one: Traced, field: str) -> None:
    numbers = [np.append(shape.anchors.ravel(), shape.numbers) for shape in one.shapes]
    biggest = float(np.max(np.abs(np.concatenate([*numbers, one.base, one.far])), initial=0.0))
    if not biggest < REMOTEST:
        found, limit = f"{one.name}: a number {biggest:g}", f"finite numbers below {REMOTEST:g} mm"
        raise Refused("E-CURVE-NUMBER", field, found, limit, "Draw it near the origin.")


def _refuse_leaving(name: str, away: float, join: float, flat: bool, field: str) -> None:
    found = f"{name} leaves {'the height of the drawing' if flat else 'the plane'} by {away:.6g} mm"
    way_out = 'Draw it at one height, or set drawn = "world" and give the plane.' if flat else "Check the plane's axes."
    _refuse("PLANE", f"{field}.drawn", found, f"{join:g} mm", way_out)


def _refuse_false_closure(one: Traced, pieces: tuple[Piece, ...], join: float, field: str) -> None:
    if one.says_closed and pieces:
        gap = float(np.hypot(*(pieces[-1].point(np.ones(1)) - pieces[0].point(np.zeros(1)))[0]))
        if gap > join + ROUNDING:
            found = f"{one.name} says that it is closed, but its ends are {gap:.6g} mm apart"
            _refuse("CURVES", field, found, f"{join:g} mm", "Close it in CAD and save again.")


def _refuse_nothing(strokes: list[Stroke[Piece]], field: str) -> None:
    if not strokes:
        _refuse("CURVES", field, "only points", "one curve", "Draw a curve on the layer.")


def _refuse(what: str, field: str, found: str, limit: str, way_out: str) -> None:
    raise Refused(code=f"E-DRAWN-{what}", field=field, found=found, limit=limit, way_out=way_out)
