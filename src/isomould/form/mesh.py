"""The mesh as general arrays: what is left of the product form once parts are made of it, trimmed or not.

Node (i, j) lies on parallel i and generatrix j. Generatrix edges run (i, j) → (i+1, j), parallel edges
(i, j) → (i, j+1); faces are (i, j), (i, j+1), (i+1, j+1), (i+1, j): counter-clockwise from outside.
"""

from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from isomould.arrays import Bools, Floats, Ints, T, read_only
from isomould.form.surface import Surface, node_axes

_NONE = read_only(np.empty(0, dtype=np.int64))


class Family(IntEnum):
    """The family of a mesh edge."""

    GENERATRIX = 0
    PARALLEL = 1
    SILL = 2

    @property
    def word(self) -> str:
        """The family's name in schedules."""
        return self.name.lower()


class NodeKind(IntEnum):
    """The kind of a node: the first that applies."""

    SUPPORT = 0
    BOUNDARY = 1
    FLAT = 2
    INTERIOR = 3

    @property
    def word(self) -> str:
        """The kind's name in schedules."""
        return self.name.lower()


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes with axes, edges with families, ragged faces.

    Attributes
    ----------
    nodes, axes : (n, 3) float, mm and unit
    node_ij : (n, 2) int
    kind : (n,) int
        A `NodeKind` each.
    edges : (e, 2) int
    family : (e,) int
        A `Family` each.
    edge_ij : (e, 2) int
        (i, j) of the edge's first node.
    faces : (k,) int, face_offsets : (f + 1,) int
        Corners of face f: `faces[face_offsets[f]:face_offsets[f + 1]]`.
    face_ij : (f, 2) int
    rim_plane : (k,) int
        For the side after each corner the number of the plane that cut it; −1 for sides that no plane made.
    planes : (p, 2, 3) float
        The cutting planes: a point (mm) and the unit normal towards what was kept.
    node_piece, edge_piece, face_piece : (n,), (e,), (f,) int
        0 for what is whole, else the piece of (i, j) that trimming left, counted from 1.
    shape : (int, int)
        Numbers of parallels and generatrices before trimming.
    closed : (bool, bool)
        Whether the profile and the rail are closed.
    """

    nodes: Floats
    axes: Floats
    node_ij: Ints
    kind: Ints
    edges: Ints
    family: Ints
    edge_ij: Ints
    faces: Ints
    face_offsets: Ints
    face_ij: Ints
    rim_plane: Ints
    planes: Floats
    node_piece: Ints
    edge_piece: Ints
    face_piece: Ints
    shape: tuple[int, int]
    closed: tuple[bool, bool]

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                read_only(value)

    @property
    def sizes(self) -> Ints:
        """Number of corners (f,) of every face."""
        return np.diff(self.face_offsets)

    @property
    def ahead(self) -> Ints:
        """For every corner (k,) the place in `faces` of the next corner of the same face."""
        following = np.arange(1, len(self.faces) + 1)
        following[self.face_offsets[1:] - 1] = self.face_offsets[:-1]
        return following

    @property
    def rimmed(self) -> Bools:
        """Whether a plane cut the side after each corner (k,)."""
        return self.rim_plane >= 0

    @property
    def rims(self) -> Floats:
        """Normals (k, 3) of the planes that cut the sides after the corners; zeros for sides that no plane made."""
        return np.concatenate([self.planes[:, 1], np.zeros((1, 3))])[self.rim_plane]

    @property
    def sides(self) -> Ints:
        """Nodes (k, 2) of the side after each corner, in the order of the face."""
        return np.stack([self.faces, self.faces[self.ahead]], axis=-1)

    def per_corner(self, values: NDArray[T]) -> NDArray[T]:
        """Repeat values (f, …) of the faces for their corners (k, …)."""
        return np.repeat(values, self.sizes, axis=0)

    def table(self, values: Ints) -> Ints:
        """Lay values (k,) of the corners out in rows (f, v), −1 beyond the corners of a face."""
        column = np.arange(self.sizes.max())
        place = np.where(column < self.sizes[:, None], self.face_offsets[:-1, None] + column, -1)
        return np.where(place >= 0, values[place], -1)


def make_mesh(surface: Surface) -> Mesh:
    """Flatten the product form into arrays of nodes, edges and faces."""
    closed = (surface.profile.closed, surface.rail.closed)
    caps = surface.profile.caps
    bare = np.flatnonzero(surface.profile.gap)
    poles = bare, np.array(caps.rows, dtype=np.int64)
    return _with_lids(grid_mesh(surface.V, node_axes(surface), _kinds(surface), closed, poles), caps.lids)


def grid_mesh(
    nodes: Floats, axes: Floats, kinds: Ints, closed: tuple[bool, bool], poles: tuple[Ints, Ints] = (_NONE, _NONE)
) -> Mesh:
    """Give the mesh of any grid of nodes (m, n, 3) with axes (m, n, 3) and kinds (m, n).

    `poles` are rows without members, and rows with panels all the same.
    """
    parallels, generatrices = nodes.shape[:2]
    rows = np.setdiff1d(np.arange(parallels - (not closed[0])), poles[0])
    panelled = np.union1d(rows, poles[1])
    number = np.arange(parallels * generatrices).reshape(parallels, generatrices)
    strips = generatrices - (not closed[1])
    above, beside = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    up, along, corner = number[rows], number[:, :strips], number[panelled, :strips]
    ahead = np.roll(above, -1, axis=1)
    quads = np.stack([corner, *(ring[panelled, :strips] for ring in (beside, ahead, above))])
    edges = [np.stack([up, above[rows]]), np.stack([along, beside[:, :strips]])]
    first = np.concatenate([up.ravel(), along.ravel()])
    return Mesh(
        nodes=nodes.reshape(-1, 3),
        axes=axes.reshape(-1, 3),
        node_ij=_ij(number.ravel(), generatrices),
        kind=kinds.ravel(),
        edges=np.concatenate([edge.reshape(2, -1).T for edge in edges]),
        family=np.repeat([Family.GENERATRIX, Family.PARALLEL], [up.size, along.size]),
        edge_ij=_ij(first, generatrices),
        faces=np.moveaxis(quads, 0, -1).ravel(),
        face_offsets=np.arange(0, 4 * corner.size + 1, 4),
        face_ij=_ij(corner.ravel(), generatrices),
        rim_plane=np.full(4 * corner.size, -1),
        planes=np.zeros((0, 2, 3)),
        node_piece=np.zeros(number.size, dtype=np.int64),
        edge_piece=np.zeros(first.size, dtype=np.int64),
        face_piece=np.zeros(corner.size, dtype=np.int64),
        shape=(parallels, generatrices),
        closed=closed,
    )


def _with_lids(mesh: Mesh, lids: tuple[int, ...]) -> Mesh:
    """Add the panels over the parallels `lids`; they count as row m − 1 over the last parallel, m over the first."""
    m, n = mesh.shape
    first = {m - 1: (m - 1, np.arange(n)), 0: (m, np.roll(np.arange(n)[::-1], 1))}
    added = [first[lid] for lid in sorted(lids, reverse=True)]
    corners = [(0 if row == m else row) * n + around for row, around in added]
    return replace(
        mesh,
        faces=np.concatenate([mesh.faces, *corners]),
        face_offsets=np.concatenate([mesh.face_offsets, mesh.face_offsets[-1] + n * np.arange(1, len(added) + 1)]),
        face_ij=np.concatenate([mesh.face_ij, np.array([(row, 0) for row, _ in added], dtype=np.int64).reshape(-1, 2)]),
        face_piece=np.concatenate([mesh.face_piece, np.zeros(len(added), dtype=np.int64)]),
        rim_plane=np.concatenate([mesh.rim_plane, np.full(n * len(added), -1)]),
    )


def _ij(number: Ints, generatrices: int) -> Ints:
    return np.stack(np.divmod(number, generatrices), axis=-1)


def _kinds(surface: Surface) -> Ints:
    rail, profile = surface.rail, surface.profile
    kinds = np.full(surface.V.shape[:2], int(NodeKind.INTERIOR))
    kinds[profile.flat] = NodeKind.FLAT
    kinds[:, rail.flat] = NodeKind.FLAT
    kinds[~profile.inner] = NodeKind.BOUNDARY
    kinds[:, ~rail.inner] = NodeKind.BOUNDARY
    return kinds
