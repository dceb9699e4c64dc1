"""Dimensions along a side of a view: stacked in rows so that no text meets another or an extension line (ISO 129).

A side has its own coordinates on paper: u along what is measured, v away from the view.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats
from isomould.documents.shop.font import text_width
from isomould.documents.shop.page import SMALL, Item, Line, Text, point, reading
from isomould.ties import FINE

FIRST, PITCH = 9.0, 7.0
"""From the side to the first row of dimensions, and from row to row, mm."""
_ARROW, _HALF = 2.5, 0.42
_CLEAR, _GAP, _BEYOND = 0.9, 1.0, 1.5
"""Text above its line; view to extension line; extension line beyond the dimension line."""


@dataclass(frozen=True, eq=False)
class Side:
    """Where a stack of dimensions lies on paper: origin (2,) mm, unit vectors along and away (2,)."""

    origin: Floats
    along: Floats
    away: Floats

    def at(self, u: float, v: float) -> Floats:
        """Give a point (2,) on paper."""
        return self.origin + u * self.along + v * self.away

    @property
    def turn(self) -> float:
        """Direction (rad) of texts, to be read from below or from the right."""
        return reading(float(np.arctan2(self.along[1], self.along[0])))


@dataclass(frozen=True)
class Span:
    """A length to dimension: where it starts and ends along the side (mm on paper), its text, its feet in v."""

    start: float
    end: float
    text: str
    feet: tuple[float, float] = (0.0, 0.0)

    @property
    def length(self) -> float:
        """Length on paper, mm."""
        return self.end - self.start


@dataclass(frozen=True)
class _Placed:
    """A span with the middle of its text, and what both take of the row."""

    span: Span
    middle: float
    low: float
    high: float

    @property
    def inside(self) -> bool:
        return self.span.start < self.middle < self.span.end


def right_of(origin: Floats) -> Side:
    """Give the side that measures upwards, to the right of a view."""
    return Side(origin, np.array([0.0, 1.0]), np.array([1.0, 0.0]))


def left_of(origin: Floats) -> Side:
    """Give the side that measures upwards, to the left of a view."""
    return Side(origin, np.array([0.0, 1.0]), np.array([-1.0, 0.0]))


def above(origin: Floats) -> Side:
    """Give the side that measures to the right, above a view."""
    return Side(origin, np.array([1.0, 0.0]), np.array([0.0, 1.0]))


def below(origin: Floats) -> Side:
    """Give the side that measures to the right, below a view."""
    return Side(origin, np.array([1.0, 0.0]), np.array([0.0, -1.0]))


def stack(side: Side, spans: Iterable[Span], first: float = FIRST, through: Sequence[float] = ()) -> list[Item]:
    """Draw spans in as few rows as keep them apart, the shortest nearest to the view.

    Extension lines of other dimensions pass `through` all rows, at these u; no text stands on them.
    """
    rows = _rows(spans, through)
    return [
        item for k, row in enumerate(rows) for placed in row for item in _dimension(side, placed, first + k * PITCH)
    ]


def ways_to_write(side: Side, span: Span, rows: Iterable[float]) -> Iterator[list[Item]]:
    """Give the ways to draw one span in rows at some distances from the side."""
    return (_dimension(side, placed, v) for v in rows for placed in _ways(span))


def stack_height(spans: Iterable[Span], first: float = FIRST, through: Sequence[float] = ()) -> float:
    """Give how far a stack reaches from its side, mm."""
    return first + (len(_rows(spans, through)) - 1) * PITCH + _CLEAR + SMALL


def _rows(spans: Iterable[Span], through: Sequence[float]) -> list[list[_Placed]]:
    waiting = sorted(spans, key=lambda span: (round(span.length, 6), span.start))
    rows = list[list[_Placed]]()
    while waiting:
        row = _row(waiting, through) or [_forced(waiting[0], waiting, through)]
        taken = {id(placed.span) for placed in row}
        waiting = [span for span in waiting if id(span) not in taken]
        rows.append(row)
    return rows


def _row(waiting: Sequence[Span], through: Sequence[float]) -> list[_Placed]:
    """Fill one row with what fits beside each other; extension lines of all that waits pass through it."""
    row = list[_Placed]()
    for span in waiting:
        lines = [u for other in waiting if other is not span for u in (other.start, other.end)]
        fitting = (placed for placed in _ways(span) if _fits(placed, row, [*lines, *through]))
        row += [placed for placed in [next(fitting, None)] if placed]
    return row


def _ways(span: Span) -> list[_Placed]:
    """Ways to write a span: inside, where text and arrows have room, else to its right or left."""
    width = text_width(span.text, SMALL)
    if span.length >= width + 2 * _ARROW + 1:
        middles = [span.start + share * span.length for share in (0.5, 0.35, 0.65)]
        return [_Placed(span, middle, span.start, span.end) for middle in middles]
    reach = 2 * _ARROW + _GAP
    right, left = span.end + reach + width / 2, span.start - reach - width / 2
    return [
        _Placed(span, right, span.start - reach, right + width / 2 + _GAP),
        _Placed(span, left, left - width / 2 - _GAP, span.end + reach),
    ]


def _fits(placed: _Placed, row: Sequence[_Placed], lines: Sequence[float]) -> bool:
    half = text_width(placed.span.text, SMALL) / 2 + _CLEAR
    crossed = any(abs(u - placed.middle) < half for u in lines)
    return not crossed and all(placed.low >= p.high - 1e-6 or placed.high <= p.low + 1e-6 for p in row)


def _forced(span: Span, waiting: Sequence[Span], through: Sequence[float]) -> _Placed:
    """Write a span to the right of all extension lines, where nothing can be in the way."""
    furthest = max(*through, *(max(other.start, other.end) for other in waiting), span.end)
    middle = furthest + 2 * _ARROW + _GAP + text_width(span.text, SMALL) / 2
    return _Placed(span, middle, span.start, np.inf)


def _dimension(side: Side, placed: _Placed, v: float) -> list[Item]:
    span, width = placed.span, text_width(placed.span.text, SMALL)
    ends = sorted((span.start, span.end, placed.middle - width / 2, placed.middle + width / 2))
    tails = (0.0, 0.0) if placed.inside else (2 * _ARROW, 2 * _ARROW)
    low, high = min(ends[0], span.start - tails[0]), max(ends[-1], span.end + tails[1])
    feet = zip((span.start, span.end), span.feet, strict=True)
    way = 1.0 if placed.inside else -1.0
    return [
        Line("thin", np.array([side.at(low, v), side.at(high, v)])),
        *(Line("thin", np.array([side.at(u, foot + _GAP), side.at(u, v + _BEYOND)])) for u, foot in feet),
        arrow(side.at(span.start, v), way * side.along),
        arrow(side.at(span.end, v), -way * side.along),
        _above_line(side, placed.middle, v, span.text),
    ]


def _above_line(side: Side, u: float, v: float, text: str) -> Text:
    up = np.array([-np.sin(side.turn), np.cos(side.turn)])
    return Text(text, point(side.at(u, v) + _CLEAR * up), SMALL, "middle", side.turn)


def arrow(tip: Floats, back: Floats) -> Line:
    """Give a filled arrowhead whose tip is at (2,) and whose shaft lies in the unit direction `back`."""
    across = _HALF * np.array([-back[1], back[0]])
    foot = tip + _ARROW * back
    return Line("thin", np.array([tip, foot + across, foot - across]), closed=True, filled=True)


def running(side: Side, marks: Sequence[tuple[float, str]], first: float = FIRST, least: float = -np.inf) -> list[Item]:
    """Draw running dimensions from a common origin: a text at the end of every extension line, moved apart.

    Parameters
    ----------
    marks : sequence of (u, text)
        Sorted by u.
    least : float, mm
        Where the first text stands at least, so that those of two sides keep clear of each other at their corner.
    """
    pitch = SMALL + 1.2
    spread = spread_out([u for u, _ in marks], pitch)
    places = [max(place, least + k * pitch) for k, place in enumerate(spread)]
    items = list[Item]()
    for (u, text), place in zip(marks, places, strict=True):
        line = np.array([side.at(u, _GAP), side.at(u, first - 4), side.at(place, first - 1), side.at(place, first)])
        items += [Line("thin", line), _along_line(side, place, first + 0.8, text)]
    return items


def _along_line(side: Side, u: float, v: float, text: str) -> Text:
    """Write a text in the direction away from the view, centred on its extension line."""
    turned = Side(side.origin, side.away, side.along)
    up = np.array([-np.sin(turned.turn), np.cos(turned.turn)])
    reading = np.array([np.cos(turned.turn), np.sin(turned.turn)])
    outwards = float(reading @ side.away) > -FINE
    return Text(text, point(side.at(u, v) - SMALL / 2 * up), SMALL, "start" if outwards else "end", turned.turn)


def spread_out(wanted: Sequence[float], pitch: float) -> list[float]:
    """Move sorted places apart to at least a pitch, each group about its middle.

    >>> spread_out([0.0, 1.0, 20.0], 4.0)
    [-1.5, 2.5, 20.0]
    """
    groups = list[tuple[list[float], float]]()
    for place in wanted:
        members, start = [place], place
        while groups and start < groups[-1][1] + pitch * len(groups[-1][0]):
            members = groups.pop()[0] + members
            start = sum(members) / len(members) - pitch * (len(members) - 1) / 2
        groups.append((members, start))
    return [start + k * pitch for members, start in groups for k in range(len(members))]
