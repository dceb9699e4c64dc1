"""Members on stock bars: what the search for bars gets from sections and members, and the layout that it makes.

The kerf needs no counting of cuts: every piece is as long as itself and one kerf, and the bar's room one
kerf longer (failure mode F3). Lengths are whole micrometres; pieces round up, bars down.
"""

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import gcd

import numpy as np

from isomould.errors import Refused
from isomould.nesting.bar_checker import check_bars
from isomould.nesting.bar_rack import ENDLESS, BarRack, Need
from isomould.nesting.bar_search import BarBound, find_bars
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
    size: int


@dataclass(frozen=True)
class _Kind:
    """A stock bar: `room` in micrometres with one kerf added, `cost` in millionths of price or else of length."""

    bar: BarStock
    room: int
    cost: int


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
    rack, need, unit = _rack(pieces, kinds)
    patterns, bound = find_bars(rack, need)
    queues = {size: deque(piece for piece in pieces if piece.size == size) for size in rack.sizes.tolist()}
    plans = [
        (kinds[p.kind].bar, [queues[size].popleft() for size in np.repeat(rack.sizes, p.takes).tolist()])
        for p in patterns
    ]
    return _Nested(plans, [piece for queue in queues.values() for piece in queue], bound, unit)


def _rack(pieces: Sequence[_Piece], kinds: Sequence[_Kind]) -> tuple[BarRack, Need, int]:
    """Give the search what it sees, and the common unit of its costs in millionths."""
    sizes, counts = np.unique([piece.size for piece in pieces], return_counts=True)
    unit = gcd(*(kind.cost for kind in kinds))
    costs = np.array([kind.cost // unit for kind in kinds], dtype=np.float64)
    limits = [ENDLESS if kind.bar.quantity is None else kind.bar.quantity for kind in kinds]
    rack = BarRack(sizes[::-1].astype(np.int64), np.array([kind.room for kind in kinds], dtype=np.int64), costs)
    return rack, Need(counts[::-1].astype(np.int64), np.array(limits, dtype=np.int64)), unit


def _kinds(section: str, stock: StockSettings) -> list[_Kind]:
    """Give the bars of a section, the longest first; they cost their prices, or without any their lengths."""
    bars = sorted((bar for bar in stock.bars if bar.section == section), key=lambda bar: -bar.length)
    priced = any(bar.price for bar in bars)
    return [_Kind(bar, _room(bar, stock), round((bar.price if priced else bar.length) * MILLIONTHS)) for bar in bars]


def _room(bar: BarStock, stock: StockSettings) -> int:
    return int((bar.length - 2 * stock.bar_trim + stock.bar_kerf) * UM + 1e-6)


def _pieces(member: Member, stock: StockSettings) -> Iterator[_Piece]:
    size = round_away((member.length + stock.bar_kerf) * UM)
    for location in member.locations or (None,) * member.quantity:
        yield _Piece(member.id, location, member.length, size)


def _refuse_long(pieces: Iterable[_Piece], kinds: Sequence[_Kind], section: str, stock: StockSettings) -> None:
    longest = max((kind.room for kind in kinds), default=0)
    for piece in pieces:
        if piece.size > longest:
            found = f"needs a bar of {piece.length + 2 * stock.bar_trim:g} mm with the trim"
            bars = " or ".join(f"{kind.bar.length:g} mm" for kind in kinds) or "none"
            way_out = "Add a longer bar of this section or divide the member."
            raise Refused("E-NEST-20", f"member {piece.id}", found, f"stock bars of {section}: {bars}", way_out)


def _bar(name: str, plan: _Plan, stock: StockSettings) -> Bar:
    bar, pieces = plan
    cuts = tuple(_cuts(pieces, stock))
    end = cuts[-1].start + cuts[-1].length
    return Bar(name, bar.section, bar.length, cuts, bar.length - stock.bar_trim - end)


def _cuts(pieces: Iterable[_Piece], stock: StockSettings) -> Iterator[Cut]:
    start = stock.bar_trim
    for piece in pieces:
        yield Cut(piece.id, piece.location, start, piece.length)
        start += piece.length + stock.bar_kerf


def _unplaced(piece: _Piece) -> Unplaced:
    return Unplaced(piece.id, "no bar is left in stock", (piece.length, 0.0), piece.location)


def _proved(members: Sequence[Member], stock: StockSettings, layout: BarLayout) -> BarLayout:
    findings = check_bars(members, stock, layout)
    if findings:
        message = f"the bars failed their own check ({len(findings)} findings): {findings[0]}"
        raise AssertionError(message)
    return layout
