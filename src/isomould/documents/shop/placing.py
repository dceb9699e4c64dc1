"""Finding room for texts: the first of some places where a text meets nothing that is drawn already."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from isomould.arrays import Bools, Floats
from isomould.documents.shop.checks import points_of, text_box
from isomould.documents.shop.dimensions import arrow
from isomould.documents.shop.font import depth_below, text_width
from isomould.documents.shop.page import SMALL, Item, Line, Text, point, unit

_LEAST = 1e-12
_BEYOND = 0.8
"""From the end of a leader to its text, mm."""

Waiting = tuple[str, Floats]
"""A text that found no room yet, and the point (2,) that it speaks of."""
Wish = tuple[str, Floats, Iterable[Text]]
"""A text, the point (2,) that it speaks of, and places for it, the best first."""

_AROUND = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]])
"""Sides and diagonals of a box: whatever overlaps it meets one of them, or lies in one of its four small triangles."""

_CLEAR = 0.5
"""What texts keep from everything, mm."""
_REACHES = (*range(6, 30, 3), *range(30, 150, 6))
_TURNS = np.radians([60, 120, -60, -120, 30, 150, -30, -150, 15, 165, -15, -165, 75, 105, -75, -105, 0, 180]).tolist()
"""How far leaders reach, mm, and where they point: lines that lean are told from the others."""


def segments(items: Iterable[Item]) -> Floats:
    """Give all lines of items as segments (n, 2, 2); texts as the sides and diagonals of their boxes."""
    found = [_segments(item) for item in items]
    return np.concatenate(found) if found else np.empty((0, 2, 2))


def _segments(item: Item) -> Floats:
    if isinstance(item, Text):
        return text_box(item)[_AROUND]
    points = points_of(item)
    return np.stack([points[:-1], points[1:]], axis=1)


def free_text(candidates: Iterable[Text], taken: Floats, clear: float = _CLEAR) -> Text | None:
    """Give the first candidate that keeps `clear` mm from segments (n, 2, 2), or None."""
    return next((text for text in candidates if not meets(text, taken, clear).any()), None)


def meets(text: Text, taken: Floats, clear: float) -> Bools:
    """Tell which segments (n, 2, 2) come nearer to the box of a text than `clear`: clipped by its slabs."""
    low = np.array([-clear - _before(text), -clear - depth_below(text.text, text.height)])
    high = np.array([text_width(text.text, text.height, bold=text.bold) - _before(text) + clear, text.height + clear])
    sine, cosine = np.sin(text.turn), np.cos(text.turn)
    local = (taken - np.array(text.at)) @ np.array([[cosine, -sine], [sine, cosine]])
    start, way = local[:, 0], local[:, 1] - local[:, 0]
    way = np.where(np.abs(way) < _LEAST, _LEAST, way)
    one, other = (low - start) / way, (high - start) / way
    enter, leave = np.minimum(one, other).max(axis=1), np.maximum(one, other).min(axis=1)
    return np.maximum(enter, 0.0) <= np.minimum(leave, 1.0)


def _before(text: Text) -> float:
    share = {"start": 0.0, "middle": 0.5, "end": 1.0}[text.anchor]
    return share * text_width(text.text, text.height, bold=text.bold)


def place_all(ways: Iterable[Iterable[Text]], items: Iterable[Item], clear: float = _CLEAR) -> list[Text]:
    """Place one text after the other, each at the first of its ways that is free; those that find none are left out."""
    taken, found = segments(items), list[Text]()
    for way in ways:
        text = free_text(way, taken, clear)
        if text:
            found.append(text)
            taken = np.concatenate([taken, segments([text])])
    return found


def place_or_wait(
    wishes: Iterable[Wish], items: Iterable[Item], clear: float = _CLEAR
) -> tuple[list[Text], list[Waiting]]:
    """Place one text after the other, each at the first of its places that is free.

    Returns
    -------
    placed, waiting
        Those that find no room wait, each with the point that it speaks of.
    """
    taken, found, waiting = segments(items), list[Text](), list[Waiting]()
    for content, target, ways in wishes:
        text = free_text(ways, taken, clear)
        if text:
            found.append(text)
            taken = np.concatenate([taken, segments([text])])
        else:
            waiting.append((content, target))
    return found, waiting


def collide(items: Iterable[Item], others: Iterable[Item]) -> bool:
    """Tell whether a text of either group meets anything of the other."""
    groups = list(items), list(others)
    taken = [segments(group) for group in groups]
    return any(meets(item, taken[1 - k], 0.3).any() for k in (0, 1) for item in groups[k] if isinstance(item, Text))


def bounds(items: Iterable[Item]) -> Floats:
    """Give the lower left and the upper right corner (2, 2) of the box around items, mm."""
    points = segments(items).reshape(-1, 2)
    return np.array([points.min(axis=0), points.max(axis=0)])


def led(waiting: Iterable[Waiting], items: Iterable[Item], box: Floats) -> list[Item]:
    """Write texts at the nearest free places in a box (2, 2), with leaders to what they speak of.

    Leaders cross lines but no texts. What finds no room in all the box is left out.
    """
    known, found = list(items), list[Item]()
    for text, target in waiting:
        found += _with_leader(text, target, [*known, *found], box)
    return found


def _with_leader(text: str, target: Floats, items: Sequence[Item], box: Floats) -> list[Item]:
    taken, texts = segments(items), [item for item in items if isinstance(item, Text)]
    for label, leader in _leaders(text, target):
        corners, way = text_box(label), segments([leader])
        inside = (corners > box[0]).all() and (corners < box[1]).all()
        if inside and not meets(label, taken, _CLEAR).any() and not any(meets(t, way, _CLEAR).any() for t in texts):
            return [label, leader, arrow(target, unit(leader.points[1] - target))]
    return []


def _leaders(text: str, target: Floats) -> Iterator[tuple[Text, Line]]:
    """Places further and further from a target, all around it."""
    for reach in _REACHES:
        for turn in _TURNS:
            end, right = target + reach * np.array([np.cos(turn), np.sin(turn)]), np.cos(turn) >= 0
            foot = end + np.array([_BEYOND if right else -_BEYOND, -SMALL / 2])
            yield Text(text, point(foot), SMALL, "start" if right else "end"), Line("thin", np.array([target, end]))


def within(text: Text, outline: Floats) -> bool:
    """Tell whether the box of a text lies inside a convex outline (n, 2), counter-clockwise."""
    side = np.roll(outline, -1, axis=0) - outline
    away = text_box(text)[:, None] - outline
    return bool((side[:, 0] * away[..., 1] - side[:, 1] * away[..., 0] > 0).all())
