"""Trimming by planes: faces clipped to polygons, edges cut, support nodes where they end (geometry §6)."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.errors import Note, Refused
from isomould.form.mesh import Family, Mesh, NodeKind
from isomould.form.settings import SurfaceSettings, TrimSettings

_NOISE = 1e-6
"""mm: nodes nearer than this to a plane lie on it."""


@dataclass(frozen=True, eq=False)
class Cut:
    """A trimming plane: a point of it and its unit normal towards what is kept, (3,) each."""

    field: str
    origin: Floats
    normal: Floats

    def heights(self, points: Floats) -> Floats:
        """Signed distances (n,) mm of points (n, 3), positive where they are kept."""
        return (points - self.origin) @ self.normal


def trim_mesh(mesh: Mesh, settings: SurfaceSettings, min_member: float) -> tuple[Mesh, tuple[Note, ...]]:
    """Cut a mesh by the planes of the `[surface]` table, one after another; add sills where asked for.

    Parameters
    ----------
    mesh, settings
        Without planes the mesh comes back as it is.
    min_member
        mm: a support node that would lie nearer to a node of the mesh is that node.

    Raises
    ------
    Refused
        If nothing is left, two planes meet on a panel, or a node or sill is left that cannot be made.
    """
    if not settings.trim:
        return mesh, ()
    notes: list[Note] = []
    for number, table in enumerate(settings.trim):
        mesh, found = _cut_once(mesh, make_cut(table, f"surface.trim[{number}]"), min_member)
        notes += found
    mesh = _level(replace(mesh, node_piece=_ranks(mesh.node_ij, mesh.node_piece)))
    _refuse_loose(mesh)
    mesh = _with_sills(mesh, min_member) if settings.sill else mesh
    return mesh, (*notes, *_sliver_notes(mesh, min_member), *_sill_notes(mesh))


def make_cut(table: TrimSettings, field: str) -> Cut:
    """Give the plane of one entry of `surface.trim`.

    Raises
    ------
    Refused
        If the side to keep does not follow from it.
    """
    level = table.plane.z is not None
    origin = np.array([0.0, 0.0, table.plane.z] if level else table.plane.origin, dtype=np.float64)
    normal = np.array((0.0, 0.0, 1.0) if level else table.plane.normal, dtype=np.float64)
    size = float(np.linalg.norm(normal))
    towards = {"above": (0.0, 0.0, 1.0), "below": (0.0, 0.0, -1.0)}.get(str(table.keep), table.keep)
    side = float(normal @ np.array(towards, dtype=np.float64)) if size else 0.0
    if abs(side) <= 1e-9 * size:
        found = f"keep = {table.keep!r} names no side of a plane with the normal {normal.tolist()}"
        raise Refused("E-TRIM-SIDE", field, found, "one side", "Give a direction [x, y, z] towards what is kept.")
    return Cut(field, origin, np.sign(side) * normal / size)


def _cut_once(mesh: Mesh, cut: Cut, min_member: float) -> tuple[Mesh, list[Note]]:
    height = cut.heights(mesh.nodes)
    side = np.where(np.abs(height) <= _NOISE, 0, np.sign(height)).astype(np.int64)
    snapped = _near(mesh, side, height, min_member)
    side[snapped] = 0
    if not (np.maximum.reduceat(side[mesh.faces], mesh.face_offsets[:-1]) > 0).any():
        found, way_out = "nothing of the surface is left", "Move the plane, or keep its other side."
        raise Refused("E-TRIM-EMPTY", cut.field, found, "at least one panel", way_out)
    _refuse_corners(mesh, side, cut)
    crossing = np.flatnonzero(side[mesh.edges].prod(axis=1) < 0)
    fresh = dict(zip(map(tuple, mesh.edges[crossing].tolist()), range(len(mesh.nodes), 10**9), strict=False))
    new = fresh | {(there, here): node for (here, there), node in fresh.items()}
    clipped = _clip_faces(_with_supports(mesh, crossing, height, side), cut.normal, side, new)
    return _compact(clipped), _cut_notes(mesh, side, snapped, height, cut)


def _shares(mesh: Mesh, height: Floats, edges: Ints) -> Floats:
    """Where (e,) edges meet the plane, as a share of their length from the start."""
    start, end = height[mesh.edges[edges]].T
    return start / (start - end)


def _near(mesh: Mesh, side: Ints, height: Floats, min_member: float) -> Ints:
    """Nodes that support nodes snap onto: the nearer end of every edge that would be cut close to an end."""
    crossing = np.flatnonzero(side[mesh.edges].prod(axis=1) < 0)
    ends, share = mesh.edges[crossing], _shares(mesh, height, crossing)
    length = np.linalg.norm(mesh.nodes[ends[:, 1]] - mesh.nodes[ends[:, 0]], axis=1)
    close = np.minimum(share, 1 - share) * length < min_member
    return np.unique(np.where(share < 0.5, ends[:, 0], ends[:, 1])[close])


def _with_supports(mesh: Mesh, crossing: Ints, height: Floats, side: Ints) -> Mesh:
    """Add a support node on every edge that is cut, and end the edge there; the axis is the blend of its ends'."""
    share, ends = _shares(mesh, height, crossing)[:, None], mesh.edges[crossing]
    points, axes = ((1 - share) * values[ends[:, 0]] + share * values[ends[:, 1]] for values in (mesh.nodes, mesh.axes))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    number = len(mesh.nodes) + np.arange(len(crossing))
    edges, piece = mesh.edges.copy(), mesh.edge_piece.copy()
    edges[crossing] = np.where(side[ends] > 0, ends, number[:, None])
    piece[crossing] = 1
    kind = np.where(side == 0, int(NodeKind.SUPPORT), mesh.kind)
    return replace(
        mesh,
        nodes=np.concatenate([mesh.nodes, points]),
        axes=np.concatenate([mesh.axes, axes]),
        node_ij=np.concatenate([mesh.node_ij, mesh.edge_ij[crossing]]),
        node_piece=np.concatenate([mesh.node_piece, np.ones_like(number)]),
        kind=np.concatenate([kind, np.full_like(number, NodeKind.SUPPORT)]),
        edges=edges,
        edge_piece=piece,
    )


