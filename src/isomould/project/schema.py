"""The project file: the settings of every stage, composed (deliverables, Project file)."""

from typing import Literal

from pydantic import Field, model_validator

from isomould.curves.plane import PlaneSettings
from isomould.curves.settings import CurveSettings
from isomould.documents.info import ProjectInfo
from isomould.form.rail import Ends
from isomould.form.settings import (
    GeneratrixDivide,
    Inflections,
    PositiveCount,
    RailDivide,
    SurfaceSettings,
)
from isomould.nesting.settings import StockSettings
from isomould.parts.settings import MemberSettings, NodeSettings, PanelSettings
from isomould.settings import Settings
from isomould.units import Flag, Length, NonNegativeLength, Number, PositiveLength, PositiveNumber
from isomould.writers.settings import DeliverSettings


class RailTable(Settings):
    """The `[rail]` table."""

    curve: CurveSettings
    plane: PlaneSettings = "xy"
    outside: Literal["outer", "inner"] | tuple[Number, Number]
    divide: RailDivide = RailDivide()
    ends: Ends | None = None
    """Default: mitred for edge offset meshes, square for all others."""
    inflections: Inflections = "nearest"
    flat_nodes: Flag = False
    max_edge: PositiveLength | None = None


class GeneratrixTable(Settings):
    """The `[generatrix]` table."""

    curve: CurveSettings
    origin: tuple[Length, Length] = (0.0, 0.0)
    axes: Literal["dz", "zd"] = "dz"
    outside: tuple[Number, Number] = (1.0, 0.0)
    divide: GeneratrixDivide = GeneratrixDivide()
    inflections: Inflections = "nearest"
    flat_nodes: Flag = False
    max_edge: PositiveLength | None = None


class ToleranceTable(Settings):
    """The `[tolerances]` table: when parts are the same, and what the mesh may not exceed."""

    length: PositiveLength = 0.5
    angle_deg: PositiveNumber = 0.05
    min_member: PositiveLength = 100.0
    max_deviation: NonNegativeLength | None = None
    max_turning_deg: PositiveNumber = 60.0


class LimitTable(Settings):
    """The `[limits]` table."""

    max_panels: PositiveCount = 200_000


class Project(Settings):
    """A whole project file."""

    schema_: Literal[1] = Field(alias="schema")
    project: ProjectInfo
    rail: RailTable
    generatrix: GeneratrixTable
    surface: SurfaceSettings = SurfaceSettings()
    members: MemberSettings = MemberSettings()
    nodes: NodeSettings = NodeSettings()
    panels: PanelSettings = PanelSettings()
    tolerances: ToleranceTable = ToleranceTable()
    stock: StockSettings | None = None
    deliver: DeliverSettings = DeliverSettings()
    limits: LimitTable = LimitTable()

    @model_validator(mode="after")
    def _kind_fits_division(self) -> "Project":
        kind, rail, generatrix = self.surface.kind, self.rail.divide, self.generatrix.divide
        if kind != "moulding" and rail.nodes is None and rail.angle_deg is None and rail.angles is None:
            message = (
                f"surface.kind = '{kind}' has one turning angle: it needs rail.divide = {{nodes}} or {{angle_deg}}"
            )
            raise ValueError(message)
        if kind == "edge-offset" and rail.angles is not None:
            message = "surface.kind = 'edge-offset' has one turning angle: rail.divide = {angles} gives several"
            raise ValueError(message)
        if (kind == "edge-offset") != (generatrix.phase is not None):
            message = "generatrix.divide = {phase} and surface.kind = 'edge-offset' go together"
            raise ValueError(message)
        return self
