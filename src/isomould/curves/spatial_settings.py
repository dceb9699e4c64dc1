"""The curves in space that a `curve = {kind = …}` table of the rail may stand for."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from isomould.arrays import Floats
from isomould.curves.chains import Stroke
from isomould.curves.construction import bspline_segments, points_of, spline_segments
from isomould.curves.drawn_settings import DrawnSettings, DxfSettings, RhinoSettings
from isomould.curves.joining import join_tolerance
from isomould.curves.origins import origin_of, seen_from
from isomould.curves.pieces import Line
from isomould.curves.points import are_spatial
from isomould.curves.settings import (
    BsplineSettings,
    CurveSettings,
    PolylineSettings,
    SplineSettings,
)
from isomould.curves.shapes import distinct
from isomould.curves.space_curve import SpatialCurve, SpatialPiece, join_in_space, piece_in_space
from isomould.curves.spatial import Shape, Traced, refuse_wild, shapes_of
from isomould.errors import Note, Refused


@dataclass(frozen=True, eq=False)
class LocalSpatialCurve:
    """A curve in space and the origin (3,) mm that its coordinates are measured from."""

    curve: SpatialCurve
    origin: Floats
    notes: tuple[Note, ...]


def build_spatial_curve(settings: CurveSettings, base_dir: Path, field: str) -> LocalSpatialCurve:
    """Build the curve in space of a `curve` table: polyline, spline, bspline, or drawn in the world.

    Raises
    ------
    Refused
        If the table describes a curve in a plane, or its numbers give no curve.
    OutputFault
        If a file cannot be read.
    """
    if isinstance(settings, DxfSettings | RhinoSettings):
        return _drawn(settings, base_dir, field)
    shapes, closed, notes = _shapes(settings, field)
    traced = [Traced(settings.kind, shapes, closed)]
    refuse_wild(traced, field)
    origin = origin_of(traced)
    local = [shape for one in seen_from(traced, origin) for shape in one.shapes]
    curve, more = join_in_space(tuple(piece_in_space(shape) for shape in local), closed, field)
    return LocalSpatialCurve(curve, origin, (*notes, *more))


def _shapes(settings: CurveSettings, field: str) -> tuple[list[Shape], bool, tuple[Note, ...]]:
    if not are_spatial(getattr(settings, "points", ())):
        _refuse_planar(f"{field}.kind", f"a {settings.kind} in a plane")
    match settings:
        case BsplineSettings():
            return shapes_of(bspline_segments(settings, field)), settings.closed, ()
        case SplineSettings():
            parts, notes = spline_segments(settings, field)
            return shapes_of(parts), settings.closed, notes
        case PolylineSettings():
            _refuse_bulges(settings, field)
            points, notes = distinct(points_of(settings, field), settings.closed, f"{field}.points")
            return _lines(points, settings.closed), settings.closed, notes
        case _:
            return [], False, ()


def _lines(points: Floats, closed: bool) -> list[Shape]:
    path = np.vstack([points, points[:1]]) if closed else points
    return [Shape(Line, path[k : k + 2]) for k in range(len(path) - 1)]


def _drawn(settings: DrawnSettings, base_dir: Path, field: str) -> LocalSpatialCurve:
    if settings.drawn != "world":
        _refuse_planar(f"{field}.drawn", f"a curve drawn {settings.drawn}")

    from isomould.curves.drawn import the_one_chain, trace_drawn  # whose readers take half a second to import

    drawing = trace_drawn(settings, base_dir, field)
    refuse_wild(drawing.traced, field)
    origin = origin_of(drawing.traced)
    traced = seen_from(drawing.traced, origin)
    strokes = [Stroke(one.name, _pieces(one)) for one in traced]
    join = join_tolerance(settings.join, drawing.printed)
    chain, moved = the_one_chain([stroke for stroke in strokes if stroke.pieces], join, field)
    curve, notes = join_in_space(chain.pieces, chain.closed, field)
    return LocalSpatialCurve(curve, origin, (*drawing.notes, *moved, *notes))


def _pieces(one: Traced) -> tuple[SpatialPiece, ...]:
    """Give the pieces of an entity; lines of length zero are no pieces."""
    return tuple(piece_in_space(shape) for shape in one.shapes if np.ptp(shape.anchors, axis=0).any())


def _refuse_planar(field: str, found: str) -> None:
    raise Refused(
        code="E-CURVE-PLANAR",
        field=field,
        found=found,
        limit='a polyline, spline or bspline with points [x, y, z], or a dxf or rhino curve drawn = "world"',
        way_out="Give it in space, or leave out rail.up and use surface.kind = 'moulding' with a plane.",
    )


def _refuse_bulges(settings: PolylineSettings, field: str) -> None:
    if settings.bulges is not None:
        raise Refused(
            code="E-CURVE-BULGE",
            field=f"{field}.bulges",
            found="bulges in space",
            limit="straight edges",
            way_out="Leave the bulges out, or draw the arcs in CAD and read them from its file.",
        )
