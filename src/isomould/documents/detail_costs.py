"""What hardware, caps, end plates and fins cost, and where their mass is paid for and carried (fabrication, Costs)."""

from isomould.documents.live import Live, add_up
from isomould.documents.quantities import Tables, products, sum_if, total
from isomould.documents.table import cells

Work = tuple[str, str, str, str, Live]
"""Code, group, description, unit and quantity of a line."""

_BOUGHT = {"bolt": "Bolts", "nut": "Nuts", "washer": "Washers"}
_MADE = {"cap": ("cap", "Caps"), "end_plate": ("end-plate", "End plates"), "fin": ("fin", "Fins")}
"""Rates of fittings, with the kind that they are for."""


def needless_rates(tables: Tables) -> frozenset[str]:
    """Name the rates of details that the design has not; hardware is paid for by piece where it is listed."""
    items, kinds = _words(tables, "hardware", "item"), _words(tables, "fittings", "kind")
    bought = {code for code in _BOUGHT if code not in items} | ({"hardware"} if items else set())
    made = {code for code, (kind, _) in _MADE.items() if kind not in kinds} | (set() if kinds else {"fitting_steel"})
    return frozenset(bought | made)


def steel_of_members(tables: Tables) -> Live:
    """Mass of the members (kg) as they are bought: their end plates are paid for as fittings."""
    mass = total(tables, "members.total_mass_kg")
    return mass - _of_kind(tables, "end-plate", "total_mass_kg") if "fittings" in tables else mass


def delivered_masses(tables: Tables) -> Live:
    """Mass of all parts (kg), each once: nodes include bases and fins, members their end plates."""
    parts = [total(tables, f"{name}.total_mass_kg") for name in ("nodes", "members", "panels")]
    return add_up([*parts, *_caps(tables, "total_mass_kg")])


def handled_pieces(tables: Tables) -> Live:
    """Number of the pieces that leave the shop loose; fins are on their nodes, end plates in their members."""
    parts = [total(tables, f"{name}.quantity") for name in ("nodes", "members", "panels")]
    return add_up([*parts, *_caps(tables, "quantity")])


def coated_area(tables: Tables) -> Live:
    """Coated area (m²) of nodes with their fins, members, caps and end plates."""
    names = [name for name in ("nodes", "members", "fittings") if name in tables]
    return add_up([products(tables, f"{name}.quantity", "coated_area_m2") for name in names])


def material_lines(tables: Tables) -> tuple[Work, ...]:
    """Give the steel of caps, end plates and fins."""
    if "fittings" not in tables:
        return ()
    return (("fitting_steel", "Material", "Caps, end plates and fins", "kg", total(tables, "fittings.total_mass_kg")),)


def fabrication_lines(tables: Tables) -> tuple[Work, ...]:
    """Give holes of members, threads of nodes, and what makes caps, end plates and fins."""
    needless = needless_rates(tables)
    made = [
        (code, "Fabrication", words, "pieces", _of_kind(tables, kind, "quantity"))
        for code, (kind, words) in _MADE.items()
        if code not in needless
    ]
    holes, threads = products(tables, "members.quantity", "holes"), products(tables, "nodes.quantity", "threads")
    return (
        ("member_hole", "Fabrication", "Holes and slots of members", "pieces", holes),
        ("thread", "Fabrication", "Threads of nodes", "pieces", threads),
        *made,
    )


def hardware_lines(tables: Tables) -> tuple[Work, ...]:
    """Give bolts, nuts and washers by piece where they are listed, or small parts by node."""
    needless = needless_rates(tables)
    if "hardware" in needless:
        listed = [(code, words) for code, words in _BOUGHT.items() if code not in needless]
        return tuple((code, "Hardware", words, "pieces", _pieces(tables, code)) for code, words in listed)
    return (("hardware", "Hardware", "Bolts, washers and small parts", "nodes", total(tables, "nodes.quantity")),)


def _pieces(tables: Tables, item: str) -> Live:
    return sum_if(tables["hardware"], "item", item, "total_pieces")


def _of_kind(tables: Tables, kind: str, column: str) -> Live:
    return sum_if(tables["fittings"], "kind", kind, column)


def _caps(tables: Tables, column: str) -> list[Live]:
    return [_of_kind(tables, "cap", column)] if "fittings" in tables else []


def _words(tables: Tables, name: str, column: str) -> set[object]:
    """Give the words of a column, none where there is no such table."""
    chosen = [found for found in tables[name].columns if found.name == column] if name in tables else []
    return {cell for found in chosen for cell in cells(tables[name], found)}
