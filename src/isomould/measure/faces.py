"""Panels of any mesh: how flat, how round, how long they are, and which are equal (paper §2, §3.3, Table 4)."""

from collections.abc import Callable

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.form.mesh import Mesh
from isomould.parts.congruence import classify


def planarity(mesh: Mesh) -> Floats:
    """Give the thickness (f,) mm of the slab that holds each panel, along its plane of least squares."""
    return _by_corners(mesh, _slab)


def circularity(mesh: Mesh) -> Floats:
    """Give `|ω1 + ω3 − π|` (f,) rad of quadrilaterals, 0 on a circle; 0 for triangles, NaN for other polygons."""
    return _by_corners(mesh, _roundness)


def aspect_ratios(mesh: Mesh) -> Floats:
    """Give the aspect ratios (f,): of quadrilaterals the larger over the smaller mean of opposite sides (Table 4).

    Of other polygons the longest over the shortest side.
    """
    return _by_corners(mesh, _aspect)


def face_classes(mesh: Mesh, tolerance: float, *, flippable: bool = False) -> Ints:
    """Sort the faces into classes (f,) of equal polygons: all sides and short diagonals within `tolerance` mm."""
    result, used = np.empty(len(mesh.face_ij), dtype=np.int64), 0
    for rows, corners in faces_by_corners(mesh):
        numbers = _readings(corners, flippable=flippable)
        labels = np.zeros((*numbers.shape[:2], 1), dtype=np.int64)
        result[rows] = used + classify(numbers, labels, np.full(numbers.shape[2], tolerance)).of
        used = int(result[rows].max()) + 1
    return result


def angle(a: Floats, b: Floats) -> Floats:
    """Angles (…) rad between vectors (…, 3), exact for small angles too."""
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.einsum("...k,...k->...", a, b))


def faces_by_corners(mesh: Mesh) -> list[tuple[Ints, Floats]]:
    """Faces by their number of corners: rows (g,) and corners (g, n, 3)."""
    count = np.diff(mesh.face_offsets)
    found: list[tuple[Ints, Floats]] = []
    for corners in np.unique(count).tolist():
        rows = np.flatnonzero(count == corners)
        found.append((rows, mesh.nodes[mesh.faces[mesh.face_offsets[rows, None] + np.arange(corners)]]))
    return found


def _by_corners(mesh: Mesh, measure: Callable[[Floats], Floats]) -> Floats:
    result = np.empty(len(mesh.face_ij))
    for rows, corners in faces_by_corners(mesh):
        result[rows] = measure(corners)
    return result


def _slab(corners: Floats) -> Floats:
    centred = corners - corners.mean(axis=1, keepdims=True)
    normal = np.linalg.svd(centred, full_matrices=False)[2][:, 2]
    return np.ptp(np.einsum("fnk,fk->fn", centred, normal), axis=1)


def _roundness(corners: Floats) -> Floats:
    if corners.shape[1] == 3:
        return np.zeros(len(corners))
    if corners.shape[1] > 4:
        return np.full(len(corners), np.nan)
    ahead, behind = (np.roll(corners, shift, axis=1) - corners for shift in (-1, 1))
    inside = angle(ahead, behind)
    return np.abs(inside[:, 0] + inside[:, 2] - np.pi)


def _sides(corners: Floats, apart: int = 1) -> Floats:
    return np.linalg.norm(np.roll(corners, -apart, axis=1) - corners, axis=2)


def _aspect(corners: Floats) -> Floats:
    sides = _sides(corners)
    means = (sides[:, :2] + sides[:, 2:]) / 2 if corners.shape[1] == 4 else sides
    return means.max(axis=1) / means.min(axis=1)


def _readings(corners: Floats, *, flippable: bool) -> Floats:
    """Sides and short diagonals (g, s, 2n), started at every corner, and backwards where panels may be turned over."""
    orders = [np.roll(np.arange(corners.shape[1]), -k) for k in range(corners.shape[1])]
    orders += [order[::-1] for order in orders] if flippable else []
    read = [np.concatenate([_sides(corners[:, order]), _sides(corners[:, order], 2)], axis=1) for order in orders]
    return np.stack(read, axis=1)
