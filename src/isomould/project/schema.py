"""The project file: the settings of every stage, composed (deliverables, Project file)."""

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, model_validator

from isomould.curves.plane_settings import PlaneSettings
from isomould.curves.settings import CurveSettings
from isomould.documents.cost_settings import CostSettings
from isomould.documents.info import ProjectInfo
from isomould.form.settings import (
    Ends,
    GeneratrixDivide,
    Inflections,
    PositiveCount,
    RailDivide,
    SurfaceSettings,
)
from isomould.nesting.settings import StockSettings
from isomould.parts.settings import MemberSettings, NodeSettings, PanelLimits, PanelSettings, SlottedSettings
from isomould.settings import Name, Settings
from isomould.units import Count, Flag, Length, NonNegativeLength, Number, PositiveLength, PositiveNumber, Tolerance
from isomould.writers.names import safe_name
from isomould.writers.settings import DeliverSettings


class RailTable(Settings):
    """The `[rail]` table."""

    curve: CurveSettings
    plane: PlaneSettings = "xy"
    outside: Literal["outer", "inner"] | tuple[Number, Number] | None = None
    """Of a planar rail, required."""
    up: tuple[Number, Number, Number] | None = None
    """Of a rail in space, required."""
    divide: RailDivide = Field(default_factory=RailDivide)
    ends: Ends | None = None
    """Default: mitred for edge offset meshes, square for all others."""
    inflections: Inflections = "nearest"
    flat_nodes: Flag = False
    max_edge: PositiveLength | None = None

    @model_validator(mode="after")
    def _plane_or_space(self) -> "RailTable":
        if self.up is None and self.outside is None:
            message = "outside is missing: say where the outside of the rail lies (or up, for a rail in space)"
            raise ValueError(message)
        planar = sorted(self.model_fields_set & {"plane", "outside", "ends", "inflections", "flat_nodes"})
        if self.up is not None and planar:
            message = f"{' and '.join(planar)} cannot stand beside up: they are for planar rails"
            raise ValueError(message)
        return self


class GeneratrixTable(Settings):
    """The `[generatrix]` table."""

    curve: CurveSettings
    origin: tuple[Length, Length] = (0.0, 0.0)
    axes: Literal["dz", "zd"] = "dz"
    outside: tuple[Number, Number] = (1.0, 0.0)
    divide: GeneratrixDivide = Field(default_factory=GeneratrixDivide)
    inflections: Inflections = "nearest"
    flat_nodes: Flag = False
    max_edge: PositiveLength | None = None


class ToleranceTable(Settings):
    """The `[tolerances]` table: when parts are the same, and what the mesh may not exceed."""

    length: Annotated[Tolerance, Field(le=5.0)] = 0.5
    angle_deg: Annotated[PositiveNumber, Field(le=0.5)] = 0.05
    min_member: PositiveLength = 100.0
    max_deviation: NonNegativeLength | None = None
    max_turning_deg: PositiveNumber = 60.0


class LimitTable(PanelLimits):
    """The `[limits]` table."""

    max_panels: PositiveCount = 200_000


MAIN = "main"
"""The shape that `[rail]` and `[generatrix]` describe."""


class ShapeTable(Settings):
    """An entry of `[[shapes]]`: another shape made of the same nodes.

    The keys of its `rail` and `generatrix` take the place of those in the tables of the project.
    """

    name: Name
    rail: dict[str, Any] = Field(default_factory=dict[str, Any])
    generatrix: dict[str, Any] = Field(default_factory=dict[str, Any])

    @property
    def slug(self) -> str:
        """The name of its folder."""
        return safe_name(self.name, "shapes.name")


def _distinct(shapes: tuple[ShapeTable, ...]) -> tuple[ShapeTable, ...]:
    slugs = [MAIN, *(shape.slug for shape in shapes)]
    if len(set(slugs)) < len(slugs):
        message = f"names must differ in their letters and digits, also from {MAIN!r}: {', '.join(slugs)}"
        raise ValueError(message)
    return shapes


