"""The `curve = {kind = …}` tables of the project file, and the curves they stand for."""

from pathlib import Path
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from isomould.arrays import Floats
from isomould.curves import shapes
from isomould.curves.bspline import (
    Nurbs,
    Segment,
    SplineEnds,
    clamped_knots,
    interpolated,
    periodic,
    piece_of,
    segments,
)
from isomould.curves.curve import PlanarCurve, join_pieces
from isomould.curves.drawn import DxfSettings, RhinoSettings, read_drawn
from isomould.curves.plane import Plane
from isomould.curves.points import Points, refuse_spatial
from isomould.curves.shapes import Draft
from isomould.errors import Note, Refused
from isomould.settings import Settings
from isomould.units import (
    MM_PER_UNIT,
    Count,
    Flag,
    Length,
    LengthUnit,
    Number,
    PositiveLength,
    PositiveNumber,
)

Coordinates = tuple[Number, Number]
"""A point in the units of its table."""

_LENGTHS = ("radius", "span", "chord", "rise", "semi_axes")


class _WithCoordinates(Settings):
    """Shared by the tables that hold coordinates."""

    units: LengthUnit | None = None
    """Of the coordinates; mm when left out. Lengths carry their own unit."""

    @model_validator(mode="before")
    @classmethod
    def _refuse_bare_lengths(cls, data: object) -> object:
        """Refuse a bare number (mm) beside coordinates in another unit: it was surely meant in that unit."""
        if isinstance(data, dict) and data.get("units") not in (None, "mm"):
            bare = [name for name in _LENGTHS if _is_bare(data.get(name))]
            if bare:
                message = f"{bare[0]} is a bare number beside units = {data['units']!r}; a text with its unit"
                raise ValueError(message)
        return data


class ArcSettings(_WithCoordinates):
    """A circular arc by radius, start_deg, end_deg (and centre), or an arch by span (or chord) and rise."""

    kind: Literal["arc"]
    radius: PositiveLength | None = None
    start_deg: Number | None = None
    end_deg: Number | None = None
    centre: Coordinates = (0.0, 0.0)
    span: PositiveLength | None = None
    chord: PositiveLength | None = None
    rise: Length | None = None

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        given = self.model_fields_set - {"kind", "centre", "units"}
        if given not in ({"radius", "start_deg", "end_deg"}, {"span", "rise"}, {"chord", "rise"}):
            message = "an arc takes radius, start_deg and end_deg, or span (chord) and rise"
            raise ValueError(message)
        return self


class CircleSettings(_WithCoordinates):
    """A circle, drawn from its easternmost point, counter-clockwise."""

    kind: Literal["circle"]
    radius: PositiveLength
    centre: Coordinates = (0.0, 0.0)


class EllipseSettings(_WithCoordinates):
    """An ellipse or, with start_deg and end_deg, an arc of one.

    The angles are the ellipse's parameter, as in CAD: they count on the circle that the ellipse is a
    stretched image of.
    """

    kind: Literal["ellipse"]
    semi_axes: tuple[PositiveLength, PositiveLength]
    centre: Coordinates = (0.0, 0.0)
    rotation_deg: Number = 0.0
    start_deg: Number | None = None
    end_deg: Number | None = None

    @model_validator(mode="after")
    def _both_or_none(self) -> Self:
        if (self.start_deg is None) != (self.end_deg is None):
            message = "an arc of an ellipse takes both start_deg and end_deg"
            raise ValueError(message)
        return self


class ParabolaSettings(Settings):
    """An arch from (−span/2, 0) to (span/2, 0) with its apex at (0, rise)."""

    kind: Literal["parabola"]
    span: PositiveLength
    rise: Length


class CatenarySettings(Settings):
    """An arch from (−span/2, 0) to (span/2, 0) with its apex at (0, rise)."""

    kind: Literal["catenary"]
    span: PositiveLength
    rise: Length


class SineSettings(Settings):
    """y = amplitude·sin(2πx/wavelength + phase), from x = 0 over a number of waves."""

    kind: Literal["sine"]
    amplitude: PositiveLength
    wavelength: PositiveLength
    waves: Annotated[PositiveNumber, Field(le=1000)]
    phase_deg: Number = 0.0


class BsplineSettings(_WithCoordinates):
    """A B-spline or, with weights, a NURBS curve; closed means periodic with uniform knots."""

    kind: Literal["bspline"]
    degree: Count = 3
    points: Points
    weights: tuple[Number, ...] | None = None
    knots: tuple[Number, ...] | None = None
    closed: Flag = False

    @model_validator(mode="after")
    def _uniform_when_closed(self) -> Self:
        if self.closed and self.knots is not None:
            message = "a closed bspline is uniform and takes no knots"
            raise ValueError(message)
        return self


class SplineSettings(_WithCoordinates):
    """A C2 cubic through points, parametrised by chord length, as CAD programs draw it.

    Open ends have no curvature ("natural") or share one cubic over two spans ("not-a-knot").
    """

    kind: Literal["spline"]
    points: Points
    closed: Flag = False
    ends: SplineEnds = "natural"


class PolylineSettings(_WithCoordinates):
    """Straight edges and, where a bulge (tan of a quarter of the angle, left positive) is not 0, arcs."""

    kind: Literal["polyline"]
    points: Points
    bulges: tuple[Number, ...] | None = None
    closed: Flag = False


CurveSettings = Annotated[
    ArcSettings
    | CircleSettings
    | EllipseSettings
    | ParabolaSettings
    | CatenarySettings
    | SineSettings
    | BsplineSettings
    | SplineSettings
    | PolylineSettings
    | DxfSettings
    | RhinoSettings,
    Field(discriminator="kind"),
]


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
    refuse_spatial(getattr(settings, "points", ()), field)
    draft = _draft(settings, base_dir, plane, field)
    curve, notes = join_pieces(draft.pieces, draft.closed, field)
    return curve, (*draft.notes, *notes)


def _draft(settings: CurveSettings, base_dir: Path, plane: Plane | None, field: str) -> Draft:
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
    centre = np.array(settings.centre) * _scale(settings)
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
    return np.array(settings.points, float) * _scale(settings)


def _scale(settings: _WithCoordinates) -> float:
    return MM_PER_UNIT[settings.units or "mm"]


def _is_bare(value: object) -> bool:
    values = value if isinstance(value, list | tuple) else [value]
    return any(isinstance(item, int | float) for item in values)


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
