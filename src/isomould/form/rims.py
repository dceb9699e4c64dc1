"""What stands along the sides that planes cut: sills, and what should be known of them (geometry §6)."""

from dataclasses import replace

import numpy as np

from isomould.arrays import Floats
from isomould.errors import Note, Refused
from isomould.form.mesh import Family, Mesh


def with_sills(mesh: Mesh, min_member: float) -> Mesh:
    """Add a sill along every rim, in the order of the faces."""
    rims = np.flatnonzero(mesh.rimmed)
    edges = mesh.sides[rims]
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


def _refuse_short(length: Floats, min_member: float) -> None:
    if len(length) and length.min() < min_member:
        found, limit = f"a sill of {length.min():.3f} mm", f"tolerances.min_member = {min_member:g} mm"
        raise Refused("E-TRIM-SHORT", "surface.trim", found, limit, "Move the plane a little, or leave out the sills.")


def sliver_notes(mesh: Mesh, min_member: float) -> list[Note]:
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


def sill_notes(mesh: Mesh) -> list[Note]:
    """Report how far sills stand from the axes of their nodes: they are exempt from the torsion rule."""
    ends = mesh.edges[mesh.family == Family.SILL]
    if not len(ends):
        return []
    across = np.cross(mesh.nodes[ends[:, 1]] - mesh.nodes[ends[:, 0]], sill_tops(mesh))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    sine = np.abs(np.einsum("ekx,ex->ek", mesh.axes[ends], across)).max()
    angle = np.degrees(np.arcsin(min(float(sine), 1.0)))
    return [Note("W-TRIM-SILL", "surface.sill", f"sills stand at up to {angle:.2f}° to the axes of their nodes")]
