"""V13: no panel and no beam passes through another one that it shares no node with.

Two convex plane polygons meet along the line that their planes share: there each covers an interval, and the two
overlap or they do not. Polygons in one plane overlap in an area.
"""

from typing import NamedTuple

import numpy as np
import shapely

from isomould.verify.delivery import Delivery
from isomould.verify.rules import Floats, Ints, Measured, Rule, worst_of

LENGTH = 1e-6
_PARALLEL = 1e-9
_CHUNK = 100_000
_SKEW = np.linalg.qr(np.array([[0.36, 0.48, 0.80], [0.79, -0.60, 0.13], [0.54, 0.59, -0.60]]))[0]
"""Axes along which no building is aligned: seen along the last, few of its parts lie behind each other."""


class _Polygons(NamedTuple):
    """Corners (p, v, 3) and their nodes (p, v), the last repeated where there are fewer; names (p,)."""

    corners: Floats
    nodes: Ints
    names: np.ndarray[tuple[int], np.dtype[np.str_]]


def crossings(delivery: Delivery) -> Measured:
    """Length, or root of the area, that two polygons without a common node have in common."""
    polygons = _polygons(delivery)
    pairs = _candidates(polygons)
    parts = np.array_split(pairs, 1 + len(pairs) // _CHUNK)
    common = np.concatenate([_common(polygons.corners[part]) for part in parts])
    names = [" and ".join(polygons.names[pair]) for pair in pairs[common > LENGTH]]
    if not names:
        return Measured(len(polygons.nodes), float(common.max(initial=0.0)))
    return worst_of(common[common > LENGTH], names)


def _polygons(delivery: Delivery) -> _Polygons:
    mesh = delivery.mesh
    sizes = np.diff(mesh.face_offsets)
    most = max(int(sizes.max()), 4)
    nodes = mesh.faces[mesh.face_offsets[:-1, None] + np.minimum(np.arange(most), sizes[:, None] - 1)]
    kept = np.flatnonzero(mesh.edge_family != "sill")
    ends = mesh.edges[kept]
    reach = float(delivery.design.raw["member"]["depth"]) / 2 / delivery.edge_slopes[kept, :, None]
    foot, head = (mesh.nodes[ends] + side * reach * mesh.node_axes[ends] for side in (-1, 1))
    beams = np.stack([foot[:, 0], foot[:, 1], head[:, 1], head[:, 0]], axis=1)
    again = np.minimum(np.arange(most), 3)
    return _Polygons(
        np.concatenate([mesh.nodes[nodes], beams[:, again]]),
        np.concatenate([nodes, ends[:, [0, 1, 1, 0]][:, again]]),
        np.concatenate([mesh.face_location, mesh.edge_location[kept]]),
    )


def _candidates(polygons: _Polygons) -> Ints:
    """Give the pairs (k, 2) whose boxes along the skew axes overlap and that have no node in common."""
    seen = polygons.corners @ _SKEW
    low, high = seen.min(axis=1) - LENGTH, seen.max(axis=1) + LENGTH
    boxes = np.asarray(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))
    one, other = shapely.STRtree(boxes).query(boxes)
    near = (one < other) & (low[one, 2] <= high[other, 2]) & (low[other, 2] <= high[one, 2])
    one, other = one[near], other[near]
    meet = (polygons.nodes[one][:, :, None] == polygons.nodes[other][:, None]).any(axis=(1, 2))
    return np.stack([one[~meet], other[~meet]], axis=1)


def _common(pairs: Floats) -> Floats:
    """Give what the polygons (k, 2, v, 3) of each pair have in common, mm; 0 where they only touch."""
    normals = _normals(pairs)
    heights = np.stack([_heights(pairs, normals, side) for side in (0, 1)], axis=1)
    line = np.cross(normals[:, 0], normals[:, 1])
    sine = np.linalg.norm(line, axis=1)
    pierced = ((heights.min(axis=2) < -LENGTH) & (heights.max(axis=2) > LENGTH)).all(axis=1) & (sine > _PARALLEL)
    coplanar = (abs(heights).max(axis=(1, 2)) <= LENGTH) & ~pierced
    common = np.zeros(len(pairs))
    common[pierced] = _along(pairs[pierced], heights[pierced], line[pierced] / sine[pierced, None])
    common[coplanar] = [_root_of_area(pairs[k, 0], pairs[k, 1], normals[k, 0]) for k in np.flatnonzero(coplanar)]
    return common


def _normals(pairs: Floats) -> Floats:
    spokes = pairs - pairs[:, :, :1]
    area = np.cross(spokes, np.roll(spokes, -1, axis=2)).sum(axis=2)
    return area / np.linalg.norm(area, axis=2, keepdims=True)


def _heights(pairs: Floats, normals: Floats, side: int) -> Floats:
    """Give the heights (k, v) of one polygon's corners over the other's plane."""
    return ((pairs[:, side] - pairs[:, 1 - side, :1]) * normals[:, 1 - side, None]).sum(axis=2)


def _along(pairs: Floats, heights: Floats, line: Floats) -> Floats:
    """Give the length of the shared interval on the line (k, 3) of both planes."""
    at = ((pairs - pairs[:, :1, :1]) * line[:, None, None]).sum(axis=3)
    after, beyond = np.roll(at, -1, axis=2), np.roll(heights, -1, axis=2)
    through = (heights > 0) != (beyond > 0)
    share = heights / np.where(through, heights - beyond, 1.0)
    place = at + share * (after - at)
    start, end = np.where(through, place, np.inf).min(axis=2), np.where(through, place, -np.inf).max(axis=2)
    return np.maximum(end.min(axis=1) - start.max(axis=1), 0.0)


def _root_of_area(one: Floats, other: Floats, normal: Floats) -> float:
    flat = np.linalg.svd(normal[None])[2][1:].T
    first, second = (shapely.Polygon((corners - one[0]) @ flat) for corners in (one, other))
    return float(np.sqrt(first.intersection(second).area))


RULES = (Rule("V13", "no panel or beam passes through another", LENGTH, "mm", crossings),)
