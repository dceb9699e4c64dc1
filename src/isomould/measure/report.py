"""Everything that is measured of one mesh, in one value: a column of the comparison (paper Tables 1 and 5)."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats
from isomould.form.mesh import Mesh, NodeKind
from isomould.measure.faces import aspect_ratios, circularity, face_classes, planarity
from isomould.measure.freegrid import buildability
from isomould.measure.joints import cone_angles, conical_residual, edge_classes, edge_lengths, horizontal_levels
from isomould.measure.smooth import Smooth, surface_distances
from isomould.parts.arms import find_arms
from isomould.parts.nodes import classify_nodes
from isomould.parts.quality import beam_mismatch, node_torsion
from isomould.parts.settings import CongruenceSettings


@dataclass(frozen=True)
class Measured:
    """Counts and worst values of a mesh; NaN where a measure means nothing.

    Lengths in mm, angles in rad. `spread` is the standard deviation of the member lengths over their mean.
    `interior` counts the classes of inner nodes that are not flat. `cone` is the largest spread of the angles
    between a node's members and its axis, `mismatch` what it costs in mm of beam depth, `deviation` the largest
    distance of nodes and face centres from the smooth surface, `levels` the number of horizontal parallels.
    The last three are those of the freeGrid benchmark.
    """

    parallels: int
    generatrices: int
    nodes: int
    node_classes: int
    interior: int
    members: int
    member_classes: int
    panels: int
    panel_classes: int
    shortest: float
    longest: float
    spread: float
    aspect: float
    planarity: float
    conical: float
    circular: float
    cone: float
    mismatch: float
    torsion: float
    deviation: float
    levels: int
    freegrid_planarity: float
    freegrid_joint_classes: int
    freegrid_lengths: float


def measure_mesh(mesh: Mesh, smooth: Smooth, depth: float, tolerance: CongruenceSettings) -> Measured:
    """Measure a mesh whose members are `depth` mm high against the surface that it stands for."""
    arms = find_arms(mesh)
    nodes = classify_nodes(mesh, arms, tolerance)
    lengths = edge_lengths(mesh)
    public = buildability(mesh, arms)
    return Measured(
        parallels=mesh.shape[0],
        generatrices=mesh.shape[1],
        nodes=len(mesh.nodes),
        node_classes=len(nodes.marks),
        interior=int(np.count_nonzero(nodes.kind == NodeKind.INTERIOR)),
        members=len(mesh.edges),
        member_classes=len(edge_classes(mesh, arms, tolerance).representative),
        panels=len(mesh.face_ij),
        panel_classes=int(face_classes(mesh, tolerance.length).max()) + 1,
        shortest=float(lengths.min()),
        longest=float(lengths.max()),
        spread=float(lengths.std() / lengths.mean()),
        aspect=float(aspect_ratios(mesh).max()),
        planarity=float(planarity(mesh).max()),
        conical=_worst(conical_residual(mesh, arms)),
        circular=_worst(circularity(mesh)),
        cone=float(cone_angles(arms)[1].max()),
        mismatch=float(beam_mismatch(arms, depth).max()),
        torsion=float(node_torsion(mesh, arms).max()),
        deviation=float(surface_distances(smooth, _samples(mesh)).max()),
        levels=int(np.isfinite(horizontal_levels(mesh)).sum()),
        freegrid_planarity=public.planarity,
        freegrid_joint_classes=public.clusters,
        freegrid_lengths=public.lengths,
    )


def _worst(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else float("nan")


def _samples(mesh: Mesh) -> Floats:
    """Nodes and centres of faces (k, 3)."""
    sums = np.add.reduceat(mesh.nodes[mesh.faces], mesh.face_offsets[:-1], axis=0)
    return np.concatenate([mesh.nodes, sums / np.diff(mesh.face_offsets)[:, None]])
