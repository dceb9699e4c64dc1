"""Where a surface is curved too little or too unequally for good panels, and which curve is to blame (paper §4.4).

All panels of an isogonal mesh turn by the same angles, so that their areas go as one over the Gaussian curvature, and
the ratios of their sides as the ratio of the principal radii (Table 4).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Bools, Floats, Ints, read_only
from isomould.curves.curve import PlanarCurve
from isomould.errors import Note
from isomould.form.assemble import Form
from isomould.form.polygon import CurvePolygon, Role
from isomould.form.spatial import SpatialPolygon
from isomould.measure.anisotropy import mean_sides
from isomould.measure.smooth import Smooth, curvature, principal_curvatures

LOW_CURVATURE = 0.1
"""Of the mean Gaussian curvature: from there on panels would be ten times, their sides three times as large."""

LARGE_PANEL = 2.0
"""Times the median area. Flat spots shorter than a panel, as at an inflection, do no harm: its edges bridge them."""

STRONG_ANISOTROPY = 4.0
"""L/l: the most oblong dome that the paper shows has 3.6 (Table 4)."""


_BOUNDLESS = 1e6
"""R1/R2 of curves that are straight but for rounding."""


@dataclass(frozen=True, eq=False)
class Evenness:
    """What is measured of every panel (rows, strips).

    Attributes
    ----------
    counted : bool
        Panels of the mesh whose sides touch both curves. Straight parts are drawn on purpose, and edges through an
        inflection touch where there is no curvature by nature.
    gauss : float
        Gaussian curvature, as a share of the surface's mean.
    area : float
        By the mean sides, over the median.
    on_parallel, on_generatrix : float, mm
        Means of opposite sides.
    radii : float
        R1/R2, at least 1; infinite where a curve is straight.
    rail, generatrix : float
        Curvature of the rail (strips,) and of the generatrix (rows,), over the mean of each.
    closed : set of str
        Which of "rail" and "generatrix" have no ends.
    """

    counted: Bools
    gauss: Floats
    area: Floats
    on_parallel: Floats
    on_generatrix: Floats
    radii: Floats
    rail: Floats
    generatrix: Floats
    closed: frozenset[str]

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                read_only(value)

    @property
    def aspect(self) -> Floats:
        """L/l (rows, strips), at least 1."""
        ratio = self.on_parallel / self.on_generatrix
        return np.maximum(ratio, 1 / ratio)


def measure_evenness(form: Form, smooth: Smooth, panels: Ints) -> Evenness | None:
    """Measure the panels (f, 2) of a mesh, given by row and strip; None over a rail in space or without curvature."""
    if isinstance(form.rail, SpatialPolygon):
        return None
    counted = _touching(form.generatrix)[:, None] & _touching(form.rail) & _there(form, panels)
    if not counted.any():
        return None
    across, along = principal_curvatures(smooth, form)
    on_parallel, on_generatrix = mean_sides(form)
    gauss, area = np.abs(across * along), on_parallel * on_generatrix
    mean = np.average(gauss[counted], weights=area[counted])
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.abs(along / across)
        radii = np.maximum(ratio, 1 / ratio)
    return Evenness(
        counted=counted,
        gauss=gauss / mean,
        area=area / np.median(area[counted]),
        on_parallel=on_parallel,
        on_generatrix=on_generatrix,
        radii=radii,
        rail=_bends(smooth.rail, form.rail),
        generatrix=_bends(smooth.generatrix, form.generatrix),
        closed=frozenset(name for name in ("rail", "generatrix") if getattr(smooth, name).closed),
    )


def _touching(polygon: CurvePolygon) -> Bools:
    return np.array([role is Role.TANGENT for role in polygon.edges.role])


def _there(form: Form, panels: Ints) -> Bools:
    """Mark the panels (rows, strips) that trims have left; those that close gaps and ends have no row of their own."""
    found = np.zeros((len(form.generatrix.edges.role), len(form.surface.rail.lengths)), dtype=bool)
    inside = (panels >= 0).all(axis=1) & (panels < found.shape).all(axis=1)
    found[tuple(panels[inside].T)] = True
    return found


def _bends(curve: PlanarCurve, polygon: CurvePolygon) -> Floats:
    """Give the curvature (m,) where each edge touches, over the mean along the polygon."""
    edges = polygon.edges
    bend = np.abs(curvature(curve, edges.piece, edges.parameter))
    return bend / np.average(bend, weights=np.abs(polygon.lengths))


def evenness_notes(measured: Evenness, names: dict[tuple[int, int], str]) -> Iterator[Note]:
    """Note low Gaussian curvature and strong anisotropy at the worst panel of each; `names` are those of the panels."""
    low = measured.counted & (measured.gauss < LOW_CURVATURE) & (measured.area > LARGE_PANEL)
    if low.any():
        row, strip = _worst(np.where(low, measured.area, -np.inf))
        yield Note("W-LOW-CURVATURE", "panels", _low_text(measured, (row, strip), names[row, strip]))
    aspect = np.where(measured.counted, measured.aspect, -np.inf)
    row, strip = _worst(aspect)
    if aspect[row, strip] > STRONG_ANISOTROPY:
        yield Note("W-ANISOTROPY", "panels", _long_text(measured, (row, strip), names[row, strip]))


def _worst(values: Floats) -> tuple[int, int]:
    """Give row and strip of the largest value, the first of equal ones; noise does not decide."""
    row, strip = np.unravel_index(int(np.round(values, 6).argmax()), values.shape)
    return int(row), int(strip)


def _low_text(measured: Evenness, at: tuple[int, int], name: str) -> str:
    """Blame the curve that is flatter there than it is on average."""
    row, strip = at
    flatter = "generatrix" if measured.generatrix[row] <= measured.rail[strip] else "rail"
    share = f"{100 * measured.gauss[at]:.1f} % of the surface's mean (noted below {100 * LOW_CURVATURE:g} %)"
    return (
        f"the Gaussian curvature at {name} is {share}, and the panel {measured.area[at]:.1f} times as large as the "
        f"median one; {_ratios(measured, at)}. Bend the {flatter} more {_place(measured, flatter, at)}, "
        f"or give its max_edge."
    )


def _long_text(measured: Evenness, at: tuple[int, int], name: str) -> str:
    """Blame the curve along which the panel is long: its radius is the larger one."""
    long, short = "rail", "generatrix"
    if measured.on_generatrix[at] > measured.on_parallel[at]:
        long, short = short, long
    return (
        f"{_ratios(measured, at)} at {name}, long along the {long} (noted above {STRONG_ANISOTROPY:g}). Bend the "
        f"{long} more {_place(measured, long, at)}, or the {short} less {_place(measured, short, at)}."
    )


def _ratios(measured: Evenness, at: tuple[int, int]) -> str:
    """Print both ratios; where a curve is straight, the radii have none."""
    radii = f"{measured.radii[at]:.2f}" if measured.radii[at] < _BOUNDLESS else "without bound"
    return f"L/l is {measured.aspect[at]:.2f} and R1/R2 {radii}"


def _place(measured: Evenness, curve: str, at: tuple[int, int]) -> str:
    """Say where on a curve, by the line of the mesh that starts there: it is the same however the curve was drawn."""
    row, strip = at
    number, count = (row, len(measured.generatrix)) if curve == "generatrix" else (strip, len(measured.rail))
    line = f"near {'parallel' if curve == 'generatrix' else 'generatrix'} {number} of {count}"
    if curve in measured.closed:
        return line
    share = (number + 0.5) / count
    if share < 1 / 3:
        return f"at its beginning ({line})"
    return f"{'at its end' if share > 2 / 3 else 'in its middle'} ({line})"
