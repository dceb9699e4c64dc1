"""Names on the developed surface: mark and location of every part, each written once, where it finds room."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.documents.shop.font import text_width
from isomould.documents.shop.page import SMALL, SMALLEST, Text, point, reading
from isomould.form.mesh import Mesh
from isomould.parts.kit import Kit
from isomould.ties import NOISE


@dataclass(frozen=True, eq=False)
class Names:
    """What stands on every node, edge and face: mark and location."""

    nodes: tuple[str, ...]
    edges: tuple[str, ...]
    faces: tuple[tuple[str, str], ...]
    face_edges: Ints

    @cached_property
    def longest(self) -> float:
        """Width of the longest name along an edge, mm."""
        return max(text_width(name, SMALLEST) for name in (*self.nodes, *self.edges))


def make_names(kit: Kit) -> Names:
    """Give mark and location of every part of the mesh."""
    nodes, edges = (
        tuple(f"{parts.marks[k]} {where}" for k, where in zip(parts.classes.of.tolist(), parts.locations, strict=True))
        for parts in (kit.nodes, kit.members)
    )
    panels = kit.panels
    marks = [panels.marks[k] for k in panels.classes.of.tolist()]
    return Names(nodes, edges, tuple(zip(marks, panels.locations, strict=True)), panels.edges)


@dataclass(frozen=True, eq=False)
class Labels:
    """The names of the parts, and the one panel in which an edge's or a node's name is written."""

    mesh: Mesh
    names: Names
    edge_owner: Ints
    node_owner: Ints


def owners(mesh: Mesh, names: Names) -> tuple[Ints, Ints]:
    """Give the face that writes the name of every edge and of every node: the last one around it."""
    order = np.argsort(mesh.per_corner(mesh.face_ij.sum(axis=1)), kind="stable")
    face = mesh.per_corner(np.arange(len(mesh.face_ij)))
    edges, nodes = np.full(len(mesh.edges), -1), np.full(len(mesh.nodes), -1)
    seated = order[names.face_edges[order] >= 0]
    edges[names.face_edges[seated]], nodes[mesh.faces[order]] = face[seated], face[order]
    return edges, nodes


def face_names(face: int, points: Floats, labels: Labels) -> Iterator[list[Text]]:
    """Ways to write what belongs to a panel: its own name, those of its edges, those of its corners."""
    mesh, names = labels.mesh, labels.names
    corner = range(mesh.face_offsets[face], mesh.face_offsets[face + 1])
    centre = points.mean(axis=0)
    mark, where = names.faces[face]
    yield [Text(mark, point(centre + np.array([0.0, 0.4])), SMALL, "middle", bold=True)]
    yield [Text(where, point(centre - np.array([0.0, 2.3])), SMALLEST, "middle")]
    for k, at in enumerate(corner):
        edge = names.face_edges[at]
        if edge >= 0 and labels.edge_owner[edge] == face:
            yield _along_side(points[k], points[(k + 1) % len(points)], names.edges[edge])
    for k, at in enumerate(corner):
        node = mesh.faces[at]
        if labels.node_owner[node] == face:
            yield _at_corner(points[k], centre, names.nodes[node])


def _along_side(start: Floats, end: Floats, name: str) -> list[Text]:
    """Ways to write a name inside a panel along its side from start to end, which has the panel on its left."""
    way = end - start
    turn = float(np.arctan2(way[1], way[0]))
    inward = np.array([-np.sin(turn), np.cos(turn)])
    shown = reading(turn)
    rise = 0.9 + (SMALLEST if np.cos(shown - turn) < 0 else 0.0)
    texts = (name, name.split(maxsplit=1)[0])
    shares = (0.5, 0.6, 0.4)
    return [Text(t, point(start + s * way + rise * inward), SMALLEST, "middle", shown) for t in texts for s in shares]


def _at_corner(corner: Floats, centre: Floats, name: str) -> list[Text]:
    """Ways to write a name level inside a panel near one of its corners."""
    right, up = np.where(centre - corner > -NOISE, 1.0, -1.0).tolist()
    anchor = "start" if right > 0 else "end"
    lift = 0.0 if up > 0 else -SMALLEST
    return [
        Text(text, point(corner + np.array([right * x, up * y + lift])), SMALLEST, anchor)
        for text in (name, name.split(maxsplit=1)[0])
        for y in (1.2, 3.4, 5.6)
        for x in (1.2, 3.4)
    ]
