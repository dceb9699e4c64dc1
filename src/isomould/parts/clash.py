"""Parts that take each other's space, looked for at one node of every kind (fabrication, Clash).

Everything is compared in the frame of a node, near the origin, where the solid kernel is exact. Parts that are meant to
touch may overlap by what rounding adds to their outlines; a clash is deeper than that.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

import manifold3d as m3
import numpy as np

from isomould.arrays import Floats, Ints
from isomould.errors import Refused
from isomould.parts.arms import normalised
from isomould.parts.building import Standing, place_bases, place_parts
from isomould.parts.kit import Kit, KitSettings
from isomould.parts.plates import Shape, shape_of

CONTACT = 0.005
"""mm: how deep parts that touch may overlap."""
SLIVER = 1e-3
"""mm³: what is left of two faces that touch."""
_REACH = 400.0
"""mm: outlines further from the node than this do not tell kinds of nodes apart."""
_GRID, _TURN = 0.02, 2e-5
"""mm and rad: nodes whose surroundings agree to this are of one kind."""


@dataclass(frozen=True, eq=False)
class _Part:
    """A part at a node: its name, its mark and its pose (4, 4) in the node's frame."""

    name: str
    mark: str
    pose: Floats


@dataclass(frozen=True, eq=False)
class _Clash:
    depth: float
    parts: tuple[_Part, _Part]
    node: str


def refuse_clashes(kit: Kit, settings: KitSettings, shapes: Mapping[str, Shape]) -> None:
    """Hold members, panels and nodes against each other at every kind of node.

    Raises
    ------
    Refused
        If two parts overlap, naming the deepest overlap.
    """
    worst = max(_clashes(kit, settings, shapes), key=lambda clash: clash.depth, default=None)
    if worst is None:
        return
    one, other = worst.parts
    raise Refused(
        "E-CLASH",
        f"parts ({one.name} and {other.name})",
        f"they overlap by {worst.depth:.3f} mm at node {worst.node}",
        f"at most {CONTACT:g} mm, the contact of rounded outlines",
        "Divide the curves differently, give more room (nodes.end_gap, nodes.clearance, panels.gap, panels.spacer) or "
        "tighter [tolerances].",
    )


def _clashes(kit: Kit, settings: KitSettings, shapes: Mapping[str, Shape]) -> Iterator[_Clash]:
    solids = {mark: _solid(shape) for mark, shape in shapes.items()}
    for node, parts in _kinds(kit, place_parts(kit, settings), place_bases(kit)):
        placed = [solids[part.mark].transform(part.pose[:3]) for part in parts]
        for (one, body), (other, against) in combinations(zip(parts, placed, strict=True), 2):
            depth = overlap_depth(body, against)
            if depth > CONTACT:
                yield _Clash(depth, (one, other), node)


def _solid(shape: Shape) -> m3.Manifold:
    vertices, triangles = shape.vertices.copy(), shape.triangles.astype(np.uint64)  # it takes writable arrays only
    return m3.Manifold(m3.Mesh64(vertices, triangles))


def overlap_depth(one: m3.Manifold, other: m3.Manifold) -> float:
    """Give the thickness, mm, of what two solids share, of its thickest piece; 0 if they touch at most."""
    common = one ^ other
    if common.volume() <= SLIVER:
        return 0.0
    return max(_thickness(piece) for piece in common.decompose())


def _thickness(piece: m3.Manifold) -> float:
    """Smallest extent along the normals of the faces, but no more than 6 V / S.

    Exact for slabs. No ball inside a convex body is thicker than 6 V / S, which tells a thin film that runs round a
    corner, as contact on two faces leaves it, from a body of the corner's size.
    """
    shape = shape_of(piece)
    a, b, c = np.moveaxis(shape.vertices[shape.triangles], 1, 0)
    normals = np.cross(b - a, c - a)
    real = np.linalg.norm(normals, axis=1) > 1e-9
    if piece.volume() <= SLIVER / 10 or not real.any():
        return 0.0
    extent = np.ptp(shape.vertices @ normalised(normals[real]).T, axis=0).min()
    return float(min(extent, 6 * piece.volume() / piece.surface_area()))


