"""Members on stock bars, section by section, and the layout that the search for bars makes of them.

`bar_task` says what the search sees of them.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from isomould.errors import Gathering, Refused
from isomould.nesting.bar_bound import BarBound
from isomould.nesting.bar_checker import check_bars
from isomould.nesting.bar_ends import Blank, Laid, lay
from isomould.nesting.bar_rack import cost_of, one_by_one
from isomould.nesting.bar_search import find_bars
from isomould.nesting.bar_task import MILLIONTHS, Kind, Piece, kinds_of, make_task, pieces_of
from isomould.nesting.layout import Bar, BarLayout, Cut, Member, Unplaced
from isomould.nesting.search import Search
from isomould.nesting.settings import BarStock, StockSettings
from isomould.nesting.shapes import UM, round_away
from isomould.nesting.stop import Heard, never

_Plan = tuple[BarStock, list[Piece]]

_Laying = Callable[[tuple[Blank, ...], int], list[Laid]]

_LAID = 1024
"""Orders of pieces that are remembered: bars cut alike are laid once."""


@dataclass(frozen=True)
class _Nested:
    """Bars of one section, pieces without one, and the bound, whose costs are in `unit` millionths."""

    plans: list[_Plan]
    left: list[Piece]
    bound: BarBound
    unit: int
    at_bound: bool


def nest_bars(members: Sequence[Member], stock: StockSettings, task: Search | None = None) -> BarLayout:
    """Nest members on the stock bars of their sections.

    A quick effort leaves out patterns, and bounds by them, where lengths are many; the best is the normal one.

    Returns
    -------
    BarLayout
        Proved by `check_bars`; `bounds` holds for any cutting of the same pieces. `reproducible` is False if the
        task was told to stop before the search had ended.

    Raises
    ------
    Refused
        If a member is longer than every bar of its section.
    """
    refuse_long_members(members, stock)
    sections = list(dict.fromkeys(member.section for member in members))
    task = task or Search()
    heard, nested = Heard(task.should_stop or never), list[_Nested]()
    task = replace(task, should_stop=heard)
    for done, section in enumerate(sections, start=1):
        nested.append(_nest_section(section, members, stock, task))
        found = sum(len(one.plans) for one in nested)
        task.tell(done, len(sections), found, sum(one.bound.bars for one in nested))
    plans = [plan for one in nested for plan in one.plans]
    left = tuple(_unplaced(piece) for one in nested for piece in one.left)
    digits = max(3, len(str(len(plans))))
    laying = lru_cache(_LAID)(lay)
    bars = tuple(_bar(f"B{k:0{digits}}", plan, stock, laying) for k, plan in enumerate(plans, start=1))
    layout = BarLayout(
        bars=bars,
        unplaced=left,
        bounds={section: one.bound.bars for section, one in zip(sections, nested, strict=True)},
        bound_kind="lp" if any(one.bound.kind == "lp" for one in nested) else "area",
        price=sum(bar.price for bar, _ in plans),
        price_bound=sum(_price_bound(one) for one in nested),
        status="incomplete" if left else "complete",
        reproducible=not heard.told or all(one.at_bound for one in nested),
    )
    return _proved(members, stock, layout)


def _price_bound(nested: _Nested) -> float:
    """Give the least price of the bars; 0 without prices."""
    priced = any(bar.price for bar, _ in nested.plans)
    return nested.bound.cost * nested.unit / MILLIONTHS if priced else 0.0


def _nest_section(section: str, members: Sequence[Member], stock: StockSettings, search: Search) -> _Nested:
    kinds = kinds_of(section, stock)
    pieces = [piece for member in members if member.section == section for piece in pieces_of(member, stock)]
    task = make_task(pieces, kinds, stock)
    slanted = any(any(piece.blank.runs) for piece in pieces)
    patterns, bound = find_bars(task.rack, task.need, task.proof, task.fits if slanted else None, search)
    plans = [(kinds[bar.kind].bar, task.take(bar.takes)) for bar in one_by_one(patterns)]
    left = [piece for queue in task.queues for piece in queue]
    at_bound = not left and len(plans) <= bound.fewest and cost_of(task.rack, patterns) <= bound.cost
    return _Nested(plans, left, bound, task.unit, at_bound)


def refuse_long_members(members: Sequence[Member], stock: StockSettings) -> None:
    """Refuse members that are longer than every stock bar of their section: one of each section is named.

    Raises
    ------
    Refused
        E-NEST-20, with the length that is needed and the bars that there are.
    """
    longest: dict[str, Piece] = {}
    for member in members:
        piece = next(pieces_of(member, stock))
        known = longest.get(member.section)
        if known is None or piece.blank.length > known.blank.length:
            longest[member.section] = piece
    with Gathering() as faults:
        for section, piece in longest.items():
            faults.run(_refuse_long, piece, kinds_of(section, stock), section, stock)


def _refuse_long(piece: Piece, kinds: Sequence[Kind], section: str, stock: StockSettings) -> None:
    room = max((kind.room for kind in kinds), default=-1)
    if piece.blank.length > room:
        found = f"needs a bar of {piece.length + 2 * stock.bar_trim:.12g} mm with the trim"
        bars = " or ".join(f"{kind.bar.length:g} mm" for kind in kinds) or "none"
        way_out = "Add a longer bar of this section or divide the member."
        raise Refused("E-NEST-20", f"member {piece.id}", found, f"stock bars of {section}: {bars}", way_out)


def _bar(name: str, plan: _Plan, stock: StockSettings, laying: _Laying) -> Bar:
    bar, pieces = plan
    laid = laying(tuple(piece.blank for piece in pieces), round_away(stock.bar_kerf * UM))
    cuts = tuple(_cut(pieces[one.piece], one, stock.bar_trim) for one in laid)
    end = max(cut.start + cut.length for cut in cuts)
    return Bar(name, bar.section, bar.length, cuts, bar.length - stock.bar_trim - end)


def _cut(piece: Piece, laid: Laid, trim: float) -> Cut:
    return Cut(piece.id, piece.location, trim + laid.start / UM, piece.length, laid.turned)


def _unplaced(piece: Piece) -> Unplaced:
    return Unplaced(piece.id, "no bar is left in stock", (piece.length, 0.0), piece.location)


def _proved(members: Sequence[Member], stock: StockSettings, layout: BarLayout) -> BarLayout:
    findings = check_bars(members, stock, layout)
    if findings:
        message = f"the bars failed their own check ({len(findings)} findings): {findings[0]}"
        raise AssertionError(message)
    return layout
