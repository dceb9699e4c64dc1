"""The building as a scene to turn on a screen: panels, members and nodes, each told what it is when pointed at."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints, read_only
from isomould.documents.picture import INK, blend, colour
from isomould.form.mesh import Family, Mesh
from isomould.parts.kit import Kit

_DRAWN_IN = 0.04
"""Share by which panels are drawn smaller than their faces, so that each stands apart from its neighbours."""

_PALER = 0.5

_METRES = 1e-3

_FAMILY_INKS = {Family.GENERATRIX: INK, Family.PARALLEL: "#7d4a12", Family.SILL: "#a02020"}


@dataclass(frozen=True, eq=False)
class Facets:
    """Triangles (m, 3) over vertices (n, 3), m; a text per vertex and a colour per triangle."""

    name: str
    vertices: Floats
    triangles: Ints
    texts: tuple[str, ...]
    colours: tuple[str, ...]

    def __post_init__(self) -> None:
        read_only(self.vertices)
        read_only(self.triangles)


@dataclass(frozen=True, eq=False)
class Strokes:
    """Straight lines between pairs of points (k, 2, 3), m, all of one colour."""

    name: str
    ends: Floats
    texts: tuple[str, ...]
    ink: str

    def __post_init__(self) -> None:
        read_only(self.ends)


@dataclass(frozen=True, eq=False)
class Points:
    """Points (n, 3), m, with a text and a colour each."""

    name: str
    places: Floats
    texts: tuple[str, ...]
    colours: tuple[str, ...]

    def __post_init__(self) -> None:
        read_only(self.places)


@dataclass(frozen=True)
class Scene:
    """What stands in space."""

    panels: Facets
    members: tuple[Strokes, ...]
    nodes: Points


def make_scene(kit: Kit) -> Scene:
    """Give the mesh of a kit, panels and nodes coloured by class."""
    nodes = Points(
        "nodes",
        kit.mesh.nodes * _METRES,
        _texts(kit.nodes.marks, kit.nodes.classes.of, kit.nodes.locations),
        tuple(colour(number) for number in kit.nodes.classes.of.tolist()),
    )
    families = [family for family in Family if (kit.mesh.family == family).any()]
    return Scene(_facets(kit), tuple(_strokes(kit, family) for family in families), nodes)


def _texts(marks: tuple[str, ...], of: Ints, locations: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(f"{marks[number]} {where}" for number, where in zip(of.tolist(), locations, strict=True))


def _facets(kit: Kit) -> Facets:
    mesh, of = kit.mesh, kit.panels.classes.of
    texts = _texts(kit.panels.marks, of, kit.panels.locations)
    triangles = np.repeat(of, mesh.sizes - 2)
    return Facets(
        "panels",
        _drawn_in(mesh) * _METRES,
        _fans(mesh),
        tuple(texts[face] for face in mesh.per_corner(np.arange(len(texts))).tolist()),
        tuple(blend(colour(number), "#ffffff", _PALER) for number in triangles.tolist()),
    )


def _drawn_in(mesh: Mesh) -> Floats:
    """Corners (k, 3) of all faces, moved towards the middle of their own."""
    corners = mesh.nodes[mesh.faces]
    middle = np.add.reduceat(corners, mesh.face_offsets[:-1]) / mesh.sizes[:, None]
    return corners + _DRAWN_IN * (mesh.per_corner(middle) - corners)


def _fans(mesh: Mesh) -> Ints:
    """Triangles (m, 3) over the corners of all faces, those of a face around its first corner."""
    first = np.repeat(mesh.face_offsets[:-1], mesh.sizes - 2)
    before = np.concatenate([[0], np.cumsum(mesh.sizes - 2)[:-1]])
    step = np.arange(len(first)) - np.repeat(before, mesh.sizes - 2)
    return np.stack([first, first + step + 1, first + step + 2], axis=-1)


def _strokes(kit: Kit, family: Family) -> Strokes:
    chosen = np.flatnonzero(kit.mesh.family == family)
    texts = _texts(kit.members.marks, kit.members.classes.of, kit.members.locations)
    ends = kit.mesh.nodes[kit.mesh.edges[chosen]] * _METRES
    return Strokes(f"members, {family.word}", ends, tuple(texts[k] for k in chosen.tolist()), _FAMILY_INKS[family])
