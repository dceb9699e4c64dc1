"""Members on stock bars: what the search for bars gets from sections and members, and the layout that it makes.

The kerf needs no counting of cuts: every piece is as long as itself and one kerf, and the bar's room one
kerf longer (failure mode F3). Lengths are whole micrometres; pieces round up, bars down. Pieces with slanted ends
are as long as along the middle of the bar, and every bar keeps room for the largest run of an end (`bar_ends`).
"""

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import gcd

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.errors import Refused
from isomould.nesting.bar_bound import BarBound, Proof
from isomould.nesting.bar_checker import check_bars
from isomould.nesting.bar_ends import Blank, blank, lay, square, surely_lost
from isomould.nesting.bar_rack import ENDLESS, BarRack, Need
from isomould.nesting.bar_search import find_bars
from isomould.nesting.layout import Bar, BarLayout, Cut, Id, Member, Unplaced
from isomould.nesting.settings import BarStock, StockSettings
from isomould.nesting.shapes import UM, round_away

MILLIONTHS = 1_000_000
"""Costs are whole millionths, so that sums of them are exact."""


@dataclass(frozen=True)
class _Piece:
    id: Id
    location: str | None
    length: float
    blank: Blank


@dataclass(frozen=True)
class _Kind:
    """A stock bar: `room` in micrometres between its trims, `cost` in millionths of price or else of length."""

    bar: BarStock
    room: int
    cost: int


@dataclass(frozen=True, eq=False)
class _Task:
    """What the search gets: sizes (n,) and pieces by size, a rack and a need; `unit` of its costs in millionths."""

    queues: dict[int, deque[_Piece]]
    rack: BarRack
    need: Need
    proof: Proof
    unit: int


_Plan = tuple[BarStock, list[_Piece]]


@dataclass(frozen=True)
class _Nested:
    """Bars of one section, pieces without one, and the bound, whose costs are in `unit` millionths."""

    plans: list[_Plan]
    left: list[_Piece]
    bound: BarBound
    unit: int


def nest_bars(members: Sequence[Member], stock: StockSettings) -> BarLayout:
    """Nest members on the stock bars of their sections.

    Returns
    -------
    BarLayout
        Proved by `check_bars`; `bounds` holds for any cutting of the same pieces.

    Raises
    ------
    Refused
        If a member is longer than every bar of its section.
    """
    sections = list(dict.fromkeys(member.section for member in members))
    nested = [_nest_section(section, members, stock) for section in sections]
    plans = [plan for one in nested for plan in one.plans]
    left = tuple(_unplaced(piece) for one in nested for piece in one.left)
    bars = tuple(_bar(f"B{k + 1:0{max(3, len(str(len(plans))))}}", plan, stock) for k, plan in enumerate(plans))
    layout = BarLayout(
        bars=bars,
        unplaced=left,
        bounds={section: one.bound.bars for section, one in zip(sections, nested, strict=True)},
        bound_kind="lp" if any(one.bound.kind == "lp" for one in nested) else "area",
        price=sum(bar.price for bar, _ in plans),
        price_bound=sum(_price_bound(one) for one in nested),
        status="incomplete" if left else "complete",
    )
    return _proved(members, stock, layout)


def _price_bound(nested: _Nested) -> float:
    """Give the least price of the bars; 0 without prices."""
    priced = any(bar.price for bar, _ in nested.plans)
    return nested.bound.cost * nested.unit / MILLIONTHS if priced else 0.0


def _nest_section(section: str, members: Sequence[Member], stock: StockSettings) -> _Nested:
    kinds = _kinds(section, stock)
    pieces = [piece for member in members if member.section == section for piece in _pieces(member, stock)]
    _refuse_long(pieces, kinds, section, stock)
    task = _task(pieces, kinds, stock)
    patterns, bound = find_bars(task.rack, task.need, task.proof)
    plans = [
        (kinds[p.kind].bar, [task.queues[size].popleft() for size in np.repeat(task.rack.sizes, p.takes).tolist()])
        for p in patterns
    ]
    return _Nested(plans, [piece for queue in task.queues.values() for piece in queue], bound, task.unit)