def _clip_faces(mesh: Mesh, normal: Floats, side: Ints, new: dict[tuple[int, ...], int]) -> Mesh:
    """Clip every face; `side` is of the nodes before the cut, `new` names the node between two of them."""
    starts = mesh.face_offsets[:-1]
    whole = np.minimum.reduceat(side[mesh.faces], starts) >= 0
    kept = np.flatnonzero(np.maximum.reduceat(side[mesh.faces], starts) > 0)
    corners, rims = np.split(mesh.faces, mesh.face_offsets[1:-1]), np.split(mesh.rims, mesh.face_offsets[1:-1])
    clipped = [list(_clip(corners[face], rims[face], normal, side, new)) for face in kept]
    return replace(
        mesh,
        faces=np.array([node for face in clipped for node, _ in face], dtype=np.int64),
        rims=np.array([rim for face in clipped for _, rim in face]),
        face_offsets=np.cumsum([0, *(len(face) for face in clipped)]),
        face_ij=mesh.face_ij[kept],
        face_piece=np.where(whole, mesh.face_piece, 1)[kept],
    )


def _clip(
    corners: Ints, rims: Floats, normal: Floats, side: Ints, new: dict[tuple[int, ...], int]
) -> Iterator[tuple[int, Floats]]:
    """Walk round a face: nodes that stay or are new, each with the rim of the side that follows it."""
    for here, there, rim in zip(corners.tolist(), np.roll(corners, -1).tolist(), rims, strict=True):
        if side[here] >= 0:
            yield here, normal if side[here] == 0 and side[there] < 0 else rim
        if side[here] * side[there] < 0:
            yield new[here, there], normal if side[here] > 0 else rim


