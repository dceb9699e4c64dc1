"""What meets at every node of the placed model, and which nodes look alike to the parts that meet there."""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from isomould.verify.read.glb import Model, Placed
from isomould.verify.read.mesh import Mesh
from isomould.verify.read.solid import Solid
from isomould.verify.rules import Floats, Ints, Unreadable

NEAR = 400.0
"""Corners nearer to the node than this, mm, and the edges that leave them, tell two joints apart."""
_GRID = np.array([0.02, 0.02, 0.02, 2e-5, 2e-5, 2e-5])
_OFF_TIES = 0.0031415
_BENT = 1e-3


@dataclass(frozen=True, eq=False)
class Joint:
    """The parts at one node, their transforms (4, 4) in the frame of the node."""

    location: str
    parts: tuple[Placed, ...]


def different_joints(mesh: Mesh, model: Model) -> list[Joint]:
    """Give one joint of every kind: nodes of one mark around which all corners and edges are the same."""
    around = _around(mesh, model)
    looks = _looks(model, around)
    chosen: dict[tuple[str, ...], Joint] = {}
    for location, parts in around.items():
        marks = tuple(part.mark for part in parts if part.location == location)
        others = sorted(looks[location, part.location] for part in parts if part.location != location)
        chosen.setdefault((*marks, *others), Joint(location, parts))
    return list(chosen.values())


def _around(mesh: Mesh, model: Model) -> dict[str, tuple[Placed, ...]]:
    """All parts at every node, in its frame: its own, members that end and panels that have a corner there."""
    named: dict[str, list[Placed]] = defaultdict(list)
    for part in model.parts:
        named[part.location].append(part)
    _require({*mesh.node_location, *mesh.edge_location, *mesh.face_location}, named)
    meeting: dict[str, list[str]] = {str(location): [str(location)] for location in mesh.node_location}
    for node, location in _ends(mesh):
        meeting[str(mesh.node_location[node])].append(location)
    return {node: _in_frame(named, names) for node, names in meeting.items()}


def _ends(mesh: Mesh) -> Iterator[tuple[int, str]]:
    for location, pair in zip(mesh.edge_location.tolist(), mesh.edges.tolist(), strict=True):
        yield from ((node, location) for node in pair)
    corners = np.split(mesh.faces, mesh.face_offsets[1:-1])
    for location, nodes in zip(mesh.face_location.tolist(), corners, strict=True):
        yield from ((node, location) for node in nodes.tolist())


def _in_frame(named: dict[str, list[Placed]], names: list[str]) -> tuple[Placed, ...]:
    there = np.linalg.inv(named[names[0]][0].matrix)
    return tuple(Placed(part.mark, part.location, there @ part.matrix) for name in names for part in named[name])


def _require(wanted: set[str], named: dict[str, list[Placed]]) -> None:
    differing = sorted(wanted ^ named.keys())
    if differing:
        message = f"model/model.glb: {', '.join(differing[:3])} in the mesh or in the model only"
        raise Unreadable(message)


def _looks(model: Model, around: dict[str, tuple[Placed, ...]]) -> dict[tuple[str, str], str]:
    """Describe every part at every node as the node sees it, whatever its mark and its far end."""
    by_mark: dict[str, list[tuple[str, Placed]]] = defaultdict(list)
    for node, parts in around.items():
        for part in parts:
            if part.location != node:
                by_mark[part.mark].append((node, part))
    return {key: look for mark, seen in by_mark.items() for key, look in _looks_of(model.shapes[mark], seen)}


def _looks_of(shape: Solid, seen: list[tuple[str, Placed]]) -> Iterator[tuple[tuple[str, str], str]]:
    """Rows of a corner near the node and the direction of an edge from it, rounded and sorted."""
    start, end = _real_edges(shape).T
    pose = np.stack([part.matrix for _, part in seen])
    points = np.einsum("ijk,vk->ivj", pose[:, :3, :3], np.round(shape.vertices, 3)) + pose[:, None, :3, 3]
    along = points[:, end] - points[:, start]
    along /= np.linalg.norm(along, axis=2)[..., None]
    rows = np.concatenate([points[:, start], along], axis=2) / _GRID + _OFF_TIES
    near = np.linalg.norm(points[:, start], axis=2) < NEAR
    for (node, part), found, there in zip(seen, np.round(rows).astype(np.int64), near, strict=True):
        kept = found[there]
        yield (node, part.location), kept[np.lexsort(kept.T)].tobytes().hex()


def _real_edges(shape: Solid) -> Ints:
    """Directed edges (e, 2) of a solid at which its surface bends; the others are the triangulation's."""
    corner = shape.vertices[shape.triangles]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    sides = np.concatenate([shape.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    owner = np.tile(np.arange(len(shape.triangles)), 3)
    ahead, back = np.lexsort(sides.T), np.lexsort(sides[:, ::-1].T)
    bend = np.linalg.norm(normal[owner[ahead]] - normal[owner[back]], axis=1)
    return sides[ahead][bend > _BENT]


def spread_of(points: Floats, normals: Floats) -> float:
    """Give the smallest extent of points (n, 3) along unit normals (m, 3)."""
    return float(np.ptp(points @ normals.T, axis=0).min())
