"""Tables on paper: ruled cells as wide as their texts."""

from collections.abc import Sequence

import numpy as np

from isomould.documents.shop.font import text_width
from isomould.documents.shop.page import SMALL, Item, Line, Text

_SIDE = 1.2
"""Room beside a text in its cell, mm."""


def grid_size(rows: Sequence[Sequence[str]], height: float = SMALL) -> tuple[float, float]:
    """Give width and height (mm) of a table of rows of texts; the first row is its heading."""
    return sum(_widths(rows, height)), len(rows) * _pitch(height)


def grid(
    rows: Sequence[Sequence[str]], corner: tuple[float, float], height: float = SMALL, *, heading: bool = True
) -> list[Item]:
    """Draw a table of rows of texts with its upper left corner on paper.

    Numbers stand at the right of their cells, other texts at the left.
    """
    (left, top), pitch, widths = corner, _pitch(height), _widths(rows, height)
    edges = left + np.concatenate([[0.0], np.cumsum(widths)])
    bottom = top - len(rows) * pitch
    rules = [np.array([[x, top], [x, bottom]]) for x in edges.tolist()]
    rules += [np.array([[left, y], [edges[-1], y]]) for y in (top - pitch * np.arange(len(rows) + 1)).tolist()]
    items: list[Item] = [Line("thin", rule) for rule in rules]
    for k, row in enumerate(rows):
        base = top - (k + 1) * pitch + (pitch - height) / 2
        cells = zip(row, edges.tolist(), edges[1:].tolist(), strict=False)
        items += [_cell(text, x, end, base, height, bold=heading and k == 0) for text, x, end in cells if text]
    return items


def _cell(text: str, left: float, right: float, base: float, height: float, *, bold: bool) -> Text:
    if _is_number(text):
        return Text(text, (right - _SIDE, base), height, "end", bold=bold)
    return Text(text, (left + _SIDE, base), height, bold=bold)


def _is_number(text: str) -> bool:
    return text.lstrip("-").replace(".", "", 1).isdigit()


def _pitch(height: float) -> float:
    return 1.8 * height


def _widths(rows: Sequence[Sequence[str]], height: float) -> list[float]:
    """Widths of the columns: the widest text of each, measured bold, which is never narrower for digits and letters."""
    columns = zip(*rows, strict=True)
    return [max(text_width(text, height, bold=True) for text in column) + 2 * _SIDE for column in columns]
