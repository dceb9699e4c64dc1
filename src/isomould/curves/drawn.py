"""Curves drawn in CAD: the tables that name them, and the way from what is drawn to one curve."""

from pathlib import Path
from typing import Literal, Self

from pydantic import model_validator

from isomould.curves.chains import chained
from isomould.curves.dxf import Drawing, trace_layer
from isomould.curves.plane import Plane
from isomould.curves.rhino import Model, trace_model
from isomould.curves.shapes import Draft
from isomould.curves.spatial import Traced, laid_flat
from isomould.errors import Note, Refused
from isomould.settings import Settings
from isomould.units import LengthUnit


class DxfSettings(Settings):
    """The one curve on a layer of a DXF file.

    "flat": the drawing's x, y are the curve's own; "world": the drawing is the building, in space.
    """

    kind: Literal["dxf"]
    file: str
    layer: str
    units: LengthUnit | None = None
    drawn: Literal["flat", "world"] = "flat"


class RhinoSettings(Settings):
    """The one curve on a layer, or of a name, in a Rhino model (.3dm); `drawn` as for DXF files."""

    kind: Literal["rhino"]
    file: str
    layer: str | None = None
    name: str | None = None
    units: LengthUnit | None = None
    drawn: Literal["flat", "world"] = "flat"

    @model_validator(mode="after")
    def _named(self) -> Self:
        if self.layer is None and self.name is None:
            message = "a rhino curve needs layer or name: which curve of the model it is"
            raise ValueError(message)
        return self


DrawnSettings = DxfSettings | RhinoSettings


def read_drawn(settings: DrawnSettings, base_dir: Path, plane: Plane | None, field: str) -> Draft:
    """Read the one planar curve that a table names.

    Raises
    ------
    Refused
        As `trace_layer` and `trace_model`; E-DRAWN-PLANE without a plane to project on or for what leaves it,
        E-DRAWN-CURVES for more than one curve.
    OutputFault
        If the system does not let the file be read.
    """
    if settings.drawn == "world" and plane is None:
        raise Refused(
            code="E-DRAWN-PLANE",
            field=f"{field}.drawn",
            found='"world" for a curve without a plane',
            limit="a plane to project on",
            way_out='Give the plane, or draw the curve flat and set drawn = "flat".',
        )
    traced, remarks = trace_drawn(settings, base_dir, field)
    strokes, repeated = laid_flat(traced, plane if settings.drawn == "world" else None, field)
    pieces, closed = chained(strokes, field)
    return Draft(pieces, closed, (*remarks, *repeated))


def trace_drawn(settings: DrawnSettings, base_dir: Path, field: str) -> tuple[list[Traced], tuple[Note, ...]]:
    """Give what a table names as shapes in space, mm, object by object."""
    path = base_dir / settings.file
    if isinstance(settings, DxfSettings):
        return trace_layer(Drawing(path, settings.layer, settings.units), field)
    return trace_model(Model(path, settings.layer, settings.name, settings.units), field), ()
