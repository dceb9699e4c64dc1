"""Whether far parts of a surface pass through each other (failure mode C10).

Panels and the middle planes of their beams are convex plane polygons. Two of them are apart exactly if some axis
separates them: a normal, a cross product of two sides, or, in one plane, a normal of a side. Neighbours, which share a
node, are left to the lengths and turnings of their edges.
"""

from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np
from scipy.spatial import KDTree

from isomould.arrays import Bools, Floats, Ints
from isomould.errors import Refused
from isomould.form.mesh import Family, Mesh

TOUCH = 1e-6
"""How deep polygons may reach into each other, mm."""

_CHUNK = 1 << 15


class Polygons(NamedTuple):
    """Convex plane polygons; short ones repeat their last corner."""

    corners: Floats
    """(p, v, 3) mm."""
    nodes: Ints
    """(p, v) numbers of the mesh's nodes that each touches."""


def refuse_clashes(mesh: Mesh, depth: float) -> None:
    """Refuse a mesh whose panels, or beams of a depth (mm), pass through others that they do not meet.

    Raises
    ------
    Refused
        E-SURFACE-CLASH naming both parts and how deep they reach into each other.
    """
    polygons = polygons_of(mesh, depth)
    pairs, depths = clashes(polygons)
    if not pairs.size:
        return
    worst = int(np.argmax(depths))
    one, other = (_called(mesh, int(number)) for number in pairs[worst])
    raise Refused(
        "E-SURFACE-CLASH",
        "generatrix.curve",
        f"{one} and {other} pass through each other, {depths[worst]:.3f} mm deep ({len(pairs)} such pairs)",
        f"parts that share no node stay apart (within {TOUCH:g} mm)",
        "Part the curves where they come back on themselves, trim the surface, or use a lower section.",
    )


def polygons_of(mesh: Mesh, depth: float) -> Polygons:
    """Give the panels and, after them, the middle planes of all members but sills."""
    beams = mesh.edges[mesh.family != Family.SILL]
    webs = _webs(mesh, beams, depth)
    table = mesh.table(mesh.faces)
    table = np.where(table < 0, table[np.arange(len(table)), mesh.sizes - 1][:, None], table)
    wide = np.arange(max(table.shape[1], 4))
    panels, rest = np.minimum(wide, table.shape[1] - 1), np.minimum(wide, 3)
    nodes = np.concatenate([table[:, panels], beams[:, [0, 1, 1, 0]][:, rest]])
    return Polygons(np.concatenate([mesh.nodes[table[:, panels]], webs[:, rest]]), nodes)


def _webs(mesh: Mesh, beams: Ints, depth: float) -> Floats:
    """Give the corners (b, 4, 3) of the middle planes: bottom and top of each beam on the axes of its nodes."""
    ends, axes = mesh.nodes[beams], mesh.axes[beams]
    along = ends[:, 1] - ends[:, 0]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    sine = np.linalg.norm(np.cross(along[:, None], axes), axis=2, keepdims=True)
    reach = depth / 2 / sine * axes
    low, high = ends - reach, ends + reach
    return np.stack([low[:, 0], low[:, 1], high[:, 1], high[:, 0]], axis=1)


