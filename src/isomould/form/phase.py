"""Where the slopes of an edge offset mesh begin: as asked, or where they fit the curve's ends (geometry §5)."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from isomould.arrays import Floats
from isomould.curves.curve import PlanarCurve
from isomould.curves.turning import Spans
from isomould.form.arc_lattices import shared_lattices
from isomould.form.closing import end_points
from isomould.form.lattice import KoebeLattice, koebe_lattice
from isomould.form.poles import half_of
from isomould.form.polygon import cross, unit
from isomould.form.settings import SlopePhase
from isomould.form.tangents import tangent_edges

_BESIDE = 1e-6
"""Share of a step by which the search for a balance keeps off the phases where the number of edges changes."""


def choose_lattice(
    curve: PlanarCurve, turns: Spans, turning: float, phase: str | SlopePhase, field: str
) -> KoebeLattice:
    """Give the slopes for a strip of the generatrix with a rail turning by `turning` (rad)."""
    half = half_of(turns)
    if isinstance(phase, SlopePhase):
        return koebe_lattice(turning, float(np.radians(phase.slope_deg)), half)
    if phase == "fit":
        return fit_lattice(curve, turns, koebe_lattice(turning, "node", half), field)
    return koebe_lattice(turning, phase, half)


def fit_lattice(curve: PlanarCurve, turns: Spans, lattice: KoebeLattice, field: str) -> KoebeLattice:
    """Shift a lattice so that the ends of the curve lie least off the lines of the end edges.

    The larger of both distances is smallest where the tangent at one end is an edge, or where both distances
    are equal: between the former phases one distance falls and the other grows, or both grow.
    """

    def misses(shift: float) -> Floats:
        return end_misses(curve, turns, _shifted(lattice, shift), field)

    first, second = np.sort(np.mod(lattice.index(np.array([turns.theta0[0], turns.theta1[-1]])), 1.0)).tolist()
    shifts = [first, second, *_balances(misses, first, second), *_balances(misses, second, first + 1.0)]
    worst = [round(float(misses(shift).max()), 9) for shift in shifts]
    return _shifted(lattice, shifts[worst.index(min(worst))])


def end_misses(curve: PlanarCurve, turns: Spans, lattice: KoebeLattice, field: str) -> Floats:
    """Distances (2,) mm of the ends of the curve from the lines of the first and the last edge."""
    edges = tangent_edges(curve, turns, shared_lattices(turns, lattice), field)
    if len(edges.index) == 0:
        return np.zeros(2)
    return np.abs(cross(end_points(curve, turns) - edges.contact[[0, -1]], unit(edges.direction[[0, -1]])))


def _shifted(lattice: KoebeLattice, shift: float) -> KoebeLattice:
    return replace(lattice, start=lattice.start + shift * lattice.step)


def _balances(misses: Callable[[float], Floats], low: float, high: float) -> list[float]:
    """Find the shift between two others where both ends miss alike, if there is one."""

    def difference(shift: float) -> float:
        first, last = misses(shift).tolist()
        return first - last

    low, high = low + _BESIDE, high - _BESIDE
    if low >= high or difference(low) * difference(high) >= 0:
        return []
    return [float(brentq(difference, low, high, xtol=1e-14))]
