"""What every reader of part lists gives: an instance, and the holes of its parts."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from isomould.arrays import Floats, round_um
from isomould.documents.drawing import Circle, Polyline
from isomould.errors import Note
from isomould.intake.instance import Instance
from isomould.nesting.layout import Id, Placement

Hole = Polyline | Circle
"""A closed contour of CUT_INNER, or a hole of DRILL."""


@dataclass(frozen=True, eq=False)
class PartList:
    """An instance, the holes of its parts in the frames of their outlines, and what should be known of it."""

    instance: Instance
    holes: Mapping[Id, tuple[Hole, ...]] = field(default_factory=dict[Id, tuple[Hole, ...]])
    notes: tuple[Note, ...] = ()

    def holes_of(self, placement: Placement) -> tuple[Hole, ...]:
        """Give the holes of a placed part where they lie on its sheet."""
        holes = self.holes.get(placement.id, ())
        return tuple(_moved(hole, placement, self._corner(placement)) for hole in holes)

    def _corner(self, placement: Placement) -> Floats:
        return next(part.outline[0] for part in self.instance.parts if part.id == placement.id)


_TURNS = {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}


def _moved(hole: Hole, placement: Placement, corner: Floats) -> Hole:
    """Move a hole as its part was: turned over (x to -x), turned, and its first corner put in its place."""
    cosine, sine = _TURNS[placement.rotation_deg]
    mirror = -1 if placement.turned_over else 1
    turn = np.array([[mirror * cosine, mirror * sine], [-sine, cosine]])
    if isinstance(hole, Circle):
        x, y = round_um((np.array(hole.centre) - corner) @ turn + placement.points[0]).tolist()
        return replace(hole, centre=(x, y))
    bulges = None if hole.bulges is None else mirror * hole.bulges
    return replace(hole, points=round_um((hole.points - corner) @ turn + placement.points[0]), bulges=bulges)
