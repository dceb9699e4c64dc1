"""Panels on sheets and members on bars: what the nesting room gets from the parts, and what comes back."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import cast

import numpy as np

from isomould.arrays import Floats, Ints, round_um
from isomould.documents.schedules import OnBar, Placed
from isomould.errors import Gathering, Note, Refused
from isomould.form.mesh import Mesh
from isomould.nesting.assembly import yield_percent
from isomould.nesting.bars import nest_bars, refuse_long_members
from isomould.nesting.layout import BarLayout, Layout, Member, Part, Unplaced
from isomould.nesting.nest import nest_blanks, nest_sheets, refuse_unnestable
from isomould.nesting.scarcity import refuse_scarce_bars, refuse_scarce_sheets
from isomould.nesting.search import Search
from isomould.nesting.settings import StockSettings
from isomould.parts.catalogue import PlateSection
from isomould.parts.kit import Kit
from isomould.parts.members import MemberParts, MemberShape
from isomould.parts.panels import PanelParts
from isomould.workers import Spread

_NO_WASTE, _MUCH_WASTE = 1e-6, 60.0
"""Per cent of the sheets that are bought."""


@dataclass(frozen=True, eq=False)
class Cutting:
    """Layouts of panels and members; `bars` is None without bars in stock."""

    stock: StockSettings
    sheets: Layout
    bars: BarLayout | None

    @property
    def notes(self) -> tuple[Note, ...]:
        """What should be known about the layouts."""
        return weigh_waste(self.sheets.yield_percent) if self.stock.sheets else ()

    @property
    def placed(self) -> dict[str, Placed]:
        """Sheet and place of every panel location."""
        return {
            str(p.location): Placed(
                p.sheet, float(p.points[0, 0]), float(p.points[0, 1]), p.rotation_deg, p.turned_over
            )
            for p in self.sheets.placements
        }

    @property
    def positions(self) -> dict[str, OnBar]:
        """Bar, distance from its left end and turning of every member location."""
        bars = self.bars.bars if self.bars else ()
        return {str(cut.location): OnBar(bar.id, cut.start, cut.turned) for bar in bars for cut in bar.cuts}


def weigh_waste(yield_percent: float) -> tuple[Note, ...]:
    """Note a waste of stock sheets that smells of a mistaken unit: none at all, or most of them (failure mode F8).

    >>> [len(weigh_waste(percent)) for percent in (100.0, 85.0, 40.0, 39.0)]
    [1, 0, 0, 1]
    """
    waste = 100.0 - yield_percent
    if _NO_WASTE < waste <= _MUCH_WASTE:
        return ()
    text = f"{waste:.1f} % of the sheets is waste; are the units of sheets and surface right?"
    return (Note("W-NEST-WASTE", "stock.sheets", text),)


def nest_kit(kit: Kit, stock: StockSettings | None, task: Search, spread: Spread) -> Cutting:
    """Nest all panels and members; without stock sheets every row gets blanks to order of its own.

    Raises
    ------
    Refused
        If a part fits no sheet or bar, or the stock does not suffice.
    """
    stock = stock or StockSettings()
    parts, members = panel_parts(kit.panels, kit.mesh), member_parts(kit.members)
    refuse_stock(kit, stock)
    work = [
        _panel_work(parts, stock, task),
        *([partial(nest_bars, members, stock, Search(task.effort))] if stock.bars else []),
    ]
    sheets, *rest = spread(_run, work)
    bars = cast("BarLayout", rest[0]) if rest else None
    refuse_unplaced(sheets.unplaced, "stock.sheets")
    refuse_unplaced(bars.unplaced if bars else (), "stock.bars")
    return Cutting(stock, _with_chamfers(kit, cast("Layout", sheets)), bars)


def refuse_stock(kit: Kit, stock: StockSettings) -> None:
    """Refuse stock that cannot hold the parts, as far as this is known without a search.

    Raises
    ------
    Refused
        For sheets and bars together.
    """
    with Gathering() as faults:
        faults.run(refuse_sheets, panel_parts(kit.panels, kit.mesh), stock)
        faults.run(refuse_bars, member_parts(kit.members), stock)


def refuse_sheets(parts: Sequence[Part], stock: StockSettings) -> None:
    """Refuse stock that cannot hold the panels, as far as this is known without a search.

    Raises
    ------
    Refused
        If a panel fits no sheet or blank, cannot be scored free, or all of them need more area than there is.
    """
    refuse_unnestable(parts, _face_up(stock))
    refuse_scarce_sheets(parts, _face_up(stock))


def refuse_bars(members: Sequence[Member], stock: StockSettings) -> None:
    """Refuse bars that cannot hold the members, as far as this is known without a search.

    Raises
    ------
    Refused
        If a member is longer than all bars of its section, or all of them than the bars together.
    """
    if stock.bars:
        refuse_long_members(members, stock)
        refuse_scarce_bars(members, stock)


def _face_up(stock: StockSettings) -> StockSettings:
    """Give stock on which panels lie face up: what is fixed to them has its side."""
    return stock.model_copy(update={"turn_over": False})


def _with_chamfers(kit: Kit, layout: Layout) -> Layout:
    """Cut the corners off the panels where they were placed: they are nested uncut."""
    parts = dict(zip(kit.panels.marks, zip(kit.panels.blanks, kit.panels.outlines, strict=True), strict=True))
    cut = {mark: both for mark, both in parts.items() if len(both[0]) != len(both[1])}
    if not cut:
        return layout
    placed = tuple(
        replace(p, points=_placed(p.points, *cut[str(p.id)], turned_over=p.turned_over)) if str(p.id) in cut else p
        for p in layout.placements
    )
    return replace(layout, placements=placed, yield_percent=yield_percent(layout.sheets, placed))


def _placed(points: Floats, blank: Floats, outline: Floats, *, turned_over: bool) -> Floats:
    """Place an outline (n, 2) as its blank was, whose first side tells the quarter turn."""
    x = np.round((points[1] - points[0]) / blank[1, 0])
    y = np.array([-x[1], x[0]]) * (-1.0 if turned_over else 1.0)
    return round_um(points[0] + outline @ np.stack([x, y]))


def _run(work: Callable[[], Layout | BarLayout]) -> Layout | BarLayout:
    return work()


def refuse_unplaced(unplaced: Sequence[Unplaced], field: str) -> None:
    """Refuse layouts that leave parts out: nothing is dropped."""
    if not unplaced:
        return
    first = unplaced[0]
    raise Refused(
        "E-STOCK",
        field,
        f"{len(unplaced)} pieces find no place, the first is {first.id} ({first.reason})",
        f"room for {first.needs[0]:.3f} x {first.needs[1]:.3f} mm and as many sheets or bars as the parts need",
        "Add stock of that size, or raise its quantity.",
    )


def _where(kit_locations: tuple[str, ...], of: Ints, count: int) -> list[tuple[str, ...]]:
    """Locations of every class, in order."""
    found: list[list[str]] = [[] for _ in range(count)]
    for location, number in zip(kit_locations, of.tolist(), strict=True):
        found[number].append(location)
    return [tuple(names) for names in found]


def panel_parts(panels: PanelParts, mesh: Mesh) -> tuple[Part, ...]:
    """Give the panels as the nesting room sees them, one per class."""
    rows = mesh.face_ij[panels.classes.representative, 0].tolist()
    where = _where(panels.locations, panels.classes.of, len(panels.marks))
    return tuple(
        Part(mark, outline, len(places), row, places)
        for mark, outline, row, places in zip(panels.marks, panels.blanks, rows, where, strict=True)
    )


def member_parts(members: MemberParts) -> tuple[Member, ...]:
    """Give the members as the nesting room sees them, one per class."""
    where = _where(members.locations, members.classes.of, len(members.marks))
    return tuple(
        Member(mark, shape.section.name, shape.cut_length, len(places), places, _flat(shape))
        for mark, shape, places in zip(members.marks, members.shapes, where, strict=True)
    )


def _flat(shape: MemberShape) -> tuple[tuple[float, float], ...]:
    """Give the outline of a plate as wide as its bar, from x = 0; nothing of others, which are cut square."""
    points = round_um(shape.outline - [shape.outline[:, 0].min(), 0.0])
    if not isinstance(shape.section, PlateSection) or np.ptp(points[:, 1]) != shape.section.depth:
        return ()
    return tuple((float(x), float(y)) for x, y in points)


def _panel_work(parts: tuple[Part, ...], stock: StockSettings, task: Search) -> Callable[[], Layout]:
    stock = _face_up(stock)
    return partial(nest_sheets, parts, stock, task) if stock.sheets else partial(nest_blanks, parts, stock)