def _known_schema(value: int) -> int:
    if value != 1:
        message = "must be 1, the schema that this version of isomould reads"
        raise ValueError(message)
    return value


class Project(Settings):
    """A whole project file."""

    schema_: Annotated[Count, AfterValidator(_known_schema)] = Field(alias="schema")
    project: ProjectInfo
    rail: RailTable
    generatrix: GeneratrixTable
    surface: SurfaceSettings = Field(default_factory=SurfaceSettings)
    members: MemberSettings = Field(default_factory=MemberSettings)
    nodes: NodeSettings = Field(default_factory=SlottedSettings)
    panels: PanelSettings = Field(default_factory=PanelSettings)
    tolerances: ToleranceTable = Field(default_factory=ToleranceTable)
    stock: StockSettings | None = None
    costs: CostSettings = Field(default_factory=CostSettings)
    deliver: DeliverSettings = Field(default_factory=DeliverSettings)
    limits: LimitTable = Field(default_factory=LimitTable)
    shapes: Annotated[tuple[ShapeTable, ...], AfterValidator(_distinct)] = ()

    def conflicts(self) -> Iterator[str]:
        """Say which tables do not go together."""
        yield from self._classes_and_gaps()
        yield from self._bases_without_supports()
        yield from self._coated_panels_turned()
        yield from self._stock_of_several_materials()
        yield from self.kind_and_division()

    def _classes_and_gaps(self) -> Iterator[str]:
        if self.tolerances.length > self.panels.gap / 2:
            yield (
                f"tolerances.length = {self.tolerances.length:g} mm is too wide; at most half of panels.gap = "
                f"{self.panels.gap:g} mm: parts of one class would close the gaps"
            )

    def _bases_without_supports(self) -> Iterator[str]:
        if self.nodes.base_plate is not None and not self.surface.trim:
            yield "nodes.base_plate goes under the supports of a trimmed surface: it needs surface.trim"

    def _coated_panels_turned(self) -> Iterator[str]:
        turned = {
            "panels.flippable": self.panels.flippable,
            "stock.turn_over": self.stock is not None and self.stock.turn_over,
        }
        coating = self.panels.coating
        for field in (field for field, asked in turned.items() if asked and coating != "none"):
            yield f"panels.coating = {coating!r} and {field}: a coated panel has only one way up"

    def _stock_of_several_materials(self) -> Iterator[str]:
        """Say where the stock leaves open what panels or members of a section are cut from: a project has one."""
        stock = self.stock or StockSettings()
        if len({sheet.made_of.key for sheet in stock.sheets}) > 1:
            yield "stock.sheets are of several materials, grades or thicknesses: the panels of a project are of one"
        grades = {(bar.section, bar.grade) for bar in stock.bars}
        if len(grades) > len({section for section, _ in grades}):
            yield "stock.bars are of several grades: the members of a section in a project are of one"

    def kind_and_division(self) -> Iterator[str]:
        """Say which divisions the kind of surface does not have."""
        kind, rail, generatrix = self.surface.kind, self.rail.divide, self.generatrix.divide
        by_angle = any(way is not None for way in (rail.nodes, rail.angle_deg, rail.angles))
        if (kind == "monge") != (self.rail.up is not None):
            yield "surface.kind = 'monge' and rail.up = [x, y, z] go together: a rail in space"
        if kind == "monge" and (by_angle or rail.first_deg is not None):
            yield "a rail in space is divided by rail.divide = {stations}, or as drawn: its tangents do not meet"
        if kind in {"isogonal", "edge-offset"} and not by_angle:
            yield f"surface.kind = '{kind}' has one turning angle: it needs rail.divide = {{nodes}} or {{angle_deg}}"
        if kind == "edge-offset" and rail.angles is not None:
            yield "surface.kind = 'edge-offset' has one turning angle: rail.divide = {angles} gives several"
        if (kind == "edge-offset") != (generatrix.phase is not None):
            yield "generatrix.divide = {phase} and surface.kind = 'edge-offset' go together"