def _task(pieces: Sequence[_Piece], kinds: Sequence[_Kind], stock: StockSettings) -> _Task:
    """Give the search what it sees: lengths along the middle of the bars, and room for the worst order of ends.

    The proof sees what no order can save: the least kerf, and the runs that every bar loses.
    """
    runs = [abs(run) for piece in pieces for run in piece.blank.runs]
    cut = round_away(stock.bar_kerf * UM * max((piece.blank.stretch for piece in pieces), default=1.0))
    rooms = np.array([kind.room for kind in kinds], dtype=np.int64)
    reserve = max(runs, default=0)
    queues: dict[int, deque[_Piece]] = {}
    for piece in sorted(pieces, key=lambda piece: -piece.blank.mean):
        queues.setdefault(min(piece.blank.mean + cut, int(rooms[0]) + cut - reserve), deque()).append(piece)
    unit = gcd(*(kind.cost for kind in kinds))
    costs = np.array([kind.cost // unit for kind in kinds], dtype=np.float64)
    limits = [ENDLESS if kind.bar.quantity is None else kind.bar.quantity for kind in kinds]
    need = Need(np.array([len(queue) for queue in queues.values()]), np.array(limits, dtype=np.int64))
    rack = BarRack(np.array(list(queues), dtype=np.int64), np.maximum(rooms + cut - reserve, 0), costs)
    return _Task(queues, rack, need, _proof(queues, rooms, costs, stock), unit)


def _proof(queues: dict[int, deque[_Piece]], rooms: Ints, costs: Floats, stock: StockSettings) -> Proof:
    kerf = int(stock.bar_kerf * UM + 1e-6)
    blanks = [piece.blank for queue in queues.values() for piece in queue]
    straight = min((this.true for this in blanks), default=1.0)
    always = int(straight * min((abs(run) for this in blanks for run in this.runs), default=0))
    sizes = [min(piece.blank.least for piece in queue) + kerf for queue in queues.values()]
    longest = int(rooms.max(initial=0)) + kerf - always
    alike = [size for size, queue in zip(sizes, queues.values(), strict=True) for _ in queue]
    lost = surely_lost(blanks, alike, longest, always) if blanks else 0
    return Proof(BarRack(np.array(sizes, dtype=np.int64), rooms + kerf - always, costs), lost)


def _kinds(section: str, stock: StockSettings) -> list[_Kind]:
    """Give the bars of a section, the longest first; they cost their prices, or without any their lengths."""
    bars = sorted((bar for bar in stock.bars if bar.section == section), key=lambda bar: -bar.length)
    priced = any(bar.price for bar in bars)
    return [_Kind(bar, _room(bar, stock), round((bar.price if priced else bar.length) * MILLIONTHS)) for bar in bars]


def _room(bar: BarStock, stock: StockSettings) -> int:
    return int((bar.length - 2 * stock.bar_trim) * UM + 1e-6)


def _pieces(member: Member, stock: StockSettings) -> Iterator[_Piece]:
    slanted = member.outline and stock.bar_ends == "head-to-tail"
    this = blank(member.outline) if slanted else square(round_away(member.length * UM))
    for location in member.locations or (None,) * member.quantity:
        yield _Piece(member.id, location, member.length, this)


def _refuse_long(pieces: Iterable[_Piece], kinds: Sequence[_Kind], section: str, stock: StockSettings) -> None:
    longest = max((kind.room for kind in kinds), default=-1)
    for piece in pieces:
        if piece.blank.length > longest:
            found = f"needs a bar of {piece.length + 2 * stock.bar_trim:g} mm with the trim"
            bars = " or ".join(f"{kind.bar.length:g} mm" for kind in kinds) or "none"
            way_out = "Add a longer bar of this section or divide the member."
            raise Refused("E-NEST-20", f"member {piece.id}", found, f"stock bars of {section}: {bars}", way_out)


def _bar(name: str, plan: _Plan, stock: StockSettings) -> Bar:
    bar, pieces = plan
    cuts = tuple(_cuts(pieces, stock))
    end = max(cut.start + cut.length for cut in cuts)
    return Bar(name, bar.section, bar.length, cuts, bar.length - stock.bar_trim - end)


def _cuts(pieces: Sequence[_Piece], stock: StockSettings) -> Iterator[Cut]:
    for laid in lay([piece.blank for piece in pieces], round_away(stock.bar_kerf * UM)):
        piece = pieces[laid.piece]
        start = stock.bar_trim + laid.start / UM
        yield Cut(piece.id, piece.location, start, piece.length, laid.turned)


def _unplaced(piece: _Piece) -> Unplaced:
    return Unplaced(piece.id, "no bar is left in stock", (piece.length, 0.0), piece.location)


def _proved(members: Sequence[Member], stock: StockSettings, layout: BarLayout) -> BarLayout:
    findings = check_bars(members, stock, layout)
    if findings:
        message = f"the bars failed their own check ({len(findings)} findings): {findings[0]}"
        raise AssertionError(message)
    return layout
