"""How far the vertices of a polygon lie from the curve that it replaces."""

import numpy as np
from scipy.spatial import cKDTree

from isomould.arrays import Floats, Ints
from isomould.curves.curve import PlanarCurve

_SAMPLES = 64
_STEPS = 6
_NOISE = 1e-9
"""mm: a step that lengthens the distance by no more is taken, because the distance is flat at its foot."""


def curve_distance(curve: PlanarCurve, points: Floats) -> float:
    """Give the largest distance (mm) of points (n, 2) from a curve."""
    return float(np.linalg.norm(points - curve.point(*nearest_places(curve, points)), axis=1).max())


def nearest_places(curve: PlanarCurve, points: Floats) -> tuple[Ints, Floats]:
    """Find the places of a curve, index (n,) and t (n,), nearest to points (n, 2): the nearest sample, refined.

    Newton steps that lead away from a point are not taken.
    """
    piece = np.repeat(np.arange(len(curve.pieces)), _SAMPLES + 1)
    parameter = np.tile(np.linspace(0.0, 1.0, _SAMPLES + 1), len(curve.pieces))
    _, nearest = cKDTree(curve.point(piece, parameter)).query(points)
    piece, parameter = piece[nearest], parameter[nearest]
    best, distance = parameter, np.linalg.norm(points - curve.point(piece, parameter), axis=1)
    for _ in range(_STEPS):
        away = curve.point(piece, parameter) - points
        along, bend = curve.derivative(piece, parameter), curve.second(piece, parameter)
        slope = np.einsum("ij,ij->i", away, along)
        rate = np.einsum("ij,ij->i", along, along) + np.einsum("ij,ij->i", away, bend)
        parameter = np.clip(parameter - slope / np.where(rate > 0, rate, np.inf), 0.0, 1.0)
        found = np.linalg.norm(points - curve.point(piece, parameter), axis=1)
        best = np.where(found <= distance + _NOISE, parameter, best)
        distance = np.minimum(found, distance)
    return piece, best
