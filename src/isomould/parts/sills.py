"""Sills: plates along the edges that a plane cut, standing clear of the nodes between them (geometry §6).

A sill stands in the plane of its edge and the trimming plane's normal, whatever the axes of its nodes; it is cut square
and ends where it is clear of the drum and of the other members of the node.
"""

from collections.abc import Sequence

import numpy as np

from isomould.arrays import Floats
from isomould.form.mesh import Family, Mesh
from isomould.form.rims import sill_tops
from isomould.parts.arms import Arms, normalised
from isomould.parts.catalogue import AnySection
from isomould.parts.details.joint import Joint
from isomould.parts.settings import MemberSettings


def set_backs(mesh: Mesh, arms: Arms, joints: Sequence[Joint], settings: MemberSettings) -> Floats:
    """Give how far (e, 2) mm sills end from their nodes along their edges; zeros for all other members.

    Parameters
    ----------
    joints : sequence of n Joint
        One per node of the mesh.
    """
    found = np.zeros((len(mesh.edges), 2))
    tops, sections = edge_tops(mesh), [settings.of(family) for family in mesh.family]
    rows: list[int] = np.flatnonzero(arms.sill).tolist()
    for row in rows:
        joint = joints[arms.node[row]]
        others = [other for other in np.flatnonzero(arms.node == arms.node[row]).tolist() if other != row]
        clear = [joint.reach(float(arms.elevation[row]))]
        clear += [_past_member(arms, (row, other), tops, sections) for other in others]
        found[arms.edge[row], arms.end[row]] = max(clear) + joint.clearance
    return np.ceil(np.round(found * 1000, 3)) / 1000


def edge_tops(mesh: Mesh) -> Floats:
    """Unit directions (e, 3) of the members' depth, to the outside; sills stand upright on the cutting plane."""
    along = normalised(mesh.nodes[mesh.edges[:, 1]] - mesh.nodes[mesh.edges[:, 0]])
    axes = mesh.axes[mesh.edges].sum(axis=1)
    top = normalised(axes - np.einsum("ij,ij->i", axes, along)[:, None] * along)
    top[mesh.family == Family.SILL] = sill_tops(mesh)
    return top


def _past_member(arms: Arms, rows: tuple[int, int], tops: Floats, sections: list[AnySection]) -> float:
    """Distance along a sill's arm from which it is clear of another member of the node.

    From there the whole sill lies on one side of the other's plane; or, if the other points backwards, before
    all of it.
    """
    row, other = rows
    along, away = arms.direction[row], arms.direction[other]
    top, other_top = tops[arms.edge[row]], tops[arms.edge[other]]
    across, other_across = np.cross(along, top), np.cross(away, other_top)
    section, beyond = sections[arms.edge[row]], sections[arms.edge[other]]
    size = beyond.width + section.depth * abs(top @ other_across) + section.width * abs(across @ other_across)
    beside = size / 2 / max(abs(along @ other_across), 1e-9)
    before = (beyond.depth * abs(other_top @ along) + beyond.width * abs(other_across @ along)) / 2
    return float(min(beside, before) if away @ along <= 0 else beside)
