"""V17: a trimmed surface ends on its planes: nothing beyond them, nothing missing before them (geometry §6)."""

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.grid import ends_of, grid_of, recomputed, regular_nodes
from isomould.verify.rules import Floats, Ints, Measured, NotApplicable, Rule, faults, worst_of

LENGTH = 1e-6


def _heights(delivery: Delivery, points: Floats) -> Floats:
    """Give the heights (planes, …) of points (…, 3) above the trimming planes, positive where they are kept, mm."""
    planes = delivery.design.raw.get("trim", [])
    if not planes:
        raise NotApplicable("the surface is not trimmed")
    origins, normals = (np.array([plane[key] for plane in planes], dtype=np.float64) for key in ("origin", "normal"))
    return np.stack([(points - origin) @ normal for origin, normal in zip(origins, normals, strict=True)])


def supports(delivery: Delivery) -> Measured:
    """Distance of the new nodes from the nearest trimming plane."""
    mesh = delivery.mesh
    new = np.setdiff1d(np.arange(len(mesh.nodes)), regular_nodes(mesh))
    off = abs(_heights(delivery, mesh.nodes[new])).min(axis=0)
    limit = max(LENGTH, 1e-12 * float(abs(mesh.nodes).max()))
    return worst_of(off, mesh.node_location[new], limit=limit, none="no edge is cut")


def extent(delivery: Delivery) -> Measured:
    """Nodes and faces of the uncut grid: there before the planes, gone beyond them, as far as supports may snap."""
    mesh, design = delivery.mesh, delivery.design
    if design.plane is None:
        raise NotApplicable("a spatial rail is not made of offset lines in one plane")
    grid = grid_of(mesh, design)
    height = _heights(delivery, recomputed(design, ends_of(design, mesh, grid))).min(axis=0)
    reach, there = float(design.raw["limits"]["min_member_mm"]), grid.index >= 0
    lost, stray = (height > reach) & ~there, (height < -reach) & there
    problems = [f"node {i}, {j} is missing" for i, j in np.argwhere(lost)]
    problems += [f"node {i}, {j} lies beyond a plane" for i, j in np.argwhere(stray)]
    return faults(height.size, problems + _missing_faces(mesh.face_ij, height, grid.closed, reach))


def _missing_faces(face_ij: Ints, height: Floats, closed: tuple[bool, bool], reach: float) -> list[str]:
    """Name the faces that have a corner before all planes and are not in the mesh."""
    rows, strips = (n - (not round_) for n, round_ in zip(height.shape, closed, strict=True))
    corners = [np.roll(height, (-i, -j), axis=(0, 1))[:rows, :strips] for i, j in ((0, 0), (0, 1), (1, 1), (1, 0))]
    wanted = np.max(corners, axis=0) > reach
    wanted[tuple(face_ij.T)] = False
    return [f"panel {i}, {j} is missing" for i, j in np.argwhere(wanted)]


def sills(delivery: Delivery) -> Measured:
    """Sides that no member carries are cut sides: each has a sill if sills were asked for, and nothing else has."""
    mesh = delivery.mesh
    here, following = mesh.faces, np.roll(mesh.faces, -1)
    following[mesh.face_offsets[1:] - 1] = mesh.faces[mesh.face_offsets[:-1]]
    reach = float(delivery.design.raw["limits"]["min_member_mm"])
    on_plane = abs(_heights(delivery, mesh.nodes)) <= reach
    sill = mesh.edge_family == "sill"
    bare = {_pair(a, b) for a, b in zip(here.tolist(), following.tolist(), strict=True)}
    bare -= {_pair(a, b) for a, b in mesh.edges[~sill].tolist()}
    carried = {_pair(a, b) for a, b in mesh.edges[sill].tolist()}
    wanted = bare if delivery.design.raw["sill"] else set[tuple[int, int]]()
    problems = [
        f"{_names(delivery, pair)}: not on one plane" for pair in bare if not on_plane[:, pair].all(axis=1).any()
    ]
    problems += [f"{_names(delivery, pair)}: sill missing or astray" for pair in sorted(carried ^ wanted)]
    return faults(len(bare), problems)


def _pair(a: int, b: int) -> tuple[int, int]:
    return min(a, b), max(a, b)


def _names(delivery: Delivery, pair: tuple[int, int]) -> str:
    return " to ".join(delivery.mesh.node_location[list(pair)])


RULES = (
    Rule("V17", "supports lie on a trimming plane", LENGTH, "mm", supports),
    Rule("V17b", "the surface ends at the trimming planes", 0, "faults", extent),
    Rule("V17c", "sills stand where the planes cut panels", 0, "faults", sills),
)
