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
    """Look up the neighbours of nodes and edges; `face_edges` (f, 4) are the edges under the faces' sides."""
    node_edges = np.where(arm_rows >= 0, arms.edge[arm_rows], -1)
    return Neighbours(node_edges, _sectors(mesh, node_edges, face_edges), _sides(mesh, face_edges))


def _sectors(mesh: Mesh, node_edges: Ints, face_edges: Ints) -> Ints:
    """The face after an arm is the one whose side leaves the node along that arm's edge."""
    count = len(mesh.edges)
    key = (mesh.quads * count + face_edges).ravel()
    order = np.argsort(key)
    asked = np.arange(len(mesh.nodes))[:, None] * count + node_edges
    place = np.minimum(np.searchsorted(key[order], asked), len(key) - 1)
    found = (key[order][place] == asked) & (node_edges >= 0)
    return np.where(found, order[place] // face_edges.shape[1], -1)


def _sides(mesh: Mesh, face_edges: Ints) -> Ints:
    sides = np.full((len(mesh.edges), 2), -1, dtype=np.int64)
    face = np.repeat(np.arange(len(face_edges)), face_edges.shape[1])
    edge = face_edges.ravel()
    forwards = mesh.edges[edge, 0] == mesh.quads.ravel()
    sides[edge[forwards], 0] = face[forwards]
    sides[edge[~forwards], 1] = face[~forwards]
    return sides
