"""Members on stock bars: first fit decreasing, and the largest first with exact subset sums behind it.

The kerf needs no counting of cuts: every piece is as long as itself and one kerf, and the bar's room one
kerf longer (failure mode F3). Lengths are whole micrometres; pieces round up, bars down.
"""

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import gcd

import numpy as np

from isomould.arrays import Ints
from isomould.errors import Refused
from isomould.nesting.bar_checker import check_bars
from isomould.nesting.bar_columns import Demand, find_patterns, worth_trying
from isomould.nesting.layout import Bar, BarLayout, Cut, Id, Member, Unplaced
from isomould.nesting.settings import BarStock, StockSettings
from isomould.nesting.shapes import UM, round_away

FINEST = 60_000
"""Steps into which a bar is divided at most for subset sums, unless a common divisor makes fewer exact."""

PLENTY = 2**40


@dataclass(frozen=True)
class _Piece:
    id: Id
    location: str | None
    length: float
    size: int


@dataclass(frozen=True)
class _Kind:
    """A stock bar: `room` in micrometres with one kerf added, `cost` by price or else by length."""

    bar: BarStock
    room: int
    cost: float


_Plan = tuple[_Kind, list[_Piece]]


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
    results = [_nest_section(section, members, stock) for section in sections]
    plans = [plan for kept, _, _ in results for plan in kept]
    left = tuple(_unplaced(piece) for _, rest, _ in results for piece in rest)
    bars = tuple(_bar(f"B{k + 1:0{max(3, len(str(len(plans))))}}", plan, stock) for k, plan in enumerate(plans))
    bounds = {section: bound for section, (_, _, bound) in zip(sections, results, strict=True)}
    layout = BarLayout(bars, left, bounds, "area", "incomplete" if left else "complete")
    return _proved(members, stock, layout)


def _nest_section(
    section: str, members: Sequence[Member], stock: StockSettings
) -> tuple[list[_Plan], list[_Piece], int]:
    kinds = _kinds(section, stock)
    pieces = [piece for member in members if member.section == section for piece in _pieces(member, stock)]
    _refuse_long(pieces, kinds, section, stock)
    pieces.sort(key=lambda piece: -piece.size)
    plans, bound = _best(pieces, kinds)
    placed = {id(piece) for _, used in plans for piece in used}
    left = [piece for piece in pieces if id(piece) not in placed]
    return plans, left, _bound([piece for piece in pieces if id(piece) in placed], kinds) if left else bound


def _best(pieces: list[_Piece], kinds: Sequence[_Kind]) -> tuple[list[_Plan], int]:
    """Try one method after the other until the bound is met; give the best bars and the bound."""
    bound = _bound(pieces, kinds)
    plans = min((pack(pieces, kinds) for pack in (_first_fit, _largest_first)), key=_merit)
    if len(plans) == bound or not _patterns_pay(pieces, kinds):
        return plans, bound
    patterned, proved = _by_patterns(pieces, plans, kinds[0])
    return min(plans, patterned, key=_merit), max(bound, proved)


def _patterns_pay(pieces: Sequence[_Piece], kinds: Sequence[_Kind]) -> bool:
    """Patterns are for one kind of bar without limit."""
    return len(kinds) == 1 and kinds[0].bar.quantity is None and worth_trying([piece.size for piece in pieces])


def _by_patterns(pieces: list[_Piece], plans: list[_Plan], kind: _Kind) -> tuple[list[_Plan], int]:
    """Improve first plans of all pieces by patterns."""
    sizes, counts = np.unique([piece.size for piece in pieces], return_counts=True)
    known = [np.bincount(np.searchsorted(sizes, [p.size for p in used]), minlength=len(sizes)) for _, used in plans]
    patterns, bound = find_patterns(Demand(sizes, counts, kind.room), np.stack(known, axis=1))
    queues = {int(size): deque(piece for piece in pieces if piece.size == size) for size in sizes}
    cut = [
        [int(size) for size, count in zip(sizes, pattern, strict=True) for _ in range(count)] for pattern in patterns
    ]
    return [(kind, [queues[size].popleft() for size in reversed(row)]) for row in cut], bound


def _merit(plans: list[_Plan]) -> tuple[int, float]:
    """More pieces, then less cost."""
    return -sum(len(used) for _, used in plans), sum(kind.cost for kind, _ in plans)


