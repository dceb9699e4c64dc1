"""Joining what was drawn: ends that nearly meet are moved together, by no more than drawings are inexact.

One tolerance, `join`, holds for gaps, heights and turns that are nearly full.
"""

from typing import Any, NamedTuple

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.curves.chains import Chain, P, Stroke, chains_of, places_of, tips_of
from isomould.curves.curve import JOINT_GAP
from isomould.curves.doubles import overlapping
from isomould.curves.moving import closed_turn, is_stiff, moved
from isomould.curves.spatial import ROUNDING
from isomould.errors import Note, Refused

JOIN = 0.01
"""What drawings are taken to be exact to, mm."""

LARGEST_DEFAULT = 0.1
"""More than this is joined only where it was asked for, mm."""


def join_tolerance(asked: float | None, printed: float) -> float:
    """Give the tolerance, mm: the one asked for, else 0.01 mm or what the file's printing loses.

    >>> join_tolerance(None, 0.0), join_tolerance(None, 0.05), join_tolerance(None, 3.0), join_tolerance(0.5, 0.0)
    (0.01, 0.05, 0.1, 0.5)
    """
    if asked is not None:
        return asked
    return max(JOIN, min(printed, LARGEST_DEFAULT))


def joined(strokes: list[Stroke[P]], tolerance: float, field: str) -> tuple[tuple[Chain[P], ...], tuple[Note, ...]]:
    """Join strokes to chains, each in the direction of its first stroke.

    Strokes no longer than the tolerance are left out, ends within it are moved together; both are noted.

    Raises
    ------
    Refused
        E-DRAWN-CURVES if more than two ends meet at a place, or an arc cannot be closed by a small change.
    """
    kept, notes = _without_dots(strokes, tolerance, field)
    if not kept:
        return (), notes
    tips = tips_of(kept)
    places = places_of(tips, tolerance + ROUNDING)
    _refuse_branches(kept, tips, places, tolerance, field)
    gaps = _gaps(tips, places)
    closer = _closed_up(kept, tips, gaps, field)
    return tuple(chains_of(closer, places)), (*notes, *_noted(gaps, field))


class _Gap(NamedTuple):
    """Two tips, as numbers of `tips` in one row, that have to meet."""

    one: int
    other: int
    size: float
    place: Floats


def _without_dots(strokes: list[Stroke[P]], tolerance: float, field: str) -> tuple[list[Stroke[P]], tuple[Note, ...]]:
    extents = [_extent(stroke) for stroke in strokes]
    tiny = [k for k, extent in enumerate(extents) if extent <= tolerance]
    if not tiny:
        return strokes, ()
    longest = max(extents[k] for k in tiny)
    text = f"{_named(strokes[k].name for k in tiny)}: no longer than {longest:.3g} mm, left out"
    dropped = set(tiny)
    kept = [stroke for k, stroke in enumerate(strokes) if k not in dropped]
    return kept, (Note("W-DRAWN-TINY", field, text),)


def _extent(stroke: Stroke[Any]) -> float:
    """Give the size of a stroke's box, mm."""
    points = np.concatenate([piece.point(np.linspace(0, 1, 9)) for piece in stroke.pieces])
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def _gaps(tips: Floats, places: Ints) -> list[_Gap]:
    """Give the pairs of tips that share a place, in the order of places."""
    flat = tips.reshape(-1, tips.shape[-1])
    order = np.argsort(places.ravel(), kind="stable")
    sorted_places = places.ravel()[order]
    first = np.flatnonzero(sorted_places[1:] == sorted_places[:-1])
    pairs = zip(order[first].tolist(), order[first + 1].tolist(), strict=True)
    return [_Gap(one, other, float(np.linalg.norm(flat[other] - flat[one])), flat[one]) for one, other in pairs]


