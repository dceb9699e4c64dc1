"""Holes and slots of a part as what a machine draws: circles to drill, contours to cut inside."""

from collections.abc import Iterable

import numpy as np

from isomould.arrays import Floats, round_um
from isomould.documents.drawing import Circle, Polyline
from isomould.parts.features import Hole


def front_holes(holes: Iterable[Hole]) -> tuple[Polyline | Circle, ...]:
    """Draw the holes of the front, the face that an outline shows; other faces are worked from NC1."""
    return tuple(_drawn(hole) for hole in holes if hole.face == "front")


def _drawn(hole: Hole) -> Polyline | Circle:
    centre = round_um(np.array([hole.x, hole.y]))
    if hole.lengthening == 0:
        return Circle("DRILL", (float(centre[0]), float(centre[1])), hole.diameter / 2)
    return Polyline("CUT_INNER", round_um(centre + _slot_corners(hole)), True, np.array([-1.0, 0.0, -1.0, 0.0]))


def _slot_corners(hole: Hole) -> Floats:
    """Corners (4, 2) mm of a slot about its centre, clockwise, each half circle after the first and the third."""
    reach, radius = hole.lengthening / 2, hole.diameter / 2
    return np.array([[reach, radius], [reach, -radius], [-reach, -radius], [-reach, radius]])
