"""3MF solids, zip and XML of the core specification, and binary STL, read by hand."""

import zipfile
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from isomould.verify.read.text import refusing
from isomould.verify.rules import Floats, Ints, Unreadable

_CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]


@dataclass(frozen=True, eq=False)
class Solid:
    """Triangles of one solid: `vertices` (n, 3) mm, `triangles` (t, 3)."""

    vertices: Floats
    triangles: Ints


@refusing
def read_3mf(path: Path) -> Solid:
    """Read the one object of a package in millimetres, built once in its own frame."""
    with zipfile.ZipFile(path) as package:
        if package.testzip() is not None:
            _refuse("a part of the package is corrupt")
        model = ElementTree.fromstring(package.read("3D/3dmodel.model"))
    if model.get("unit", "millimeter") != "millimeter":
        _refuse(f"unit is {model.get('unit')}")
    _refuse_moved(model)
    return _mesh(model)


def _refuse_moved(model: ElementTree.Element) -> None:
    items = model.findall(f"{_CORE}build/{_CORE}item")
    moves = [item.get("transform", "1 0 0 0 1 0 0 0 1 0 0 0") for item in items]
    if len(items) != 1 or [float(x) for x in moves[0].split()] != _IDENTITY:
        _refuse("not one build item in its own frame")


def _mesh(model: ElementTree.Element) -> Solid:
    meshes = model.findall(f".//{_CORE}mesh")
    if len(meshes) != 1:
        _refuse(f"{len(meshes)} meshes, not one")
    vertices = _rows(meshes[0], "vertex", ("x", "y", "z"))
    triangles = _rows(meshes[0], "triangle", ("v1", "v2", "v3")).astype(np.int64)
    if not (np.isfinite(vertices).all() and (triangles >= 0).all() and (triangles < len(vertices)).all()):
        _refuse("a coordinate is not finite or a triangle names no vertex")
    return Solid(vertices, triangles)


def _rows(mesh: ElementTree.Element, tag: str, names: tuple[str, str, str]) -> Floats:
    rows = [[float(row.attrib[name]) for name in names] for row in mesh.iter(f"{_CORE}{tag}")]
    return np.array(rows, dtype=np.float64).reshape(-1, 3)


@refusing
def read_stl(path: Path) -> Floats:
    """Read the corners (t, 3, 3) of the triangles of a binary STL."""
    content = path.read_bytes()
    count = int.from_bytes(content[80:84], "little")
    if len(content) != 84 + 50 * count:
        _refuse(f"{count} triangles announced, {len(content)} bytes found")
    facets = np.frombuffer(content, dtype=_FACET, offset=84)
    return facets["corners"].astype(np.float64)


def _refuse(message: str) -> None:
    raise Unreadable(message)
