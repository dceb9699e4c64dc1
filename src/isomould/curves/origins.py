"""The origin that a drawing is read from: its own where it lies within ten kilometres, else a corner of what is drawn.

Coordinates of a country, such as UTM, have seven digits before the metre; doubles hold them to a few millionths of a
millimetre at best, and everything computed from them holds less. So nothing is: points are brought near the origin
first, and the origin goes back to the building as its place on the site.
"""

from collections.abc import Iterable

import numpy as np

from isomould.arrays import Floats
from isomould.curves.spatial import Traced

REMOTE = 1e7
"""Drawings that keep within this of their origin are read from it, mm."""

WHOLE = 1000.0
"""Origins are whole metres, mm: they can be read aloud, and are exact in every format."""


def origin_of(traced: Iterable[Traced]) -> Floats:
    """Give the origin (3,) mm to read shapes from: 0 along each axis on which nothing is remote.

    Entities in another order have the same origin.
    """
    every = list(traced)
    local = [one.base + shape.anchors for one in every for shape in one.shapes]
    if not local:
        return np.zeros(3)
    fars = [one.far for one in every for _ in one.shapes]
    if all((far == fars[0]).all() for far in fars) and np.abs(np.concatenate(local)).max() <= REMOTE:
        return fars[0].copy()
    points = np.concatenate([points + far for points, far in zip(local, fars, strict=True)])
    with np.errstate(invalid="ignore"):
        least = WHOLE * np.round(points.min(axis=0) / WHOLE)
        remote = np.abs(points).max(axis=0) > REMOTE
    return np.where(remote & np.isfinite(least), least, 0.0)


def seen_from(traced: Iterable[Traced], origin: Floats) -> list[Traced]:
    """Give the same shapes with their anchors measured from one origin (3,) mm, kept as what they are far from."""
    return [
        one._replace(
            shapes=[shape._replace(anchors=shape.anchors + (one.base + (one.far - origin))) for shape in one.shapes],
            base=np.zeros(3),
            far=origin,
        )
        for one in traced
    ]
