"""V17: a trimmed surface ends on its planes: nothing beyond them, nothing missing before them (geometry §6)."""

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.grid import Grid, ends_of, grid_of, recomputed, regular_nodes
from isomould.verify.rules import Bools, Floats, Ints, Measured, NotApplicable, Rule, faults, worst_of

LENGTH = 1e-6


def _heights(delivery: Delivery, points: Floats) -> Floats:
    """Give the heights (planes, …) of points (…, 3) above the trimming planes, positive where they are kept, mm."""
    planes = delivery.design.raw.get("trim", [])
    if not planes:
        raise NotApplicable("the surface is not trimmed")
    origins, normals = (np.array([plane[key] for plane in planes], dtype=np.float64) for key in ("origin", "normal"))
    return np.stack([(points - origin) @ normal for origin, normal in zip(origins, normals, strict=True)])


def supports(delivery: Delivery) -> Measured:
    """Distance of the new nodes from what made them: a plane, and a line of the uncut grid or another plane."""
    mesh = delivery.mesh
    new = np.setdiff1d(np.arange(len(mesh.nodes)), regular_nodes(mesh))
    height = np.sort(abs(_heights(delivery, mesh.nodes[new])), axis=0)
    second = height[1] if len(height) > 1 else np.full(len(new), np.inf)
    off = np.maximum(height[0], np.minimum(second, _off_grid(delivery, new)))
    limit = max(LENGTH, 1e-12 * float(abs(mesh.nodes).max()))
    return worst_of(off, mesh.node_location[new], limit=limit, none="no edge is cut")


def _off_grid(delivery: Delivery, nodes: Ints) -> Floats:
    """Least distance (k,) mm of nodes from the lines of the uncut faces around them."""
    mesh, design = delivery.mesh, delivery.design
    grid = grid_of(mesh, design)
    whole = recomputed(design, ends_of(design, mesh, grid))
    owner = np.repeat(np.arange(len(mesh.face_ij)), np.diff(mesh.face_offsets))
    return np.array(
        [_off_faces(mesh.nodes[node], mesh.face_ij[owner[mesh.faces == node]], grid, whole) for node in nodes]
    )


def _off_faces(point: Floats, faces: Ints, grid: Grid, whole: Floats) -> float:
    rings = [_uncut(i, j, grid, whole) for i, j in faces.tolist()]
    steps = [(ring - point, np.roll(ring, -1, axis=0) - ring) for ring in rings]
    away = [np.linalg.norm(np.cross(near, along), axis=1) / np.linalg.norm(along, axis=1) for near, along in steps]
    return float(min(off.min() for off in away))


def _uncut(i: int, j: int, grid: Grid, whole: Floats) -> Floats:
    """Corners (k, 3) of a face before it was cut."""
    if i in grid.lid_rows:
        return whole[grid.lids[grid.lid_rows.index(i)]]
    m, n = grid.index.shape
    return whole[[i, i, (i + 1) % m, (i + 1) % m], [j, (j + 1) % n, (j + 1) % n, j]]


def _reach(delivery: Delivery) -> float:
    """How far, mm, nodes may lie off a plane that they are a support of."""
    return float(delivery.design.raw["limits"]["min_member_mm"])


def _rims(delivery: Delivery) -> Ints:
    """Give the sides (k, 2) of one face only that no member carries, sills apart, and that end no cap."""
    mesh = delivery.mesh
    following = np.roll(mesh.faces, -1)
    following[mesh.face_offsets[1:] - 1] = mesh.faces[mesh.face_offsets[:-1]]
    sides, times = np.unique(np.sort(np.stack([mesh.faces, following], axis=1), axis=1), axis=0, return_counts=True)
    carried = {_pair(a, b) for a, b in mesh.edges[mesh.edge_family != "sill"].tolist()}
    bare = [pair for pair in sides[times == 1].tolist() if tuple(pair) not in carried]
    pairs = np.array(bare, dtype=np.int64).reshape(-1, 2)
    return pairs[~_ends_of_caps(delivery, pairs)]


def _ends_of_caps(delivery: Delivery, pairs: Ints) -> Bools:
    """Whether sides (k, 2) lie along a radial edge of a cap at an open end of the rail."""
    mesh, design = delivery.mesh, delivery.design
    grid = grid_of(mesh, design)
    found = np.zeros(len(pairs), dtype=np.bool_)
    if design.rail.closed or not grid.caps:
        return found
    whole = recomputed(design, ends_of(design, mesh, grid))
    starts, finishes = whole[list(grid.caps)], np.roll(whole, -1, axis=0)[list(grid.caps)]
    for start, end in zip(starts[:, [0, -1]].reshape(-1, 3), finishes[:, [0, -1]].reshape(-1, 3), strict=True):
        away = np.linalg.norm(np.cross(mesh.nodes[pairs] - start, end - start), axis=2) / np.linalg.norm(end - start)
        found |= (away <= LENGTH).all(axis=1)
    return found


def extent(delivery: Delivery) -> Measured:
    """Nodes and faces of the uncut grid: there before the planes, gone beyond them, as far as supports may snap."""
    mesh, design = delivery.mesh, delivery.design
    if design.plane is None:
        raise NotApplicable("a spatial rail is not made of offset lines in one plane")
    grid = grid_of(mesh, design)
    height = _heights(delivery, recomputed(design, ends_of(design, mesh, grid))).min(axis=0)
    reach, there = _reach(delivery), grid.index >= 0
    lost, stray = (height > reach) & ~there, (height < -reach) & there
    problems = [f"node {i}, {j} is missing" for i, j in np.argwhere(lost)]
    problems += [f"node {i}, {j} lies beyond a plane" for i, j in np.argwhere(stray)]
    return faults(height.size, problems + _missing_faces(mesh.face_ij, height, grid, reach))


def _missing_faces(face_ij: Ints, height: Floats, grid: Grid, reach: float) -> list[str]:
    """Name the faces that have a corner before all planes and are not in the mesh."""
    corners = [np.roll(height, (-i, -j), axis=(0, 1)) for i, j in ((0, 0), (0, 1), (1, 1), (1, 0))]
    wanted = (np.max(corners, axis=0) > reach) & grid.panelled[:, None]
    wanted[:, height.shape[1] - (not grid.closed[1]) :] = False
    lids = [[row, 0] for row, lid in zip(grid.lid_rows, grid.lids, strict=True) if height[lid].max() > reach]
    there = set(map(tuple, face_ij.tolist()))
    return [f"panel {i}, {j} is missing" for i, j in [*np.argwhere(wanted).tolist(), *lids] if (i, j) not in there]


def sills(delivery: Delivery) -> Measured:
    """Sides that no member carries are cut sides: each has a sill if sills were asked for, and nothing else has."""
    mesh = delivery.mesh
    on_plane = abs(_heights(delivery, mesh.nodes)) <= _reach(delivery)
    sill = mesh.edge_family == "sill"
    bare = {_pair(a, b) for a, b in _rims(delivery).tolist()}
    carried = {_pair(a, b) for a, b in mesh.edges[sill].tolist()}
    if not bare | carried and len(regular_nodes(mesh)) == len(mesh.nodes):
        raise NotApplicable("no panel is cut")
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
    Rule("V17", "supports lie on a trimming plane, and on their member or another plane", LENGTH, "mm", supports),
    Rule("V17b", "the surface ends at the trimming planes", 0, "faults", extent),
    Rule("V17c", "sills stand where the planes cut panels", 0, "faults", sills),
)
