"""The product grid of a moulding mesh: nodes by (parallel i, generatrix j), whole faces, recomputation."""

import re
from dataclasses import dataclass

import numpy as np

from isomould.verify.read.design import Design, Line, edge_vectors
from isomould.verify.read.mesh import Mesh, faces_by_size
from isomould.verify.rules import Bools, Floats, Ints, NotApplicable
from isomould.verify.space import recomputed_in_space


@dataclass(frozen=True, eq=False)
class Grid:
    """Node numbers by (i, j), -1 where the mesh was trimmed, and which directions are closed."""

    index: Ints
    closed: tuple[bool, bool]
    gap: Bools
    """True (rows,) where the profile is open between a parallel and the next."""
    caps: tuple[int, ...]
    """Rows whose panels lie between parallels i and i + 1 (the last and the first too) without members."""
    lids: tuple[int, ...]
    """Parallels that are the outline of one panel."""

    @property
    def panelled(self) -> Bools:
        """True (m,) where panels lie between a parallel and the next."""
        rows: Bools = np.append(~self.gap, np.zeros(len(self.index) - len(self.gap), dtype=np.bool_))
        rows[list(self.caps)] = True
        return rows

    @property
    def lid_rows(self) -> list[int]:
        """Numbers i of the lids among the faces: behind all rows, first the last parallel's, then the first one's."""
        return [len(self.index) - (lid > 0) for lid in self.lids]

    def beside(self, di: int, dj: int) -> Ints:
        """Give for every (i, j) the node at (i + di, j + dj), -1 where there is none."""
        found = np.roll(self.index, (-di, -dj), axis=(0, 1))
        for axis, step in enumerate((di, dj)):
            if step and not self.closed[axis]:
                np.moveaxis(found, axis, 0)[-1 if step > 0 else 0] = -1
        if di:
            found[np.flatnonzero(self.gap) + (di < 0)] = -1
        return found


def grid_of(mesh: Mesh, design: Design) -> Grid:
    """Lay out the nodes whose location is the N-ii-jj of their node_ij; support nodes stay out."""
    shape = (len(design.generatrix.vertices), len(design.rail.vertices))
    index, regular = np.full(shape, -1, dtype=np.int64), regular_nodes(mesh)
    index[tuple(mesh.node_ij[regular].T)] = regular
    caps = design.raw.get("caps", {"rows": [], "lids": []})
    closed = design.generatrix.closed, design.rail.closed
    return Grid(index, closed, design.generatrix.gap, tuple(caps["rows"]), tuple(caps["lids"]))


def regular_nodes(mesh: Mesh) -> Ints:
    """Give the nodes that are vertices of the product grid, not cut by a trimming plane."""
    matches = [re.fullmatch(r"N-(\d+)-(\d+)", location) for location in mesh.node_location]
    named = np.array([[int(m[1]), int(m[2])] if m else [-1, -1] for m in matches], dtype=np.int64).reshape(-1, 2)
    return np.flatnonzero((named == mesh.node_ij).all(axis=1) & (named >= 0).all(axis=1))


def whole_faces(mesh: Mesh, grid: Grid) -> tuple[Ints, Ints]:
    """Give the faces that kept their four grid corners, (f,), and these, (f, 4), from node (i, j)."""
    for faces, corners in faces_by_size(mesh):
        if corners.shape[1] == 4:
            expected = _expected_corners(grid, mesh.face_ij[faces])
            whole: Bools = np.all(corners == expected, axis=1)
            return faces[whole], corners[whole]
    raise NotApplicable("no face has four corners")


def _expected_corners(grid: Grid, ij: Ints) -> Ints:
    around = [np.roll(grid.index, step, axis=(0, 1)) for step in ((0, 0), (0, -1), (-1, -1), (-1, 0))]
    inside: Bools = np.all((ij >= 0) & (ij < np.array(grid.index.shape)), axis=1)
    i, j = np.where(inside[:, None], ij, 0).T
    return np.where(inside[:, None], np.column_stack([corner[i, j] for corner in around]), -2)


def recomputed(design: Design, ends: tuple[str, str]) -> Floats:
    """Compute the grid anew: offset lines of the rail cut by its mitre planes, (m, n, 3) mm (geometry §3).

    The line at distance d_i from a rail edge meets the bisecting plane of the rail vertex. `ends` says for
    the two open ends "square" (the plane is perpendicular to the edge) or "mitred" (as at one more node); those of a
    rail in space are square.
    """
    if design.plane is None:
        return recomputed_in_space(design)
    before, after = rail_sides(design.rail, ends)
    d, z = design.generatrix.vertices[:, :1], design.generatrix.vertices[:, 1]
    outward = np.column_stack((after[:, 1], -after[:, 0]))
    slide = -_dot(outward, before + after) / _dot(after, before + after)
    flat = design.rail.vertices + d[..., None] * (outward + slide[:, None] * after)
    origin, x, y = design.plane
    return origin + flat[..., :1] * x + flat[..., 1:] * y + z[:, None, None] * np.cross(x, y)


def rail_sides(rail: Line, ends: tuple[str, str]) -> tuple[Floats, Floats]:
    """Give the unit directions of the edges before and after every rail vertex, (n, 2) each."""
    unit = edge_vectors(rail) / np.linalg.norm(edge_vectors(rail), axis=1)[:, None]
    if rail.closed:
        return np.roll(unit, 1, axis=0), unit
    first, last = unit[0], unit[-1]
    if ends[0] == "mitred":
        first = _turned(unit[0], -rail.turning[1])
    if ends[1] == "mitred":
        last = _turned(unit[-1], rail.turning[-2])
    return np.vstack((first, unit)), np.vstack((unit, last))


def _turned(u: Floats, angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * u[0] - s * u[1], s * u[0] + c * u[1]])


def _dot(a: Floats, b: Floats) -> Floats:
    return (a * b).sum(axis=-1)


def ends_of(design: Design, mesh: Mesh, grid: Grid) -> tuple[str, str]:
    """Give the kind of the rail's two ends: as recorded, else as the mesh is nearer to."""
    asked = design.raw.get("ends")
    return (asked, asked) if asked else _nearest_ends(design, mesh, grid)


def _nearest_ends(design: Design, mesh: Mesh, grid: Grid) -> tuple[str, str]:
    known = grid.index >= 0
    found = np.where(known[..., None], mesh.nodes[grid.index], np.nan)
    gaps = {end: abs(recomputed(design, (end, end)) - found)[:, [0, -1]].max(axis=2) for end in ("square", "mitred")}
    nearer = np.nansum(gaps["mitred"], axis=0) < np.nansum(gaps["square"], axis=0)
    return ("mitred" if nearer[0] else "square", "mitred" if nearer[1] else "square")
