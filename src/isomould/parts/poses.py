"""Where every part stands in space: the transforms from the frames of the classes to the building."""

import numpy as np

from isomould.arrays import Floats
from isomould.form.mesh import Mesh
from isomould.parts.arms import normalised
from isomould.parts.members import MemberParts
from isomould.parts.nodes import NodeParts
from isomould.parts.panels import PanelParts
from isomould.parts.sills import edge_tops


def node_poses(mesh: Mesh, nodes: NodeParts) -> Floats:
    """Transforms (n, 4, 4) of the nodes: Z along the axis, X along arm 1's projection."""
    return _poses(nodes.reference, np.cross(mesh.axes, nodes.reference), mesh.axes, mesh.nodes)


def member_poses(mesh: Mesh, members: MemberParts) -> Floats:
    """Transforms (e, 4, 4) of the members: x along the system line, y to the outside, turned as their class asks.

    The y of a sill is the direction in which it stands.
    """
    start, end = mesh.nodes[mesh.edges[:, 0]], mesh.nodes[mesh.edges[:, 1]]
    along = normalised(end - start)
    top = edge_tops(mesh)
    end_for_end = np.isin(members.classes.variant, (1, 3))[:, None]
    upside_down = np.isin(members.classes.variant, (2, 3))[:, None]
    x, y = np.where(end_for_end, -along, along), np.where(upside_down, -top, top)
    return _poses(x, y, np.cross(x, y), np.where(end_for_end, end, start))


def panel_poses(mesh: Mesh, panels: PanelParts, thickness: float) -> Floats:
    """Transforms (f, 4, 4) of the panels: x along side 0 of the part, z from its underside to the outside.

    A panel that was turned over lies face down: its z runs from its outer side to the inside.
    """
    starts, over, first = mesh.face_offsets[:-1], panels.turned_over, panels.lowest_corner
    second = np.where(over, first - 1, first + 1) % mesh.sizes
    origin = panels.corners[starts + first]
    x = normalised(panels.corners[starts + second] - origin)
    z = np.where(over[:, None], -panels.normals, panels.normals)
    return _poses(x, np.cross(z, x), z, origin + thickness * over[:, None] * panels.normals)


def _poses(x: Floats, y: Floats, z: Floats, origin: Floats) -> Floats:
    poses = np.zeros((len(origin), 4, 4))
    poses[:, :3, :] = np.stack([x, y, z, origin], axis=-1)
    poses[:, 3, 3] = 1.0
    return poses
