"""V36: every instance, measured anew from the mesh, is the part that its mark says (geometry §7)."""

from dataclasses import dataclass, replace

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.read.mesh import Mesh, edge_vectors, faces_by_size
from isomould.verify.read.tables import Table, half_unit, number, numbers, pairs, texts
from isomould.verify.rules import Floats, Ints, Measured, Rule, worse, worst_of

NOISE = 1e-9


@dataclass(frozen=True, eq=False)
class Arms:
    """Ends of members at nodes: node, member, azimuth counter-clockwise from outside, elevation (rad)."""

    owner: Ints
    edge: Ints
    azimuth: Floats
    elevation: Floats


def arms_of(mesh: Mesh, reference: Floats) -> Arms:
    """Measure all arms from the mesh alone; azimuths count from the nodes' reference directions (n, 3)."""
    count, edges = len(mesh.edges), edge_vectors(mesh)
    owner, edge = mesh.edges.T.ravel(), np.tile(np.arange(count), 2)
    ray = np.concatenate((edges, -edges))
    axis, zero = mesh.node_axes[owner], reference[owner]
    height = (ray * axis).sum(axis=1)
    level = ray - height[:, None] * axis
    azimuth = np.arctan2((np.cross(axis, zero) * level).sum(axis=1), (zero * level).sum(axis=1))
    return Arms(owner, edge, azimuth, np.arctan2(height, np.linalg.norm(level, axis=1)))


def nodes(delivery: Delivery) -> Measured:
    """Azimuths, elevations, families of every node's arms against its class, in degrees; never mirrored."""
    mesh, table = delivery.mesh, delivery.table("nodes")
    arms = arms_of(mesh, reference_directions(delivery))
    order = np.lexsort((np.round(arms.azimuth, 6) % (2 * np.pi), arms.owner))
    ends = np.searchsorted(arms.owner[order], np.arange(len(mesh.nodes) + 1))
    rows = {mark: k for k, mark in enumerate(texts(table, "mark"))}
    scheduled = _scheduled(table)
    off = [
        _node_off(mesh, arms, order[ends[k] : ends[k + 1]], scheduled[rows[str(mark)]])
        for k, mark in enumerate(mesh.node_mark)
    ]
    limit = float(delivery.design.raw["tolerances"]["angle_deg"]) + 2 * half_unit("azimuth_1_deg") + NOISE
    return worst_of(off, mesh.node_location, limit=limit)


def reference_directions(delivery: Delivery) -> Floats:
    """Give the direction of arm 1 of every node of the mesh, (n, 3), from the instances' table."""
    table = delivery.table("node_instances")
    values = np.column_stack([numbers(table, f"ref_{axis}") for axis in "xyz"])
    row = {location: k for k, location in enumerate(texts(table, "location"))}
    return values[[row[str(location)] for location in delivery.mesh.node_location]]


Scheduled = list[tuple[float, float, str]]
"""Azimuth and elevation (degrees) and family of the arms in order."""


def _scheduled(table: Table) -> list[Scheduled]:
    """Give the arms of every row, as many as its valence."""
    valence = numbers(table, "valence").astype(int)
    arms = [_arm_column(table, k) for k in range(1, int(valence.max(initial=0)) + 1)]
    return [[arms[k][row] for k in range(valence[row])] for row in range(table.rows)]


def _arm_column(table: Table, arm: int) -> Scheduled:
    azimuth, elevation = (numbers(table, f"{name}_{arm}_deg", blank=True) for name in ("azimuth", "elevation"))
    return list(zip(azimuth.tolist(), elevation.tolist(), texts(table, f"family_{arm}"), strict=True))


def _node_off(mesh: Mesh, arms: Arms, chosen: Ints, scheduled: Scheduled) -> float:
    families = [str(family) for family in mesh.edge_family[arms.edge[chosen]]]
    if families != [family for _, _, family in scheduled]:
        return np.inf
    wanted = np.array([row[:2] for row in scheduled])
    azimuth = np.degrees(arms.azimuth[chosen] - arms.azimuth[chosen[0]]) + wanted[0, 0] - wanted[:, 0]
    turned = np.remainder(azimuth + 180, 360) - 180
    return float(np.max(np.abs([turned, np.degrees(arms.elevation[chosen]) - wanted[:, 1]])))


