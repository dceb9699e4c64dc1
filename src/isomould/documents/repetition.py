"""The price of repetition: mesh families on one surface, with their classes and what these cost (paper Table 5)."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass

from isomould.documents.costs import Pricing, Rate
from isomould.documents.live import Given, Here, Live, add_up
from isomould.documents.table import Table, make_live_table

WORKS = (
    "node_set_up_cost",
    "node_run_cost",
    "member_set_up_cost",
    "member_run_cost",
    "panel_set_up_cost",
    "panel_run_cost",
    "member_material_cost",
    "panel_material_cost",
    "assembly_cost",
    "erection_cost",
)
"""What differs between families, as columns in the order of the chart."""


@dataclass(frozen=True)
class FamilyQuantities:
    """Counts, classes and quantities of one family, rounded as the table shows them."""

    nodes_count: int
    node_classes: int
    twisted_nodes_count: int
    members_count: int
    member_classes: int
    panels_count: int
    panel_classes: int
    member_length_mm: float
    panel_area_m2: float
    charged_area_m2: float
    contour_length_mm: float


_QUANTITIES = tuple(FamilyQuantities.__annotations__)
_MONEY = (*WORKS, "works_cost", "surcharge_cost", "full_cost", "square_metre_cost")


def make_repetition(
    families: Mapping[str, FamilyQuantities | None], rates: Mapping[str, Rate], pricing: Pricing, mass: float
) -> Table:
    """Price the families; a family without a mesh is a row of blanks.

    Parameters
    ----------
    families
        Quantities by the family's name.
    rates
        All rates of the project.
    pricing
        Stock and currency.
    mass
        Of a member per length, kg/m.
    """
    rows = [_row(found, rates, pricing, mass) if found else {} for found in families.values()]
    data: dict[str, Sequence[object]] = {name: [row.get(name) for row in rows] for name in (*_QUANTITIES, *_MONEY)}
    return make_live_table(
        "repetition", {"family": [*families], **data, "currency": [pricing.rates.currency] * len(rows)}
    )


def _row(found: FamilyQuantities, rates: Mapping[str, Rate], pricing: Pricing, mass: float) -> dict[str, object]:
    quantities = asdict(found)
    here: dict[str, Live] = {name: Here(name, value) for name, value in quantities.items()}
    works = _works(here, {code: rate.cell for code, rate in rates.items()})
    works |= _material(here, rates, pricing, mass)
    return {**quantities, **works, **_sums(works, here["panel_area_m2"], rates)}


def _works(here: Mapping[str, Live], rate: Mapping[str, Live]) -> dict[str, Live]:
    """Work on nodes, members and panels: per class, and per piece, cut or metre."""
    nodes, members, panels = (here[f"{part}s_count"] for part in ("node", "member", "panel"))
    twisted, two, thousand = here["twisted_nodes_count"], Given(2.0), Given(1000.0)
    runs = (nodes - twisted) * rate["node_run"] + twisted * rate["node_run_torsion"]
    hours = nodes * rate["hours_node"] + members * rate["hours_member"] + panels * rate["hours_panel"]
    erection = nodes * rate["erect_node"] + members * rate["erect_member"] + panels * rate["erect_panel"]
    contours = here["contour_length_mm"] / thousand * rate["panel_cut"]
    return {
        **{f"{part}_set_up_cost": here[f"{part}_classes"] * rate[f"{part}_set_up"] for part in _PARTS},
        "node_run_cost": runs + members * two * rate["slot"],
        "member_run_cost": members * two * rate["saw_cut"],
        "panel_run_cost": contours + panels * rate["panel_pierce"],
        "assembly_cost": hours * rate["assembly"],
        "erection_cost": erection,
    }


_PARTS = ("node", "member", "panel")


def _material(here: Mapping[str, Live], rates: Mapping[str, Rate], pricing: Pricing, mass: float) -> dict[str, Live]:
    """Price panels by charged area and members by length, at the rates of the first stock size or by area and mass.

    One effort for all families: every panel is paid for as a rectangle of its own, whatever nests of it might save.
    """
    metres = here["member_length_mm"] / Given(1000.0)
    panels, members = here["charged_area_m2"], metres * Given(mass)
    return {
        "panel_material_cost": panels * rates["sheet_1"].cell / Given(pricing.sheets[0].size)
        if pricing.sheets
        else panels * rates["glass"].cell * _raised_by(rates["waste_panels"]),
        "member_material_cost": metres * rates["bar_1"].cell / Given(pricing.bars[0].size)
        if pricing.bars
        else members * rates["steel"].cell * _raised_by(rates["waste_members"]),
    }


def _sums(works: Mapping[str, Live], area: Live, rates: Mapping[str, Rate]) -> dict[str, Live]:
    """Sum of the works, overhead and margin on it, both together, and that per m² of panels."""
    total = add_up([_here(name, works[name]) for name in WORKS])
    rest = (_raised_by(rates["overhead"]) * _raised_by(rates["margin"]) - Given(1.0)) * _here("works_cost", total)
    full = _here("works_cost", total) + _here("surcharge_cost", rest)
    per_area = _here("full_cost", full) / area
    return {"works_cost": total, "surcharge_cost": rest, "full_cost": full, "square_metre_cost": per_area}


def _here(column: str, live: Live) -> Here:
    return Here(column, live.value)


def _raised_by(percent: Rate) -> Live:
    """Give the factor that adds a percentage."""
    return Given(1.0) + percent.cell / Given(100.0)
