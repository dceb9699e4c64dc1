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
from isomould.ties import FINE


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
        clear += [_past_hold(arms, (row, other), tops, sections, joint) for other in others if not arms.sill[other]]
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
    breadth = sections[arms.edge[other]].width
    beside = _beside(arms, rows, tops, sections, breadth)
    before = _ahead(arms, rows, tops, sections, (breadth, 0.0))
    backwards = arms.direction[other] @ arms.direction[row] <= FINE
    return min(beside, before) if backwards else beside


def _past_hold(arms: Arms, rows: tuple[int, int], tops: Floats, sections: list[AnySection], joint: Joint) -> float:
    """Distance along a sill's arm from which it is clear of what holds another member: beside it, or beyond its end."""
    hold = joint.hold(sections[arms.edge[rows[1]]])
    return min(_beside(arms, rows, tops, sections, hold[0]), _ahead(arms, rows, tops, sections, hold))


def _beside(arms: Arms, rows: tuple[int, int], tops: Floats, sections: list[AnySection], breadth: float) -> float:
    """Where the whole sill is on one side of a layer of this breadth about another arm's plane."""
    (row, other), section = rows, sections[arms.edge[rows[0]]]
    along, top = arms.direction[row], tops[arms.edge[row]]
    across, other_across = np.cross(along, top), np.cross(arms.direction[other], tops[arms.edge[other]])
    size = breadth + section.depth * abs(top @ other_across) + section.width * abs(across @ other_across)
    return float(size / 2 / max(abs(along @ other_across), 1e-9))


def _ahead(
    arms: Arms, rows: tuple[int, int], tops: Floats, sections: list[AnySection], size: tuple[float, float]
) -> float:
    """How far a body of this breadth and length along another arm, as deep as its member, reaches along the sill."""
    (row, other), (breadth, length) = rows, size
    along, away, other_top = arms.direction[row], arms.direction[other], tops[arms.edge[other]]
    across, depth = np.cross(away, other_top), sections[arms.edge[other]].depth
    half = (depth * abs(other_top @ along) + breadth * abs(across @ along)) / 2
    return float(length * max(away @ along, 0.0) + half)
