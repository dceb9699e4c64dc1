"""Trimming by planes: faces clipped to polygons, edges cut, support nodes where they end (geometry §6).

The planes cut one after another, and each cuts whatever the planes before it have left: members, their panels, and the
rims of those. Where a rim is cut two planes meet on a panel.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.errors import Note, Refused
from isomould.form.mesh import Family, Mesh, NodeKind
from isomould.form.rims import sill_notes, sliver_notes, with_sills
from isomould.form.settings import SurfaceSettings, TrimSettings
from isomould.ties import FINE

_NOISE = 1e-6
"""mm: nodes nearer than this to a plane lie on it."""


@dataclass(frozen=True, eq=False)
class Cut:
    """A trimming plane: its number, a point of it and its unit normal towards what is kept, (3,) each."""

    number: int
    origin: Floats
    normal: Floats

    @property
    def field(self) -> str:
        """The plane's place in the project."""
        return f"surface.trim[{self.number}]"

    def heights(self, points: Floats) -> Floats:
        """Signed distances (n,) mm of points (n, 3), positive where they are kept."""
        return (points - self.origin) @ self.normal


@dataclass(frozen=True, eq=False)
class _Crossings:
    """The sides of faces that a plane crosses: nodes (c, 2), the lower first, and what comes between them.

    `points` (c, 3) mm and `axes` (c, 3) are those of the new nodes, numbered on from `first`.
    """

    pairs: Ints
    points: Floats
    axes: Floats
    first: int

    @property
    def between(self) -> dict[tuple[int, ...], int]:
        """The new node between two nodes, in either order."""
        named = dict(zip(map(tuple, self.pairs.tolist()), range(self.first, 10**9), strict=False))
        return named | {(there, here): node for (here, there), node in named.items()}


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
        If nothing is left, or a node or sill is left that cannot be made.
    """
    if not settings.trim:
        return mesh, ()
    cuts = [make_cut(table, number) for number, table in enumerate(settings.trim)]
    mesh = replace(mesh, planes=np.stack([np.stack([cut.origin, cut.normal]) for cut in cuts]))
    notes: list[Note] = []
    for cut in cuts:
        mesh, found = _cut_once(mesh, cut, min_member)
        notes += found
    mesh = _level(replace(mesh, node_piece=_ranks(mesh.node_ij, mesh.node_piece)))
    mesh = with_sills(mesh, min_member) if settings.sill else mesh
    _refuse_loose(mesh)
    return mesh, (*notes, *sliver_notes(mesh, min_member), *sill_notes(mesh))


def make_cut(table: TrimSettings, number: int) -> Cut:
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
        way_out = "Give a direction [x, y, z] towards what is kept."
        raise Refused("E-TRIM-SIDE", f"surface.trim[{number}]", found, "one side", way_out)
    return Cut(number, origin, np.sign(side) * normal / size)


def _cut_once(mesh: Mesh, cut: Cut, min_member: float) -> tuple[Mesh, list[Note]]:
    height = cut.heights(mesh.nodes)
    side = np.where(np.abs(height) <= _NOISE, 0, np.sign(height)).astype(np.int64)
    pairs = _pairs(mesh)
    snapped = _near(mesh, pairs, side, height, min_member)
    side[snapped] = 0
    if not (np.maximum.reduceat(side[mesh.faces], mesh.face_offsets[:-1]) > 0).any():
        found = f"nothing of the surface is left: its outermost node lies at {height.max():.3f} mm"
        found += " from the plane (positive: on the side that is kept)"
        way_out = "Move the plane, or keep its other side."
        raise Refused("E-TRIM-EMPTY", cut.field, found, "at least one panel", way_out)
    crossings = _cross(mesh, pairs[side[pairs].prod(axis=1) < 0], height, cut, min_member)
    clipped = _clip_faces(_with_supports(mesh, crossings, side), cut.number, side, crossings.between)
    _refuse_bent(clipped, cut)
    return _compact(clipped), _cut_notes(mesh, side, snapped, height, cut)


def _pairs(mesh: Mesh) -> Ints:
    """Sides (s, 2) of all faces, each once, the lower node first."""
    return np.unique(np.sort(mesh.sides, axis=1), axis=0)


def _shares(height: Floats, pairs: Ints) -> Floats:
    """Where sides (s, 2) meet the plane, as a share of their length from the first node."""
    start, end = height[pairs].T
    return start / (start - end)


def _near(mesh: Mesh, pairs: Ints, side: Ints, height: Floats, min_member: float) -> Ints:
    """Nodes that new nodes snap onto: the nearer end of every side that would be cut close to an end."""
    ends = pairs[side[pairs].prod(axis=1) < 0]
    share = _shares(height, ends)
    length = np.linalg.norm(mesh.nodes[ends[:, 1]] - mesh.nodes[ends[:, 0]], axis=1)
    close = np.minimum(share, 1 - share) * length < min_member
    return np.unique(np.where(share < 0.5 - FINE, ends[:, 0], ends[:, 1])[close])


def _cross(mesh: Mesh, pairs: Ints, height: Floats, cut: Cut, min_member: float) -> _Crossings:
    """Place the new nodes: points and axes are blends of the ends', and corners lie on both their planes."""
    share = _shares(height, pairs)[:, None]
    start, end = pairs.T
    points, axes = ((1 - share) * values[start] + share * values[end] for values in (mesh.nodes, mesh.axes))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    points = points + _slides(mesh, pairs, points, cut, min_member)
    return _Crossings(pairs, points, axes, len(mesh.nodes))


