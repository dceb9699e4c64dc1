"""Polygons that cross themselves and profiles that hang over (failure modes B6 and C5)."""

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.errors import Note, Refused
from isomould.form.profile import Profile

_HANGING = 1e-9
"""Cosine; profile edges nearer to the horizontal neither rise nor fall."""


def refuse_crossing(vertices: Floats, closed: bool, field: str) -> None:
    """Refuse a polygon (n, 2) that crosses or touches itself, naming the two edges and the place.

    Raises
    ------
    Refused
        E-CURVE-CROSSING.
    """
    if not _are_simple(vertices[None], closed):
        raise Refused(
            "E-CURVE-CROSSING",
            f"{field}.curve",
            f"a polygon that crosses itself: {_crossing(vertices, closed)}",
            "a polygon without crossings",
            "Redraw the curve so that it does not come back on itself.",
        )


def refuse_crossing_parallels(parallels: Floats, closed: bool) -> None:
    """Refuse parallels (m, n, 2), in plan, of which one crosses itself.

    Raises
    ------
    Refused
        E-SURFACE-CROSSING naming the parallel, its two edges and the place.
    """
    if _are_simple(parallels, closed):
        return
    simple = [_are_simple(line[None], closed) for line in parallels]
    first = int(np.argmin(simple))
    raise Refused(
        "E-SURFACE-CROSSING",
        "generatrix.origin",
        f"parallel {first} crosses itself, the surface passes through itself: {_crossing(parallels[first], closed)}",
        "parallels without crossings",
        "Move the generatrix towards the outside, or widen the rail.",
    )


def overhang_notes(profile: Profile) -> tuple[Note, ...]:
    """Note an open profile that runs back along the rail's axis: the surface covers itself, seen from outside."""
    rising = np.cos(profile.latitude[~profile.gap])
    hanging = int(np.count_nonzero(rising < -_HANGING))
    if profile.closed or not hanging or not (rising > _HANGING).any():
        return ()
    text = f"{hanging} of {rising.size} rows hang over: the generatrix runs back along the axis of the rail there"
    return (Note("W-GENERATRIX-OVERHANG", "generatrix.curve", text),)


def _are_simple(lines: Floats, closed: bool) -> bool:
    rings = np.concatenate([lines, lines[:, :1]], axis=1) if closed else lines
    return bool(np.all(shapely.is_simple(shapely.linestrings(rings))))


def _crossing(vertices: Floats, closed: bool) -> str:
    """Say which two edges that are no neighbours meet first, and where."""
    ends = np.roll(vertices, -1, axis=0) if closed else vertices[1:]
    edges = np.asarray(shapely.linestrings(np.stack([vertices[: len(ends)], ends], axis=1)))
    one, other = shapely.STRtree(edges).query(edges, predicate="intersects")
    apart = (other > one + 1) & ~(closed & (one == 0) & (other == len(edges) - 1))
    if not apart.any():
        return "an edge runs back on its neighbour"
    first = np.flatnonzero(apart)[np.argmin(one[apart])]
    x, y = shapely.get_coordinates(shapely.intersection(edges[one[first]], edges[other[first]]))[0]
    return f"edges {one[first]} and {other[first]} meet at ({x:.3f}, {y:.3f}) mm"
