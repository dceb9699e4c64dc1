"""The tables that name a curve drawn in CAD."""

from typing import Literal, Self

from pydantic import model_validator

from isomould.settings import Settings
from isomould.units import LengthUnit, PositiveLength


class DxfSettings(Settings):
    """The one curve on a layer of a DXF file.

    "flat": the drawing's x, y are the curve's own; "world": the drawing is the building, in space.
    """

    kind: Literal["dxf"]
    file: str
    layer: str
    units: LengthUnit | None = None
    join: PositiveLength | None = None
    drawn: Literal["flat", "world"] = "flat"


class RhinoSettings(Settings):
    """The one curve on a layer, or of a name, in a Rhino model (.3dm); `drawn` as for DXF files."""

    kind: Literal["rhino"]
    file: str
    layer: str | None = None
    name: str | None = None
    units: LengthUnit | None = None
    join: PositiveLength | None = None
    drawn: Literal["flat", "world"] = "flat"

    @model_validator(mode="after")
    def _named(self) -> Self:
        if self.layer is None and self.name is None:
            message = "a rhino curve needs layer or name: which curve of the model it is"
            raise ValueError(message)
        return self


DrawnSettings = DxfSettings | RhinoSettings
