"""The mesh families of a comparison, priced with the project's rates (fabrication, Comparing mesh families)."""

from collections.abc import Iterable

import numpy as np

from isomould.arrays import Floats
from isomould.comparison import Compared
from isomould.documents.costs import Price, Pricing, make_rate_table, make_rates
from isomould.documents.numbers import round_to
from isomould.documents.repetition import FamilyQuantities, make_repetition
from isomould.documents.schedules import charged_areas
from isomould.documents.stock_tables import bar_name
from isomould.documents.table import Table
from isomould.nesting.settings import BarStock, SheetStock, StockSettings
from isomould.parts.settings import PanelSettings
from isomould.project.schema import Project


def make_pricing(project: Project, stock: StockSettings) -> Pricing:
    """Gather rates and the prices of what is in stock; families are priced where they are compared."""
    sheets = tuple(Price(sheet.name, _given(sheet), sheet.width * sheet.height / 1e6) for sheet in stock.sheets)
    bars = tuple(Price(bar_name(bar.section, bar.length), _given(bar), bar.length / 1e3) for bar in stock.bars)
    return Pricing(project.costs, sheets, bars, project.deliver.compare and is_priced(project))


def is_priced(project: Project) -> bool:
    """Tell whether the project gives rates."""
    return bool(project.costs.model_fields_set - {"currency"})


def price_families(compared: Iterable[Compared], project: Project, pricing: Pricing) -> tuple[Table, Table]:
    """Give the tables "rates" and "repetition" of a comparison."""
    families = {each.family: _quantities(each, project.panels) for each in compared}
    mass = project.members.section.area / 1e6 * project.members.density
    rates = make_rates(pricing)
    return make_rate_table(rates), make_repetition(families, rates, pricing, mass)


def _given(stock: SheetStock | BarStock) -> float | None:
    return stock.price if "price" in stock.model_fields_set else None


def _quantities(compared: Compared, panels: PanelSettings) -> FamilyQuantities | None:
    """Gather the quantities of a family, rounded once, as the table shows them; None if there is no such mesh."""
    measured, taken = compared.measured, compared.taken
    if measured is None or taken is None:
        return None
    return FamilyQuantities(
        nodes_count=measured.nodes,
        node_classes=measured.node_classes,
        twisted_nodes_count=taken.twisted,
        members_count=measured.members,
        member_classes=measured.member_classes,
        panels_count=measured.panels,
        panel_classes=measured.panel_classes,
        member_length_mm=_rounded(taken.length, 3),
        panel_area_m2=_rounded(taken.area / 1e6, 12),
        charged_area_m2=_rounded(_charged(taken.boxes, panels), 12),
        contour_length_mm=_rounded(taken.contour, 3),
    )


def _charged(boxes: Floats, panels: PanelSettings) -> float:
    return float(charged_areas(boxes, panels).sum())


def _rounded(value: float, decimals: int) -> float:
    return float(round_to(np.array([value]), decimals)[0])