def _closed_up(strokes: list[Stroke[P]], tips: Floats, gaps: list[_Gap], field: str) -> list[Stroke[P]]:
    """Move the ends of strokes together where they are apart by more than rounding."""
    steps = np.zeros((2 * len(strokes), tips.shape[-1]))
    flat = tips.reshape(-1, tips.shape[-1])
    result = list(strokes)
    for gap in gaps:
        if gap.size <= JOINT_GAP:
            continue
        owner = gap.one // 2
        if owner == gap.other // 2 and len(strokes[owner].pieces) == 1 and is_stiff(strokes[owner].pieces[0]):
            result[owner] = strokes[owner]._replace(pieces=(closed_turn(strokes[owner].pieces[0]),))  # type: ignore[arg-type]
            continue
        target = _target(strokes, flat, gap)
        steps[gap.one], steps[gap.other] = target - flat[gap.one], target - flat[gap.other]
    return [_stretched(stroke, steps[2 * k : 2 * k + 2], field) for k, stroke in enumerate(result)]


def _target(strokes: list[Stroke[Any]], flat: Floats, gap: _Gap) -> Floats:
    """Give where two tips meet: on the arc, if one of them is the end of one, else in the middle."""
    stiff = [is_stiff(strokes[tip // 2].pieces[-(tip % 2)]) for tip in (gap.one, gap.other)]
    if stiff[0] != stiff[1]:
        return flat[gap.one if stiff[0] else gap.other]
    return (flat[gap.one] + flat[gap.other]) / 2


def _stretched(stroke: Stroke[P], steps: Floats, field: str) -> Stroke[P]:
    """Give a stroke with its start and its end moved by steps (2, dim)."""
    if not steps.any():
        return stroke
    still = np.zeros(steps.shape[1])
    pieces = list(stroke.pieces)
    try:
        if len(pieces) == 1:
            pieces[0] = moved(pieces[0], steps[0], steps[1])
        else:
            pieces[0], pieces[-1] = moved(pieces[0], steps[0], still), moved(pieces[-1], still, steps[1])
    except ValueError as error:
        _refuse(f"{stroke.name}: {error}", "ends that nearly meet", "Draw it closed, or part its ends.", field)
    return stroke._replace(pieces=tuple(pieces))


def _noted(gaps: list[_Gap], field: str) -> tuple[Note, ...]:
    wide = [gap for gap in gaps if gap.size > JOINT_GAP]
    if not wide:
        return ()
    largest = max(wide, key=lambda gap: round(gap.size, 9))
    count = f"{len(wide)} gaps" if len(wide) > 1 else "1 gap"
    text = f"{count} closed, the largest {largest.size:.3g} mm at ({place_text(largest.place)})"
    return (Note("W-DRAWN-JOINED", field, text),)


def place_text(place: Floats) -> str:
    """Give coordinates for messages."""
    return ", ".join(f"{coordinate:.6g}" for coordinate in place)


def _refuse_branches(strokes: list[Stroke[Any]], tips: Floats, places: Ints, tolerance: float, field: str) -> None:
    crowded = np.flatnonzero(np.bincount(places.ravel()) > 2)
    if not crowded.size:
        return
    here = np.argwhere(places == crowded[0])
    meeting = [strokes[k] for k in np.unique(here[:, 0])]
    names = ", ".join(stroke.name for stroke in meeting)
    found = f"{len(here)} ends meet at ({place_text(tips[tuple(here[0])])}): {names}"
    doubled = overlapping(meeting, tolerance)
    if doubled:
        found += f"; {doubled[0][0]} and {doubled[0][1]} lie on each other"
    _refuse(found, "two ends at a joint", "Keep each curve once, its entities joined end to end.", field)


def _named(names: Any) -> str:
    every = list(names)
    return ", ".join(every[:4]) + (f" and {len(every) - 4} more" if len(every) > 4 else "")


def _refuse(found: str, limit: str, way_out: str, field: str) -> None:
    raise Refused("E-DRAWN-CURVES", field, found, limit, way_out)
