"""Panels too slender or too sharp to be made, or to be made gladly (failure mode C9)."""

import numpy as np

from isomould.arrays import Bools, Floats
from isomould.errors import Note, Refused
from isomould.form.mesh import Mesh

SHORTEST_SIDE = 1.0
"""mm; shorter sides are no sides."""
SHARPEST_DEG, SHARP_DEG = 1.0, 5.0
"""Inner angles below the first are refused, below the second noted."""
SLENDER = 20.0
"""Panels whose longest side is so many times the shortest are noted."""


def weigh_panels(mesh: Mesh) -> tuple[Note, ...]:
    """Refuse panels that degenerate, and note sharp and slender ones.

    Raises
    ------
    Refused
        E-PANEL-SLIVER for a side below 1 mm or an inner angle below 1°.
    """
    lengths, angles = side_lengths(mesh), inner_angles_deg(mesh)
    _refuse(mesh, lengths, f"a side of {lengths.min():.3f} mm", f"{SHORTEST_SIDE:g} mm", SHORTEST_SIDE)
    _refuse(mesh, angles, f"an inner angle of {angles.min():.3f}°", f"{SHARPEST_DEG:g}°", SHARPEST_DEG)
    starts = mesh.face_offsets[:-1]
    aspect = np.maximum.reduceat(lengths, starts) / np.minimum.reduceat(lengths, starts)
    sharp, slender = np.minimum.reduceat(angles, starts) < SHARP_DEG, aspect > SLENDER
    return (
        *_noted(sharp, f"an inner angle below {SHARP_DEG:g}°, the least {angles.min():.2f}°"),
        *_noted(slender, f"sides more than {SLENDER:g} times as long as others, at most {aspect.max():.1f} times"),
    )


def side_lengths(mesh: Mesh) -> Floats:
    """Give the length (k,) mm of the side after each corner."""
    return np.linalg.norm(mesh.nodes[mesh.faces[mesh.ahead]] - mesh.nodes[mesh.faces], axis=1)


def inner_angles_deg(mesh: Mesh) -> Floats:
    """Give the inner angle (k,) of the panel at each corner, convex panels taken for granted."""
    after = mesh.nodes[mesh.faces[mesh.ahead]] - mesh.nodes[mesh.faces]
    before = np.empty_like(after)
    before[mesh.ahead] = -after
    sine = np.linalg.norm(np.cross(after, before), axis=1)
    return np.degrees(np.arctan2(sine, np.einsum("kc,kc->k", after, before)))


def _refuse(mesh: Mesh, values: Floats, found: str, limit: str, least: float) -> None:
    worst = int(np.argmin(values))
    if values[worst] >= least:
        return
    i, j = mesh.face_ij[int(np.searchsorted(mesh.face_offsets, worst, side="right")) - 1]
    raise Refused(
        "E-PANEL-SLIVER",
        f"panel of row {i}, strip {j}",
        found,
        f"at least {limit}",
        "Divide the curves more coarsely there, keep away from the pole, or move the plane that trims it.",
    )


def _noted(where: Bools, text: str) -> tuple[Note, ...]:
    count = int(np.count_nonzero(where))
    return (Note("W-PANEL-SLIVER", "panels", f"{count} panels have {text}"),) if count else ()
