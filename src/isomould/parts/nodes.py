"""Node classes: which nodes of the mesh are the same part (geometry §7)."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints, read_only
from isomould.form.mesh import Family, Mesh
from isomould.parts.arms import Arms, normalised
from isomould.parts.congruence import Classes, Handed, classify, handedness
from isomould.parts.marks import locations, marks
from isomould.parts.settings import CongruenceSettings


@dataclass(frozen=True, eq=False)
class NodeArms:
    """The arms of one node class, counter-clockwise from outside, arm 1 first.

    Attributes
    ----------
    azimuth, elevation : (v,) float, rad
        Azimuth from arm 1.
    family : (v,) int
    """

    azimuth: Floats
    elevation: Floats
    family: Ints

    def __post_init__(self) -> None:
        for value in vars(self).values():
            read_only(value)

    @property
    def gap(self) -> Floats:
        """Azimuth (v,) rad to the next arm; they sum to 2π."""
        return np.diff(self.azimuth, append=2 * np.pi)

    @property
    def held(self) -> "NodeArms":
        """The arms that the node holds: all but sills, their azimuths still from arm 1."""
        held = self.family != Family.SILL
        return NodeArms(self.azimuth[held], self.elevation[held], self.family[held])

    @property
    def held_gap(self) -> Floats:
        """Azimuth (s,) rad from each of the held arms to the next; none where sills meet and nothing else."""
        azimuth = self.held.azimuth
        return np.diff(azimuth, append=azimuth[:1] + 2 * np.pi)


@dataclass(frozen=True, eq=False)
class NodeParts:
    """Node classes and where they are.

    Attributes
    ----------
    classes : Classes
    marks, locations : tuple of str
        One per class, one per node.
    arms : tuple of NodeArms
        One per class, measured on its representative.
    handed : tuple of str
        Chirality per class; a mirror image is another part.
    kind : (k,) int
        A `NodeKind` per class.
    arm_rows : (n, v) int
        Rows of `Arms` of every node in the order of its class's arms; −1 beyond its valence.
    reference : (n, 3) float
        Unit direction of arm 1's projection onto the plane perpendicular to the node axis.
    deviation : (n,) float, rad
        Largest angular deviation of the node from its class.
    up : (k, 3) float
        Direction in the class's frame in which a support stands on its base; zeros for all other classes.
    """

    classes: Classes
    marks: tuple[str, ...]
    locations: tuple[str, ...]
    arms: tuple[NodeArms, ...]
    handed: tuple[Handed, ...]
    kind: Ints
    arm_rows: Ints
    reference: Floats
    deviation: Floats
    up: Floats

    def __post_init__(self) -> None:
        for array in (self.kind, self.arm_rows, self.reference, self.deviation, self.up):
            read_only(array)


def classify_nodes(mesh: Mesh, arms: Arms, tolerance: CongruenceSettings, up: Floats | None = None) -> NodeParts:
    """Sort the nodes into classes by the angles and families of their arms.

    `up` (n, 3) are the directions in which nodes stand on bases, zeros for those without; nodes of a class share it.
    """
    rows, up = _arm_table(arms), np.zeros_like(mesh.nodes) if up is None else up
    numbers, labels = _signatures(mesh, arms, _rotations(rows), up)
    spread = np.full(numbers.shape[2], np.radians(tolerance.angle_deg))
    classes = classify(numbers, labels, spread, _reading_order(rows.shape[1]), _held(numbers, rows.shape[1]))
    ordered = np.take_along_axis(_rotations(rows), classes.variant[:, None, None], axis=1)[:, 0]
    first = ordered[:, 0]
    axes = mesh.axes
    flat = arms.direction[first] - np.einsum("ij,ij->i", arms.direction[first], axes)[:, None] * axes
    chosen = classes.representative
    return NodeParts(
        classes=classes,
        marks=marks("N", len(chosen)),
        locations=locations("N", mesh.node_ij, mesh.node_piece),
        arms=tuple(_class_arms(mesh, arms, row) for row in ordered[chosen]),
        handed=_handedness(mesh, arms, rows[chosen], up[chosen], spread),
        kind=mesh.kind[chosen],
        arm_rows=ordered,
        reference=normalised(flat),
        deviation=classes.deviation.max(axis=1),
        up=_in_frame(mesh, arms, first[:, None], up)[chosen, 0],
    )


def _arm_table(arms: Arms) -> Ints:
    """Rows of the arms (n, v) of every node, −1 beyond its valence."""
    valence = np.diff(arms.offsets)
    column = np.arange(valence.max())
    return np.where(column < valence[:, None], arms.offsets[:-1, None] + column, -1)


def _rotations(rows: Ints) -> Ints:
    """All cyclic orders (n, v, v) of the arms; a node of lower valence repeats its first order."""
    valence = (rows >= 0).sum(axis=1)[:, None, None]
    start, step = np.arange(rows.shape[1])[None, :, None], np.arange(rows.shape[1])[None, None, :]
    column = (np.where(start < valence, start, 0) + step) % valence
    taken = np.take_along_axis(rows[:, None, :], column, axis=2)
    return np.where(step < valence, taken, -1)


def _signatures(mesh: Mesh, arms: Arms, order: Ints, up: Floats, *, mirrored: bool = False) -> tuple[Floats, Ints]:
    """Gaps, elevations, up (n, v, 2v + 3), families and kind (n, v, v + 1) of the nodes read in the orders (n, v, v).

    A mirror image is read clockwise: there the gap after an arm belongs to the arm that follows.
    """
    there = order >= 0
    valence = there.sum(axis=2, keepdims=True)
    following = np.take_along_axis(order, (np.arange(order.shape[2]) + 1) % valence, axis=2)
    gap = arms.gap[following if mirrored else order]
    numbers = [np.where(there, values, 0.0) for values in (gap, arms.elevation[order])]
    stands = _in_frame(mesh, arms, order[:, :, 0], up) * [1.0, -1.0 if mirrored else 1.0, 1.0]
    family = np.where(there, mesh.family[arms.edge[order]], -1)
    kind = mesh.kind[arms.node[order[:, :, :1]]]
    return np.concatenate([*numbers, stands], axis=2), np.concatenate([family, kind], axis=2)


def _held(numbers: Floats, valence: int) -> Floats:
    """What nodes of a class have alike: azimuths from arm 1 in place of the gaps, each measured for itself (V36)."""
    gaps = numbers[..., :valence]
    azimuths = np.cumsum(gaps, axis=-1) - gaps
    return np.concatenate([azimuths, numbers[..., valence:]], axis=-1)


def _in_frame(mesh: Mesh, arms: Arms, first: Ints, up: Floats) -> Floats:
    """Directions (n, 3) in the frames (n, s, 3) of the nodes read from the arms (n, s)."""
    axis, along = mesh.axes[arms.node[first]], arms.direction[first]
    x = normalised(along - np.einsum("nsk,nsk->ns", along, axis)[..., None] * axis)
    return np.stack([np.einsum("nsk,nk->ns", way, up) for way in (x, np.cross(axis, x), axis)], axis=-1)


def _reading_order(valence: int) -> Ints:
    """Order of the columns of a signature that compares nodes arm by arm: gap, elevation, family; up and kind last.

    Arm 1 is the one from which the sequence read so is smallest (fabrication, Node solids).
    """
    column = np.arange(3 * valence + 4)
    up = slice(2 * valence, 2 * valence + 3)
    arm_by_arm = np.delete(column, up)[:-1].reshape(3, valence).T.ravel()
    return np.concatenate([arm_by_arm, column[up], column[-1:]])


def _class_arms(mesh: Mesh, arms: Arms, row: Ints) -> NodeArms:
    row = row[row >= 0]
    azimuth = np.concatenate([[0.0], np.cumsum(arms.gap[row])[:-1]])
    return NodeArms(azimuth, arms.elevation[row], mesh.family[arms.edge[row]])


def _backwards(rows: Ints) -> Ints:
    """Arm rows (n, v) in reverse order, still padded at the end."""
    valence, column = (rows >= 0).sum(axis=1)[:, None], np.arange(rows.shape[1])
    reverse = np.take_along_axis(rows, (valence - 1 - column) % valence, axis=1)
    return np.where(column < valence, reverse, -1)


def _handedness(mesh: Mesh, arms: Arms, rows: Ints, up: Floats, tolerance: Floats) -> tuple[Handed, ...]:
    """Chirality (k,) of nodes given by their arm rows (k, v)."""
    own = _signatures(mesh, arms, _rotations(rows), up)
    mirror = _signatures(mesh, arms, _rotations(_backwards(rows)), up, mirrored=True)
    valence = rows.shape[1]
    held = _held(own[0], valence), _held(mirror[0], valence)
    return handedness(own, mirror, tolerance, _reading_order(valence), held)
