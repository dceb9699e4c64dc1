"""Panels laid flat: strips between generatrices unrolled side by side, trimmed panels included (paper §3.3)."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.form.mesh import Mesh
from isomould.parts.arms import normalised

_BETWEEN = 0.06
"""Distance of neighbouring strips, in the length of a usual panel's side."""


@dataclass(frozen=True, eq=False)
class Block:
    """Some panels laid flat: their numbers, and the corners (k, 2) mm of each."""

    faces: tuple[int, ...]
    corners: tuple[Floats, ...]

    @property
    def extent(self) -> tuple[Floats, Floats]:
        """Lower left and upper right corner (2,), (2,) of the box around all."""
        points = np.concatenate(self.corners)
        return points.min(axis=0), points.max(axis=0)


def flat_faces(mesh: Mesh) -> list[Floats]:
    """Give every face (k, 2) in its own plane: side 0 along x from the origin, seen from outside."""
    corner = mesh.nodes[mesh.faces]
    first = mesh.face_offsets[:-1]
    along = normalised(corner[first + 1] - corner[first])
    third, last = corner[first + 2] - corner[first], corner[mesh.face_offsets[1:] - 1] - corner[first + 1]
    inward = np.cross(normalised(np.cross(third, last)), along)
    away = corner - mesh.per_corner(corner[first])
    x, y = (np.einsum("ij,ij->i", away, mesh.per_corner(axis)) for axis in (along, inward))
    return np.split(np.stack([x, y], axis=1), mesh.face_offsets[1:-1])


def usual_size(mesh: Mesh) -> tuple[float, float]:
    """Give width and height (mm) of a usual panel: the medians of the first sides and of the heights over them."""
    flat = flat_faces(mesh)
    return float(np.median([face[1, 0] for face in flat])), float(np.median([np.ptp(face[:, 1]) for face in flat]))


def lay_block(mesh: Mesh, flat: list[Floats], rows: range, columns: range) -> Block:
    """Lay the strips of some columns (j) over some rows (i) of panels side by side."""
    width, height = (float(np.median([size[k] for size in map(_size, flat)])) for k in (0, 1))
    numbers, corners, x = list[int](), list[Floats](), 0.0
    for column in columns:
        strip = _in_strip(mesh, rows, column)
        laid = _lay_strip(mesh, flat, strip)
        if laid:
            points = np.concatenate(laid)
            start = height * (mesh.face_ij[strip[0], 0] - rows.start)
            move = np.array([x - points[:, 0].min(), start - points[:, 1].min()])
            numbers, corners = [*numbers, *strip], [*corners, *(face + move for face in laid)]
            x += np.ptp(points[:, 0]) + _BETWEEN * width
    return Block(tuple(numbers), tuple(corners))


def _size(face: Floats) -> tuple[float, float]:
    return float(face[1, 0]), float(np.ptp(face[:, 1]))


def _in_strip(mesh: Mesh, rows: range, column: int) -> list[int]:
    ij = mesh.face_ij
    found = np.flatnonzero((ij[:, 1] == column) & (ij[:, 0] >= rows.start) & (ij[:, 0] < rows.stop))
    return found[np.argsort(ij[found, 0], kind="stable")].tolist()


def _lay_strip(mesh: Mesh, flat: list[Floats], strip: list[int]) -> list[Floats]:
    """Lay each face at the side that it shares with the one before, and stand the strip upright."""
    laid = list[Floats]()
    for k, face in enumerate(strip):
        laid.append(_lay(mesh, flat[face], face, strip[k - 1], laid[-1]) if laid else flat[face])
    return _upright(laid)


def _corners(mesh: Mesh, face: int) -> Ints:
    return mesh.faces[mesh.face_offsets[face] : mesh.face_offsets[face + 1]]


def _lay(mesh: Mesh, face: Floats, number: int, before: int, placed: Floats) -> Floats:
    """Move a face (k, 2) to the side that it shares with the placed one, or above it where they share none."""
    shared, here, there = np.intersect1d(_corners(mesh, number), _corners(mesh, before), return_indices=True)
    if len(shared) < 2:
        return face + np.array([placed[:, 0].min() - face[:, 0].min(), placed[:, 1].max() - face[:, 1].min()])
    own, goal = face[here[:2]] @ np.array([1, 1j]), placed[there[:2]] @ np.array([1, 1j])
    turn = (goal[1] - goal[0]) / (own[1] - own[0])
    moved = (face @ np.array([1, 1j]) - own[0]) * (turn / abs(turn)) + goal[0]
    return np.stack([moved.real, moved.imag], axis=1)


def _upright(laid: list[Floats]) -> list[Floats]:
    """Turn a strip so that its last panel stands above its first."""
    if len(laid) < 2:
        return laid
    way = laid[-1].mean(axis=0) - laid[0].mean(axis=0)
    sine, cosine = way / np.hypot(*way)
    return [face @ np.array([[cosine, sine], [-sine, cosine]]) for face in laid]
