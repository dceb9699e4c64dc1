"""Proof that a page can be read: no text on another, none crossed by a line, none off the sheet (failure mode G7)."""

from collections.abc import Iterable

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.documents.shop.font import depth_below, text_width
from isomould.documents.shop.page import Arc, Code, Item, Line, Page, Text

_CHORDS = 24
_SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0], [1, 1], [1, 0], [0, 1]], dtype=float)
_SHARE = {"start": 0.0, "middle": 0.5, "end": 1.0}


def text_box(text: Text) -> Floats:
    """Give the corners (4, 2) of the box of a text, mm."""
    width = text_width(text.text, text.height, bold=text.bold)
    left, low = -_SHARE[text.anchor] * width, -depth_below(text.text, text.height)
    box = np.array([[left, low], [left + width, low], [left + width, text.height], [left, text.height]])
    sine, cosine = np.sin(text.turn), np.cos(text.turn)
    return box @ np.array([[cosine, sine], [-sine, cosine]]) + np.array(text.at)


def clashes(page: Page) -> tuple[str, ...]:
    """Name the texts of a page that overlap another text or a line, or leave the sheet."""
    texts = [item for item in page.items if isinstance(item, Text)]
    boxes = [shapely.Polygon(text_box(text)) for text in texts]
    lines = lines_of(page.items)
    crossing = shapely.STRtree(lines).query(boxes, predicate="intersects")[0].tolist()
    one, other = shapely.STRtree(boxes).query(boxes, predicate="intersects")
    pairs = [(a, b) for a, b in zip(one.tolist(), other.tolist(), strict=True) if a < b]
    outside = np.flatnonzero(~shapely.contains(shapely.box(0, 0, *page.size), boxes)).tolist()
    return (
        *(f"{page.name}: a line crosses {texts[k].text!r} at {texts[k].at}" for k in sorted(set(crossing))),
        *(f"{page.name}: {texts[a].text!r} overlaps {texts[b].text!r} at {texts[b].at}" for a, b in pairs),
        *(f"{page.name}: {texts[k].text!r} leaves the sheet" for k in outside),
    )


def lines_of(items: Iterable[Item]) -> list[shapely.LineString]:
    """Give all lines of a page as geometries; arcs as chords."""
    return [shapely.LineString(points_of(item)) for item in items if not isinstance(item, Text)]


def points_of(item: Line | Arc | Code) -> Floats:
    """Give the points (n, 2) that a line runs through, the first again where it is closed; of an arc, its chords.

    A code is a square with its diagonals, so that no text can lie in it.
    """
    if isinstance(item, Code):
        return np.array(item.at) + item.side * _SQUARE
    if isinstance(item, Line):
        return np.concatenate([item.points, item.points[:1]]) if item.closed else item.points
    angle = np.linspace(item.start, item.end, _CHORDS + 1)
    return np.array(item.centre) + item.radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