def _slides(mesh: Mesh, pairs: Ints, points: Floats, cut: Cut, min_member: float) -> Floats:
    """Steps (c, 3) mm along the cut, in the panel, from points on rims to those rims' planes.

    They are not zero where an end of the rim is a node that the rim's plane snapped to: such a rim leaves its plane.
    """
    place = _find(_keys(mesh.sides), _keys(pairs))
    rims = mesh.rims[place]
    face = np.searchsorted(mesh.face_offsets, place, side="right") - 1
    way = np.cross(_normals(mesh)[face], cut.normal)
    off = np.einsum("ij,ij->i", points - _points(mesh)[place], rims)
    slope = np.einsum("ij,ij->i", way, rims)
    away = np.abs(off) > _NOISE
    step = np.where(away, -off / np.where(away & (slope != 0), slope, 1.0), 0.0)[:, None] * way
    _refuse_flat(mesh, pairs, np.linalg.norm(step, axis=1), cut, min_member)
    return step


def _points(mesh: Mesh) -> Floats:
    """Points (k, 3) of the planes that cut the sides; zeros for sides that no plane made."""
    return np.concatenate([mesh.planes[:, 0], np.zeros((1, 3))])[mesh.rim_plane]


def _normals(mesh: Mesh) -> Floats:
    """Normals (f, 3) of the faces, twice as long as their areas."""
    starts = mesh.face_offsets[:-1]
    away = mesh.nodes[mesh.faces] - mesh.per_corner(mesh.nodes[mesh.faces[starts]])
    return np.add.reduceat(np.cross(away, away[mesh.ahead]), starts)


def _with_supports(mesh: Mesh, crossings: _Crossings, side: Ints) -> Mesh:
    """Add a support node on every side that is cut, and end the edge there if the side has one."""
    count, number = len(crossings.pairs), crossings.first + np.arange(len(crossings.pairs))
    cut = np.flatnonzero(side[mesh.edges].prod(axis=1) < 0)
    place = _find(_keys(crossings.pairs), _keys(mesh.edges[cut]))
    edges, piece, ij = mesh.edges.copy(), mesh.edge_piece.copy(), mesh.node_ij[crossings.pairs[:, 0]]
    edges[cut] = np.where(side[edges[cut]] > 0, edges[cut], number[place][:, None])
    piece[cut], ij[place] = 1, mesh.edge_ij[cut]
    kind = np.where(side == 0, int(NodeKind.SUPPORT), mesh.kind)
    return replace(
        mesh,
        nodes=np.concatenate([mesh.nodes, crossings.points]),
        axes=np.concatenate([mesh.axes, crossings.axes]),
        node_ij=np.concatenate([mesh.node_ij, ij]),
        node_piece=np.concatenate([mesh.node_piece, np.ones(count, dtype=np.int64)]),
        kind=np.concatenate([kind, np.full(count, int(NodeKind.SUPPORT))]),
        edges=edges,
        edge_piece=piece,
    )


def _clip_faces(mesh: Mesh, plane: int, side: Ints, between: dict[tuple[int, ...], int]) -> Mesh:
    """Clip every face; `side` is of the nodes before the cut, `between` names the node between two of them."""
    starts, inner = mesh.face_offsets[:-1], mesh.face_offsets[1:-1]
    whole = np.minimum.reduceat(side[mesh.faces], starts) >= 0
    kept = np.flatnonzero(np.maximum.reduceat(side[mesh.faces], starts) > 0)
    corners, rims = np.split(mesh.faces, inner), np.split(mesh.rim_plane, inner)
    clipped = [list(_clip(corners[face], rims[face], plane, side, between)) for face in kept]
    return replace(
        mesh,
        faces=np.array([node for face in clipped for node, _ in face], dtype=np.int64),
        rim_plane=np.array([rim for face in clipped for _, rim in face], dtype=np.int64),
        face_offsets=np.cumsum([0, *(len(face) for face in clipped)]),
        face_ij=mesh.face_ij[kept],
        face_piece=np.where(whole, mesh.face_piece, 1)[kept],
    )


