"""Nodes of any mesh: cones about their axes (paper eq. 1), and the members between them (geometry §4, §7)."""

import numpy as np

from isomould.arrays import Floats
from isomould.form.mesh import Mesh, NodeKind
from isomould.measure.faces import angle
from isomould.parts.arms import Arms, across
from isomould.parts.congruence import Classes, classify
from isomould.parts.settings import CongruenceSettings


def conical_residual(mesh: Mesh, arms: Arms) -> Floats:
    """Give `|ω1 + ω3 − ω2 − ω4|` (n,) rad (paper eq. 1); NaN at the boundary and where not four members meet."""
    result = np.full(len(mesh.nodes), np.nan)
    four = np.flatnonzero((np.diff(arms.offsets) == 4) & (mesh.kind != NodeKind.BOUNDARY))
    direction = arms.direction[arms.offsets[four, None] + np.arange(4)]
    result[four] = np.abs(angle(direction, np.roll(direction, -1, axis=1)) @ np.array([1.0, -1.0, 1.0, -1.0]))
    return result


def cone_angles(arms: Arms) -> tuple[Floats, Floats]:
    """Give the mean (n,) rad of the acute angles between the lines of a node's members and its axis, and their spread.

    The spread is 0 exactly where beams of one height meet: in edge offset meshes, whose nodes have all their members on
    one right circular double cone (geometry §4).
    """
    open_angle, starts = np.pi / 2 - np.abs(arms.elevation), arms.offsets[:-1]
    mean = np.add.reduceat(open_angle, starts) / np.diff(arms.offsets)
    return mean, np.maximum.reduceat(open_angle, starts) - np.minimum.reduceat(open_angle, starts)


def horizontal_levels(mesh: Mesh, tolerance: float = 1e-6) -> Floats:
    """Give the level z (m,) mm of every parallel that is horizontal within a tolerance (mm), NaN for the others."""
    count, i = mesh.shape[0], mesh.node_ij[:, 0]
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, i, mesh.nodes[:, 2])
    np.maximum.at(high, i, mesh.nodes[:, 2])
    return np.where(high - low <= tolerance, (low + high) / 2, np.nan)


def edge_lengths(mesh: Mesh) -> Floats:
    """Give the lengths (e,) mm of the system lines."""
    return np.linalg.norm(np.diff(mesh.nodes[mesh.edges], axis=1)[:, 0], axis=1)


def edge_classes(mesh: Mesh, arms: Arms, tolerance: CongruenceSettings) -> Classes:
    """Sort the system lines into classes: length, angles at both ends, twist between the end axes, family.

    A member may be turned end for end and upside down; a twisted one is another part than its mirror image.
    """
    rise = np.empty((len(mesh.edges), 2))
    rise[arms.edge, arms.end] = arms.elevation
    first = np.column_stack([edge_lengths(mesh), rise, edge_twists(mesh)])
    over = first * np.array([1.0, -1.0, -1.0, 1.0])
    swap = np.array([0, 2, 1, 3])
    numbers = np.stack([first, first[:, swap], over, over[:, swap]], axis=1)
    spread = np.radians(np.full(4, tolerance.angle_deg))
    spread[0] = tolerance.length
    labels = np.broadcast_to(mesh.family[:, None, None], (*numbers.shape[:2], 1))
    return classify(numbers, labels, spread)


def edge_twists(mesh: Mesh) -> Floats:
    """Give the signed angle (e,) rad about each edge from its first node's axis to its last one's."""
    along = np.diff(mesh.nodes[mesh.edges], axis=1)[:, 0]
    first, second = across(along / np.linalg.norm(along, axis=1)[:, None])
    start, end = (
        np.arctan2(*(np.einsum("ij,ij->i", axis, mesh.axes[mesh.edges[:, k]]) for axis in (second, first)))
        for k in (0, 1)
    )
    return np.mod(end - start + np.pi, 2 * np.pi) - np.pi
