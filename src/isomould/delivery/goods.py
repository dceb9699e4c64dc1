"""Everything that is written, and its tables."""

from dataclasses import dataclass
from functools import cached_property

from isomould.cutting import Cutting
from isomould.design import Design, kit_settings
from isomould.documents.schedules import part_tables
from isomould.documents.stock_tables import bar_table, sheet_table
from isomould.documents.strips import strip_table
from isomould.documents.table import Table
from isomould.parts.solid import Solid
from isomould.parts.strips import Strip, unroll_strips


@dataclass(frozen=True, eq=False)
class Delivery:
    """Everything that is written: the design, its solids, its layouts."""

    design: Design
    solids: tuple[Solid, ...]
    cutting: Cutting

    @cached_property
    def strips(self) -> tuple[Strip, ...]:
        """The strips that the project asks for, unrolled."""
        mesh, asked = self.design.kit.mesh, self.design.project.deliver.strips
        return tuple(strip for along in asked for strip in unroll_strips(mesh, along))


def make_tables(delivery: Delivery) -> tuple[Table, ...]:
    """Give the tables of the schedules, in the order of the workbook; summary and checks apart."""
    design, cutting = delivery.design, delivery.cutting
    settings = kit_settings(design.project)
    tables = part_tables(design.kit, settings, delivery.solids, cutting.placed, cutting.positions)
    sheets = sheet_table(cutting.sheets, cutting.stock)
    bars = (bar_table(cutting.bars, cutting.stock),) if cutting.bars else ()
    strips = (strip_table(delivery.strips),) if delivery.strips else ()
    return (*tables, sheets, *bars, *strips)
