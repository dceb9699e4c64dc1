"""The curves that the `curve = {kind = …}` tables of the project file stand for."""

from pathlib import Path

import numpy as np

from isomould.arrays import Floats
from isomould.curves import shapes
from isomould.curves.bspline import (
    Nurbs,
    Segment,
    clamped_knots,
    interpolated,
    periodic,
    piece_of,
    segments,
)
from isomould.curves.curve import PlanarCurve, join_pieces
from isomould.curves.drawn_settings import DxfSettings, RhinoSettings
from isomould.curves.plane import Plane
from isomould.curves.points import refuse_spatial
from isomould.curves.settings import (
    ArcSettings,
    BsplineSettings,
    CatenarySettings,
    CircleSettings,
    CurveSettings,
    EllipseSettings,
    ParabolaSettings,
    PolylineSettings,
    SineSettings,
    SplineSettings,
)
from isomould.curves.shapes import Draft
from isomould.errors import Note, Refused


def build_curve(
    settings: CurveSettings, base_dir: Path, plane: Plane | None = None, field: str = "curve"
) -> tuple[PlanarCurve, tuple[Note, ...]]:
    """Build the curve of a `curve` table.

    Parameters
    ----------
    base_dir
        Folder that the names of drawings are relative to.
    plane
        The rail's plane, needed for curves drawn in world coordinates only.
    field
        Name of the table in the project file, such as "rail.curve".

    Raises
    ------
    Refused
        If the numbers give no curve; `field` and the key name the place.
    OutputFault
        If a file cannot be read.
    """
    draft = draft_curve(settings, base_dir, plane, field)
    curve, notes = join_pieces(draft.pieces, draft.closed, field)
    placed = curve.mapped(np.eye(2), np.array(draft.origin)) if any(draft.origin) else curve
    return placed, (*draft.notes, *notes)


def draft_curve(settings: CurveSettings, base_dir: Path, plane: Plane | None, field: str) -> Draft:
    """Give the pieces that a `curve` table stands for, measured from an origin near them; `build_curve` joins them."""
    refuse_spatial(getattr(settings, "points", ()), field)
    match settings:
        case ArcSettings() | CircleSettings() | EllipseSettings():
            return _round(settings, field)
        case BsplineSettings():
            return _bspline(settings, field)
        case SplineSettings():
            return _spline(settings, field)
        case PolylineSettings():
            return _polyline(settings, field)
        case DxfSettings() | RhinoSettings():
            from isomould.curves.drawn import read_drawn  # whose readers take half a second to import

            return read_drawn(settings, base_dir, plane, field)
        case _:
            return _arch(settings, field)


def _arch(settings: ParabolaSettings | CatenarySettings | SineSettings, field: str) -> Draft:
    if isinstance(settings, SineSettings):
        wave = (settings.amplitude, settings.wavelength, settings.waves, np.radians(settings.phase_deg))
        return Draft((shapes.sine(*wave),), closed=False)
    _refuse_flat(settings.rise, field)
    shape = shapes.parabola if isinstance(settings, ParabolaSettings) else shapes.catenary
    return Draft((shape(settings.span, settings.rise),), False, _hanging(settings.rise, field))


def _round(settings: ArcSettings | CircleSettings | EllipseSettings, field: str) -> Draft:
    centre = np.array(settings.centre) * settings.scale
    if isinstance(settings, EllipseSettings):
        a, b = settings.semi_axes
        turn = np.radians(settings.rotation_deg)
        range_, closed = _range(settings.start_deg, settings.end_deg, field)
        axes = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
        return Draft((shapes.ellipse(centre, a * axes[0], b * axes[1], range_),), closed)
    if settings.radius is None:
        return _chord_arc(settings, field)
    angles = (settings.start_deg, settings.end_deg) if isinstance(settings, ArcSettings) else (None, None)
    range_, closed = _range(*angles, field)
    axes = settings.radius * np.eye(2)
    return Draft((shapes.ellipse(centre, axes[0], axes[1], range_),), closed)


def _chord_arc(settings: ArcSettings, field: str) -> Draft:
    span, rise = settings.span or settings.chord or 0.0, settings.rise or 0.0
    _refuse_flat(rise, field)
    end = np.array([span / 2, 0.0])
    return Draft((shapes.bulged(-end, end, -2 * rise / span),), False, _hanging(rise, field))


