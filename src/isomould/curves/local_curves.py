"""Curves measured from an origin near them, so that a site's coordinates lose nothing (intake K5)."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from isomould.arrays import Floats
from isomould.curves.construction import draft_curve
from isomould.curves.curve import PlanarCurve, join_pieces
from isomould.curves.origins import REMOTE, WHOLE
from isomould.curves.plane import Plane
from isomould.curves.settings import CurveSettings
from isomould.errors import Note
from isomould.units import MM_PER_UNIT

_STEPS = {"mm": WHOLE, "cm": 100.0}
"""Origins are multiples of this in the table's own units; of other units they are whole ones."""


@dataclass(frozen=True, eq=False)
class LocalCurve:
    """A planar curve and the origin (2,) mm in its plane that its coordinates are measured from."""

    curve: PlanarCurve
    origin: Floats
    notes: tuple[Note, ...]


def build_local_curve(
    settings: CurveSettings, base_dir: Path, plane: Plane | None = None, field: str = "curve"
) -> LocalCurve:
    """Build the curve of a `curve` table as `build_curve` does, its coordinates taken from an origin near it.

    The origin is (0, 0) for everything that lies within ten kilometres of it.

    Raises
    ------
    Refused, OutputFault
        As `build_curve`.
    """
    near, moved = _near(settings)
    draft = draft_curve(near, base_dir, plane, field)
    curve, notes = join_pieces(draft.pieces, draft.closed, field)
    return LocalCurve(curve, moved + np.array(draft.origin), (*draft.notes, *notes))


def _near(settings: CurveSettings) -> tuple[CurveSettings, Floats]:
    """Take the coordinates of a table from an origin near them, before anything is computed of them."""
    key = "points" if hasattr(settings, "points") else "centre"
    given = getattr(settings, key, None)
    if not given or len(np.shape(given[0] if key == "points" else given)) != 1:
        return settings, np.zeros(2)
    points = np.atleast_2d(np.array(given, float))
    units = getattr(settings, "units", None) or "mm"
    step = _STEPS.get(units, 1.0)
    remote = np.abs(points).max(axis=0) * MM_PER_UNIT[units] > REMOTE
    corner = np.where(remote, step * np.round(points.min(axis=0) / step), 0.0)
    if points.shape[1] != 2 or not corner.any():
        return settings, np.zeros(2)
    local = tuple((float(x), float(y)) for x, y in points - corner)
    moved = settings.model_copy(update={key: local if key == "points" else local[0]})
    return moved, corner * MM_PER_UNIT[units]
