"""V11, V12, V15: counts, orientation and position of the whole mesh."""

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.grid import Grid, ends_of, grid_of, recomputed, regular_nodes
from isomould.verify.read.design import edge_vectors as line_edges
from isomould.verify.read.mesh import Mesh, edge_vectors
from isomould.verify.rules import Floats, Ints, Measured, Rule, faults, worse, worst_of

LENGTH = 1e-6


def euler(delivery: Delivery) -> Measured:
    """Check counts, Euler's number, and that every inner edge is in two faces that run it both ways."""
    mesh, grid = delivery.mesh, grid_of(delivery.mesh, delivery.design)
    sides = _sides(mesh)
    problems = _count_faults(mesh, delivery.design.raw["counts"]) + _side_faults(mesh, sides)
    if len(regular_nodes(mesh)) == len(mesh.nodes) == grid.index.size and (grid.index >= 0).all():
        problems += _grid_faults(mesh, grid, sides)
    return faults(len(mesh.nodes) + len(mesh.edges) + len(mesh.face_ij), problems)


def _sides(mesh: Mesh) -> Ints:
    """Give all sides of the faces as directed pairs of nodes, (k, 2)."""
    following = np.roll(mesh.faces, -1)
    following[mesh.face_offsets[1:] - 1] = mesh.faces[mesh.face_offsets[:-1]]
    return np.column_stack((mesh.faces, following))


def _count_faults(mesh: Mesh, asked: dict[str, int]) -> list[str]:
    found = {"nodes": len(mesh.nodes), "edges": len(mesh.edges), "faces": len(mesh.face_ij)}
    return [f"{n} {name}, designed {asked[name]}" for name, n in found.items() if asked[name] != n]


def _side_faults(mesh: Mesh, sides: Ints) -> list[str]:
    directed, times = np.unique(sides, axis=0, return_counts=True)
    problems = [f"two faces run side {_side(mesh, side)} the same way" for side in directed[times > 1]]
    known, members = _undirected(sides), _undirected(mesh.edges)
    if len(np.unique(members, axis=0)) < len(members):
        problems.append("two members join the same nodes")
    loose = ~_rows_in(members, known)
    return problems + [f"member {location} is no side of a face" for location in mesh.edge_location[loose]]


def _side(mesh: Mesh, side: Ints) -> str:
    return " to ".join(mesh.node_location[side])


def _undirected(pairs: Ints) -> Ints:
    return np.sort(pairs, axis=1)


def _rows_in(rows: Ints, others: Ints) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    base = max(int(rows.max(initial=0)), int(others.max(initial=0))) + 1
    return np.isin(rows @ [base, 1], others @ [base, 1])


def _grid_faults(mesh: Mesh, grid: Grid, sides: Ints) -> list[str]:
    """Check an untrimmed mesh against its numbers m, n and closed directions."""
    m, n = grid.index.shape
    rows, strips, lids = int((~grid.gap).sum()), n - (not grid.closed[1]), len(grid.lids)
    panels = rows + len(grid.caps)
    border = strips * (2 * (m - panels) - lids) + (2 * panels if strips < n else 0)
    edges, times = np.unique(_undirected(sides), axis=0, return_counts=True)
    expected = {"faces": panels * strips + lids, "members": rows * n + m * strips, "sides in one face": border}
    found = {
        "faces": len(mesh.face_ij),
        "members": len(mesh.edges),
        "sides in one face": int((times == 1).sum()),
    }
    problems = [f"{found[k]} {k}, expected {expected[k]} of {m} × {n}" for k in expected if found[k] != expected[k]]
    number, discs = len(mesh.nodes) - len(edges) + len(mesh.face_ij), (m - panels) * (n - strips) + lids
    problems += _row_faults(mesh, grid)
    return problems + ([] if number == discs else [f"V − E + F = {number}, expected {discs}"])


def _row_faults(mesh: Mesh, grid: Grid) -> list[str]:
    """Name rows that have panels, or none, against the design, and lids that are not the whole of their parallel."""
    expected = {*np.flatnonzero(grid.panelled).tolist(), *grid.lid_rows}
    astray = expected.symmetric_difference(mesh.face_ij[:, 0].tolist())
    faces = {tuple(ij): corners for ij, corners in zip(mesh.face_ij.tolist(), _corners(mesh), strict=True)}
    lids = [(row, faces.get((row, 0)), grid.index[lid]) for row, lid in zip(grid.lid_rows, grid.lids, strict=True)]
    wrong = [row for row, found, parallel in lids if found is not None and set(found) != set(parallel.tolist())]
    return [f"row {row}: panels against the design" for row in sorted(astray)] + [f"lid {row} is cut" for row in wrong]


