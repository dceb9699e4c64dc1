"""The `[rail]`, `[generatrix]` and `[surface]` tables of the project file, curves apart."""

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from isomould.settings import Settings
from isomould.units import Count, Flag, Length, NonNegativeLength, Number, PositiveLength, PositiveNumber, Tolerance

Kind = Literal["isogonal", "moulding", "monge", "edge-offset"]
Ends = Literal["square", "mitred"]
"""Of a rail: square to its end edges, or to the mirror line there."""

Inflections = Literal["nearest", "residual", "fit", "refuse"]


def _at_least_one(value: int) -> int:
    if value < 1:
        message = "must be at least 1"
        raise ValueError(message)
    return value


PositiveCount = Annotated[Count, AfterValidator(_at_least_one)]


def _acute(value: float) -> float:
    if abs(value) >= 90:
        message = "must lie between -90° and 90°"
        raise ValueError(message)
    return value


WAYS = ("nodes", "angle_deg", "angles", "per_arc", "stations", "phase")
"""Keys of `divide` that exclude each other."""


class SlopePhase(Settings):
    """Phase of an edge offset mesh by the normal latitude of one edge."""

    slope_deg: Annotated[Number, AfterValidator(_acute)]


class AngleRange(Settings):
    """A turning angle, and how far along the oriented curve it goes; the last range goes to the end."""

    until: PositiveLength | None = None
    angle_deg: PositiveNumber


def _ordered(ranges: tuple[AngleRange, ...]) -> tuple[AngleRange, ...]:
    """Refuse ranges that do not follow each other up to the end of the curve."""
    ends = [part.until for part in ranges]
    borders = [end for end in ends[:-1] if end is not None]
    if not ends or ends[-1] is not None or len(borders) < len(ends) - 1 or borders != sorted(set(borders)):
        message = "every range but the last needs an until, each greater than the one before; the last has none"
        raise ValueError(message)
    return ranges


AngleRanges = Annotated[tuple[AngleRange, ...], AfterValidator(_ordered)]


class RailDivide(Settings):
    """How the rail is divided: exactly one way; none for a drawn polyline."""

    nodes: PositiveCount | None = None
    angle_deg: PositiveNumber | None = None
    angles: AngleRanges | None = None
    stations: PositiveCount | tuple[Length, ...] | None = None
    first_deg: Number | None = None
    keep_ends: Flag = False

    @model_validator(mode="after")
    def _one_way(self) -> "RailDivide":
        _refuse_two_ways(self, ("nodes", "angle_deg", "angles", "stations"))
        return self


class GeneratrixDivide(Settings):
    """How the generatrix is divided: exactly one way; `phase` belongs to the kind edge-offset."""

    nodes: PositiveCount | None = None
    angle_deg: PositiveNumber | None = None
    angles: AngleRanges | None = None
    per_arc: PositiveCount | None = None
    stations: PositiveCount | tuple[Length, ...] | None = None
    phase: Literal["centre", "node", "fit"] | SlopePhase | None = None
    first_deg: Number | None = None
    keep_ends: Flag = False

    @model_validator(mode="after")
    def _one_way(self) -> "GeneratrixDivide":
        _refuse_two_ways(self, ("nodes", "angle_deg", "angles", "per_arc", "stations", "phase"))
        return self


def _refuse_two_ways(table: Settings, names: tuple[str, ...]) -> None:
    given = [name for name in names if getattr(table, name) is not None]
    if len(given) > 1:
        message = f"{' and '.join(given)} exclude each other; one of them alone"
        raise ValueError(message)


class Treatment(Settings):
    """What the division does at inflections, straight parts and short ends."""

    inflections: Inflections = "nearest"
    flat_nodes: Flag = False
    max_edge: PositiveLength | None = None


class TrimPlane(Settings):
    """A plane in the world: level at `z`, or through `origin` with a `normal` of any length."""

    z: Length | None = None
    origin: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    normal: tuple[Number, Number, Number] | None = None

    @model_validator(mode="after")
    def _one_way(self) -> "TrimPlane":
        _refuse_two_ways(self, ("z", "normal"))
        if self.z is None and (self.normal is None or not any(self.normal)):
            message = "a plane is {z = …} or {origin = […], normal = […]} with a normal that is not zero"
            raise ValueError(message)
        return self


class TrimSettings(Settings):
    """A plane that trims the surface, and which side is kept: above, below, or the one in a direction."""

    plane: TrimPlane
    keep: Literal["above", "below"] | tuple[Number, Number, Number]


class SurfaceSettings(Settings):
    """The `[surface]` table."""

    kind: Kind = "isogonal"
    min_pole_angle_deg: Annotated[PositiveNumber, Field(lt=90)] = 5.0
    pole: Literal["refuse", "open", "cap"] = "refuse"
    trim: tuple[TrimSettings, ...] = ()
    sill: Flag = False
    """Members along the edges that the planes cut."""

    def conflicts(self) -> Iterator[str]:
        """Say which options go with nothing that is there."""
        if self.pole == "cap" and self.kind != "edge-offset":
            yield f"pole = 'cap' closes what edge offset meshes leave open; kind = '{self.kind}' leaves nothing open"
        if self.sill and not self.trim:
            yield "sill = true needs planes to trim by: trim = [{plane = {z = 0}, keep = 'above'}]"


class FormLimits(Settings):
    """Limits that the form stages hold: part of the `[tolerances]` and `[limits]` tables."""

    min_member: PositiveLength = 100.0
    same_length: Tolerance = 0.5
    """Edges whose lengths differ by no more are equal, as parts are (`tolerances.length`)."""
    max_deviation: NonNegativeLength | None = None
    max_turning_deg: PositiveNumber = Field(default=60.0)
    max_panels: PositiveCount = 200_000
