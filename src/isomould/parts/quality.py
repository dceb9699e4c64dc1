"""How well beams meet at the nodes: mismatch and torsion (geometry §4)."""

import numpy as np

from isomould.arrays import Floats
from isomould.errors import Refused
from isomould.form.mesh import Mesh
from isomould.parts.arms import Arms, normalised

_MAX_TORSION_DEG = 0.01


def beam_mismatch(arms: Arms, depth: float) -> Floats:
    """Give the mismatch (n,) mm of every node: the spread of `(h/2)/sin(edge, axis)` over its arms.

    Sills are left out; the mismatch of none but sills is 0.
    """
    reach = depth / 2 / np.cos(arms.elevation)
    starts = arms.offsets[:-1]
    high, low = (np.where(arms.sill, none, reach) for none in (-np.inf, np.inf))
    return np.maximum(np.maximum.reduceat(high, starts) - np.minimum.reduceat(low, starts), 0.0)


def node_torsion(mesh: Mesh, arms: Arms) -> Floats:
    """Give the torsion (n,) rad of every node: how far its axis leaves the beam planes of its arms.

    The beam plane of a member contains its system line and the axis of its far end; sills are exempt.
    """
    near = mesh.axes[arms.node]
    far = mesh.axes[mesh.edges[arms.edge, 1 - arms.end]]
    plane = normalised(np.cross(arms.direction, far))
    twist = np.abs(np.arcsin(np.clip(np.einsum("ij,ij->i", plane, near), -1.0, 1.0)))
    return np.maximum.reduceat(np.where(arms.sill, 0.0, twist), arms.offsets[:-1])


def refuse_torsion(torsion: Floats, where: tuple[str, ...]) -> None:
    """Refuse nodes whose beams do not share the axis (failure mode D5)."""
    worst = int(np.argmax(torsion))
    if np.degrees(torsion[worst]) > _MAX_TORSION_DEG:
        raise Refused(
            "E-NODE-TORSION",
            f"nodes ({where[worst]})",
            f"a torsion of {np.degrees(torsion[worst]):.4f}°",
            f"{_MAX_TORSION_DEG:g}°",
            "Members with one-angle cuts need torsion-free nodes; check the design's kind.",
        )