def member_lengths(delivery: Delivery) -> Measured:
    """System length of every member in the mesh against its class."""
    mesh, claimed = delivery.mesh, pairs(delivery.table("members"), "mark", "system_length_mm")
    own = np.linalg.norm(edge_vectors(mesh), axis=1)
    off = abs(own - np.array([number(claimed[str(mark)]) for mark in mesh.edge_mark]))
    limit = float(delivery.design.raw["tolerances"]["length_mm"]) + half_unit("length_mm") + NOISE
    return worst_of(off, mesh.edge_location, limit=limit)


def member_ends(delivery: Delivery) -> Measured:
    """End cuts of every member as its class lies turned, in degrees: −elevation, and 0 where they are square."""
    mesh, count = delivery.mesh, len(delivery.mesh.edges)
    elevation = np.degrees(arms_of(mesh, mesh.node_axes).elevation.reshape(2, count).T)
    turned = pairs(delivery.table("member_instances"), "location", "turned")
    ends = _end_angles(delivery)
    where = zip(mesh.edge_mark, mesh.edge_location, strict=True)
    claimed = np.array([_as_turned(ends[str(mark)], turned[str(location)]) for mark, location in where])
    square = (mesh.edge_family == "sill") | (delivery.design.raw["node"]["detail"] == "faceted")
    off = abs(claimed - np.where(square[:, None], 0.0, -elevation))
    limit = float(delivery.design.raw["tolerances"]["angle_deg"]) + half_unit("angle_deg") + NOISE
    return worst_of(off.max(axis=1), mesh.edge_location, limit=limit)


def _end_angles(delivery: Delivery) -> dict[str, tuple[float, float]]:
    table = delivery.table("members")
    start, end = (numbers(table, f"end_angle_{side}_deg") for side in ("start", "end"))
    return dict(zip(texts(table, "mark"), zip(start.tolist(), end.tolist(), strict=True), strict=True))


def _as_turned(ends: tuple[float, float], turned: str) -> tuple[float, float]:
    start, end = ends
    return {
        "none": (start, end),
        "end_for_end": (end, start),
        "upside_down": (-start, -end),
        "both": (-end, -start),
    }[turned]


def panels(delivery: Delivery) -> Measured:
    """Largest difference of sides and diagonals of the mesh faces under the panels of one mark.

    Outlines are insets of the faces by different amounts, which is why twice the tolerance is allowed here.
    """
    found = [_spread(delivery, faces, corners) for faces, corners in faces_by_size(delivery.mesh)]
    limit = 2 * (float(delivery.design.raw["tolerances"]["length_mm"]) + 2 * half_unit("side_mm")) + NOISE
    return replace(worse(*found), limit=limit)


def _spread(delivery: Delivery, faces: Ints, corners: Ints) -> Measured:
    """Compare faces (f,) with as many corners (f, k): the largest spread within a mark."""
    marks, first, of = np.unique(delivery.mesh.face_mark[faces], return_index=True, return_inverse=True)
    ways = _face_sizes(delivery, faces, delivery.mesh.nodes[corners])
    off = abs(ways - ways[0][first][of]).max(axis=2)
    measured = ways[off.argmin(axis=0), np.arange(len(faces))]
    return worst_of([float(np.ptp(measured[of == k], axis=0).max()) for k in range(len(marks))], marks)


def _face_sizes(delivery: Delivery, faces: Ints, points: Floats) -> Floats:
    """Give sides and diagonals (ways, f, q) of faces from the part's first corner; both ways if flippable."""
    first = pairs(delivery.table("panel_instances"), "location", "first_corner")
    start = np.array([int(first[str(name)]) - 1 for name in delivery.mesh.face_location[faces]])
    count = points.shape[1]
    step = np.arange(count) - start[:, None]
    flippable = bool(delivery.design.raw["panel"].get("flippable", False))
    orders = [step % count, (start[:, None] - np.arange(count)) % count] if flippable else [step % count]
    return np.stack([_sizes(np.take_along_axis(points, order[..., None], axis=1)) for order in orders])


def _sizes(around: Floats) -> Floats:
    sides = np.linalg.norm(np.roll(around, -1, axis=1) - around, axis=2)
    return np.hstack((sides, np.linalg.norm(around[:, 2:] - around[:, :-2], axis=2)))


RULES = (
    Rule("V36", "nodes are congruent with their class, not mirrored", 0, "°", nodes),
    Rule("V36b", "members have the length of their class", 0, "mm", member_lengths),
    Rule("V36c", "members have the end cuts of their class", 0, "°", member_ends),
    Rule("V36d", "panels of one mark cover congruent faces", 0, "mm", panels),
)
