"""The `[members]`, `[nodes]`, `[panels]` and `[tolerances]` tables of the project file."""

from typing import Annotated, Literal

from pydantic import Field

from isomould.settings import Settings
from isomould.units import (
    Flag,
    NonNegativeLength,
    NonNegativeNumber,
    PositiveLength,
    PositiveNumber,
)


class PlateSection(Settings):
    """A plate on edge: `depth` in the plane of the member, `thickness` across it."""

    kind: Literal["plate"] = "plate"
    depth: PositiveLength
    thickness: PositiveLength

    @property
    def name(self) -> str:
        """Designation in schedules, as shops write flat bars.

        >>> PlateSection(depth=200, thickness=12).name
        'FL200*12'
        """
        return f"FL{self.depth:g}*{self.thickness:g}"


class MemberSettings(Settings):
    """The `[members]` table."""

    section: PlateSection = Field(default_factory=lambda: PlateSection(depth=200.0, thickness=12.0))
    grade: Annotated[str, Field(min_length=1, max_length=24)] = "S355"
    density: PositiveNumber = 7850.0
    """kg/m³"""
    min_clear: PositiveLength = 50.0
    """Smallest length of a member's top and bottom edges between its end cuts."""
    max_end_angle_deg: PositiveNumber = 60.0
    """Largest end cut that the saw can make, measured from square."""


class BasePlateSettings(Settings):
    """Plates under the supports of a trimmed surface, and the stems that carry the drums on them."""

    thickness: PositiveLength = 15.0
    stem_thickness: PositiveLength = 15.0
    margin: PositiveLength = 60.0
    """Of the plate beyond the drum's shadow on it."""
    holes: Literal[4, 6, 8] = 4
    hole_diameter: PositiveLength = 18.0
    edge_distance: PositiveLength = 30.0
    clearance: PositiveLength = 10.0
    """Between the plate's top and what stands over it."""


class NodeSettings(Settings):
    """The `[nodes]` table: a slotted drum (fabrication, Node solids)."""

    detail: Literal["slotted"] = "slotted"
    retention: Literal["weld"] = "weld"
    slot_end: Literal["square", "round"] = "square"
    clearance: NonNegativeLength = 0.5
    """Width of a slot beyond the plate's thickness."""
    end_gap: NonNegativeLength = 2.0
    """Between the plate's end and the slot floor, and between its shoulder and the drum."""
    slot_depth: PositiveLength | None = None
    drum_diameter: PositiveLength | None = None
    bore: NonNegativeLength = 20.0
    min_web: PositiveLength = 6.0
    min_core: PositiveLength = 8.0
    diameter_step: PositiveLength = 5.0
    bar_allowance: NonNegativeLength = 2.0
    """Turned off the bar's diameter."""
    facing_allowance: NonNegativeLength = 4.0
    """Turned off the blank's length."""
    density: PositiveNumber = 7850.0
    """kg/m³"""
    base_plate: BasePlateSettings | None = None


Coating = Literal["none", "inside", "outside"]
"""Which side of a panel is coated."""


class EdgeDeduction(Settings):
    """How much further inside a panel ends than gap or overhang ask, by what is under the side."""

    generatrix: NonNegativeLength = 0.0
    parallel: NonNegativeLength = 0.0
    boundary: NonNegativeLength = 0.0
    cut: NonNegativeLength = 0.0
    """Sides that a trimming plane made."""


class PanelSettings(Settings):
    """The `[panels]` table (fabrication, Panels)."""

    thickness: PositiveLength = 12.0
    density: PositiveNumber = 2500.0
    """kg/m³"""
    makeup: Annotated[str, Field(max_length=120)] = "glass"
    gap: PositiveLength = 15.0
    """Clear distance of neighbouring panels at the narrowest level."""
    spacer: NonNegativeLength = 2.0
    seat_width: PositiveLength = 60.0
    seat_height: NonNegativeLength = 10.0
    min_bearing: PositiveLength = 12.0
    edge_overhang: NonNegativeLength = 0.0
    """Beyond the trace of the member's centre plane, on the boundary."""
    corner_clearance: NonNegativeLength = 5.0
    """Of corners from caps that stand proud of the nodes."""
    edge_deduction: EdgeDeduction = EdgeDeduction()
    flippable: Flag = False
    coating: Coating = "none"
    orientation_mark: Flag = True
    """Engrave an arrow to side a, and which side is coated."""
    glass_round: PositiveLength = 10.0
    """Step to which each side of the bounding box is rounded up for the charged area."""
    glass_min_area: NonNegativeNumber = 0.3
    """m²"""


class CongruenceSettings(Settings):
    """When two instances are the same part: the first fields of `[tolerances]`."""

    length: PositiveLength = 0.5
    angle_deg: PositiveNumber = 0.05