def clashes(polygons: Polygons) -> tuple[Ints, Floats]:
    """Give the pairs (k, 2) of polygons without a common node that overlap, and how deep (k,), mm."""
    pairs = _near(polygons)
    depths = [_depth(polygons.corners[part]) for part in np.array_split(pairs, 1 + len(pairs) // _CHUNK)]
    found = np.concatenate(depths) if depths else np.empty(0)
    return pairs[found > TOUCH], found[found > TOUCH]


def _near(polygons: Polygons) -> Ints:
    """Give the pairs (k, 2) whose boxes overlap and that share no node, by balls of like size."""
    low, high = polygons.corners.min(axis=1) - TOUCH, polygons.corners.max(axis=1) + TOUCH
    centre, radius = (low + high) / 2, np.linalg.norm(high - low, axis=1) / 2
    octave = np.floor(np.log2(radius)).astype(np.int64)
    groups = [np.flatnonzero(octave == k) for k in np.unique(octave)]
    found = [_balls(centre, radius, one, other) for one, other in combinations_with_replacement(groups, 2)]
    pairs = np.concatenate(found)
    first, second = pairs.T
    boxes = ((low[first] <= high[second]) & (low[second] <= high[first])).all(axis=1)
    pairs = pairs[boxes]
    return pairs[~_meet(polygons.nodes, pairs)]


def _balls(centre: Floats, radius: Floats, one: Ints, other: Ints) -> Ints:
    reach = float(radius[one].max() + radius[other].max())
    if one is other:
        return one[KDTree(centre[one]).query_pairs(reach, output_type="ndarray")]
    near = KDTree(centre[one]).sparse_distance_matrix(KDTree(centre[other]), reach, output_type="ndarray")
    return np.stack([one[near["i"]], other[near["j"]]], axis=1)


def _meet(nodes: Ints, pairs: Ints) -> Bools:
    first, second = nodes[pairs[:, 0]], nodes[pairs[:, 1]]
    shared = [(first == second[:, [k]]).any(axis=1) for k in range(nodes.shape[1])]
    return np.any(shared, axis=0)


def _depth(pairs: Floats) -> Floats:
    """Give how deep the polygons (k, 2, v, 3) of each pair overlap, mm: the least over all separating axes."""
    axes = _axes(pairs)
    size = np.linalg.norm(axes, axis=-1, keepdims=True)
    unit = np.divide(axes, size, out=np.zeros_like(axes), where=size > 0)
    at = pairs - pairs[:, :1, :1]
    reach = np.einsum("kpvc,kac->kpav", at, unit)
    low, high = reach.min(axis=3), reach.max(axis=3)
    overlap = np.minimum(high[:, 0] - low[:, 1], high[:, 1] - low[:, 0])
    flat = high.max(axis=1) - low.min(axis=1) <= TOUCH  # the normal of one plane that holds both separates nothing
    return np.where((size[..., 0] > 1e-9) & ~flat, overlap, np.inf).min(axis=1)


def _axes(pairs: Floats) -> Floats:
    """Give the axes (k, a, 3) among which one separates the polygons of a pair if they are apart.

    Unit sides make their cross products sines: those of parallel sides, which are no axes, are seen as such.
    """
    sides = np.roll(pairs, -1, axis=2) - pairs
    size = np.linalg.norm(sides, axis=3, keepdims=True)
    sides = np.divide(sides, size, out=np.zeros_like(sides), where=size > 0)
    normals = _normals(pairs)
    count, _, corners, _ = pairs.shape
    within = np.cross(normals[:, :, None], sides).reshape(count, 2 * corners, 3)
    across = np.cross(sides[:, 0, :, None], sides[:, 1, None]).reshape(count, corners**2, 3)
    return np.concatenate([normals, within, across], axis=1)


def _normals(pairs: Floats) -> Floats:
    """Give unit normals (k, 2, 3) by the sum of the corners' cross products, twice the area."""
    from_first = pairs - pairs[:, :, :1]
    area = np.cross(from_first[:, :, 1:-1], from_first[:, :, 2:]).sum(axis=2)
    return area / np.linalg.norm(area, axis=2, keepdims=True)


def _called(mesh: Mesh, number: int) -> str:
    if number < len(mesh.face_ij):
        i, j = mesh.face_ij[number]
        return f"the panel of row {i}, strip {j}"
    beam = np.flatnonzero(mesh.family != Family.SILL)[number - len(mesh.face_ij)]
    i, j = mesh.edge_ij[beam]
    return f"the {Family(mesh.family[beam]).word} member at node ({i}, {j})"
