"""V34c: members on stock bars, one kerf apart, every one once, and the offcuts add up."""

from collections import defaultdict

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.read.tables import Table, numbers, pairs, read_table, texts
from isomould.verify.rules import Measured, NotApplicable, Rule, faults, worst_of

ROUNDING = 2e-3
"""Positions, lengths and offcuts are printed to 0.001 mm."""

Piece = tuple[float, float]
"""Position and length, mm."""


def bars(delivery: Delivery) -> Measured:
    """How far pieces fall short of kerf or trim, and bars of one stock differ in what they add up to."""
    table, pieces = _bars(delivery), _pieces(delivery)
    names = texts(table, "bar")
    kerf, trim = (float(delivery.design.raw["nesting"][key]) for key in ("bar_kerf_mm", "bar_trim_mm"))
    short = [_shortfall(pieces.get(name, []), kerf, trim) for name in names]
    counted = np.equal([len(pieces.get(name, [])) for name in names], numbers(table, "pieces"))
    strays = [float("inf") for _ in pieces.keys() - set(names)]
    off = [
        *short,
        *_stock_spread(table, pieces),
        *np.where(counted, 0.0, np.inf),
        *strays,
    ]
    return worst_of(off, [*names, *names, *names, *sorted(pieces.keys() - set(names))])


def _bars(delivery: Delivery) -> Table:
    used = any(texts(delivery.table("member_instances"), "bar"))
    if not used and ("bars" not in delivery.tables or not delivery.tables["bars"].rows):
        raise NotApplicable("no bars in stock")
    return delivery.table("bars")


def _pieces(delivery: Delivery) -> dict[str, list[Piece]]:
    """Give the pieces of every bar from left to right."""
    instances, members = delivery.table("member_instances"), delivery.table("members")
    length = {mark: float(text) for mark, text in pairs(members, "mark", "cut_length_mm").items()}
    found: defaultdict[str, list[Piece]] = defaultdict(list)
    places = zip(texts(instances, "bar"), numbers(instances, "position_mm"), texts(instances, "mark"), strict=True)
    for bar, position, mark in places:
        found[bar].append((float(position), length[mark]))
    return {bar: sorted(pieces) for bar, pieces in found.items()}


def _shortfall(pieces: list[Piece], kerf: float, trim: float) -> float:
    ends = [trim - kerf, *(position + length for position, length in pieces)]
    return max((end + kerf - position for end, (position, _) in zip(ends, pieces, strict=False)), default=0.0)


def _stock_spread(table: Table, pieces: dict[str, list[Piece]]) -> list[float]:
    """Give for every bar how far end of the last piece + offcut is from the first bar of that stock."""
    rows = zip(texts(table, "bar"), texts(table, "stock"), numbers(table, "offcut_mm"), strict=True)
    total = {bar: (stock, sum(pieces.get(bar, [(0.0, 0.0)])[-1]) + offcut) for bar, stock, offcut in rows}
    first = dict(reversed(list(total.values())))
    return [abs(length - first[stock]) for stock, length in total.values()]


def twin(delivery: Delivery) -> Measured:
    """Compare the saw's list `bars/bars.csv` with the table of the schedule, cell by cell."""
    table, path = _bars(delivery), delivery.folder / "bars" / "bars.csv"
    same = read_table(path).columns == table.columns
    return faults(table.rows, [] if same else ["bars/bars.csv differs from tables/bars.csv"])


RULES = (
    Rule("V34c", "bars: kerf, trim and offcuts add up", ROUNDING, "mm", bars),
    Rule("V34d", "the saw's list = schedule", 0, "faults", twin),
)
