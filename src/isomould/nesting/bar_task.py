"""Members on stock bars as the search for them sees them: sizes, rooms and costs in whole numbers.

The kerf needs no counting of cuts: every piece is as long as itself and one kerf, and the bar's room one
kerf longer (failure mode F3). Lengths are whole micrometres; pieces round up, bars down. Pieces with slanted ends
are as long as along the middle of the bar, and every bar keeps room for the largest run of an end (`bar_ends`).
"""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import gcd

import numpy as np

from isomould.arrays import Bools, Floats, Ints
from isomould.nesting.bar_bound import Proof
from isomould.nesting.bar_ends import Blank, blank, lay, square, surely_lost
from isomould.nesting.bar_rack import ENDLESS, BarRack, Need
from isomould.nesting.layout import Id, Member
from isomould.nesting.settings import BarStock, StockSettings
from isomould.nesting.shapes import UM, round_away

MILLIONTHS = 1_000_000
"""Costs are whole millionths, so that sums of them are exact."""


@dataclass(frozen=True)
class Piece:
    """A member's piece, `length` mm long, as it is sawn."""

    id: Id
    location: str | None
    length: float
    blank: Blank


@dataclass(frozen=True)
class Kind:
    """A stock bar: `room` in micrometres between its trims, `cost` in millionths of price or else of length."""

    bar: BarStock
    room: int
    cost: int


@dataclass(frozen=True, eq=False)
class Task:
    """What the search gets: pieces of every size (n,), alike in length and runs, and bars of every kind (k,).

    `rack` has sizes that hold for any order of a bar's pieces, `proof` the least sizes that they may take; costs are in
    `unit` millionths, the kerf in micrometres.
    """

    queues: list[deque[Piece]]
    kinds: Sequence[Kind]
    rack: BarRack
    need: Need
    proof: Proof
    unit: int
    kerf: int

    def take(self, takes: Ints) -> list[Piece]:
        """Take pieces of every size (n,) from their queues."""
        return [queue.popleft() for queue, many in zip(self.queues, takes.tolist(), strict=True) for _ in range(many)]

    def fits(self, takes: Ints) -> Bools:
        """Tell of every kind of bar (k,) whether it holds pieces of every size (n,) in their best order."""
        blanks = [queue[0].blank for queue, many in zip(self.queues, takes.tolist(), strict=True) for _ in range(many)]
        end = max(laid.start + blanks[laid.piece].length for laid in lay(blanks, self.kerf))
        return np.array([end <= kind.room for kind in self.kinds], dtype=np.bool_)


def make_task(pieces: Sequence[Piece], kinds: Sequence[Kind], stock: StockSettings) -> Task:
    """Give the search what it sees: lengths along the middle of the bars, and room for the worst order of ends.

    The proof sees what no order can save: the least kerf, and the runs that every bar loses.
    """
    blanks = [piece.blank for piece in pieces]
    reserve = max((abs(run) for this in blanks for run in this.runs), default=0)
    kerf, stretch = stock.bar_kerf * UM, max((this.stretch for this in blanks), default=1.0)
    cut = round_away(kerf * stretch)
    rooms = np.array([kind.room for kind in kinds], dtype=np.int64)
    queues = _queues(pieces)
    sizes = np.array([queue[0].blank.mean + cut for queue in queues], dtype=np.int64)
    counts = np.array([len(queue) for queue in queues], dtype=np.int64)
    unit = gcd(*(kind.cost for kind in kinds))
    costs = np.array([kind.cost // unit for kind in kinds], dtype=np.float64)
    limits = [ENDLESS if kind.bar.quantity is None else kind.bar.quantity for kind in kinds]
    need, longest = Need(counts, np.array(limits, dtype=np.int64)), int(rooms.max(initial=0)) + cut - reserve
    rack = BarRack(np.minimum(sizes, longest), np.maximum(rooms + cut - reserve, 0), costs)
    return Task(queues, kinds, rack, need, _proof(queues, rooms, costs, stock), unit, round_away(kerf))


def _queues(pieces: Sequence[Piece]) -> list[deque[Piece]]:
    """Give the pieces by length and runs, the longest first."""
    queues: dict[tuple[int, int, int], deque[Piece]] = {}
    for piece in sorted(pieces, key=lambda piece: -piece.blank.mean):
        one, other = sorted(map(abs, piece.blank.runs))
        queues.setdefault((piece.blank.mean, one, other), deque()).append(piece)
    return list(queues.values())


def _proof(queues: Sequence[deque[Piece]], rooms: Ints, costs: Floats, stock: StockSettings) -> Proof:
    kerf = int(stock.bar_kerf * UM + 1e-6)
    blanks = [piece.blank for queue in queues for piece in queue]
    straight = min((this.true for this in blanks), default=1.0)
    always = int(straight * min((abs(run) for this in blanks for run in this.runs), default=0))
    sizes = [min(piece.blank.least for piece in queue) + kerf for queue in queues]
    longest = int(rooms.max(initial=0)) + kerf - always
    alike = [size for size, queue in zip(sizes, queues, strict=True) for _ in queue]
    lost = surely_lost(blanks, alike, longest, always) if blanks else 0
    return Proof(BarRack(np.array(sizes, dtype=np.int64), rooms + kerf - always, costs), lost)


def kinds_of(section: str, stock: StockSettings) -> list[Kind]:
    """Give the bars of a section, the longest first; they cost their prices, or without any their lengths."""
    bars = sorted((bar for bar in stock.bars if bar.section == section), key=lambda bar: -bar.length)
    priced = any(bar.price for bar in bars)
    return [Kind(bar, _room(bar, stock), round((bar.price if priced else bar.length) * MILLIONTHS)) for bar in bars]


def _room(bar: BarStock, stock: StockSettings) -> int:
    return int((bar.length - 2 * stock.bar_trim) * UM + 1e-6)


def pieces_of(member: Member, stock: StockSettings) -> Iterator[Piece]:
    """Give the pieces of a member; slanted ends count where they are to lie beside each other."""
    slanted = member.outline and stock.bar_ends == "head-to-tail"
    this = blank(member.outline) if slanted else square(round_away(member.length * UM))
    for location in member.locations or (None,) * member.quantity:
        yield Piece(member.id, location, member.length, this)
