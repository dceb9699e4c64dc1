"""The frame of a rail in space: carried by reflection, so that it turns no more than the rail (geometry §3)."""

from itertools import pairwise

import numpy as np

from isomould.arrays import Floats
from isomould.errors import Note, Refused
from isomould.form.profile import Profile
from isomould.form.rail import Rail
from isomould.form.spatial import SpatialPolygon

_UPRIGHT = 1e-6
"""Sine of the smallest angle between the first edge and `up`."""
CLOSES = 0.01
"""Largest gap, mm, of a frame that closes (failure mode B12): as far the panels of the last strip leave their planes.

It is there for rails that close as they were thought but whose coordinates are rounded.
"""
_EXACT = 1e-6
"""Gap, mm, from which it is told."""


def spatial_rail(polygon: SpatialPolygon, up: Floats) -> Rail:
    """Give the frame of a rail in space (geometry §3).

    W of the first edge is what `up` (3,) has across it, U = e × W the outside, on the right of who walks along the
    rail with `up` overhead. Both are carried on by reflection in the bisecting planes of the rail's nodes; open ends
    are square.

    Raises
    ------
    Refused
        E-RAIL-UP if `up` runs along the first edge.
    """
    along = polygon.directions
    outward, upward = carry_frame(along, _first_frame(along[0], up), closed=polygon.closed)
    count = len(along)
    edge, before = _edges_at(polygon)
    bisector = along[before] + along[edge]
    return Rail(
        R=polygon.vertices,
        A=_mitred(outward[edge], along[edge], bisector),
        C=_mitred(upward[edge], along[edge], bisector),
        directions=along,
        outward=outward[:count],
        lengths=polygon.lengths,
        turning=np.nan_to_num(polygon.turning),
        inner=np.isfinite(polygon.turning),
        closed=polygon.closed,
        twist=_twist(outward, upward) if polygon.closed else 0.0,
    )


def carry_frame(along: Floats, first: Floats, *, closed: bool) -> tuple[Floats, Floats]:
    """Carry a frame along unit edges (m, 3) by reflection.

    Parameters
    ----------
    first
        U and W (2, 3) of edge 0.
    closed
        Carry it once round: the last row is then edge 0 again.

    Returns
    -------
    U and W, each (m, 3), or (m + 1, 3) if closed.
    """
    path = np.vstack([along, along[:1]]) if closed else along
    frames = [first]
    for here, ahead in pairwise(path):
        normal = (here + ahead) / np.linalg.norm(here + ahead)
        reflected = frames[-1] - 2 * np.outer(frames[-1] @ normal, normal)
        frames.append(_squared(reflected, ahead))
    carried = np.array(frames)
    return carried[:, 0], carried[:, 1]


def refuse_twist(rail: Rail, profile: Profile) -> tuple[Note, ...]:
    """Refuse closed rails whose frame does not close (failure mode B12), or tell its gap: the twist is never spread.

    The gap is the largest distance, mm, between a profile vertex and itself carried once round.
    """
    reach = float(np.hypot(profile.d, profile.z).max())
    gap = 2 * reach * float(np.sin(abs(rail.twist) / 2))
    if gap > CLOSES:
        raise Refused(
            "E-RAIL-TWIST",
            "rail.curve",
            f"carried once round this closed rail, the generatrix comes back turned by {np.degrees(rail.twist):.6g}°: "
            f"a gap of {gap:.6g} mm, {reach:.6g} mm from the rail",
            f"a gap of {CLOSES:g} mm; spreading the turn over the nodes would bend the panels",
            "Open the rail at a seam (closed = false), or draw it in one plane or as its own mirror image: there every "
            "frame closes.",
        )
    text = f"the frame of the closed rail misses itself by {gap:.6f} mm: as far panels of the last strip are not plane"
    return (Note("W-RAIL-SEAM", "rail.curve", text),) if gap > _EXACT else ()


def _first_frame(along: Floats, up: Floats) -> Floats:
    """U and W (2, 3) of the first edge."""
    across = up - (up @ along) * along
    size = float(np.linalg.norm(across))
    if not size > _UPRIGHT * float(np.linalg.norm(up)):
        raise Refused(
            "E-RAIL-UP",
            "rail.up",
            f"[{', '.join(f'{value:g}' for value in up)}], which runs along the rail's first edge",
            "a direction across it",
            "Give rail.up another direction, such as [0, 0, 1].",
        )
    return np.array([np.cross(along, across / size), across / size])


def _squared(frame: Floats, along: Floats) -> Floats:
    """Take rounding noise out of a frame (2, 3): it must not grow with the number of edges."""
    across = frame[1] - float(frame[1] @ along) * along
    upward = across / float(np.linalg.norm(across))
    return np.array([np.cross(along, upward), upward], dtype=np.float64)


def _edges_at(polygon: SpatialPolygon) -> tuple[np.ndarray, np.ndarray]:
    """Numbers (n,), (n,) of the edges after and before every vertex; an open end sees its one edge twice."""
    count = len(polygon.piece)
    vertex = np.arange(len(polygon.vertices))
    if polygon.closed:
        return vertex, vertex - 1
    return np.minimum(vertex, count - 1), np.maximum(vertex - 1, 0)


def _mitred(across: Floats, along: Floats, bisector: Floats) -> Floats:
    """Shear vectors (n, 3) across an edge along it into the bisecting planes: A and C (geometry §3)."""
    rise = np.sum(across * bisector, axis=1) / np.sum(along * bisector, axis=1)
    return across - rise[:, None] * along


def _twist(outward: Floats, upward: Floats) -> float:
    """Angle (rad) from the frame of edge 0 to itself carried once round."""
    return float(np.arctan2(outward[-1] @ upward[0], outward[-1] @ outward[0]))