def _clip(
    corners: Ints, rims: Ints, plane: int, side: Ints, between: dict[tuple[int, ...], int]
) -> Iterator[tuple[int, int]]:
    """Walk round a face: nodes that stay or are new, each with the plane that cut the side that follows it."""
    for here, there, rim in zip(corners.tolist(), np.roll(corners, -1).tolist(), rims.tolist(), strict=True):
        if side[here] >= 0:
            yield here, plane if side[here] == 0 and side[there] < 0 else rim
        if side[here] * side[there] < 0:
            yield between[here, there], plane if side[here] > 0 else rim


def _compact(mesh: Mesh) -> Mesh:
    """Leave out nodes and edges of no face, and number the nodes anew."""
    used, faces = np.unique(mesh.faces, return_inverse=True)
    number = np.full(len(mesh.nodes), -1)
    number[used] = np.arange(len(used))
    there = np.isin(_keys(mesh.edges), _keys(mesh.sides))
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


def _find(keys: Ints, asked: Ints) -> Ints:
    """Give the places (n,) of numbers asked for that are among the keys."""
    order = np.argsort(keys, kind="stable")
    return order[np.searchsorted(keys[order], asked)]


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
    along = np.isin(_keys(mesh.sides), _keys(mesh.edges[mesh.family == Family.PARALLEL]))
    order = np.arange(len(mesh.faces))
    for face in np.flatnonzero(mesh.face_piece):
        rows = slice(*mesh.face_offsets[face : face + 2])
        order[rows] = np.roll(order[rows], -int(np.argmax(along[rows])))
    return replace(mesh, faces=mesh.faces[order], rim_plane=mesh.rim_plane[order])


def _refuse_loose(mesh: Mesh) -> None:
    loose = np.setdiff1d(np.arange(len(mesh.nodes)), mesh.edges)
    if len(loose):
        i, j = mesh.node_ij[loose[0]].tolist()
        found = f"a corner of a panel near node ({i}, {j}) is left without a member"
        way_out = "Move a plane a little, or let sills meet there: surface.sill = true."
        raise Refused("E-TRIM-LOOSE", "surface.trim", found, "a member at every corner", way_out)


def _refuse_flat(mesh: Mesh, pairs: Ints, slide: Floats, cut: Cut, min_member: float) -> None:
    """Refuse corners that would lie far from the rim that ends there, because it leaves its plane."""
    if len(slide) and not slide.max() <= min_member:
        i, j = mesh.node_ij[pairs[np.argmax(slide), 0]].tolist()
        found = f"it meets another plane at a flat angle beside node ({i}, {j}), which is a support of that plane"
        found += f": their corner would lie {slide.max():.3f} mm off"
        limit = f"planes that meet within tolerances.min_member = {min_member:g} mm of the rim"
        raise Refused("E-TRIM-CORNER", cut.field, found, limit, "Move one of the planes a little.")


def _refuse_bent(mesh: Mesh, cut: Cut) -> None:
    """Refuse panels that are no longer convex: a corner of theirs lies beyond a side that snapped to a node."""
    along = mesh.nodes[mesh.sides[:, 1]] - mesh.nodes[mesh.sides[:, 0]]
    turn = np.einsum("ij,ij->i", np.cross(along, along[mesh.ahead]), mesh.per_corner(_normals(mesh)))
    if turn.min() <= 0:
        i, j = mesh.per_corner(mesh.face_ij)[np.argmin(turn)].tolist()
        found = f"what is left of panel ({i}, {j}) is not convex: planes meet within reach of a node"
        way_out = "Move one of the planes a little, or lower tolerances.min_member."
        raise Refused("E-TRIM-CORNER", cut.field, found, "convex panels", way_out)


def _cut_notes(mesh: Mesh, side: Ints, snapped: Ints, height: Floats, cut: Cut) -> list[Note]:
    notes = [] if (side <= 0).any() else [Note("W-TRIM-NOTHING", cut.field, "the plane cuts nothing")]
    if not len(snapped):
        return notes
    worst = snapped[np.argmax(np.abs(height[snapped]))]
    i, j = mesh.node_ij[worst].tolist()
    text = f"{len(snapped)} nodes near the plane are its supports, up to {abs(height[worst]):.3f} mm off it"
    return [*notes, Note("W-TRIM-SNAP", cut.field, f"{text} (node ({i}, {j}))")]
