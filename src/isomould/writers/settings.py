"""The `[deliver]` table: what is written, and under which layer names."""

from typing import Annotated, Literal

from pydantic import Field

from isomould.parts.strips import Along
from isomould.settings import Settings

LayerName = Annotated[str, Field(pattern=r"^[A-Za-z0-9_$-]{1,31}$")]
Layer = Literal["CUT", "CUT_INNER", "DRILL", "ENGRAVE", "SCORE", "SHEET", "INFO"]


class DeliverSettings(Settings):
    """The `[deliver]` table."""

    layers: dict[Layer, LayerName] = Field(default_factory=dict[Layer, str])
    """Other names for the layers of the machine DXF."""
    strips: tuple[Along, ...] = ()
    """Strips to unroll: between neighbouring generatrices, between neighbouring parallels."""