def _compact(mesh: Mesh) -> Mesh:
    """Leave out nodes and edges of no face, and number the nodes anew."""
    used, faces = np.unique(mesh.faces, return_inverse=True)
    number = np.full(len(mesh.nodes), -1)
    number[used] = np.arange(len(used))
    there = np.isin(_keys(mesh.edges), _keys(np.stack([mesh.faces, mesh.faces[mesh.ahead]], axis=-1)))
    return replace(
        mesh,
        **{name: getattr(mesh, name)[used] for name in ("nodes", "axes", "node_ij", "node_piece", "kind")},
        **{name: getattr(mesh, name)[there] for name in ("family", "edge_ij", "edge_piece")},
        edges=number[mesh.edges[there]],
        faces=faces.ravel(),
    )


def _keys(pairs: Ints) -> Ints:
    """One number (n,) for every pair of nodes, whatever its direction."""
    low, high = np.sort(pairs, axis=1).T
    return low * 2**31 + high


def _ranks(ij: Ints, piece: Ints) -> Ints:
    """Count the pieces (n,) of the same (i, j) from 1; 0 stays for what is whole."""
    seen: dict[tuple[int, ...], int] = {}
    ranks = np.zeros_like(piece)
    for row in np.flatnonzero(piece):
        key = tuple(ij[row].tolist())
        ranks[row] = seen[key] = seen.get(key, 0) + 1
    return ranks


def _level(mesh: Mesh) -> Mesh:
    """Start the clipped faces with a side along a parallel, if one is left: their outlines then lie in rows."""
    key = _keys(np.stack([mesh.faces, mesh.faces[mesh.ahead]], axis=-1))
    along = np.isin(key, _keys(mesh.edges[mesh.family == Family.PARALLEL]))
    order = np.arange(len(mesh.faces))
    for face in np.flatnonzero(mesh.face_piece):
        rows = slice(*mesh.face_offsets[face : face + 2])
        order[rows] = np.roll(order[rows], -int(np.argmax(along[rows])))
    return replace(mesh, faces=mesh.faces[order], rims=mesh.rims[order])


def _with_sills(mesh: Mesh, min_member: float) -> Mesh:
    """Add a sill along every rim, in the order of the faces."""
    rims = np.flatnonzero(mesh.rimmed)
    edges = np.stack([mesh.faces, mesh.faces[mesh.ahead]], axis=-1)[rims]
    _refuse_short(np.linalg.norm(mesh.nodes[edges[:, 1]] - mesh.nodes[edges[:, 0]], axis=1), min_member)
    return replace(
        mesh,
        edges=np.concatenate([mesh.edges, edges]),
        family=np.concatenate([mesh.family, np.full(len(rims), int(Family.SILL))]),
        edge_ij=np.concatenate([mesh.edge_ij, mesh.per_corner(mesh.face_ij)[rims]]),
        edge_piece=np.concatenate([mesh.edge_piece, np.zeros(len(rims), dtype=np.int64)]),
    )


def sill_tops(mesh: Mesh) -> Floats:
    """Unit directions (s, 3) in which the sills stand: the parts of the rims' normals perpendicular to their edges.

    The sills are the last edges of the mesh, in the order of its rims.
    """
    ends = mesh.nodes[mesh.edges[mesh.family == Family.SILL]]
    return rim_tops(ends[:, 1] - ends[:, 0], mesh.rims[mesh.rimmed][: len(ends)])


def rim_tops(along: Floats, rims: Floats) -> Floats:
    """Parts (n, 3) of the rims' normals that are perpendicular to their sides, as unit vectors."""
    unit = along / np.linalg.norm(along, axis=1, keepdims=True)
    tops = rims - np.einsum("ij,ij->i", rims, unit)[:, None] * unit
    return tops / np.linalg.norm(tops, axis=1, keepdims=True)


