"""V34c: members on stock bars, one kerf apart, every one once, and the offcuts add up."""

from collections import defaultdict
from itertools import combinations

import numpy as np
import shapely

from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import one_outline
from isomould.verify.read.tables import Table, numbers, read_table, texts
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, faults, worst_of

ROUNDING = 2e-3
"""Positions, lengths and offcuts are printed to 0.001 mm."""

LEAVE = 1e-6
"""Area mm² by which pieces overlap through rounding."""

Piece = shapely.Polygon
"""The outline of a piece where it lies on its bar."""


def bars(delivery: Delivery) -> Measured:
    """How far pieces fall short of kerf or trim, and bars of one stock differ in what they add up to."""
    table, pieces = _bars(delivery), _pieces(delivery)
    names = texts(table, "bar")
    kerf, trim = (float(delivery.nesting[key]) for key in ("bar_kerf_mm", "bar_trim_mm"))
    short = [shortfall(pieces.get(name, []), kerf, trim) for name in names]
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
    """Give the pieces of every bar from left to right, from the part files of the members."""
    instances = delivery.table("member_instances")
    columns = ("bar", "mark", "bar_turned")
    places = zip(*(texts(instances, name) for name in columns), numbers(instances, "position_mm"), strict=True)
    found: defaultdict[str, list[Piece]] = defaultdict(list)
    for bar, mark, turned, position in places:
        if bar:
            found[bar].append(placed(one_outline(delivery.members[mark]).points, turned, float(position)))
    return {bar: sorted(pieces, key=_left) for bar, pieces in found.items()}


def placed(points: Floats, turned: str, position: float) -> Piece:
    """Turn a part and set its left end where it lies on its bar, its middle on that of the bar."""
    facing = points * np.array(_FACING[turned])
    low, high = facing.min(axis=0), facing.max(axis=0)
    return shapely.Polygon(facing - [low[0] - position, (low[1] + high[1]) / 2])


_FACING = {"none": (1, 1), "end_for_end": (-1, -1), "upside_down": (1, -1), "both": (-1, 1)}


def _left(piece: Piece) -> float:
    return float(piece.bounds[0])


def reach(pieces: list[Piece]) -> float:
    """Give where the last piece ends."""
    return max((float(piece.bounds[2]) for piece in pieces), default=0.0)


def shortfall(pieces: list[Piece], kerf: float, trim: float) -> float:
    """Give how far any two pieces fall short of the kerf, or the first of the trim."""
    pairs = ((a, b) for a, b in combinations(pieces, 2) if _left(b) - a.bounds[2] < kerf)
    short = [kerf - float(a.distance(b)) if a.intersection(b).area <= LEAVE else np.inf for a, b in pairs]
    return max([0.0, *(trim - _left(piece) for piece in pieces[:1]), *short])


def _stock_spread(table: Table, pieces: dict[str, list[Piece]]) -> list[float]:
    """Give for every bar how far end of the last piece + offcut is from the first bar of that stock."""
    rows = zip(texts(table, "bar"), texts(table, "stock"), numbers(table, "offcut_mm"), strict=True)
    total = {bar: (stock, reach(pieces.get(bar, [])) + offcut) for bar, stock, offcut in rows}
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
