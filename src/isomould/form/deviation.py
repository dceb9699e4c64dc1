"""How far the vertices of a polygon lie from the curve that it replaces."""

import numpy as np
from scipy.spatial import cKDTree

from isomould.arrays import Floats
from isomould.curves.curve import PlanarCurve

_SAMPLES = 64
_STEPS = 4


def curve_distance(curve: PlanarCurve, points: Floats) -> float:
    """Give the largest distance (mm) of points (n, 2) from a curve: the nearest sample, refined by Newton steps."""
    piece = np.repeat(np.arange(len(curve.pieces)), _SAMPLES + 1)
    parameter = np.tile(np.linspace(0.0, 1.0, _SAMPLES + 1), len(curve.pieces))
    _, nearest = cKDTree(curve.point(piece, parameter)).query(points)
    piece, parameter = piece[nearest], parameter[nearest]
    distance = np.linalg.norm(points - curve.point(piece, parameter), axis=1)
    for _ in range(_STEPS):
        away = curve.point(piece, parameter) - points
        along, bend = curve.derivative(piece, parameter), curve.second(piece, parameter)
        slope = np.einsum("ij,ij->i", away, along)
        rate = np.einsum("ij,ij->i", along, along) + np.einsum("ij,ij->i", away, bend)
        parameter = np.clip(parameter - slope / np.where(rate > 0, rate, np.inf), 0.0, 1.0)
        distance = np.minimum(distance, np.linalg.norm(points - curve.point(piece, parameter), axis=1))
    return float(distance.max())
