"""The `curve = {kind = …}` tables of the project file. They import no numerics, so that a file is read at once."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from isomould.curves.drawn_settings import DxfSettings, RhinoSettings
from isomould.curves.points import Points
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

SplineEnds = Literal["natural", "not-a-knot"]

_LENGTHS = ("radius", "span", "chord", "rise", "semi_axes")


class _WithCoordinates(Settings):
    """Shared by the tables that hold coordinates."""

    units: LengthUnit | None = None
    """Of the coordinates; mm when left out. Lengths carry their own unit."""

    @property
    def scale(self) -> float:
        """Millimetres per unit of the coordinates."""
        return MM_PER_UNIT[self.units or "mm"]

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


def _is_bare(value: object) -> bool:
    values = value if isinstance(value, list | tuple) else [value]
    return any(isinstance(item, int | float) for item in values)


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
