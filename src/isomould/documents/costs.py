"""What a delivery costs: rates, quantities taken off the schedules, and a line for each (fabrication, Costs)."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from isomould.documents.cost_settings import CostSettings
from isomould.documents.detail_costs import (
    Work,
    coated_area,
    delivered_masses,
    fabrication_lines,
    handled_pieces,
    hardware_lines,
    material_lines,
    needless_rates,
    steel_of_members,
)
from isomould.documents.live import Given, Here, Live, NamedCell, RateCell, add_up
from isomould.documents.quantities import Blanks, Tables, count, matches, products, sum_if, total
from isomould.documents.table import Table, make_live_table

GROUPS = ("Material", "Fabrication", "Hardware", "Assembly", "Transport", "Erection")
"""Sub-totals, in the order of the lines."""


@dataclass(frozen=True)
class Price:
    """A stock size and its price, None where nobody gave one; `size` in m² of a sheet, m of a bar."""

    name: str
    price: float | None
    size: float


@dataclass(frozen=True)
class Pricing:
    """What the cost needs to know beside the schedules: rates, stock and its prices.

    `repetition` says that mesh families are priced too, which have nodes with torsion.
    """

    rates: CostSettings
    sheets: tuple[Price, ...]
    bars: tuple[Price, ...]
    repetition: bool = False


@dataclass(frozen=True)
class Rate:
    """An input cell: `rate_<code>`."""

    code: str
    description: str
    unit: str
    value: float | None

    @property
    def cell(self) -> RateCell:
        """The cell in formulas."""
        return RateCell(self.code, self.value)


@dataclass(frozen=True, eq=False)
class Line:
    """A line of the cost: `waste` is a rate in percent where waste is paid for."""

    code: str
    group: str
    description: str
    unit: str
    quantity: Live
    rate: Rate
    waste: Rate | None = None


@dataclass(frozen=True, eq=False)
class Result:
    """A figure below the lines; `name` is the defined name of its cell, if it has one."""

    label: str
    unit: str
    live: Live
    name: str = ""


@dataclass(frozen=True, eq=False)
class Cost:
    """Rates and lines as tables, and what follows from them."""

    rates: Table
    lines: Table
    results: tuple[Result, ...]
    total: float


def make_cost(tables: Sequence[Table], pricing: Pricing) -> Cost:
    """Price the schedules.

    Parameters
    ----------
    tables
        The schedules, nodes, members, panels and sheets among them.
    pricing
        Rates and stock prices.
    """
    by_name = {table.name: table for table in tables}
    rates = make_rates(pricing, by_name)
    lines = _line_table([*_lines(by_name, rates, pricing)])
    rate_table = make_rate_table(rates)
    waste = tuple(_stock_waste(by_name, pricing))
    results = (*_results(by_name, rates, rate_table, lines, pricing.rates.currency), *waste)
    return Cost(rate_table, lines, results, next(r for r in results if r.name == "total_cost").live.value)


def make_rates(pricing: Pricing, tables: Tables | None = None) -> dict[str, Rate]:
    """Give all input cells by their codes; `tables` tell what hardware and fittings there are."""
    return {rate.code: rate for rate in _rates(pricing, tables or {})}


def _rates(pricing: Pricing, tables: Tables) -> Iterator[Rate]:
    """Stock prices first, then the rates of the project; what stock makes needless is left out."""
    currency, needless = pricing.rates.currency, _needless(pricing) | needless_rates(tables)
    for kind, prices in (("sheet", pricing.sheets), ("bar", pricing.bars)):
        for k, price in enumerate(prices, start=1):
            yield Rate(f"{kind}_{k}", f"Stock {kind}: {price.name}", f"{currency}/{kind}", price.price)
    for code, field in CostSettings.model_fields.items():
        if code != "currency" and code not in needless:
            yield Rate(code, field.description or code, _unit(field, currency), _initial(code, pricing.rates))


def _initial(code: str, rates: CostSettings) -> float | None:
    """Give the value of a rate; a node with torsion costs what another one costs, where nobody says more."""
    return getattr(rates, code) if code != "node_run_torsion" else rates.node_run_torsion or rates.node_run


def _needless(pricing: Pricing) -> frozenset[str]:
    """Rates of material by mass and area, where stock is bought; of torsion, where no mesh has any."""
    panels = ("glass", "waste_panels") if pricing.sheets else ()
    members = ("steel", "waste_members") if pricing.bars else ()
    return frozenset((*panels, *members, *(() if pricing.repetition else ("node_run_torsion",))))


def _unit(field: object, currency: str) -> str:
    extra: Mapping[str, str] = getattr(field, "json_schema_extra", None) or {}
    return f"{currency}{extra['unit']}" if extra["unit"].startswith("/") else extra["unit"]


def _lines(tables: Tables, rates: Mapping[str, Rate], pricing: Pricing) -> Iterator[Line]:
    yield from _material(tables, rates, pricing)
    for code, group, description, unit, quantity in _work(tables, rates):
        yield Line(code, group, description, unit, quantity, rates[code])


def _material(tables: Tables, rates: Mapping[str, Rate], pricing: Pricing) -> Iterator[Line]:
    """Stock as bought, or net quantities and their waste; and the bar that nodes are turned from."""
    for kind, table, prices in (("sheet", "sheets", pricing.sheets), ("bar", "bars", pricing.bars)):
        for k, price in enumerate(prices, start=1):
            code = f"{kind}_{k}"
            bought = matches(tables, f"{table}.stock", price.name)
            yield Line(code, "Material", rates[code].description, f"{kind}s", bought, rates[code])
    if not pricing.sheets:
        charged = products(tables, "panels.quantity", "charged_area_m2")
        yield Line("glass", "Material", "Panels, charged area", "m²", charged, rates["glass"], rates["waste_panels"])
    if not pricing.bars:
        yield Line(
            "steel", "Material", "Members", "kg", steel_of_members(tables), rates["steel"], rates["waste_members"]
        )
    blanks = products(tables, "nodes.quantity", "bar_mass_kg")
    yield Line("node_steel", "Material", "Round bar for nodes", "kg", blanks, rates["node_steel"])
    bases = products(tables, "nodes.quantity", "base_mass_kg")
    yield Line("base_steel", "Material", "Base plates and stems of supports", "kg", bases, rates["base_steel"])
    for code, group, description, unit, quantity in material_lines(tables):
        yield Line(code, group, description, unit, quantity, rates[code])


def _work(tables: Tables, rates: Mapping[str, Rate]) -> tuple[Work, ...]:
    """Code, group, description, unit and quantity of everything that is done."""
    pieces = {name: total(tables, f"{name}.quantity") for name in ("nodes", "members", "panels")}
    classes = {name: count(tables, f"{name}.mark") for name in ("nodes", "members", "panels")}
    taken = ("slots", "facets", "holes", "base_holes", "weld_length_mm")
    each = {name: products(tables, "nodes.quantity", name) for name in taken}
    hours = [pieces[f"{name}s"] * rates[f"hours_{name}"].cell for name in ("node", "member", "panel")]
    thousand = Given(1000.0)
    return (
        ("panel_set_up", "Fabrication", "Panel classes", "classes", classes["panels"]),
        ("panel_cut", "Fabrication", "Contours of panels", "m", total(tables, "sheets.cut_length_mm") / thousand),
        ("panel_pierce", "Fabrication", "Contours to start", "pieces", total(tables, "sheets.cuts")),
        ("member_set_up", "Fabrication", "Member classes", "classes", classes["members"]),
        ("saw_cut", "Fabrication", "End cuts of members", "cuts", pieces["members"] * Given(2.0)),
        ("node_set_up", "Fabrication", "Node classes", "classes", classes["nodes"]),
        ("node_run", "Fabrication", "Nodes", "pieces", pieces["nodes"]),
        ("slot", "Fabrication", "Slots of nodes", "pieces", each["slots"]),
        ("facet", "Fabrication", "Facets of nodes", "pieces", each["facets"]),
        ("hole", "Fabrication", "Bores and holes of nodes and bases", "pieces", each["holes"] + each["base_holes"]),
        ("weld", "Fabrication", "Welds", "m", each["weld_length_mm"] / thousand),
        *fabrication_lines(tables),
        ("coating", "Fabrication", "Coated area of nodes, members and fittings", "m²", coated_area(tables)),
        *hardware_lines(tables),
        ("assembly", "Assembly", "Hours in the shop", "h", add_up(hours)),
        ("handling", "Transport", "Parts handled and packed", "pieces", handled_pieces(tables)),
        ("transport", "Transport", "Mass of all parts", "t", delivered_masses(tables) / thousand),
        ("erect_node", "Erection", "Nodes", "pieces", pieces["nodes"]),
        ("erect_member", "Erection", "Members", "pieces", pieces["members"]),
        ("erect_panel", "Erection", "Panels", "pieces", pieces["panels"]),
    )


def make_rate_table(rates: Mapping[str, Rate]) -> Table:
    """Make the table "rates"."""
    data = {
        "code": [*rates],
        "description": [rate.description for rate in rates.values()],
        "unit": [rate.unit for rate in rates.values()],
        "value": [rate.value for rate in rates.values()],
    }
    return make_live_table("rates", data)


def _line_table(lines: Sequence[Line]) -> Table:
    data = {
        "code": [line.code for line in lines],
        "group": [line.group for line in lines],
        "description": [line.description for line in lines],
        "unit": [line.unit for line in lines],
        "quantity": [line.quantity for line in lines],
        "waste_percent": [line.waste.cell if line.waste else None for line in lines],
        "rate": [line.rate.cell for line in lines],
        "amount": [_amount(line) for line in lines],
    }
    return make_live_table("cost", data)


def _amount(line: Line) -> Live:
    """Quantity, with its waste where that is paid for, times rate."""
    amount = Here("quantity", line.quantity.value) * Here("rate", line.rate.cell.value)
    if line.waste is None:
        return amount
    return amount * (Given(1.0) + Here("waste_percent", line.waste.cell.value) / Given(100.0))


def _results(
    tables: Tables, rates: Mapping[str, Rate], rate_table: Table, lines: Table, currency: str
) -> tuple[Result, ...]:
    """Sub-totals, overhead and margin, the total, what a m² costs, and what a further class of nodes would."""
    priced = {"cost": lines, "rates": rate_table, **tables}
    groups = tuple(Result(group, currency, sum_if(lines, "group", group, "amount")) for group in GROUPS)
    works = Result("Works", currency, total(priced, "cost.amount"), "works_cost")
    overhead = Result("Overhead", currency, _named(works) * _share(rates["overhead"]), "overhead_cost")
    margin = Result("Margin", currency, (_named(works) + _named(overhead)) * _share(rates["margin"]), "margin_cost")
    grand = Result("Total", currency, _named(works) + _named(overhead) + _named(margin), "total_cost")
    per_area = _named(grand) / total(tables, "panels.total_area_m2")
    surcharge = (Given(1.0) + _share(rates["overhead"])) * (Given(1.0) + _share(rates["margin"]))
    further = rates["node_set_up"].cell * surcharge
    blanks = Blanks(rate_table, rate_table.columns[-1])
    return (
        *groups,
        works,
        overhead,
        margin,
        grand,
        Result("Total per m² of panels", f"{currency}/m²", per_area, "cost_per_m2"),
        Result("A further node class", currency, further, "cost_per_node_class"),
        Result("Rates that are blank and count as nothing", "", blanks, "blank_rates"),
    )


def _stock_waste(tables: Tables, pricing: Pricing) -> Iterator[Result]:
    """Show what of the stock is waste; it was paid for with the stock and is multiplied nowhere."""
    all_of = Given(1.0)
    if pricing.sheets and "sheets" in tables:
        used = total(tables, "sheets.part_area_m2") / _bought(tables, "sheets.stock", pricing.sheets)
        yield Result("Waste of sheets, in their price", "%", (all_of - used) * Given(100.0))
    if pricing.bars and "bars" in tables:
        left = total(tables, "bars.offcut_mm") / Given(1000.0) / _bought(tables, "bars.stock", pricing.bars)
        yield Result("Offcuts of bars, in their price", "%", left * Given(100.0))


def _bought(tables: Tables, path: str, prices: Sequence[Price]) -> Live:
    """Area (m²) or length (m) of the stock that is used up."""
    return add_up([matches(tables, path, price.name) * Given(price.size) for price in prices])


def _named(result: Result) -> NamedCell:
    return NamedCell(result.name, result.live)


def _share(rate: Rate) -> Live:
    return rate.cell / Given(100.0)