def _corners(mesh: Mesh) -> list[list[int]]:
    return [face.tolist() for face in np.split(mesh.faces, mesh.face_offsets[1:-1])]


def flips(delivery: Delivery) -> Measured:
    """Edges that run backwards on the mid layer or at the top or bottom of the beams, or are too short."""
    mesh = delivery.mesh
    edges, half = edge_vectors(mesh), float(delivery.design.raw["member"]["depth"]) / 2
    reach = (half / delivery.edge_slopes)[..., None] * mesh.node_axes[mesh.edges]
    offset = reach[:, 1] - reach[:, 0]
    forward = np.min([((edges + s * offset) * edges).sum(axis=1) for s in (-1, 0, 1)], axis=0)
    along = (edges * _reference(delivery, edges)).sum(axis=1)
    short = np.linalg.norm(edges, axis=1) < (delivery.design.raw["limits"]["min_member_mm"] or 0.0)
    bad = (mesh.edge_family != "sill") & ~((forward > 0) & (along > 0))
    return faults(3 * len(edges), [*mesh.edge_location[bad], *mesh.edge_location[short & ~bad]])


def _reference(delivery: Delivery, edges: Floats) -> Floats:
    """Give the direction that each edge must not oppose: the rail's for parallels, its own for the others."""
    mesh, design = delivery.mesh, delivery.design
    along = line_edges(design.rail) @ (np.eye(3) if design.plane is None else design.plane[1:])
    ruled = (mesh.edge_family == "parallel") & _starts_on_grid(mesh)
    strip = np.where(ruled, mesh.node_ij[mesh.edges[:, 0], 1], 0)
    return np.where(ruled[:, None], along[np.minimum(strip, len(along) - 1)], edges)


def _starts_on_grid(mesh: Mesh) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    return np.isin(mesh.edges[:, 0], regular_nodes(mesh))


def positions(delivery: Delivery) -> Measured:
    """Distance of grid nodes from where offset lines and mitre planes of the design's polygons put them."""
    mesh, design = delivery.mesh, delivery.design
    grid = grid_of(mesh, design)
    known = grid.index >= 0
    expected = recomputed(design, ends_of(design, mesh, grid))[known]
    off = np.linalg.norm(mesh.nodes[grid.index[known]] - expected, axis=1)
    limit = max(LENGTH, 1e-12 * float(abs(mesh.nodes).max()))
    found = worst_of(off, mesh.node_location[grid.index[known]], limit=limit)
    return worse(found, *_cut_edges(mesh, grid, recomputed(design, ends_of(design, mesh, grid)), limit))


def _cut_edges(mesh: Mesh, grid: Grid, expected: Floats, limit: float) -> list[Measured]:
    """Edges from a grid node to a support node: distance of the latter from the line of the uncut edge."""
    regular = np.isin(mesh.edges, grid.index[grid.index >= 0])
    cut = np.flatnonzero((regular.sum(axis=1) == 1) & (mesh.edge_family != "sill"))
    if not len(cut):
        return []
    kept = np.where(regular[cut, 0], mesh.edges[cut, 0], mesh.edges[cut, 1])
    lost = mesh.edges[cut].sum(axis=1) - kept
    step = (
        np.where(regular[cut, 0], 1, -1)[:, None]
        * np.where(mesh.edge_family[cut] == "parallel", [[0], [1]], [[1], [0]]).T
    )
    i, j = ((mesh.node_ij[kept] + step) % grid.index.shape).T
    way, ray = expected[i, j] - mesh.nodes[kept], mesh.nodes[lost] - mesh.nodes[kept]
    off = np.linalg.norm(np.cross(way, ray), axis=1) / np.linalg.norm(way, axis=1)
    return [worst_of(off, mesh.edge_location[cut], limit=limit)]


RULES = (
    Rule("V11", "counts, Euler's number, inner edges in two faces", 0, "faults", euler),
    Rule("V12", "no edge is flipped on any layer or too short", 0, "edges", flips),
    Rule("V15", "nodes lie where offset lines and mitre planes put them", LENGTH, "mm", positions),
)
