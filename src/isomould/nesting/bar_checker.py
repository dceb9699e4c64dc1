"""Proves a layout of bars, apart from the search that made it."""

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import pairwise

from isomould.nesting.checker import TOLERANCE, Finding
from isomould.nesting.layout import Bar, BarLayout, Member
from isomould.nesting.settings import StockSettings

PRICE_TOLERANCE = 1e-6
"""Of sums of prices."""


def check_bars(members: Sequence[Member], stock: StockSettings, layout: BarLayout) -> tuple[Finding, ...]:
    """Prove that a layout cuts the members as asked from the bars in stock; empty if it does."""
    findings = [*_check_quantities(members, layout), *_check_stock(stock, layout), *_check_bounds(stock, layout)]
    for bar in layout.bars:
        findings += [*_check_bar(bar, stock), *_check_lengths(bar, members)]
    return tuple(findings)


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


def _check_bar(bar: Bar, stock: StockSettings) -> Iterator[Finding]:
    """Check trims, kerfs and the sum: lengths + kerfs + trims + rest = bar."""
    ends = [stock.bar_trim - stock.bar_kerf, *(cut.start + cut.length for cut in bar.cuts)]
    for end, cut in zip(ends, bar.cuts, strict=False):
        if not cut.start - end >= stock.bar_kerf - TOLERANCE:
            yield Finding("N-BAR-06", f"bar {bar.id}, {cut.id}", f"{cut.start - end:.6f} mm", f"{stock.bar_kerf:g} mm")
    if not bar.length - ends[-1] >= stock.bar_trim - TOLERANCE:
        yield Finding("N-BAR-07", f"bar {bar.id}", f"ends at {ends[-1]:.6f} mm", f"{bar.length - stock.bar_trim:g} mm")
    kerfs = sum(after.start - before.start - before.length for before, after in pairwise(bar.cuts))
    total = sum(cut.length for cut in bar.cuts) + kerfs + 2 * stock.bar_trim + bar.rest
    if not abs(total - bar.length) <= TOLERANCE:
        yield Finding("N-BAR-08", f"bar {bar.id}", f"{total:.6f} mm in all", f"{bar.length:g} mm")


def _check_lengths(bar: Bar, members: Sequence[Member]) -> Iterator[Finding]:
    asked = {member.id: (member.section, member.length) for member in members}
    for cut in bar.cuts:
        if asked.get(cut.id) != (bar.section, cut.length):
            found = f"{bar.section}, {cut.length} mm"
            yield Finding("N-BAR-09", f"bar {bar.id}, {cut.id}", found, f"{asked.get(cut.id)}")


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
