"""Everything that is written, and its tables."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from isomould.comparison import Compared, compare_families, families_table
from isomould.cutting import Cutting
from isomould.design import Design, kit_settings
from isomould.documents.costs import Cost, Pricing, make_cost
from isomould.documents.info import Logo
from isomould.documents.node_tables import fitting_table, hardware_table, limit_table, node_fitting_table
from isomould.documents.overview import kit_facts, layout_facts
from isomould.documents.packing import packing_tables
from isomould.documents.revision import Former, revision_table
from isomould.documents.schedules import part_tables
from isomould.documents.setting_out import SettingOut, set_out, setting_out_table
from isomould.documents.stock_tables import bar_table, sheet_table
from isomould.documents.strips import strip_table
from isomould.documents.table import Table, without_files
from isomould.documents.totals import make_summary
from isomould.parts.details.fittings import Fitting, make_fittings
from isomould.parts.plates import Shape
from isomould.parts.solid import Solid
from isomould.parts.strips import Strip, unroll_strips
from isomould.repetition import make_pricing, price_families


@dataclass(frozen=True, eq=False)
class Delivery:
    """Everything that is written: the design, its node solids, the surfaces of all parts by mark, its layouts.

    `former` is the delivery that it revises, `kit` the nodes that other shapes share with it, `logo`
    stands on the cover; `filed` says whether the files that schedules name are written.
    """

    design: Design
    solids: tuple[Solid, ...]
    bodies: Mapping[str, Shape]
    cutting: Cutting
    former: Former | None = None
    kit: Table | None = None
    logo: Logo | None = None
    filed: bool = True

    @cached_property
    def schedules(self) -> tuple[Table, ...]:
        """Parts, stock and strips, in the order of the workbook."""
        tables = make_schedules(self)
        return tables if self.filed else tuple(map(without_files, tables))

    @cached_property
    def compared(self) -> tuple[Compared, ...]:
        """The surface as every mesh family, where the project asks for it."""
        return compare_families(self.design) if self.design.project.deliver.compare else ()

    @cached_property
    def pricing(self) -> Pricing:
        """What the cost needs to know beside the schedules."""
        return make_pricing(self.design.project, self.cutting.stock)

    @cached_property
    def cost(self) -> Cost:
        """The schedules, priced."""
        return make_cost(self.schedules, self.pricing)

    @cached_property
    def tables(self) -> tuple[Table, ...]:
        """All tables; summary and checks apart."""
        families = (
            price_families(self.compared, self.design.project, self.pricing)[1:] if self.pricing.repetition else ()
        )
        return (self.cost.rates, self.cost.lines, *self.schedules, *families)

    @cached_property
    def summary(self) -> Table:
        """Key figures and totals."""
        facts = (*kit_facts(self.design.kit), *layout_facts(self.cutting.sheets, self.cutting.bars))
        return make_summary(facts, self.tables)

    @cached_property
    def setting_out(self) -> SettingOut:
        """Work points and axes in the datum of the site."""
        project = self.design.project
        return set_out(self.design.kit, project.members.section.depth, project.project.datum)

    @cached_property
    def fittings(self) -> tuple[Fitting, ...]:
        """Caps, end plates and fins."""
        kit = self.design.kit
        return make_fittings(kit.nodes, kit.joints, kit.members)

    @cached_property
    def strips(self) -> tuple[Strip, ...]:
        """The strips that the project asks for, unrolled."""
        mesh, asked = self.design.kit.mesh, self.design.project.deliver.strips
        return tuple(strip for along in asked for strip in unroll_strips(mesh, along))


def make_schedules(delivery: Delivery) -> tuple[Table, ...]:
    """Give the tables of the schedules, in the order of the workbook."""
    design, cutting = delivery.design, delivery.cutting
    settings = kit_settings(design.project)
    drawn = design.project.deliver.drawings
    tables = part_tables(design.kit, settings, delivery.solids, cutting.placed, cutting.positions, drawn=drawn)
    about = [
        limit_table(design.kit),
        hardware_table(design.kit),
        node_fitting_table(design.kit, delivery.fittings),
        fitting_table(delivery.fittings, settings.members.density),
    ]
    sheets = sheet_table(cutting.sheets, cutting.stock)
    bars = (bar_table(cutting.bars, cutting.stock),) if cutting.bars else ()
    strips = (strip_table(delivery.strips),) if delivery.strips else ()
    revision = (revision_table(tables, delivery.former),) if delivery.former else ()
    kit = (delivery.kit,) if delivery.kit else ()
    site = (setting_out_table(delivery.setting_out), *packing_tables(tables))
    families = (families_table(delivery.compared),) if delivery.compared else ()
    known = [table for table in about if len(table.frame)]
    return (*tables, *known, *site, sheets, *bars, *strips, *revision, *kit, *families)
