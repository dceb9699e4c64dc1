"""Offset meshes, double layers made of them, and how exactly they keep their distance (geometry §4)."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats
from isomould.errors import Note
from isomould.form.assemble import Form
from isomould.form.mesh import Mesh, make_mesh
from isomould.form.offsets import Constant, offset_surface
from isomould.measure.faces import angle


@dataclass(frozen=True, eq=False)
class DoubleLayer:
    """A mesh and its offset mesh: node k of one is connected to node k of the other.

    `error` is the largest difference (mm) between the distance asked for and the distance found.
    """

    first: Mesh
    second: Mesh
    constant: Constant
    error: float

    @property
    def notes(self) -> tuple[Note, ...]:
        """Where the offset is not exact: at flat nodes, square ends and between rail nodes of other angles."""
        text = f"the {self.constant} distances of the layers are off by up to {self.error:.3f} mm"
        return (Note("W-LAYER-DISTANCE", "deliver.double_layer", text),) if self.error > 1e-6 else ()


def make_double_layer(form: Form, constant: Constant, distance: float) -> DoubleLayer:
    """Offset a form by a distance (mm, positive to the outside) and measure what came of it.

    Raises
    ------
    Refused
        If the form has no such offset, or an edge would flip.
    """
    first, second = make_mesh(form.surface), make_mesh(offset_surface(form, constant, distance))
    measure = {"face": face_distances, "vertex": vertex_distances, "edge": edge_distances}[constant]
    error = np.abs(np.abs(measure(first, second)) - abs(distance)).max()
    return DoubleLayer(first, second, constant, float(error))


def face_distances(mesh: Mesh, offset: Mesh) -> Floats:
    """Give the distances (f,) mm of the quadrilaterals' planes, positive where `offset` lies outside."""
    corner = mesh.nodes[mesh.table(mesh.faces)]
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    between = offset.nodes[offset.table(offset.faces)].mean(axis=1) - corner.mean(axis=1)
    return np.einsum("ij,ij->i", between, normal)


def vertex_distances(mesh: Mesh, offset: Mesh) -> Floats:
    """Give the distances (n,) mm of the nodes."""
    return np.linalg.norm(offset.nodes - mesh.nodes, axis=1)


def edge_distances(mesh: Mesh, offset: Mesh) -> Floats:
    """Give the distances (e,) mm of the edges' lines."""
    along = np.diff(mesh.nodes[mesh.edges], axis=1)[:, 0]
    between = offset.nodes[mesh.edges[:, 0]] - mesh.nodes[mesh.edges[:, 0]]
    return np.linalg.norm(np.cross(between, along), axis=1) / np.linalg.norm(along, axis=1)


def edge_turnings(mesh: Mesh, offset: Mesh) -> Floats:
    """Give the angles (e,) rad between the edges of both meshes: 0 where the meshes are parallel."""
    return angle(*(np.diff(each.nodes[mesh.edges], axis=1)[:, 0] for each in (mesh, offset)))
