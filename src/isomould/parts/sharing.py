"""One kit of nodes for several meshes: the same mark is the same part in all of them (paper §3.5)."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TypeVar

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.form.mesh import Mesh
from isomould.parts.arms import Arms, find_arms
from isomould.parts.congruence import Classes
from isomould.parts.marks import locations
from isomould.parts.nodes import NodeParts, classify_nodes
from isomould.parts.settings import CongruenceSettings

T = TypeVar("T")


def share_nodes(
    meshes: Sequence[Mesh], tolerance: CongruenceSettings, up: Sequence[Floats] | None = None
) -> tuple[NodeParts, ...]:
    """Sort the nodes of several meshes into classes together, by angles and families alone.

    `up` are the directions (n, 3) per mesh in which nodes stand on bases, zeros for those without.

    Every mesh gets the classes that it uses. A class is made from its first node, in whichever mesh that lies, so
    that its arms are the same to the last bit everywhere.
    """
    together = side_by_side(meshes)
    arms = find_arms(together)
    parts = classify_nodes(together, arms, tolerance, None if up is None else np.concatenate(up))
    ends = np.cumsum([0, *(len(mesh.nodes) for mesh in meshes)]).tolist()
    return tuple(_part_of(parts, arms, mesh, slice(*rows)) for mesh, rows in zip(meshes, pairwise(ends), strict=True))


def _part_of(parts: NodeParts, arms: Arms, mesh: Mesh, rows: slice) -> NodeParts:
    """Give what one mesh, whose nodes are the `rows`, has of the classes."""
    used, first, of = np.unique(parts.classes.of[rows], return_index=True, return_inverse=True)
    classes = Classes(
        of=of.ravel(),
        variant=parts.classes.variant[rows],
        representative=first,
        canonical=parts.classes.variant[rows][first],
        deviation=parts.classes.deviation[rows],
    )
    arm_rows = parts.arm_rows[rows]
    return NodeParts(
        classes=classes,
        marks=_chosen(parts.marks, used),
        locations=locations("N", mesh.node_ij, mesh.node_piece),
        arms=_chosen(parts.arms, used),
        handed=_chosen(parts.handed, used),
        kind=parts.kind[used],
        arm_rows=np.where(arm_rows >= 0, arm_rows - arms.offsets[rows.start], -1),
        reference=parts.reference[rows],
        deviation=parts.deviation[rows],
        up=parts.up[used],
    )


def _chosen(values: tuple[T, ...], numbers: Ints) -> tuple[T, ...]:
    return tuple(values[k] for k in numbers)


def side_by_side(meshes: Sequence[Mesh]) -> Mesh:
    """Put meshes side by side in one; the numbers (i, j) keep their own count in each."""
    nodes = np.cumsum([0, *(len(mesh.nodes) for mesh in meshes)])
    corners = np.cumsum([0, *(len(mesh.faces) for mesh in meshes)])
    shifted = [
        replace(
            mesh,
            edges=mesh.edges + nodes[k],
            faces=mesh.faces + nodes[k],
            face_offsets=mesh.face_offsets[:-1] + corners[k],
        )
        for k, mesh in enumerate(meshes)
    ]
    arrays = {
        name: np.concatenate([vars(mesh)[name] for mesh in shifted])
        for name, value in vars(shifted[0]).items()
        if isinstance(value, np.ndarray)
    }
    return replace(shifted[0], **{**arrays, "face_offsets": np.append(arrays["face_offsets"], corners[-1])})
