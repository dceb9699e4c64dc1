"""The whole model: arrays as NPZ, the mesh as OBJ, all parts as GLB."""

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray
from trimesh.exchange.gltf import export_glb

from isomould.arrays import Floats, Ints
from isomould.documents.numbers import format_number
from isomould.errors import Refused
from isomould.writers.disk import write_bytes, zip_bytes
from isomould.writers.solids import check_triangles

_OBJ_DECIMALS = 6
_METRES_Y_UP = np.array([[0.001, 0.0, 0.0, 0.0], [0.0, 0.0, 0.001, 0.0], [0.0, -0.001, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])


@dataclass(frozen=True, eq=False)
class Instance:
    """A part of the model: mark and location, and where its class's shape stands (4, 4), mm."""

    mark: str
    location: str
    matrix: Floats

    @property
    def name(self) -> str:
        """Mark and location, as in the file."""
        return f"{self.mark} {self.location}"


def write_npz(path: Path, arrays: Mapping[str, NDArray[np.generic]]) -> None:
    """Write arrays as compressed NPZ without pickles, the same bytes every time.

    Raises
    ------
    Refused
        If an array holds objects, or a number that is not finite.
    """
    for name, array in arrays.items():
        _check_array(name, array)
    write_bytes(path, zip_bytes({f"{name}.npy": _npy(array) for name, array in arrays.items()}))


def write_obj(
    path: Path,
    vertices: Floats,
    faces: Ints,
    offsets: Ints,
    groups: Sequence[str],
    lines: Mapping[str, Ints] | None = None,
) -> None:
    """Write a polygon mesh as OBJ in mm, one group per face.

    Parameters
    ----------
    path : Path
    vertices : (n, 3) float, mm
    faces : (k,) int
        Corners of all faces, one after another.
    offsets : (f + 1,) int
        Where each face starts in `faces`.
    groups : sequence of f str
        A name per face: its mark and location.
    lines : mapping of group to (2,) int, optional
        Line elements between two vertices.
    """
    points = [" ".join(["v", *(format_number(x, _OBJ_DECIMALS) for x in vertex)]) for vertex in vertices.tolist()]
    corners = np.split(faces + 1, offsets[1:-1])
    named = zip(groups, corners, strict=True)
    polygons = [f"g {group}\nf {' '.join(map(str, face.tolist()))}" for group, face in named]
    strokes = [f"g {group}\nl {' '.join(map(str, (ends + 1).tolist()))}" for group, ends in (lines or {}).items()]
    write_bytes(path, ("\n".join(["# isomould, lengths in mm", *points, *polygons, *strokes]) + "\n").encode())


def write_glb(path: Path, shapes: Mapping[str, tuple[Floats, Ints]], instances: Sequence[Instance]) -> None:
    """Write parts as GLB: one mesh per class, one node "mark location" per part; metres, Y up.

    Parameters
    ----------
    path : Path
    shapes : mapping of mark to (vertices (n, 3) mm, triangles (m, 3))
    instances : sequence of Instance
        Each of a mark in `shapes`.
    """
    scene = trimesh.Scene()
    scene.graph.update("model", matrix=_METRES_Y_UP)
    for mark, (vertices, triangles) in shapes.items():
        check_triangles(vertices, triangles, mark)
        scene.geometry[mark] = trimesh.Trimesh(vertices, triangles, process=False)
    for part in instances:
        scene.graph.update(part.name, "model", matrix=part.matrix, geometry=part.mark)
    write_bytes(path, export_glb(scene))


def _npy(array: NDArray[np.generic]) -> bytes:
    buffer = io.BytesIO()
    np.lib.format.write_array(buffer, np.asarray(array), allow_pickle=False)
    return buffer.getvalue()


def _check_array(name: str, array: NDArray[np.generic]) -> None:
    number = np.issubdtype(array.dtype, np.number)
    if array.dtype.hasobject or (number and not np.isfinite(np.asarray(array, float)).all()):
        way_out = "Nothing was written; please report the project file."
        raise Refused("E-OUT-08", f"array {name}", "objects, or NaN, or infinity", "finite numbers or text", way_out)
