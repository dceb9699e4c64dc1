"""How unequally a surface is curved, beside how long its panels are (paper §4.4, Table 4)."""

from typing import NamedTuple

import numpy as np

from isomould.arrays import Floats
from isomould.form.assemble import Form
from isomould.form.spatial import SpatialPolygon
from isomould.measure.smooth import Smooth, radii_ratios


class Anisotropy(NamedTuple):
    """The highest panel: its row and strip, how long it is for its width, and how the radii of curvature compare.

    Attributes
    ----------
    panel : (int, int)
        (i, j) of the panel.
    aspect : float
        L/l: the larger over the smaller mean of opposite sides.
    radii : float
        R1/R2 of the principal radii where the panel touches the surface, at least 1.
    """

    panel: tuple[int, int]
    aspect: float
    radii: float


def anisotropy_at_apex(form: Form, smooth: Smooth) -> Anisotropy | None:
    """Compare lengths and radii at the highest panel (Table 4); None over a rail in space.

    Of several panels of one height the first one counts. Gaps at poles have no panel.
    """
    if isinstance(form.rail, SpatialPolygon):
        return None
    height = np.round(_corners(form)[..., 2].mean(axis=0), 6)
    height[form.surface.profile.gap] = -np.inf
    row, strip = (int(k) for k in np.unravel_index(int(np.argmax(height)), height.shape))
    on_parallel, on_generatrix = (sides[row, strip] for sides in mean_sides(form))
    aspect = float(max(on_parallel, on_generatrix) / min(on_parallel, on_generatrix))
    return Anisotropy((row, strip), aspect, float(radii_ratios(smooth, form)[row, strip]))


def mean_sides(form: Form) -> tuple[Floats, Floats]:
    """Give the mean lengths (rows, strips) mm of opposite sides of all panels: along parallels, along generatrices."""
    corners = _corners(form)
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=-1)
    return (sides[0] + sides[2]) / 2, (sides[1] + sides[3]) / 2


def _corners(form: Form) -> Floats:
    """Give the corners (4, rows, strips, 3) mm of all panels, in order around them."""
    surface = form.surface
    nodes = surface.V
    rows, strips = len(surface.profile.gap), len(surface.rail.lengths)
    above, beside = np.roll(nodes, -1, axis=0), np.roll(nodes, -1, axis=1)
    rings = (nodes, beside, np.roll(above, -1, axis=1), above)
    return np.stack([ring[:rows, :strips] for ring in rings])