def _refuse_corners(mesh: Mesh, side: Ints, cut: Cut) -> None:
    """Refuse planes that meet on a panel: no member carries a node where two rims meet."""
    if (mesh.rimmed & (side[mesh.faces] * side[mesh.faces[mesh.ahead]] < 0)).any():
        found, way_out = "the plane crosses a panel that another plane has cut", "Move one of the planes."
        raise Refused("E-TRIM-CORNER", cut.field, found, "planes that meet outside the surface", way_out)


def _refuse_loose(mesh: Mesh) -> None:
    loose = np.setdiff1d(np.arange(len(mesh.nodes)), mesh.edges)
    if len(loose):
        i, j = mesh.node_ij[loose[0]].tolist()
        found = f"node ({i}, {j}) is left without a member"
        raise Refused("E-TRIM-LOOSE", "surface.trim", found, "a member at every node", "Move the plane a little.")


def _refuse_short(length: Floats, min_member: float) -> None:
    if len(length) and length.min() < min_member:
        found, limit = f"a sill of {length.min():.3f} mm", f"tolerances.min_member = {min_member:g} mm"
        raise Refused("E-TRIM-SHORT", "surface.trim", found, limit, "Move the plane a little, or leave out the sills.")


def _cut_notes(mesh: Mesh, side: Ints, snapped: Ints, height: Floats, cut: Cut) -> list[Note]:
    notes = [] if (side <= 0).any() else [Note("W-TRIM-NOTHING", cut.field, "the plane cuts nothing")]
    if not len(snapped):
        return notes
    worst = snapped[np.argmax(np.abs(height[snapped]))]
    i, j = mesh.node_ij[worst].tolist()
    text = f"{len(snapped)} nodes near the plane are its supports, up to {abs(height[worst]):.3f} mm off it"
    return [*notes, Note("W-TRIM-SNAP", cut.field, f"{text} (node ({i}, {j}))")]


def _sliver_notes(mesh: Mesh, min_member: float) -> list[Note]:
    """Name the narrowest clipped face if there are some narrower than the shortest member."""
    clipped: list[int] = np.flatnonzero(mesh.face_piece).tolist()
    narrow = {face: width for face in clipped if (width := _width(mesh, face)) < min_member}
    if not narrow:
        return []
    worst = min(narrow, key=lambda face: narrow[face])
    i, j = mesh.face_ij[worst].tolist()
    text = f"{len(narrow)} slivers of panels, the narrowest {narrow[worst]:.3f} mm wide (panel ({i}, {j}))"
    return [Note("W-TRIM-SLIVER", "surface.trim", text)]


def _width(mesh: Mesh, face: int) -> float:
    """Smallest width mm of a convex face: the least, over its sides, of the greatest distance of a corner."""
    points = mesh.nodes[mesh.faces[slice(*mesh.face_offsets[face : face + 2])]]
    along = np.roll(points, -1, axis=0) - points
    away = np.cross(points[None] - points[:, None], along[:, None])
    return float((np.linalg.norm(away, axis=2).max(axis=1) / np.linalg.norm(along, axis=1)).min())


def _sill_notes(mesh: Mesh) -> list[Note]:
    """Report how far sills stand from the axes of their nodes: they are exempt from the torsion rule."""
    ends = mesh.edges[mesh.family == Family.SILL]
    if not len(ends):
        return []
    across = np.cross(mesh.nodes[ends[:, 1]] - mesh.nodes[ends[:, 0]], sill_tops(mesh))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    sine = np.abs(np.einsum("ekx,ex->ek", mesh.axes[ends], across)).max()
    angle = np.degrees(np.arcsin(min(float(sine), 1.0)))
    return [Note("W-TRIM-SILL", "surface.sill", f"sills stand at up to {angle:.2f}° to the axes of their nodes")]
