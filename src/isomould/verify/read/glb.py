"""`model/model.glb`: the shapes by mark and where they stand, glTF 2.0 binary read by hand."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from isomould.verify.read.solid import Solid
from isomould.verify.read.text import Json, refusing
from isomould.verify.rules import Floats, Unreadable

_METRES_Y_UP = np.array([[0.001, 0, 0, 0], [0, 0, 0.001, 0], [0, -0.001, 0, 0], [0, 0, 0, 1]])
_TYPES = {5125: np.dtype("<u4"), 5126: np.dtype("<f4")}
_WIDTHS = {"SCALAR": 1, "VEC3": 3}


@dataclass(frozen=True, eq=False)
class Placed:
    """A part of the model: its mark, its location and the transform (4, 4) of its shape to the building, mm."""

    mark: str
    location: str
    matrix: Floats


@dataclass(frozen=True, eq=False)
class Model:
    """All shapes by mark, in mm in their own frames, and all parts."""

    shapes: dict[str, Solid]
    parts: tuple[Placed, ...]


@refusing
def read_glb(path: Path) -> Model:
    """Read a model whose root turns millimetres into metres and Z into Y, with parts named "mark location"."""
    content = path.read_bytes()
    size = int.from_bytes(content[12:16], "little")
    if content[:8] != b"glTF\x02\x00\x00\x00" or int.from_bytes(content[8:12], "little") != len(content):
        _refuse("no whole glTF 2 binary")
    tree: Json = json.loads(content[20 : 20 + size])
    root, *nodes = tree["nodes"]
    if not np.array_equal(_matrix(root), _METRES_Y_UP):
        _refuse("the root is not in metres with Y up")
    names = [str(mesh["name"]) for mesh in tree["meshes"]]
    shapes = {name: _shape(tree, k, content[28 + size :]) for k, name in enumerate(names)}
    return Model(shapes, tuple(_placed(node, names) for node in nodes))


def _placed(node: Json, names: list[str]) -> Placed:
    mark, location = str(node["name"]).split(" ")
    if names[int(node["mesh"])] != mark:
        _refuse(f"{location} is called {mark} and shows {names[int(node['mesh'])]}")
    return Placed(mark, location, _matrix(node))


def _matrix(node: Json) -> Floats:
    return np.array(node.get("matrix", np.eye(4).ravel()), dtype=np.float64).reshape(4, 4).T


def _shape(tree: Json, mesh: int, data: bytes) -> Solid:
    primitive: Json = tree["meshes"][mesh]["primitives"][0]
    corners = _values(tree, int(primitive["attributes"]["POSITION"]), data)
    triangles = _values(tree, int(primitive["indices"]), data)
    return Solid(corners, triangles.reshape(-1, 3).astype(np.int64))


def _values(tree: Json, number: int, data: bytes) -> Floats:
    accessor: Json = tree["accessors"][number]
    view: Json = tree["bufferViews"][accessor["bufferView"]]
    width = _WIDTHS[accessor["type"]]
    start = int(view.get("byteOffset", 0)) + int(accessor.get("byteOffset", 0))
    kind = _TYPES[accessor["componentType"]]
    return np.frombuffer(data, kind, int(accessor["count"]) * width, start).reshape(-1, width).astype(np.float64)


def _refuse(message: str) -> None:
    raise Unreadable(message)