def _kinds(section: str, stock: StockSettings) -> list[_Kind]:
    """Give the bars of a section, the longest first."""
    bars = sorted((bar for bar in stock.bars if bar.section == section), key=lambda bar: -bar.length)
    priced = all(bar.price for bar in bars)
    return [_Kind(bar, _room(bar, stock), bar.price if priced else bar.length) for bar in bars]


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


def _first_fit(pieces: list[_Piece], kinds: Sequence[_Kind]) -> list[_Plan]:
    """Put every piece, the longest first, on the first bar with room; a new bar is the longest left."""
    plans: list[_Plan] = []
    rooms: list[int] = []
    for piece in pieces:
        index = next((k for k, room in enumerate(rooms) if room >= piece.size), None)
        kind = next((kind for kind in _in_stock(kinds, plans) if kind.room >= piece.size), None)
        if index is None and kind is not None:
            index = len(plans)
            plans.append((kind, []))
            rooms.append(kind.room)
        if index is not None:
            plans[index][1].append(piece)
            rooms[index] -= piece.size
    return plans


def _largest_first(pieces: list[_Piece], kinds: Sequence[_Kind]) -> list[_Plan]:
    """Put the longest piece left on a bar and fill the rest of it by an exact subset sum."""
    plans: list[_Plan] = []
    left = list(pieces)
    step = _step(pieces, kinds)
    while left and (
        choices := [_fill(left, kind, step) for kind in _in_stock(kinds, plans) if kind.room >= left[0].size]
    ):
        best = min(choices, key=lambda plan: plan[0].cost / sum(piece.size for piece in plan[1]))
        plans.append(best)
        used = {id(piece) for piece in best[1]}
        left = [piece for piece in left if id(piece) not in used]
    return plans


def _in_stock(kinds: Sequence[_Kind], plans: Sequence[_Plan]) -> list[_Kind]:
    return [kind for kind in kinds if kind.bar.quantity is None or _used(kind, plans) < kind.bar.quantity]


def _used(kind: _Kind, plans: Sequence[_Plan]) -> int:
    return sum(1 for other, _ in plans if other is kind)


def _step(pieces: Sequence[_Piece], kinds: Sequence[_Kind]) -> int:
    """Give the grid of the subset sums: exact if the sizes have a common divisor that is coarse enough."""
    exact = gcd(*(piece.size for piece in pieces))
    return max(exact, -(-max(kind.room for kind in kinds) // FINEST))


def _fill(left: Sequence[_Piece], kind: _Kind, step: int) -> _Plan:
    """Fill one bar: bit k of a reach is set if the pieces so far can fill k steps exactly."""
    room = (kind.room - left[0].size) // step
    mask = (1 << (room + 1)) - 1
    reaches = [1]
    for piece in left[1:]:
        reaches.append(reaches[-1] | (reaches[-1] << -(-piece.size // step)) & mask)
        if reaches[-1] >> room:
            break
    return kind, [left[0], *_trace(left[1 : len(reaches)], reaches, step)]


def _trace(pieces: Sequence[_Piece], reaches: Sequence[int], step: int) -> Iterator[_Piece]:
    target = reaches[-1].bit_length() - 1
    for piece, before in zip(reversed(pieces), reversed(reaches[:-1]), strict=True):
        if not before >> target & 1:
            yield piece
            target -= -(-piece.size // step)


def _bound(pieces: Sequence[_Piece], kinds: Sequence[_Kind]) -> int:
    """Bound the number of bars by length, long pieces counted apart (Martello and Toth, bound L2)."""
    room = max((kind.room for kind in kinds), default=1)
    sizes = np.array([piece.size for piece in pieces], dtype=np.int64)
    limits = np.unique(np.append(sizes[2 * sizes <= room], 0))
    return max(_bound_from(sizes, room, int(limit)) for limit in limits)


def _bound_from(sizes: Ints, room: int, limit: int) -> int:
    """Count pieces above room - limit as full bars, leave out those below limit, spread the others."""
    alone = int(np.count_nonzero(sizes > room - limit))
    large = sizes[(2 * sizes > room) & (sizes <= room - limit)]
    small = int(sizes[(sizes >= limit) & (2 * sizes <= room)].sum())
    over = small - (len(large) * room - int(large.sum()))
    return alone + len(large) + max(-(-over // room), 0)


def _bar(name: str, plan: _Plan, stock: StockSettings) -> Bar:
    kind, pieces = plan
    cuts = tuple(_cuts(pieces, stock))
    end = cuts[-1].start + cuts[-1].length
    return Bar(name, kind.bar.section, kind.bar.length, cuts, kind.bar.length - stock.bar_trim - end)


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
