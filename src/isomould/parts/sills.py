"""Sills: plates along the edges that a plane cut, standing clear of the nodes between them (geometry §6).

A sill stands in the plane of its edge and the trimming plane's normal, whatever the axes of its nodes; it is cut square
and ends where it is clear of the drum and of the other members of the node.
"""

import numpy as np

from isomould.arrays import Floats
from isomould.form.mesh import Family, Mesh
from isomould.form.rims import sill_tops
from isomould.parts.arms import Arms, normalised
from isomould.parts.drum import Drum
from isomould.parts.settings import PlateSection


def set_backs(mesh: Mesh, arms: Arms, height: Floats, drum: Drum, section: PlateSection) -> Floats:
    """Give how far (e, 2) mm sills end from their nodes along their edges; zeros for all other members.

    Parameters
    ----------
    height : (e, 2) float, mm
        Of the drums at both ends.
    """
    found = np.zeros((len(mesh.edges), 2))
    tops = edge_tops(mesh)
    rows: list[int] = np.flatnonzero(arms.sill).tolist()
    for row in rows:
        edge, end = arms.edge[row], arms.end[row]
        others = [other for other in np.flatnonzero(arms.node == arms.node[row]).tolist() if other != row]
        clear = [_past_drum(float(arms.elevation[row]), float(height[edge, end]), drum)]
        clear += [_past_member(arms, row, other, tops, section) for other in others]
        found[edge, end] = max(clear) + drum.shoulder - drum.radius
    return np.ceil(np.round(found * 1000, 3)) / 1000


def edge_tops(mesh: Mesh) -> Floats:
    """Unit directions (e, 3) of the members' depth, to the outside; sills stand upright on the cutting plane."""
    along = normalised(mesh.nodes[mesh.edges[:, 1]] - mesh.nodes[mesh.edges[:, 0]])
    axes = mesh.axes[mesh.edges].sum(axis=1)
    top = normalised(axes - np.einsum("ij,ij->i", axes, along)[:, None] * along)
    top[mesh.family == Family.SILL] = sill_tops(mesh)
    return top


def _past_drum(elevation: float, height: float, drum: Drum) -> float:
    """Furthest that the drum reaches along an arm: `R cos e + (H/2) |sin e|`."""
    return drum.radius * np.cos(elevation) + height / 2 * abs(np.sin(elevation))


def _past_member(arms: Arms, row: int, other: int, tops: Floats, section: PlateSection) -> float:
    """Distance along a sill's arm from which it is clear of another member of the node.

    From there the whole plate lies on one side of the other's plane; or, if the other points backwards, before
    all of it.
    """
    along, away = arms.direction[row], arms.direction[other]
    top, other_top = tops[arms.edge[row]], tops[arms.edge[other]]
    across, other_across = np.cross(along, top), np.cross(away, other_top)
    depth, half = section.depth / 2, section.thickness / 2
    reach = half + depth * abs(top @ other_across) + half * abs(across @ other_across)
    beside = reach / max(abs(along @ other_across), 1e-9)
    before = depth * abs(other_top @ along) + half * abs(other_across @ along)
    return float(min(beside, before) if away @ along <= 0 else beside)
