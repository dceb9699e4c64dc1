"""V24: no two parts of the placed model take the same space (fabrication, Clash)."""

from itertools import combinations

import manifold3d as m3
import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.joints import Joint, different_joints, spread_of
from isomould.verify.read.solid import Solid
from isomould.verify.rules import Measured, Rule, Unreadable, worst_of

SLIVER = 1e-3
"""mm³: what two parts may share by rounding."""
CONTACT = 0.005
"""mm: how deep parts that touch may overlap, because outlines are rounded to 0.001 mm."""


def clashes(delivery: Delivery) -> Measured:
    """Depth of the overlap of any two parts that meet at a node, for one joint of every kind."""
    shapes = {mark: _manifold(mark, shape) for mark, shape in delivery.model.shapes.items()}
    found = [pair for joint in different_joints(delivery.mesh, delivery.model) for pair in _overlaps(joint, shapes)]
    return worst_of([depth for depth, _ in found], [where for _, where in found])


def _manifold(mark: str, shape: Solid) -> m3.Manifold:
    solid = m3.Manifold(m3.Mesh64(shape.vertices, shape.triangles.astype(np.uint64)))
    if solid.status() != m3.Error.NoError or solid.volume() <= 0:
        message = f"model/model.glb: {mark} is no solid ({solid.status().name})"
        raise Unreadable(message)
    return solid


def _overlaps(joint: Joint, shapes: dict[str, m3.Manifold]) -> list[tuple[float, str]]:
    """Overlaps of all pairs of the joint's parts, in the node's frame."""
    solids = [shapes[part.mark].transform(part.matrix[:3]) for part in joint.parts]
    names = [f"{part.mark} {part.location}" for part in joint.parts]
    pairs = combinations(range(len(solids)), 2)
    return [(_depth(solids[a] ^ solids[b]), f"{names[a]} and {names[b]} at {joint.location}") for a, b in pairs]


def _depth(common: m3.Manifold) -> float:
    """Thickness of what two parts share, the largest of its pieces; 0 for slivers of contact."""
    if common.volume() <= SLIVER:
        return 0.0
    return max(_thickness(piece) for piece in common.decompose() if piece.volume() > SLIVER / 10)


def _thickness(piece: m3.Manifold) -> float:
    """Smallest extent along a face's normal, at most 6 V / S: contact on two faces is a film bent round their edge."""
    mesh = piece.to_mesh64()
    points = np.array(mesh.vert_properties, dtype=np.float64)[:, :3]
    a, b, c = np.moveaxis(points[np.array(mesh.tri_verts, dtype=np.int64)], 1, 0)
    normals = np.cross(b - a, c - a)
    size = np.linalg.norm(normals, axis=1)
    flat = size > 1e-9
    return min(spread_of(points, normals[flat] / size[flat][:, None]), 6 * piece.volume() / (size.sum() / 2))


RULES = (Rule("V24", "no part takes another's space", CONTACT, "mm", clashes),)