def _range(start_deg: float | None, end_deg: float | None, field: str) -> tuple[tuple[float, float], bool]:
    """Give the range of φ, rad, and whether it is a whole turn."""
    if start_deg is None or end_deg is None:
        return (0.0, 2 * np.pi), True
    if not 0 < abs(end_deg - start_deg) < 360:
        raise Refused(
            code="E-CURVE-RANGE",
            field=f"{field}.end_deg",
            found=f"{end_deg - start_deg:g} degrees from start to end",
            limit="more than 0 and less than 360 degrees",
            way_out="Use a circle, or an ellipse without angles, for a whole turn.",
        )
    return (float(np.radians(start_deg)), float(np.radians(end_deg))), False


def _bspline(settings: BsplineSettings, field: str) -> Draft:
    return Draft(tuple(piece_of(segment) for segment in bspline_segments(settings, field)), settings.closed)


def bspline_segments(settings: BsplineSettings, field: str) -> list[Segment]:
    """Give the Bézier segments of a `bspline` table, in the plane or in space."""
    points = points_of(settings, field)
    weights = np.ones(len(points)) if settings.weights is None else np.array(settings.weights, float)
    if weights.size != len(points):
        _refuse_count("weights", weights.size, len(points), field)
    if settings.closed:
        _refuse_few(points, settings.degree, f"{field}.points")
        spline = periodic(points, weights, settings.degree)
    else:
        knots = settings.knots or clamped_knots(len(points), settings.degree)
        spline = Nurbs(settings.degree, points, weights, np.array(knots, float))
    return segments(spline, field)


def _spline(settings: SplineSettings, field: str) -> Draft:
    parts, notes = spline_segments(settings, field)
    return Draft(tuple(piece_of(segment) for segment in parts), settings.closed, notes)


def spline_segments(settings: SplineSettings, field: str) -> tuple[list[Segment], tuple[Note, ...]]:
    """Give the Bézier segments of a `spline` table, in the plane or in space."""
    points, notes = shapes.distinct(points_of(settings, field), settings.closed, f"{field}.points")
    _refuse_few(points, 2 if settings.closed else 1, f"{field}.points")
    path = np.vstack([points, points[:1]]) if settings.closed else points
    ends = "periodic" if settings.closed else settings.ends
    return interpolated(path, ends), notes


def _polyline(settings: PolylineSettings, field: str) -> Draft:
    points = points_of(settings, field)
    edges = len(points) - (not settings.closed)
    bulges = np.zeros(edges) if settings.bulges is None else np.array(settings.bulges, float)
    if bulges.size != edges:
        _refuse_count("bulges", bulges.size, edges, field)
    return Draft(shapes.polyline(points, bulges, settings.closed), settings.closed)


def points_of(settings: BsplineSettings | SplineSettings | PolylineSettings, field: str) -> Floats:
    """Give the points (n, 2 or 3) of a table, mm."""
    _refuse_few(np.array(settings.points), 1, f"{field}.points")
    return np.array(settings.points, float) * settings.scale


def _refuse_few(points: Floats, degree: int, field: str) -> None:
    if len(points) <= degree:
        raise Refused(
            code="E-CURVE-POINTS",
            field=field,
            found=f"{len(points)} different points",
            limit=f"at least {degree + 1}",
            way_out="Give more points.",
        )


def _refuse_count(key: str, found: int, limit: int, field: str) -> None:
    raise Refused(
        code="E-CURVE-COUNT",
        field=f"{field}.{key}",
        found=f"{found} {key}",
        limit=f"exactly {limit}",
        way_out=f"Give {limit} {key}, or leave them out.",
    )


def _hanging(rise: float, field: str) -> tuple[Note, ...]:
    """Note an arch that hangs: where a sign slipped in, everything else looks plausible."""
    text = f"{rise:g} mm: the curve hangs below the line between its ends"
    return (Note("W-CURVE-HANGS", f"{field}.rise", text),) if rise < 0 else ()


def _refuse_flat(rise: float, field: str) -> None:
    if rise == 0:
        raise Refused(
            code="E-CURVE-RISE",
            field=f"{field}.rise",
            found="0 mm",
            limit="not 0",
            way_out="Give a rise; a negative one hangs.",
        )
