"""The `[members]`, `[nodes]`, `[panels]` and `[tolerances]` tables of the project file."""

from typing import Annotated, Literal, Self, cast

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from isomould.parts.catalogue import AnySection, PlateSection, Section
from isomould.parts.hardware import BoltSize
from isomould.settings import ONE_LINE, Settings, Text
from isomould.units import (
    Flag,
    NonNegativeLength,
    NonNegativeNumber,
    PositiveLength,
    PositiveNumber,
    Tolerance,
)

Along = Literal["generatrix", "parallel"]
"""Between which lines a strip of panels runs."""


class MemberSettings(Settings):
    """The `[members]` table; families without a section of their own have the first one."""

    section: Section = Field(default_factory=lambda: PlateSection(depth=200.0, thickness=12.0))
    generatrix: Section | None = None
    parallel: Section | None = None
    sill: Section | None = None
    grade: Annotated[str, Field(min_length=1, max_length=24), ONE_LINE] = "S355"
    density: PositiveNumber = 7850.0
    """kg/m³"""
    min_clear: PositiveLength = 50.0
    """Smallest length of a member's top and bottom edges between its end cuts."""
    max_end_angle_deg: PositiveNumber = 60.0
    """Largest end cut that the saw can make, measured from square."""

    def of(self, family: int) -> AnySection:
        """Give the section of a `Family`."""
        return (self.generatrix, self.parallel, self.sill)[family] or self.section

    @model_validator(mode="after")
    def _one_depth(self) -> Self:
        depths = {section.depth for section in (self.section, self.generatrix, self.parallel) if section}
        if len(depths) > 1:
            listed = " and ".join(f"{depth:g}" for depth in sorted(depths))
            message = f"depths of {listed} mm: all members but sills have one depth, for the panels lie on them"
            raise ValueError(message)
        return self


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


class HardwareSettings(Settings):
    """The `[nodes.hardware]` table: the centre bolt of caps, or the bolts that hold members."""

    bolt: BoltSize = "M12"
    grade: Annotated[str, Field(min_length=1, max_length=12), ONE_LINE] = "8.8"


class CapSettings(Settings):
    """The `[nodes.cap]` table: discs on both ends of a drum, whose lips hold the plates by notches."""

    thickness: PositiveLength = 8.0
    lip_width: PositiveLength = 5.0
    lip_height: PositiveLength = 6.0
    rim: PositiveLength = 5.0
    """From the lip to the edge of the cap, which is as wide as the drum."""
    clearance: NonNegativeLength = 0.5
    """Around the lip, in the groove of the drum and in the notches."""
    min_hook: PositiveLength = 8.0
    """Smallest length of a tongue behind its notch."""


class DrumSettings(Settings):
    """What the `[nodes]` table says of every drum."""

    hardware: HardwareSettings = Field(default_factory=HardwareSettings)
    drum_diameter: PositiveLength | None = None
    bore: NonNegativeLength = 20.0
    end_gap: NonNegativeLength = 2.0
    """Between the plate's end and the slot floor, between shoulders and drum, and between sills and nodes."""
    min_web: PositiveLength = 6.0
    """Smallest web between neighbouring slots or holes."""
    min_core: PositiveLength = 8.0
    """Between slots or holes and the bore."""
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


def _known_detail(value: object) -> object:
    """Word what no kind of table takes."""
    if value != "slotted":
        message = f"{value!r} is no node detail; one of 'slotted', 'faceted', 'finned'"
        raise ValueError(message)
    return value


class SlottedSettings(DrumSettings):
    """The `[nodes]` table of slotted drums, for plates (fabrication, Node solids)."""

    detail: Annotated[Literal["slotted"], BeforeValidator(_known_detail)] = "slotted"
    retention: Literal["weld", "lipped-cap"] = "weld"
    cap: CapSettings = Field(default_factory=CapSettings)
    slot_end: Literal["square", "round"] = "square"
    clearance: NonNegativeLength = 0.5
    """Width of a slot beyond the plate's thickness."""
    slot_depth: PositiveLength | None = None


class FacetedSettings(DrumSettings):
    """The `[nodes]` table of faceted drums, for hollow sections (fabrication, Node solids)."""

    detail: Literal["faceted"] = "faceted"
    facet_border: PositiveLength = 3.0
    """Of a facet beside the member."""
    facet_cover: NonNegativeLength = 3.0
    """Of the drum above and below the members."""
    facet_distance: PositiveLength | None = None
    """From the work point to every facet."""
    end_plate: PositiveLength = 12.0
    """Thickness of the plates in the members' ends."""
    bolt_spacing: PositiveLength | None = None
    """Of the two bolts of deep members; half the depth without it."""
    engagement: PositiveNumber = 1.25
    """Least length of thread in the drum, in bolt diameters."""


class FinnedSettings(DrumSettings):
    """The `[nodes]` table of hubs with forks of two fins, for plates (fabrication, Node solids)."""

    detail: Literal["finned"] = "finned"
    clearance: NonNegativeLength = 1.0
    """Width of a fork beyond the plate's thickness."""
    fin_thickness: PositiveLength = 8.0
    fin_height: PositiveLength | None = None
    """Across the members; the largest that fits without it."""
    fin_cover: PositiveLength = 5.0
    """Of the hub above and below the fins."""
    weld_access: NonNegativeLength = 12.0
    """From a fin's foot to the plane halfway to the next fork."""
    bolt_rows: Annotated[int, Field(ge=1, le=4)] = 2
    """Across the depth of a member's end."""
    bolt_columns: Annotated[int, Field(ge=1, le=4)] = 1
    """Along the member."""
    bolt_spacing: PositiveLength | None = None
    """Of the rows; the depth by the number of rows without it."""
    bolt_pitch: PositiveLength | None = None
    """Of the columns; the smallest without it."""
    bolt_distance: PositiveLength | None = None
    """From the work point to the first column."""


def _detail(value: object) -> str:
    """Tell which detail a `[nodes]` table asks for."""
    asked = (
        cast("dict[str, object]", value).get("detail") if isinstance(value, dict) else getattr(value, "detail", None)
    )
    return asked if isinstance(asked, str) and asked in {"faceted", "finned"} else "slotted"


NodeSettings = Annotated[
    Annotated[SlottedSettings, Tag("slotted")]
    | Annotated[FacetedSettings, Tag("faceted")]
    | Annotated[FinnedSettings, Tag("finned")],
    Discriminator(_detail),
]
"""The `[nodes]` table."""


class PanelSettings(Settings):
    """The `[panels]` table (fabrication, Panels)."""

    thickness: PositiveLength = 12.0
    density: PositiveNumber = 2500.0
    """kg/m³"""
    makeup: Text = "glass"
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
    edge_deduction: EdgeDeduction = Field(default_factory=EdgeDeduction)
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

    length: Tolerance = 0.5
    angle_deg: PositiveNumber = 0.05


class PanelLimits(Settings):
    """What panels may not exceed: part of the `[limits]` table. None leaves trade to be compared with, in notes."""

    max_panel: tuple[PositiveLength, PositiveLength] | None = None
    """Sides of the smallest rectangle around a panel, either way round."""
    max_panel_mass: PositiveNumber | None = None
    """kg"""
    max_aspect: Annotated[PositiveNumber, Field(ge=1)] | None = None
    """Longer side by shorter side of that rectangle."""
    min_corner_deg: Annotated[PositiveNumber, Field(lt=180)] | None = None
