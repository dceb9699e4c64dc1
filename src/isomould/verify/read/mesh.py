"""`model/geometry.npz`: the delivered mesh."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from isomould.verify.read.text import refusing
from isomould.verify.rules import Floats, Ints, Unreadable

Strings = NDArray[np.str_]

_SHAPES = {  # name: (kind, columns or 0 for one-dimensional, counted with)
    "nodes": ("f", 3, "nodes"), "node_axes": ("f", 3, "nodes"), "node_ij": ("i", 2, "nodes"),
    "node_mark": ("U", 0, "nodes"), "node_location": ("U", 0, "nodes"),
    "edges": ("i", 2, "edges"), "edge_family": ("U", 0, "edges"), "edge_mark": ("U", 0, "edges"),
    "edge_location": ("U", 0, "edges"),
    "face_ij": ("i", 2, "face_ij"), "face_mark": ("U", 0, "face_ij"), "face_location": ("U", 0, "face_ij"),
    "faces": ("i", 0, "faces"), "face_offsets": ("i", 0, "face_offsets"),
}  # fmt: skip
_KINDS = {"f": np.float64, "i": np.int64, "U": np.str_}


@dataclass(frozen=True, eq=False)
class Mesh:
    """The arrays of the file (geometry.npz contract); lengths in mm, axes are unit vectors."""

    nodes: Floats
    node_axes: Floats
    node_ij: Ints
    node_mark: Strings
    node_location: Strings
    edges: Ints
    edge_family: Strings
    edge_mark: Strings
    edge_location: Strings
    face_ij: Ints
    face_mark: Strings
    face_location: Strings
    faces: Ints
    face_offsets: Ints


@refusing
def read_mesh(path: Path) -> Mesh:
    """Read and check shapes, kinds, finiteness, index ranges, unit axes and unique locations."""
    with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
        arrays = {name: _array(name, file[name]) for name in _SHAPES}
    for name, (_, _, counted) in _SHAPES.items():
        _require(len(arrays[name]) == len(arrays[counted]), f"{name} and {counted} differ in length")
    mesh = Mesh(**cast("dict[str, Any]", arrays))
    _check_indices(mesh)
    _check_values(mesh)
    return mesh


def _array(name: str, found: NDArray[np.generic]) -> NDArray[np.generic]:
    kind, columns, _ = _SHAPES[name]
    _require(found.dtype.kind == kind, f"{name} holds {found.dtype}")
    _require(
        found.shape[1:] == ((columns,) if columns else ()) and found.ndim > 0,
        f"{name} has shape {found.shape}",
    )
    return found.astype(_KINDS[kind])


def _check_indices(mesh: Mesh) -> None:
    offsets = mesh.face_offsets
    _require(len(offsets) == len(mesh.face_ij) + 1 and offsets[0] == 0, "face_offsets do not start the faces")
    _require(
        offsets[-1] == len(mesh.faces) and bool(np.all(np.diff(offsets) >= 3)),
        "face_offsets are not of faces",
    )
    for name, indices in (("edges", mesh.edges), ("faces", mesh.faces)):
        _require(bool(np.all((indices >= 0) & (indices < len(mesh.nodes)))), f"{name} name nodes that do not exist")


def _check_values(mesh: Mesh) -> None:
    for name, values in (("nodes", mesh.nodes), ("node_axes", mesh.node_axes)):
        bad = mesh.node_location[~np.isfinite(values).all(axis=1)]
        _require(not len(bad), f"{name} of {', '.join(bad[:3])} are not finite")
    _require(
        bool(np.all(abs(np.linalg.norm(mesh.node_axes, axis=1) - 1) < 1e-12)),
        "node_axes are not unit vectors",
    )
    for name in ("node_location", "edge_location", "face_location"):
        locations: Strings = getattr(mesh, name)
        _require(len(np.unique(locations)) == len(locations), f"{name} repeats a location")


def _require(holds: bool, message: str) -> None:
    if not holds:
        raise Unreadable(message)


def edge_vectors(mesh: Mesh) -> Floats:
    """Give the edges as vectors from their first to their second node, (e, 3)."""
    return mesh.nodes[mesh.edges[:, 1]] - mesh.nodes[mesh.edges[:, 0]]


def faces_by_size(mesh: Mesh) -> list[tuple[Ints, Ints]]:
    """Give for every number of corners k the faces (f,) and their corners (f, k)."""
    sizes = np.diff(mesh.face_offsets)
    chosen = [np.flatnonzero(sizes == k) for k in np.unique(sizes)]
    return [(f, mesh.faces[mesh.face_offsets[f][:, None] + np.arange(int(sizes[f[0]]))]) for f in chosen]
