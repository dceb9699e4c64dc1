"""The drawing of one part (DXF): its outline as a polygon, and its holes.

Arcs of the outline become polygons outside of it, tangents where it bulges out and chords where it bulges in, so that
no part is ever cut smaller than it was drawn.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

import numpy as np
import shapely

from isomould.arrays import Floats, round_um
from isomould.curves.chains import Stroke
from isomould.curves.drawn import the_one_chain
from isomould.curves.dxf import open_dxf_source
from isomould.curves.joining import JOIN
from isomould.curves.layer_names import layer_key
from isomould.curves.origins import origin_of, seen_from
from isomould.curves.pieces import Ellipse, Line, Piece
from isomould.curves.spatial import Traced, laid_flat
from isomould.documents.drawing import Circle, Polyline, chords
from isomould.errors import Refused
from isomould.intake.part_list import Hole
from isomould.units import LengthUnit

OUTWARD = 0.05
"""How far the polygon may lie outside an arc, mm."""

_STEP = 0.001
"""What points beside an arc keep off it, so that rounding brings none of them inside, mm."""

_INNER, _DRILLED = "CUT_INNER", "DRILL"
_SILENT = {"ENGRAVE", "INFO", "SHEET", "DEFPOINTS"}
"""Layers that say nothing of what is cut."""


@dataclass(frozen=True, eq=False)
class DrawnPart:
    """An outline (n, 2) mm, counter-clockwise, its holes, whether arcs were replaced, and layers that were not read."""

    outline: Floats
    holes: tuple[Hole, ...]
    rounded: bool
    ignored: tuple[str, ...]


def read_drawn_part(path: Path, layer: str, units: LengthUnit | None) -> DrawnPart:
    """Read the drawing of one part: its outline on one layer, closed contours on CUT_INNER, circles on DRILL.

    Parameters
    ----------
    path
        A DXF file with one closed outline of lines and arcs.
    layer
        The layer of the outline.
    units
        Of a drawing that does not say ($INSUNITS 0).

    Raises
    ------
    Refused
        E-DXF-… and E-DRAWN-… as any drawing; E-PART-OPEN, E-PART-CURVE, E-PART-HOLE.
    """
    field = str(path)
    (outer, inner, drilled), others = _traced_layers(path, (layer, _INNER, _DRILLED), units, field)
    pieces = _outline_pieces(outer, field)
    outline = _outside(pieces, field)
    holes = (*_contours(inner, field), *(_drilled(one, field) for one in drilled))
    _refuse_stray(holes, outline, field)
    ignored = tuple(name for name in others if name.upper() not in _SILENT)
    return DrawnPart(outline, holes, any(isinstance(piece, Ellipse) for piece in pieces), ignored)


def _traced_layers(
    path: Path, layers: Sequence[str], units: LengthUnit | None, field: str
) -> tuple[list[list[Traced]], list[str]]:
    """Give what is drawn on each of some layers, from one origin, and the names of all others that hold anything."""
    source = open_dxf_source(path, units, field)
    drawn = [source.trace(layer).traced if k == 0 or source.holds(layer) else [] for k, layer in enumerate(layers)]
    origin = origin_of([one for traced in drawn for one in traced])
    known = {layer_key(layer) for layer in layers}
    others = [content.name for content in source.layers() if content.kinds and layer_key(content.name) not in known]
    return [seen_from(traced, origin) for traced in drawn], sorted(others)


def _chained(strokes: list[Stroke[Piece]], field: str) -> tuple[tuple[Piece, ...], bool]:
    chain, _ = the_one_chain(strokes, JOIN, field)
    return chain.pieces, chain.closed


def _outline_pieces(traced: list[Traced], field: str) -> tuple[Piece, ...]:
    """Give the pieces of the outline in order, counter-clockwise."""
    strokes, _ = laid_flat(traced, None, field, JOIN)
    pieces, closed = _chained(strokes, field)
    if not closed:
        apart = float(np.hypot(*(_start(pieces[0]) - _end(pieces[-1]))))
        names = ", ".join(stroke.name for stroke in strokes[:4])
        found = f"{names}: the outline is open, its ends are {apart:.6g} mm apart"
        _refuse("OPEN", field, found, f"a closed outline, within {JOIN:g} mm", "Close it in CAD and save again.")
    return pieces if _turning(pieces) > 0 else tuple(piece.reversed() for piece in pieces[::-1])


def _turning(pieces: Sequence[Piece]) -> float:
    """Give twice the area that the pieces go round, positive counter-clockwise; arcs as chords."""
    points = np.concatenate([piece.point(np.linspace(0, 1, 17)[:-1]) for piece in pieces])
    x, y = (points - points[0]).T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def _start(piece: Piece) -> Floats:
    return piece.point(np.zeros(1))[0]


def _end(piece: Piece) -> Floats:
    return piece.point(np.ones(1))[0]


def _outside(pieces: Sequence[Piece], field: str) -> Floats:
    points = np.concatenate([_piece_points(piece, field) for piece in pieces])
    rounded = round_um(points)
    return rounded[(rounded != np.roll(rounded, 1, axis=0)).any(axis=1)]


def _piece_points(piece: Piece, field: str) -> Floats:
    """Give the points of a piece without its end: of an arc, those of a polygon outside it."""
    if isinstance(piece, Line):
        return np.array([piece.start])
    arc = _circular(piece, field)
    radius, turn = float(np.hypot(*arc.major)), _bulge_angle(arc)
    if turn > 0:
        step = 2 * math.acos(radius / (radius + OUTWARD - _STEP))
        count = max(math.ceil(abs(turn) / step), 3)
        shares, reach = (np.arange(count) + 0.5) / count, radius / math.cos(turn / count / 2) + _STEP
    else:
        step = 2 * math.acos(max(1 - (OUTWARD - _STEP) / radius, 0.0))
        count = max(math.ceil(abs(turn) / step), 1)
        shares, reach = np.arange(1, count) / count, radius - _STEP
    centre = np.array(arc.centre)
    return np.vstack([_start(arc), centre + (arc.point(shares) - centre) * (reach / radius)])


def _bulge_angle(arc: Ellipse) -> float:
    """Give the angle of an arc, rad, positive to the left."""
    side = arc.major[0] * arc.minor[1] - arc.major[1] * arc.minor[0]
    return math.copysign(1.0, side) * (arc.end - arc.start)


def _circular(piece: Piece, field: str) -> Ellipse:
    """Give an arc of a circle; splines and ellipses have no tangents that a shop would recognise."""
    if not isinstance(piece, Ellipse) or not _is_round(piece):
        found = f"a {piece.kind} that is no line and no arc of a circle"
        _refuse("CURVE", field, found, "lines and arcs", "Convert splines and ellipses to polylines outside of them.")
    return piece


def _is_round(piece: Ellipse) -> bool:
    one, other = math.hypot(*piece.major), math.hypot(*piece.minor)
    return abs(one - other) <= 1e-9 * one and abs(np.dot(piece.major, piece.minor)) <= 1e-9 * one * other


def _contours(traced: list[Traced], field: str) -> list[Polyline]:
    """Give the inner contours: every entity of CUT_INNER has to be a closed one."""
    strokes = laid_flat(traced, None, field, JOIN)[0] if traced else []
    found = list[Polyline]()
    for stroke in strokes:
        pieces, closed = _chained([stroke], field)
        if not closed:
            _refuse("HOLE", field, f"{stroke.name} on {_INNER} is open", "closed contours", "Close it in CAD.")
        points = round_um(np.array([_start(piece) for piece in _halved(pieces)]))
        bulges = np.array([_bulge(piece, field) for piece in _halved(pieces)])
        found.append(Polyline(_INNER, points, True, bulges if bulges.any() else None))
    return found


def _halved(pieces: Sequence[Piece]) -> list[Piece]:
    """Cut a full circle in two: a bulge holds less than that."""
    if len(pieces) > 1 or not isinstance(pieces[0], Ellipse):
        return list(pieces)
    arc = pieces[0]
    middle = (arc.start + arc.end) / 2
    return [
        Ellipse(arc.centre, arc.major, arc.minor, arc.start, middle),
        Ellipse(arc.centre, arc.major, arc.minor, middle, arc.end),
    ]


def _bulge(piece: Piece, field: str) -> float:
    return 0.0 if isinstance(piece, Line) else math.tan(_bulge_angle(_circular(piece, field)) / 4)


def _drilled(traced: Traced, field: str) -> Circle:
    (piece,) = laid_flat([traced], None, field, JOIN)[0][0].pieces[:1]
    if not isinstance(piece, Ellipse) or abs(_bulge_angle(_circular(piece, field))) < 2 * math.pi - 1e-9:
        _refuse("HOLE", field, f"{traced.name} on {_DRILLED} is no circle", "circles", "Move it to CUT_INNER.")
    x, y = round_um(np.array(piece.centre)).tolist()
    return Circle(_DRILLED, (x, y), math.hypot(*piece.major))


def _refuse_stray(holes: Sequence[Hole], outline: Floats, field: str) -> None:
    part = shapely.Polygon(outline)
    for hole in holes:
        drawn = shapely.Point(hole.centre) if isinstance(hole, Circle) else shapely.Polygon(chords(hole))
        shape = drawn.buffer(hole.radius) if isinstance(hole, Circle) else drawn
        if part.is_valid and not part.contains(shape):
            x, y = shape.representative_point().coords[0]
            found = f"the hole at {x:.3f}, {y:.3f} mm on {hole.layer} reaches out of the outline"
            _refuse("HOLE", field, found, "holes inside the outline", "Correct the drawing.")


def _refuse(what: str, field: str, found: str, limit: str, way_out: str) -> NoReturn:
    raise Refused(f"E-PART-{what}", field, found, limit, way_out)
