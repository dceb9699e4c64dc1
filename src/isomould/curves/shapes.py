"""Pieces of the shapes that architects name: arcs, arches, waves and polylines. All in mm and radians."""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from isomould.arrays import Floats
from isomould.curves.bezier import Bezier
from isomould.curves.pieces import Catenary, Ellipse, Line, Piece, Sine, tuples
from isomould.errors import Note

FLAT_BULGE = 1e-5
"""Arcs flatter than this have so remote a centre that they are written as rational Béziers, exactly too."""


class Draft(NamedTuple):
    """A curve before it is joined."""

    pieces: tuple[Piece, ...]
    closed: bool
    notes: tuple[Note, ...] = ()
    origin: tuple[float, float] = (0.0, 0.0)
    """What the pieces are measured from, mm: (0, 0) unless they were drawn far from it."""


def ellipse(centre: Floats, major: Floats, minor: Floats, range_: tuple[float, float]) -> Ellipse:
    """Make an arc of an ellipse from its centre (2,), two conjugate half diameters (2,) and a range of φ.

    >>> ellipse(np.zeros(2), np.array([2.0, 0.0]), np.array([0.0, 1.0]), (0.0, 1.0)).major
    (2.0, 0.0)
    """
    return Ellipse(tuples(centre), tuples(major), tuples(minor), *map(float, range_))


def bulged(start: Floats, end: Floats, bulge: float) -> Piece:
    """Make the arc between two points (2,); bulge is tan of a quarter of its angle, positive to the left.

    >>> bulged(np.array([-1.0, 0.0]), np.array([1.0, 0.0]), -1.0).point(np.array([0.5])).round(12) + 0.0
    array([[0., 1.]])
    """
    if bulge == 0:
        return Line(tuples(start), tuples(end))
    middle, left = (start + end) / 2, _left(end - start)
    if abs(bulge) < FLAT_BULGE:
        return _flat_arc(np.array([start, middle - left * bulge / (1 - bulge**2), end]), bulge)
    major = start - middle - left * (1 - bulge**2) / (4 * bulge)
    return ellipse(start - major, major, _left(major), (0.0, 4 * np.arctan(bulge)))


def polyline(points: Floats, bulges: Floats, closed: bool) -> tuple[Piece, ...]:
    """Make the pieces between points (n, 2), a bulge for each."""
    following = np.roll(points, -1, axis=0)
    return tuple(bulged(points[k], following[k], float(bulges[k])) for k in range(len(points) - (not closed)))


def parabola(span: float, rise: float) -> Bezier:
    """Make a parabolic arch from (−span/2, 0) to (span/2, 0) with its apex at (0, rise)."""
    return Bezier(((-span / 2, 0.0), (0.0, 2 * rise), (span / 2, 0.0)), (1.0, 1.0, 1.0))


def catenary(span: float, rise: float) -> Catenary:
    """Make a catenary arch from (−span/2, 0) to (span/2, 0) with its apex at (0, rise).

    y = rise + a − a·cosh(x/a), where a = span/2u and (cosh u − 1)/2u = |rise|/span.

    >>> float(catenary(20.0, 7.5).point(np.array([0.5]))[0, 1].round(12))
    7.5
    """
    u = _half_range(abs(rise) / span)
    a = np.copysign(span / (2 * u), rise)
    return Catenary((0.0, rise + a), (abs(a), 0.0), (0.0, -a), -u, u)


def sine(amplitude: float, wavelength: float, waves: float, phase: float) -> Sine:
    """Make y = amplitude·sin(2πx/wavelength + phase) from x = 0 over a number of waves."""
    along = wavelength / (2 * np.pi)
    return Sine((-along * phase, 0.0), (along, 0.0), (0.0, amplitude), phase, phase + 2 * np.pi * waves)


def _flat_arc(points: Floats, bulge: float) -> Bezier:
    weight = (1 - bulge**2) / (1 + bulge**2)
    return Bezier(tuples(points), (1.0, weight, 1.0))


def _left(vector: Floats) -> Floats:
    return np.array([-vector[1], vector[0]])


def _half_range(ratio: float) -> float:
    """Solve (cosh u − 1)/2u = ratio, written as sinh²(u/2)/u so that flat arches keep all digits."""

    def excess(u: float) -> float:
        return float(np.sinh(u / 2) ** 2 / u) - ratio

    # sinh x > x bounds u by 4·ratio; 700 keeps the exponential finite
    high = min(4.001 * ratio, 700.0)
    return float(brentq(excess, 1e-9 * high, high, xtol=1e-300))


def distinct(points: Floats, closed: bool, field: str) -> tuple[Floats, tuple[Note, ...]]:
    """Leave out points (n, dim) that exactly repeat the one before, with a note (failure mode A7)."""
    kept = np.any(points != np.roll(points, -1, axis=0), axis=1)
    kept[-1] |= not closed
    text = f"{np.count_nonzero(~kept)} exactly repeated point(s) left out"
    return points[kept], () if kept.all() else (Note("W-CURVE-REPEATED", field, text),)
