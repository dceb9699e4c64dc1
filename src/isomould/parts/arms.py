"""The arms of every node: the mesh edges as seen from their ends, in the node's own frame (fabrication, Node solids).

Azimuths are measured about the node axis, counter-clockwise from outside; elevations from the plane
perpendicular to it, positive to the outside.
"""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Bools, Floats, Ints, read_only
from isomould.form.mesh import Family, Mesh
from isomould.ties import FINE, first_least_of_rows


@dataclass(frozen=True, eq=False)
class Arms:
    """All arms, sorted by node and azimuth; node k has the arms `offsets[k]:offsets[k + 1]`.

    Attributes
    ----------
    node, edge, end : (a,) int
        Whose arm it is, of which mesh edge, and whether it is the edge's start (0) or end (1).
    direction : (a, 3) float
        Unit vectors away from the node.
    azimuth, elevation : (a,) float, rad
        Azimuth from an arbitrary zero of the node: only differences mean anything.
    gap : (a,) float, rad
        Azimuth to the next arm of the same node; the gaps of a node sum to 2π.
    sill : (a,) bool
        Whether it is the arm of a sill, which stands beside the node and not in it.
    offsets : (n + 1,) int
    """

    node: Ints
    edge: Ints
    end: Ints
    direction: Floats
    azimuth: Floats
    elevation: Floats
    gap: Floats
    sill: Bools
    offsets: Ints

    def __post_init__(self) -> None:
        for value in vars(self).values():
            read_only(value)


def find_arms(mesh: Mesh) -> Arms:
    """Measure the arms of all nodes."""
    count = len(mesh.edges)
    node = mesh.edges.T.ravel()
    far = mesh.edges[:, ::-1].T.ravel()
    direction = normalised(mesh.nodes[far] - mesh.nodes[node])
    azimuth, elevation = _angles(mesh.axes[node], direction)
    order = np.lexsort((azimuth, node))
    offsets = np.concatenate([[0], np.cumsum(np.bincount(node, minlength=len(mesh.nodes)))])
    return Arms(
        node=node[order],
        edge=np.tile(np.arange(count), 2)[order],
        end=np.repeat([0, 1], count)[order],
        direction=direction[order],
        azimuth=azimuth[order],
        elevation=elevation[order],
        gap=_gaps(azimuth[order], offsets),
        sill=np.tile(mesh.family == Family.SILL, 2)[order],
        offsets=offsets,
    )


def normalised(vectors: Floats) -> Floats:
    """Vectors (…, 3) divided by their lengths."""
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def across(axes: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors (n, 3), (n, 3) that make right-handed frames with the unit axes (n, 3)."""
    helper = np.eye(3)[first_least_of_rows(np.abs(axes), FINE)]
    first = normalised(np.cross(helper, axes))
    return first, np.cross(axes, first)


def _angles(axes: Floats, direction: Floats) -> tuple[Floats, Floats]:
    first, second = across(axes)
    x, y, z = (np.einsum("ij,ij->i", axis, direction) for axis in (first, second, axes))
    turn = np.arctan2(y, x)
    # half a turn is +π on every machine: the sign of a noisy y must not decide which arm comes first
    return np.where(turn < FINE - np.pi, turn + 2 * np.pi, turn), np.arctan2(z, np.hypot(x, y))


def _gaps(azimuth: Floats, offsets: Ints) -> Floats:
    following = np.arange(1, len(azimuth) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    gaps = np.mod(azimuth[following] - azimuth, 2 * np.pi)
    gaps[offsets[:-1][np.diff(offsets) == 1]] = 2 * np.pi
    return gaps
