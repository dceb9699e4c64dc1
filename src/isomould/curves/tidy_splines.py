"""Splines of other programs brought to the form that `bspline` divides: split where they break, without idle points.

ZWCAD and others join splines by inner knots of full multiplicity: two curves that meet, in one entity. Clicked twice,
an end control point comes doubled: the curve then stands still at its end.
"""

from itertools import pairwise

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.curves.bspline import Nurbs, Segment, segments
from isomould.errors import Refused

_SAME_KNOT = 1e-12
"""Knots nearer than this share of the whole range are one."""

_MEETING = 1e-6
"""Ends of two halves that are this near are one point, mm."""


def tidied_segments(spline: Nurbs, field: str) -> list[Segment]:
    """Part a spline of another program into Bézier segments.

    Raises
    ------
    Refused
        As `segments`; E-SPLINE-KNOTS where its parts do not meet.
    """
    parts = [without_doubled_ends(part) for part in split(spline)]
    pieces = [segments(part, field) for part in parts]
    for before, after in pairwise(pieces):
        _refuse_gap(before[-1], after[0], field)
    return [segment for part in pieces for segment in part]


def split(spline: Nurbs) -> list[Nurbs]:
    """Split a spline at knots that part it (degree + 1 times); what lies between such knots has no effect.

    A spline that cannot be read so comes back as it is: `segments` says why.
    """
    knots, degree, count = spline.knots, spline.degree, len(spline.points)
    sound = knots.size == count + degree + 1 and np.all(np.isfinite(knots)) and np.all(np.diff(knots) >= 0)
    if not sound or degree < 1 or spline.weights.size != count:
        return [spline]
    firsts, lasts = _groups(knots)
    full = lasts - firsts >= degree
    # from the last of one full knot's copies to the first of the next one's
    starts = lasts[full] - degree
    stops = firsts[full] + degree + 1
    if not (full.size and full[0]):
        starts = np.concatenate([[0], starts])
    else:
        stops = stops[1:]
    if full.size and full[-1]:
        starts = starts[: len(stops)]
    else:
        stops = np.append(stops, knots.size)
    return [_part(spline, int(a), int(b)) for a, b in zip(starts, stops, strict=True)]


def without_doubled_ends(spline: Nurbs) -> Nurbs:
    """Leave out end control points that repeat the very end, each with the knot next to it."""
    while _is_doubled(spline):
        spline = _shortened(spline)
    backwards = _reversed(spline)
    while _is_doubled(backwards):
        backwards = _shortened(backwards)
    return _reversed(backwards)


def has_doubled_ends(spline: Nurbs) -> bool:
    """Tell whether `without_doubled_ends` changes a spline."""
    return any(_is_doubled(part) or _is_doubled(_reversed(part)) for part in split(spline))


def _groups(knots: Floats) -> tuple[Ints, Ints]:
    """Give the first and the last index of every run of equal knots."""
    reach = _SAME_KNOT * (knots[-1] - knots[0])
    firsts = np.flatnonzero(np.concatenate([[True], np.diff(knots) > reach]))
    return firsts, np.append(firsts[1:], knots.size) - 1


def _part(spline: Nurbs, start: int, stop: int) -> Nurbs:
    points = slice(start, stop - spline.degree - 1)
    return Nurbs(spline.degree, spline.points[points], spline.weights[points], spline.knots[start:stop])


def _is_doubled(spline: Nurbs) -> bool:
    """Tell whether a clamped spline with inner knots starts with one point twice."""
    degree, knots = spline.degree, spline.knots
    clamped = len(spline.points) > degree + 1 and knots[0] == knots[degree] < knots[degree + 1]
    return bool(clamped and np.array_equal(spline.points[0], spline.points[1]))


def _shortened(spline: Nurbs) -> Nurbs:
    knots = np.delete(spline.knots, spline.degree + 1)
    return Nurbs(spline.degree, spline.points[1:], spline.weights[1:], knots)


def _reversed(spline: Nurbs) -> Nurbs:
    return Nurbs(spline.degree, spline.points[::-1], spline.weights[::-1], -spline.knots[::-1])


def _refuse_gap(before: Segment, after: Segment, field: str) -> None:
    gap = float(np.linalg.norm(after.points[0] - before.points[-1]))
    if not gap <= _MEETING:
        found = f"a knot that parts the spline, its halves {gap:.6g} apart"
        raise Refused("E-SPLINE-KNOTS", f"{field}.knots", found, "halves that meet", "Explode it, and join its parts.")
