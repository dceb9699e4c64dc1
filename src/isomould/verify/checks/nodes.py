"""V5-V7, V16: nodes are conical and free of torsion; beams of one height meet (geometry §4)."""

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.grid import ends_of, grid_of, regular_nodes, whole_faces
from isomould.verify.read.mesh import Mesh, edge_vectors
from isomould.verify.rules import Floats, Ints, Measured, NotApplicable, Rule, worse, worst_of

LENGTH = 1e-6
ANGLE = 1e-10


def conical(delivery: Delivery) -> Measured:
    """Paper eq. 1: |ω1 + ω3 − ω2 − ω4| at every node with four arms."""
    mesh, grid = delivery.mesh, grid_of(delivery.mesh, delivery.design)
    around = np.stack([grid.index, grid.beside(0, 1), grid.beside(1, 0), grid.beside(0, -1), grid.beside(-1, 0)])
    node, *arms = around[:, (around >= 0).all(axis=0)]
    rays = [mesh.nodes[arm] - mesh.nodes[node] for arm in arms]
    w1, w2, w3, w4 = (_angle(ray, rays[(k + 1) % 4]) for k, ray in enumerate(rays))
    off, limit = abs(w1 + w3 - w2 - w4), ANGLE + 4 * delivery.seam[1]
    return worst_of(off, mesh.node_location[node], limit=limit, none="no node has four arms")


def _angle(a: Floats, b: Floats) -> Floats:
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), (a * b).sum(axis=-1))


def axis_and_faces(delivery: Delivery) -> Measured:
    """Spread of the angles between a node's axis and its faces' normals: it is the axis of their cone."""
    if delivery.design.offset != "face":
        raise NotApplicable("the node axes belong to the edge offset")
    mesh = delivery.mesh
    _, corners = whole_faces(mesh, grid_of(mesh, delivery.design))
    p = mesh.nodes[corners]
    normal = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
    spread = _spread(corners.ravel(), _angle(normal[:, None], mesh.node_axes[corners]).ravel(), len(mesh.nodes))
    return worst_of(spread, mesh.node_location, limit=ANGLE + delivery.seam[1])


def _spread(owner: Ints, values: Floats, count: int) -> Floats:
    """Give the largest minus the smallest value of every owner (0 without values)."""
    high, low = np.full(count, -np.inf), np.full(count, np.inf)
    np.maximum.at(high, owner, values)
    np.minimum.at(low, owner, values)
    return np.where(low <= high, high - low, np.where(np.isfinite(low + high), np.nan, 0.0))


def torsion_free(delivery: Delivery) -> Measured:
    """Distance of a node axis, over the beam's height, from the plane of the edge and both its axes."""
    mesh, half = delivery.mesh, _half_depth(delivery)
    beams = np.flatnonzero(mesh.edge_family != "sill")
    axes = mesh.node_axes[mesh.edges[beams]]
    normal = np.cross(edge_vectors(mesh)[beams], axes.sum(axis=1))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    off = abs((axes * normal[:, None]).sum(axis=2)) * half / delivery.edge_slopes[beams]
    return worst_of(off.max(axis=1), mesh.edge_location[beams], limit=_scaled(mesh) + half * delivery.seam[1])


def _half_depth(delivery: Delivery) -> float:
    return float(delivery.design.raw["member"]["depth"]) / 2


def _scaled(mesh: Mesh) -> float:
    return max(LENGTH, 1e-9 * float(np.linalg.norm(edge_vectors(mesh), axis=1).max()))


def edge_offset(delivery: Delivery) -> Measured:
    """Tops and bottoms of all beams at a node meet on its axis, the beam height apart."""
    mesh = delivery.mesh
    if delivery.design.kind != "edge-offset":
        raise NotApplicable(f"kind is {delivery.design.kind}: beams of one height meet in edge offset meshes only")
    chosen = _one_cone(delivery)
    beams = (mesh.edge_family != "sill")[:, None] & chosen[mesh.edges]
    owner, slope = mesh.edges[beams], delivery.edge_slopes[beams]
    meets = _half_depth(delivery) / slope
    first = np.full(len(mesh.nodes), np.nan)
    first[owner] = meets
    height = abs(2 * first[owner] * slope - 2 * _half_depth(delivery))
    spread = _spread(owner, meets, len(mesh.nodes))[chosen]
    names, limit = mesh.node_location, _scaled(mesh)
    return worse(worst_of(spread, names[chosen], limit=limit), worst_of(height, names[owner], limit=limit))


def _one_cone(delivery: Delivery) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Choose the nodes that promise one angle: not flat ones, square ends or support nodes (geometry §5)."""
    mesh, rail = delivery.mesh, delivery.design.rail
    promised = abs(abs(rail.turning) - (rail.declared or np.nan)) <= ANGLE
    if not rail.closed and delivery.design.plane is not None:
        ends = ends_of(delivery.design, mesh, grid_of(mesh, delivery.design))
        promised[[0, -1]] = [end == "mitred" for end in ends]
    chosen = np.zeros(len(mesh.nodes), dtype=np.bool_)
    regular = regular_nodes(mesh)
    chosen[regular] = promised[mesh.node_ij[regular, 1]]
    return chosen


RULES = (
    Rule("V5", "inner nodes are conical", ANGLE, "rad", conical),
    Rule("V6", "nodes are free of torsion", LENGTH, "mm", torsion_free),
    Rule("V7", "beams of one height meet at the nodes", LENGTH, "mm", edge_offset),
    Rule("V16", "node axes are the axes of the nodes' cones", ANGLE, "rad", axis_and_faces),
)
