"""Parallel families: whether several designs are made of the same nodes (paper §3.5)."""

from collections.abc import Sequence

import numpy as np

from isomould.arrays import Ints
from isomould.form.mesh import Mesh, NodeKind
from isomould.parts.arms import find_arms
from isomould.parts.nodes import classify_nodes
from isomould.parts.settings import CongruenceSettings
from isomould.parts.sharing import side_by_side


def shared_node_classes(meshes: Sequence[Mesh], tolerance: CongruenceSettings) -> tuple[Ints, Ints]:
    """Sort the nodes of several meshes into classes together, by angles and families alone.

    Returns
    -------
    counts : (k, d) int
        Nodes of every class in each of the d meshes; a row without zeros is a part that all of them use.
    kind : (k,) int
        A `NodeKind` per class.
    """
    union = side_by_side(meshes)
    parts = classify_nodes(union, find_arms(union), tolerance)
    design = np.repeat(np.arange(len(meshes)), [len(mesh.nodes) for mesh in meshes])
    counts = np.zeros((len(parts.marks), len(meshes)), dtype=np.int64)
    np.add.at(counts, (parts.classes.of, design), 1)
    return counts, parts.kind


def is_one_kit(meshes: Sequence[Mesh], tolerance: CongruenceSettings, *, interior: bool = False) -> bool:
    """Whether all meshes use exactly the same node classes; with `interior`, boundary and flat nodes apart."""
    counts, kind = shared_node_classes(meshes, tolerance)
    return bool((counts[(kind == NodeKind.INTERIOR) | (not interior)] > 0).all())
