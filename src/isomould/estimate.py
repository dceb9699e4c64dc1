"""What a design weighs and costs before anything is nested: for `check`, which does not search."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp

from isomould.arrays import Floats
from isomould.cutting import member_parts, panel_parts
from isomould.design import Design, kit_settings
from isomould.documents.costs import Cost, make_cost
from isomould.documents.detail_costs import delivered_masses
from isomould.documents.figures import Figure
from isomould.documents.node_tables import fitting_table, hardware_table, node_fitting_table
from isomould.documents.schedules import Bulk, class_tables
from isomould.documents.stock_tables import bar_name
from isomould.documents.table import Table, make_table
from isomould.errors import Note
from isomould.nesting.bound import dilated_area, fits, room_of
from isomould.nesting.layout import Member, Part
from isomould.nesting.settings import BarStock, SheetStock, StockSettings
from isomould.parts.details.fittings import make_fittings
from isomould.parts.outline import area, sides
from isomould.parts.plates import Shape
from isomould.repetition import is_priced, make_pricing


@dataclass(frozen=True, eq=False)
class Estimate:
    """Masses and costs as a build has them, but for what only nesting knows; `cost` is None without rates."""

    tables: Mapping[str, Table]
    cost: Cost | None
    currency: str
    basis: str

    def figures(self) -> Iterator[Figure]:
        """Give total areas, masses and the cost."""
        covered = float(self.tables["panels"].frame["total_area_m2"].sum())
        yield Figure("total_area", "Area of all panels", covered, "m²")
        for name in ("panels", "members", "nodes"):
            mass = float(self.tables[name].frame["total_mass_kg"].sum())
            yield Figure(f"total_mass_{name}", f"Mass of all {name}", mass, "kg")
        yield Figure("total_mass", "Mass of all parts", delivered_masses(self.tables).value, "kg")
        if self.cost is not None:
            yield Figure("cost", "Cost before nesting", self.cost.total, self.currency)

    @property
    def notes(self) -> tuple[Note, ...]:
        """Say what the cost stands on."""
        return () if self.cost is None else (Note("W-COST-BASIS", "costs", self.basis),)


def estimate(design: Design, bodies: Sequence[Shape]) -> Estimate:
    """Take quantities off the parts as a build does, and price them with the least stock that could hold them.

    Parameters
    ----------
    bodies
        The surface of every node class.
    """
    settings, kit, project = kit_settings(design.project), design.kit, design.project
    stock = project.stock or StockSettings()
    fittings = make_fittings(kit.nodes, kit.joints, kit.members)
    about = [hardware_table(kit), node_fitting_table(kit, fittings), fitting_table(fittings, settings.members.density)]
    listed = [*class_tables(kit, settings, [_bulk(body) for body in bodies]), *(t for t in about if len(t.frame))]
    sheets = _sheet_rows(panel_parts(kit.panels, kit.mesh), stock)
    bars = _bar_rows(member_parts(kit.members), stock)
    tables = {table.name: table for table in (*listed, sheets, *([bars] if stock.bars else []))}
    cost = make_cost([*tables.values()], make_pricing(project, stock)) if is_priced(project) else None
    return Estimate(tables, cost, project.costs.currency, _basis(sheets, bars, stock))


def _bulk(body: Shape) -> Bulk:
    """Volume and surface of a closed surface (Gauss's theorem)."""
    a, b, c = (body.vertices[body.triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    volume = float(np.einsum("tk,tk->", a, normals)) / 6
    return Bulk(volume, float(np.linalg.norm(normals, axis=1).sum()) / 2)


def _basis(sheets: Table, bars: Table, stock: StockSettings) -> str:
    bought = [
        *([f"{len(sheets.frame)} sheets"] if stock.sheets else []),
        *([f"{len(bars.frame)} bars"] if stock.bars else []),
    ]
    if not bought:
        return "an estimate without nesting: panels are cut from blanks to order, all quantities are those of a build"
    scored = "; scored lines are counted as the panels' sides, of which neighbours share some" if stock.scored else ""
    return (
        f"an estimate without nesting: {' and '.join(bought)}, the least that could hold the parts by area and length; "
        f"what nesting adds to them is left out, all other quantities are those of a build{scored}"
    )


def _sheet_rows(parts: Sequence[Part], stock: StockSettings) -> Table:
    """Give the table "sheets" of the fewest or cheapest sheets by area; without stock one blank for all."""
    cuts = [float(sides(part.outline).sum()) for part in parts for _ in range(part.quantity)]
    covered = sum(part.polygon.area * part.quantity for part in parts) / 1e6
    names = _least_sheets(parts, stock) if stock.sheets else ["blank"]
    rest = len(names) - 1
    data: dict[str, list[object]] = {
        "sheet": [f"S{number:03d}" for number in range(1, len(names) + 1)],
        "stock": [*names],
        "parts": [len(cuts), *[0] * rest],
        "part_area_m2": [covered, *[0.0] * rest],
        "cut_length_mm": [sum(cuts), *[0.0] * rest],
        "cuts": [len(cuts), *[0] * rest],
    }
    return make_table("sheets", _blank_beside("sheets", data))


def _blank_beside(name: str, data: dict[str, list[object]]) -> dict[str, list[object]]:
    """Leave the other columns of a table of stock blank: only nesting knows them."""
    others = {
        "sheets": ("yield_percent", "offcut_width_mm", "offcut_height_mm", "price", "file"),
        "bars": ("used_mm", "offcut_mm", "price"),
    }
    count = len(next(iter(data.values())))
    return {**data, **{column: [None] * count for column in others[name]}}


def _least_sheets(parts: Sequence[Part], stock: StockSettings) -> list[str]:
    """Name the cheapest sheets, the fewest of those, that have the area of the parts that fit them."""
    groups = dict[tuple[bool, ...], float]()
    for part in parts:
        held = tuple(fits(part.outline, sheet, stock) for sheet in stock.sheets)
        groups[held] = groups.get(held, 0.0) + dilated_area([part.polygon], stock.gap) * part.quantity
    rooms = np.array([room_of(sheet, stock) for sheet in stock.sheets])
    rows = np.array([rooms * np.array(held) for held in groups])
    needs = np.array([sum(need for other, need in groups.items() if _within(other, held)) for held in groups])
    counts = _least(rows, needs, stock.sheets)
    return [sheet.name for sheet, count in zip(stock.sheets, counts, strict=True) for _ in range(count)]


def _within(sizes: tuple[bool, ...], others: tuple[bool, ...]) -> bool:
    return all(other or not one for one, other in zip(sizes, others, strict=True))


def _least(rows: Floats, needs: Floats, stock: Sequence[SheetStock | BarStock]) -> list[int]:
    """Give whole numbers of every stock size: least price, of those the fewest."""
    most = np.array([np.inf if each.quantity is None else float(each.quantity) for each in stock])
    price = np.array([each.price for each in stock])
    cost = price + 1e-6 * max(float(price.max()), 1.0)
    asked = LinearConstraint(rows, needs * (1 - 1e-9), np.inf)
    whole = np.ones(len(cost), dtype=np.int64)
    found = milp(cost, integrality=whole, bounds=Bounds(np.zeros(len(cost)), most), constraints=asked)
    # Stock that does not suffice was refused before.
    numbers: list[float] = np.asarray(found.x, dtype=np.float64).tolist()
    return [round(number) for number in numbers]


def _bar_rows(members: Sequence[Member], stock: StockSettings) -> Table:
    """Give the table "bars" of the cheapest bars by length, section by section."""
    names = list[str]()
    for section, group in groupby(sorted(members, key=lambda member: member.section), lambda member: member.section):
        bars = [bar for bar in stock.bars if bar.section == section]
        names += _least_bars([*group], bars, stock) if bars else []
    data: dict[str, list[object]] = {
        "bar": [f"B{number:03d}" for number in range(1, len(names) + 1)],
        "stock": [*names],
        "pieces": [0] * len(names),
    }
    return make_table("bars", _blank_beside("bars", data))


def _taken(member: Member, stock: StockSettings) -> float:
    """Length that a member takes of its bar, mm; slanted ends that lie head to tail take half of their slant."""
    if stock.bar_ends == "square" or not member.outline:
        return member.length
    outline = np.array(member.outline)
    return abs(area(outline)) / float(np.ptp(outline[:, 1]))


def _least_bars(members: Sequence[Member], bars: Sequence[BarStock], stock: StockSettings) -> list[str]:
    need = sum((_taken(member, stock) + stock.bar_kerf) * member.quantity for member in members)
    rooms = np.array([[bar.length - 2 * stock.bar_trim + stock.bar_kerf for bar in bars]])
    counts = _least(rooms, np.array([need]), bars)
    return [bar_name(bar.section, bar.length) for bar, count in zip(bars, counts, strict=True) for _ in range(count)]
