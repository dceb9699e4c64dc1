"""The buildability measures of the freeGrid benchmark for gridshells (Bruno et al., Structures 58, 2023, 105678).

Computed after the published definitions, so that our meshes can be set beside other people's. All are 1 or a count at
their best: faces that are plane, joints that are alike, members of one length.
"""

from typing import NamedTuple

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.form.mesh import Mesh
from isomould.measure.faces import faces_by_corners
from isomould.measure.joints import edge_lengths
from isomould.parts.arms import Arms

_ALIKE = 0.01
"""Root mean square distance of two joints' unit vectors below which they are of one cluster."""
_SHORT = 100.0
"""mm: shorter edges are no members."""
_EQUAL = 9
"""Decimals in which joints agree that are the same and need not be compared twice."""


class Buildability(NamedTuple):
    """What freeGrid measures of a mesh, its number of sections apart.

    `planarity` is 1 + the mean of the faces' distances from their planes over half their perimeters; `clusters` the
    number of clusters of joints; `lengths` 1 + the standard deviation of the members' lengths over their mean.
    """

    planarity: float
    clusters: int
    lengths: float


def buildability(mesh: Mesh, arms: Arms) -> Buildability:
    """Measure a mesh as freeGrid does.

    Parameters
    ----------
    mesh
        Any mesh.
    arms
        Its edges seen from their nodes, in order around the axes.
    """
    lengths = edge_lengths(mesh)
    members = lengths[lengths > _SHORT]
    spread = float(members.std(ddof=1) / members.mean()) if len(members) > 1 else 0.0
    return Buildability(1 + float(face_distances(mesh).mean()), joint_clusters(arms), 1 + spread)


def face_distances(mesh: Mesh) -> Floats:
    """Give the mean distance of a face's corners from their plane of least squares over half its perimeter (f,)."""
    result = np.zeros(len(mesh.face_ij))
    for rows, corners in faces_by_corners(mesh):
        if corners.shape[1] == 3:
            continue
        centred = corners - corners.mean(axis=1, keepdims=True)
        normal = np.linalg.svd(centred, full_matrices=False)[2][:, 2]
        off = np.abs(np.einsum("fnk,fk->fn", centred, normal)).mean(axis=1)
        perimeter = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).sum(axis=1)
        result[rows] = off / (perimeter / 2)
    return result


def joint_clusters(arms: Arms) -> int:
    """Count the clusters of joints: those of every number of members apart, by the farthest point strategy.

    The first joint is the first centre; as long as a joint is farther than 0.01 from all centres, the farthest one is
    the next centre. The distance of two joints is that of their unit vectors after the best rotation.
    """
    count = np.diff(arms.offsets)
    found = 0
    for members in np.unique(count).tolist():
        rows = np.flatnonzero(count == members)
        found += _clusters(arms.direction[arms.offsets[rows, None] + np.arange(members)])
    return found


def _clusters(stars: Floats) -> int:
    """Count the clusters of stars (n, v, 3) of unit vectors."""
    rest = _distinct(stars)
    apart = np.full(len(rest), np.inf)
    found = 0
    while len(rest):
        centre = rest[int(np.argmax(apart))]
        apart = np.minimum(apart, star_distances(rest, centre))
        far = apart > _ALIKE  # joints of a cluster need not be looked at again: they are never the farthest
        rest, apart = rest[far], apart[far]
        found += 1
    return found


def _distinct(stars: Floats) -> Floats:
    """Give one of all stars that a rotation maps onto each other, in their first order."""
    angles = np.einsum("nik,njk->nij", stars, stars).reshape(len(stars), -1)
    hand = np.linalg.det(stars[:, :3]) if stars.shape[1] > 2 else np.zeros(len(stars))
    signature = np.round(np.column_stack([angles, hand]), _EQUAL) + 0.0
    return stars[np.sort(np.unique(signature, axis=0, return_index=True)[1])]


def star_distances(stars: Floats, centre: Floats) -> Floats:
    """Give the root mean square distances (n,) of stars (n, v, 3) from one (v, 3), after the best rotation of each.

    Members are paired in their order around the node, forwards and backwards from any of them: other pairs would cross.
    The best rotation is Kabsch's: it leaves `2 v − 2 (σ1 + σ2 ± σ3)`, σ the singular values of the covariance.
    """
    size = len(centre)
    moment = np.einsum("nki,okj->noij", stars, centre[_orders(size)])
    sigma = np.linalg.svd(moment, compute_uv=False)
    hand = np.where(np.linalg.det(moment) < 0, -1.0, 1.0)
    overlap = (sigma[..., 0] + sigma[..., 1] + hand * sigma[..., 2]).max(axis=1)
    return np.sqrt(np.maximum(2 - 2 * overlap / size, 0.0))


def _orders(size: int) -> Ints:
    """Orders (2 v, v) of members around a node."""
    forwards = np.stack([np.roll(np.arange(size), -k) for k in range(size)])
    return np.concatenate([forwards, forwards[:, ::-1]])
