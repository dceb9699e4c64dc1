"""Proves a layout of bars, apart from the search that made it."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np
import shapely

from isomould.nesting.checker import TOLERANCE, Finding
from isomould.nesting.layout import Bar, BarLayout, Cut, Id, Member
from isomould.nesting.settings import StockSettings

_HALF = 1e4
"""Half the depth of a box, mm: deeper than any bar."""

PRICE_TOLERANCE = 1e-6
"""Of sums of prices."""


def check_bars(members: Sequence[Member], stock: StockSettings, layout: BarLayout) -> tuple[Finding, ...]:
    """Prove that a layout cuts the members as asked from the bars in stock; empty if it does."""
    findings = [*_check_quantities(members, layout), *_check_stock(stock, layout), *_check_bounds(stock, layout)]
    asked = {member.id: member for member in members}
    for bar in _cut_differently(layout.bars):
        findings += [*_check_bar(bar, asked, stock), *_check_lengths(bar, asked)]
    return tuple(findings)


def _cut_differently(bars: Sequence[Bar]) -> Iterator[Bar]:
    """Give the first of all bars that are cut alike, piece by piece: what holds for it holds for the others."""
    known = set[object]()
    for bar in bars:
        cuts = tuple((cut.id, cut.start, cut.length, cut.turned) for cut in bar.cuts)
        alike = bar.section, bar.length, bar.rest, cuts
        if alike not in known:
            known.add(alike)
            yield bar


def _check_quantities(members: Sequence[Member], layout: BarLayout) -> Iterator[Finding]:
    pieces = [*(cut for bar in layout.bars for cut in bar.cuts), *layout.unplaced]
    found = Counter(piece.id for piece in pieces)
    asked = Counter({member.id: member.quantity for member in members})
    for mark in sorted((found - asked) + (asked - found), key=str):
        yield Finding("N-BAR-01", f"member {mark}", f"{found[mark]} pieces", f"{asked[mark]}")
    places = Counter((piece.id, piece.location) for piece in pieces if piece.location is not None)
    wanted = Counter((member.id, location) for member in members for location in member.locations)
    for mark, location in sorted((places - wanted) + (wanted - places), key=str):
        yield Finding("N-BAR-02", f"member {mark}", f"location {location} not once", "each once")
    if layout.status == ("complete" if layout.unplaced else "incomplete"):
        yield Finding("N-BAR-03", "status", f"{layout.status}, {len(layout.unplaced)} unplaced", "in agreement")


def _check_stock(stock: StockSettings, layout: BarLayout) -> Iterator[Finding]:
    used = Counter((bar.section, bar.length) for bar in layout.bars)
    rack = {(bar.section, bar.length) for bar in stock.bars}
    for (section, length), count in used.items():
        kinds = [bar.quantity for bar in stock.bars if (bar.section, bar.length) == (section, length)]
        if (section, length) not in rack:
            yield Finding("N-BAR-04", f"bar {section} {length:g} mm", "not in stock", "a bar in stock")
        elif None not in kinds and count > sum(kind or 0 for kind in kinds):
            yield Finding("N-BAR-05", f"bar {section} {length:g} mm", f"{count} used", f"{kinds}")


def _check_bar(bar: Bar, asked: Mapping[Id, Member], stock: StockSettings) -> Iterator[Finding]:
    """Check trims, kerfs and the sum: last end + rest + trim = bar."""
    shapes = [_shape(cut, asked[cut.id].outline if cut.id in asked else ()) for cut in bar.cuts]
    for (one, a), (other, b) in combinations(zip(bar.cuts, shapes, strict=True), 2):
        if abs(other.start - one.start) < max(one.length, other.length) + stock.bar_kerf:
            clear = -1.0 if a.intersection(b).area > TOLERANCE * _HALF else float(a.distance(b))
            if not clear >= stock.bar_kerf - TOLERANCE:
                where = f"bar {bar.id}, {one.id} beside {other.id}"
                yield Finding("N-BAR-06", where, f"{clear:.6f} mm", f"{stock.bar_kerf:g} mm")
    start, end = min(shape.bounds[0] for shape in shapes), max(shape.bounds[2] for shape in shapes)
    if not start >= stock.bar_trim - TOLERANCE:
        yield Finding("N-BAR-06", f"bar {bar.id}", f"starts at {start:.6f} mm", f"{stock.bar_trim:g} mm")
    if not bar.length - end >= stock.bar_trim - TOLERANCE:
        yield Finding("N-BAR-07", f"bar {bar.id}", f"ends at {end:.6f} mm", f"{bar.length - stock.bar_trim:g} mm")
    total = end + bar.rest + stock.bar_trim
    if not abs(total - bar.length) <= TOLERANCE:
        yield Finding("N-BAR-08", f"bar {bar.id}", f"{total:.6f} mm in all", f"{bar.length:g} mm")


def _shape(cut: Cut, outline: Sequence[tuple[float, float]]) -> shapely.Polygon:
    """Give a piece where it lies, its left end at its start; one without an outline is a box."""
    if not outline:
        return shapely.box(cut.start, -_HALF, cut.start + cut.length, _HALF)
    points = np.array(outline)
    if cut.turned in {"end_for_end", "both"}:
        points = -points
    if cut.turned in {"upside_down", "both"}:
        points = points * [1.0, -1.0]
    low, high = points.min(axis=0), points.max(axis=0)
    return shapely.Polygon(points - [low[0] - cut.start, (low[1] + high[1]) / 2])


def _check_lengths(bar: Bar, asked: Mapping[Id, Member]) -> Iterator[Finding]:
    for cut in bar.cuts:
        member = asked.get(cut.id)
        wanted = None if member is None else (member.section, member.length)
        if wanted != (bar.section, cut.length):
            found = f"{bar.section}, {cut.length} mm"
            yield Finding("N-BAR-09", f"bar {bar.id}, {cut.id}", found, f"{wanted}")


def _check_bounds(stock: StockSettings, layout: BarLayout) -> Iterator[Finding]:
    used = Counter(bar.section for bar in layout.bars)
    for section, bound in layout.bounds.items():
        if bound > used[section]:
            yield Finding("N-BAR-10", f"bound of {section}", f"{bound}", f"at most {used[section]} bars used")
    price = sum(_price(stock, bar) for bar in layout.bars)
    if not abs(layout.price - price) <= PRICE_TOLERANCE:
        yield Finding("N-BAR-11", "price of all bars", f"{layout.price}", f"{price}")
    if not layout.price_bound <= layout.price + PRICE_TOLERANCE:
        yield Finding("N-BAR-12", "least price of all bars", f"{layout.price_bound}", f"at most {layout.price}")


def _price(stock: StockSettings, bar: Bar) -> float:
    """Give the price of a bar; 0 if it is not in stock, which is another finding."""
    return next((kind.price for kind in stock.bars if (kind.section, kind.length) == (bar.section, bar.length)), 0.0)
