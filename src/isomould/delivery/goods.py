"""Everything that is written, and its tables."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from isomould.comparison import compare_families, families_table
from isomould.cutting import Cutting
from isomould.design import Design, kit_settings
from isomould.documents.costs import Cost, Price, Pricing, make_cost
from isomould.documents.revision import Former, revision_table
from isomould.documents.schedules import part_tables
from isomould.documents.stock_tables import bar_name, bar_table, sheet_table
from isomould.documents.strips import strip_table
from isomould.documents.table import Table
from isomould.nesting.settings import BarStock, SheetStock, StockSettings
from isomould.parts.plates import Shape
from isomould.parts.solid import Solid
from isomould.parts.strips import Strip, unroll_strips
from isomould.project.schema import Project


@dataclass(frozen=True, eq=False)
class Delivery:
    """Everything that is written: the design, its node solids, the surfaces of all parts by mark, its layouts.

    `former` is the delivery that it revises, `kit` the nodes that other shapes share with it.
    """

    design: Design
    solids: tuple[Solid, ...]
    bodies: Mapping[str, Shape]
    cutting: Cutting
    former: Former | None = None
    kit: Table | None = None

    @cached_property
    def schedules(self) -> tuple[Table, ...]:
        """Parts, stock and strips, in the order of the workbook."""
        return make_schedules(self)

    @cached_property
    def cost(self) -> Cost:
        """The schedules, priced."""
        return make_cost(self.schedules, _pricing(self.design.project, self.cutting.stock))

    @cached_property
    def tables(self) -> tuple[Table, ...]:
        """All tables; summary and checks apart."""
        return (self.cost.rates, self.cost.lines, *self.schedules)

    @cached_property
    def strips(self) -> tuple[Strip, ...]:
        """The strips that the project asks for, unrolled."""
        mesh, asked = self.design.kit.mesh, self.design.project.deliver.strips
        return tuple(strip for along in asked for strip in unroll_strips(mesh, along))


def _pricing(project: Project, stock: StockSettings) -> Pricing:
    """Gather rates and the prices of what is in stock."""
    sheets = tuple(Price(sheet.name, _given(sheet)) for sheet in stock.sheets)
    bars = tuple(Price(bar_name(bar.section, bar.length), _given(bar)) for bar in stock.bars)
    return Pricing(project.costs, sheets, bars, project.nodes.density)


def _given(stock: SheetStock | BarStock) -> float | None:
    return stock.price if "price" in stock.model_fields_set else None


def make_schedules(delivery: Delivery) -> tuple[Table, ...]:
    """Give the tables of the schedules, in the order of the workbook."""
    design, cutting = delivery.design, delivery.cutting
    settings = kit_settings(design.project)
    drawn = design.project.deliver.drawings
    tables = part_tables(design.kit, settings, delivery.solids, cutting.placed, cutting.positions, drawn=drawn)
    sheets = sheet_table(cutting.sheets, cutting.stock)
    bars = (bar_table(cutting.bars, cutting.stock),) if cutting.bars else ()
    strips = (strip_table(delivery.strips),) if delivery.strips else ()
    revision = (revision_table(tables, delivery.former),) if delivery.former else ()
    kit = (delivery.kit,) if delivery.kit else ()
    families = (families_table(compare_families(design)),) if design.project.deliver.compare else ()
    return (*tables, sheets, *bars, *strips, *revision, *kit, *families)
