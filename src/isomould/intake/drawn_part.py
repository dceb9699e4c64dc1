"""Drawings of parts (DXF) as people have them: outlines as polygons, and the holes in them.

Every closed loop on the outline's layer counts: one that no other holds is the outline of a part, one inside it a hole.
Nothing that would be cut is left out with a note alone: what cannot be a part or a hole of it is refused.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely

from isomould.arrays import Floats, round_um
from isomould.curves.pieces import Ellipse, Line, Piece
from isomould.documents.drawing import Circle, Polyline
from isomould.errors import Note, Refused
from isomould.intake.flattening import OUTWARD, bulge_angle, flat_points, is_round, polygon_around
from isomould.intake.least_box import odd_angle, rotation
from isomould.intake.part_layers import DRILLED, DrawnLoops, LayerChoice, read_loops
from isomould.intake.part_list import Hole
from isomould.intake.part_loops import Loop, Nested, nest_loops

_CENTRES = 1e-6
"""How far the centres of arcs may be apart that make one circle, and their radii, mm."""

_FAR = 1e5
"""A part further from the origin is moved there, mm: where it was drawn does not matter."""


@dataclass(frozen=True, eq=False)
class DrawnPart:
    """An outline (n, 2) mm, counter-clockwise, its holes, and what is not as drawn: codes and texts of notes."""

    outline: Floats
    holes: tuple[Hole, ...]
    remarks: tuple[tuple[str, str], ...]


@dataclass(frozen=True, eq=False)
class PartDrawing:
    """The parts of a drawing, from left to right, and what should be known of the file."""

    parts: tuple[DrawnPart, ...]
    notes: tuple[Note, ...]


def read_part_drawing(path: Path, choice: LayerChoice, *, turns: bool) -> PartDrawing:
    """Read the parts of a drawing.

    Parameters
    ----------
    path
        A drawing with one outline or several.
    turns
        Whether a part that is drawn at an odd angle is turned to its least box.

    Raises
    ------
    Refused
        E-DXF-… and E-DRAWN-… as any drawing; E-PART-OPEN, -TWICE, -CROSS, -HOLE, and -LAYER for a closed loop in a part
        on a layer that is not read.
    """
    field = str(path)
    drawn = read_loops(path, choice)
    nested = nest_loops(drawn.outer, drawn.inner, drawn.join, field)
    _refuse_stray(drawn, nested, field)
    several = f"{len(nested)} outlines, each a part of its own, from left to right"
    notes = (*drawn.notes, *([Note("W-PART-SEVERAL", field, several)] if len(nested) > 1 else []))
    return PartDrawing(tuple(_drawn_part(one, turns=turns) for one in nested), notes)


def _refuse_stray(drawn: DrawnLoops, nested: Sequence[Nested], field: str) -> None:
    """Refuse a closed loop in the material of a part on a layer that is not read: it might be a hole."""
    bodies = [_body(one) for one in nested]
    tree = shapely.STRtree(bodies)
    for loop in drawn.stray:
        shape = loop.polygon.buffer(0)
        near = tree.query(shape, predicate="intersects").tolist()
        if any(_takes_from(shape, bodies[k], drawn.join) for k in near):
            found = f"{loop.name} on layer {loop.layer!r} is closed and lies in the part at {loop.place}"
            way_out = (
                f'Give --inner-layer "{loop.layer}" if it is a hole, --ignore-layer "{loop.layer}" if it is not cut.'
            )
            raise Refused("E-PART-LAYER", field, found, "loops on layers that are read, or left out by name", way_out)


def _body(one: Nested) -> shapely.Polygon:
    holes = [shapely.get_coordinates(hole.polygon.exterior) for hole in one.holes]
    return shapely.Polygon(one.outline.polygon.exterior, holes)


def _takes_from(shape: shapely.Polygon, body: shapely.Polygon, join: float) -> bool:
    """Tell whether a loop is neither a copy of an outline or hole, nor a frame around the part."""
    room = join + 0.02
    if shape.buffer(room).contains(shapely.Polygon(body.exterior)):
        return False
    return shape.intersection(body).area > room * shape.length


# --- one part


def _drawn_part(one: Nested, *, turns: bool) -> DrawnPart:
    corners = shapely.get_coordinates(one.outline.polygon.exterior)[:-1]
    angle = odd_angle(corners) if turns else 0.0
    corner = corners.min(axis=0)
    place = -np.round(corner) if np.abs(corner).max() > _FAR else np.zeros(2)
    outline, *holes = [_moved(loop, place, angle) for loop in (one.outline, *one.holes)]
    remarks = [
        *_remark(
            "W-PART-ARC", f"arcs are cut as lines up to {OUTWARD:g} mm outside", any(map(is_round, outline.pieces))
        ),
        *_remark(
            "W-PART-CURVE", _CURVES_CUT, any(_is_free(piece) for loop in (outline, *holes) for piece in loop.pieces)
        ),
        *_remark("W-PART-TURNED", f"turned by {math.degrees(angle):.3f}° to the least box", angle != 0),
    ]
    return DrawnPart(polygon_around(outline.pieces), tuple(_hole(loop) for loop in holes), tuple(remarks))


_CURVES_CUT = f"splines and ellipses are cut as lines up to {OUTWARD:g} mm outside of the outline or inside of the hole"


def _remark(code: str, text: str, applies: bool) -> list[tuple[str, str]]:
    return [(code, text)] if applies else []


def _is_free(piece: Piece) -> bool:
    return not isinstance(piece, Line) and not is_round(piece)


def _moved(loop: Loop, place: Floats, angle: float) -> Loop:
    """Move a loop, then turn it about the origin."""
    if angle == 0 and not place.any():
        return loop
    turn = rotation(angle)
    return Loop(tuple(piece.mapped(turn, turn @ place) for piece in loop.pieces), loop.name, loop.layer)


def _hole(loop: Loop) -> Hole:
    """Give a hole as it is cut: a circle of DRILL is drilled, everything else is a contour, clockwise."""
    circle = _circle_of(loop.pieces)
    if circle is not None and loop.layer.casefold() == DRILLED.casefold():
        return circle
    pieces = [piece.reversed() for piece in loop.pieces[::-1]]
    corners = [corner for piece in pieces for corner in _contour(piece)]
    points = round_um(np.array([point for point, _ in corners]))
    bulges = np.array([bulge for _, bulge in corners])
    apart = (points != np.roll(points, -1, axis=0)).any(axis=1)
    return Polyline("CUT_INNER", points[apart], True, bulges[apart] if bulges.any() else None)


def _circle_of(pieces: Sequence[Piece]) -> Circle | None:
    """Give the circle that a closed chain of arcs is, or none."""
    arcs = [piece for piece in pieces if isinstance(piece, Ellipse) and is_round(piece)]
    if len(arcs) < len(pieces):
        return None
    radii = np.array([math.hypot(*arc.major) for arc in arcs])
    centres = np.array([arc.centre for arc in arcs])
    if np.ptp(radii) > _CENTRES or np.ptp(centres, axis=0).max() > _CENTRES:
        return None
    x, y = round_um(centres[0]).tolist()
    return Circle("DRILL", (x, y), float(radii[0]))


def _contour(piece: Piece) -> list[tuple[Floats, float]]:
    """Give the corners of a contour along a piece, each with the bulge that follows it."""
    if not isinstance(piece, Ellipse) or not is_round(piece):
        return [(point, 0.0) for point in flat_points(piece)]
    return [(half.point(np.zeros(1))[0], math.tan(bulge_angle(half) / 4)) for half in _halves(piece)]


def _halves(arc: Ellipse) -> list[Ellipse]:
    """Cut an arc of more than half a circle in two: a bulge of 1 is the most that all machines read."""
    if abs(arc.end - arc.start) <= math.pi * (1 + 1e-9):
        return [arc]
    middle = (arc.start + arc.end) / 2
    return [
        Ellipse(arc.centre, arc.major, arc.minor, arc.start, middle),
        Ellipse(arc.centre, arc.major, arc.minor, middle, arc.end),
    ]
