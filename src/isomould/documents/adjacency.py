"""What lies beside what: edges and faces around nodes, faces beside edges, as index tables."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Ints
from isomould.form.mesh import Mesh
from isomould.parts.arms import Arms


@dataclass(frozen=True, eq=False)
class Neighbours:
    """Index tables; −1 stands for nothing.

    Attributes
    ----------
    node_edges : (n, v) int
        Edges of every node in the order of its class's arms.
    node_faces : (n, v) int
        The face in the sector that follows each arm, counter-clockwise from outside.
    edge_faces : (e, 2) int
        Faces to the left and right of every edge, seen from outside.
    """

    node_edges: Ints
    node_faces: Ints
    edge_faces: Ints


def find_neighbours(mesh: Mesh, arm_rows: Ints, arms: Arms, face_edges: Ints) -> Neighbours:
    """Look up the neighbours of nodes and edges; `face_edges` (k,) are the edges under the faces' sides, or −1."""
    node_edges = np.where(arm_rows >= 0, arms.edge[arm_rows], -1)
    return Neighbours(node_edges, _sectors(mesh, node_edges, face_edges), _sides(mesh, face_edges))


def _sectors(mesh: Mesh, node_edges: Ints, face_edges: Ints) -> Ints:
    """The face after an arm is the one whose side leaves the node along that arm's edge."""
    count = len(mesh.edges)
    side = np.flatnonzero(face_edges >= 0)
    face, key = _faces(mesh)[side], (mesh.faces * count + face_edges)[side]
    order = np.argsort(key)
    asked = np.arange(len(mesh.nodes))[:, None] * count + node_edges
    place = np.minimum(np.searchsorted(key[order], asked), len(key) - 1)
    found = (key[order][place] == asked) & (node_edges >= 0)
    return np.where(found, face[order[place]], -1)


def _faces(mesh: Mesh) -> Ints:
    """Give the face (k,) of every corner."""
    return mesh.per_corner(np.arange(len(mesh.face_ij)))


def _sides(mesh: Mesh, face_edges: Ints) -> Ints:
    sides = np.full((len(mesh.edges), 2), -1, dtype=np.int64)
    there = face_edges >= 0
    face, edge = _faces(mesh)[there], face_edges[there]
    forwards = mesh.edges[edge, 0] == mesh.faces[there]
    sides[edge[forwards], 0] = face[forwards]
    sides[edge[~forwards], 1] = face[~forwards]
    return sides
