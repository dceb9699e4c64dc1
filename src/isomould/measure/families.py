"""Mesh families on one smooth surface that are no moulding meshes: what a moulding mesh is compared with (Table 5).

Both divide rail and generatrix into equal lengths and take vertex normals as node axes.
"""

from dataclasses import replace

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.curves.curve import PlanarCurve
from isomould.curves.lengths import length, parameter_at
from isomould.form.mesh import Mesh, NodeKind, grid_mesh
from isomould.measure.smooth import Smooth
from isomould.parts.arms import normalised

DIAGONAL = 100
"""Family number of the edges that split quadrilaterals, beyond those of `Family`."""


def triangulated(smooth: Smooth, edges: tuple[int, int]) -> Mesh:
    """Nodes on the surface, every cell split by the diagonal from (i, j) to (i + 1, j + 1).

    `edges` are the numbers of edges of rail and generatrix.
    """
    places = _stations(smooth.rail, edges[0]), _stations(smooth.generatrix, edges[1])
    return _split(_with_normals(smooth.point(*places), smooth))


def scale_trans(smooth: Smooth, edges: tuple[int, int]) -> Mesh:
    """Give the scale-trans mesh nearest to the surface: every parallel is the rail's polygon, scaled and moved.

    Scale and motion are those of least squares to the true parallel. Panels are plane trapezoids.
    """
    rail, generatrix = _stations(smooth.rail, edges[0]), _stations(smooth.generatrix, edges[1])
    corner = smooth.rail.point(*rail)
    section = smooth.generatrix.point(*generatrix)
    target = np.multiply.outer(section[:, 0], smooth.right(*rail)) + corner
    centre, middle = corner.mean(axis=0), target.mean(axis=1, keepdims=True)
    arm = corner - centre
    scale = np.einsum("ijk,jk->i", target - middle, arm) / np.einsum("jk,jk->", arm, arm)
    flat = middle + np.multiply.outer(scale, arm)
    return _with_normals(smooth.lifted(flat, section[:, 1]), smooth)


def _stations(curve: PlanarCurve, edges: int) -> tuple[Ints, Floats]:
    places = np.linspace(0.0, length(curve), edges + 1)
    return parameter_at(curve, places[:-1] if curve.closed else places)


def _with_normals(nodes: Floats, smooth: Smooth) -> Mesh:
    """Give the mesh of a grid (m, n, 3) with the sums of its cells' area vectors as axes."""
    closed = (smooth.generatrix.closed, smooth.rail.closed)
    kinds = np.full(nodes.shape[:2], int(NodeKind.INTERIOR))
    for axis, is_closed in enumerate(closed):
        if not is_closed:
            np.moveaxis(kinds, axis, 0)[[0, -1]] = NodeKind.BOUNDARY
    mesh = grid_mesh(nodes, np.zeros_like(nodes), kinds, closed)
    corner = mesh.nodes[mesh.table(mesh.faces)]
    area = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    axes = np.zeros_like(mesh.nodes)
    np.add.at(axes, mesh.table(mesh.faces), area[:, None])
    return replace(mesh, axes=normalised(axes))


def _split(mesh: Mesh) -> Mesh:
    """Split every quadrilateral into two triangles."""
    quads = mesh.table(mesh.faces)
    return replace(
        mesh,
        edges=np.concatenate([mesh.edges, quads[:, [0, 2]]]),
        family=np.concatenate([mesh.family, np.full(len(quads), DIAGONAL)]),
        edge_ij=np.concatenate([mesh.edge_ij, mesh.face_ij]),
        faces=quads[:, [0, 1, 2, 0, 2, 3]].ravel(),
        face_offsets=np.arange(0, 6 * len(quads) + 1, 3),
        face_ij=np.repeat(mesh.face_ij, 2, axis=0),
    )