def _kinds(
    kit: Kit, standing: tuple[Standing, Standing, Standing], bases: Standing
) -> Iterator[tuple[str, list[_Part]]]:
    """Give the location and the parts of one node of every kind; what it stands on belongs to its class."""
    nodes, members, panels = standing
    inverse = np.linalg.inv(nodes.poses).astype(np.float64)
    looks: list[list[bytes]] = [[mark.encode()] for mark in nodes.marks]
    around = [
        [_Part(f"{mark} {where}", mark, np.eye(4))]
        for mark, where in zip(nodes.marks, nodes.locations, strict=True)
    ]  # fmt: skip
    place = {where: node for node, where in enumerate(nodes.locations)}
    for mark, where, pose in zip(bases.marks, bases.locations, bases.poses, strict=True):
        around[place[where]].append(_Part(f"{mark} {where}", mark, inverse[place[where]] @ pose))
    outlines = _outlines(kit)
    for parts, meeting in ((members, _of_edges(kit)), (panels, _of_faces(kit))):
        for node, part, pose, look in _seen(inverse, parts, meeting, outlines):
            around[node].append(_Part(f"{parts.marks[part]} {parts.locations[part]}", parts.marks[part], pose))
            looks[node].append(look)
    chosen = {tuple(sorted(look)): node for node, look in reversed(list(enumerate(looks)))}
    return ((nodes.locations[node], around[node]) for node in sorted(chosen.values()))


def _outlines(kit: Kit) -> dict[str, Floats]:
    shapes = dict(zip(kit.members.marks, (shape.outline for shape in kit.members.shapes), strict=True))
    return shapes | dict(zip(kit.panels.marks, kit.panels.outlines, strict=True))


def _of_edges(kit: Kit) -> Ints:
    """Pairs (k, 2) of node and member."""
    edge = np.arange(len(kit.mesh.edges))
    return np.concatenate([np.stack([end, edge], axis=-1) for end in kit.mesh.edges.T])


def _of_faces(kit: Kit) -> Ints:
    """Pairs (k, 2) of node and panel."""
    return np.stack([kit.mesh.faces, kit.mesh.per_corner(np.arange(len(kit.mesh.face_ij)))], axis=-1)


def _seen(
    inverse: Floats, parts: Standing, meeting: Ints, outlines: Mapping[str, Floats]
) -> Iterator[tuple[int, int, Floats, bytes]]:
    """Parts (node, part, pose, look) as their nodes see them; a look is of the outline near the node."""
    marks = np.array(parts.marks)[meeting[:, 1]]
    for mark in dict.fromkeys(marks.tolist()):
        pairs = meeting[marks == mark]
        poses = inverse[pairs[:, 0]] @ parts.poses[pairs[:, 1]]
        for (node, part), pose, look in zip(pairs.tolist(), poses, _looks(outlines[mark], poses), strict=True):
            yield node, part, pose, look


def _looks(outline: Floats, poses: Floats) -> list[bytes]:
    """Describe an outline (n, 2) in the poses (k, 4, 4): its near corners, each with the directions of its sides."""
    points = np.einsum("kij,nj->kni", poses[:, :3, :2], outline) + poses[:, None, :3, 3]
    sides = [normalised(np.roll(points, step, axis=1) - points) for step in (1, -1)]
    rows = [np.concatenate([points / _GRID, side / _TURN], axis=2) for side in sides]
    rounded = np.round(np.concatenate(rows, axis=1) + 1 / np.pi).astype(np.int64)
    near = np.tile(np.linalg.norm(points, axis=2) < _REACH, 2)
    return [b"".join(sorted(row.tobytes() for row in found[there])) for found, there in zip(rounded, near, strict=True)]
