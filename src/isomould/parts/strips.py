"""Developable strips: the panels between two generatrices or two parallels, unrolled flat (paper §3.1)."""

from dataclasses import dataclass

import numpy as np
import shapely

from isomould.arrays import Floats, Ints, read_only
from isomould.errors import Refused
from isomould.form.mesh import Mesh, NodeKind
from isomould.parts.outline import round_outline
from isomould.parts.settings import Along

"""The lines that a strip lies between."""


@dataclass(frozen=True, eq=False)
class Strip:
    """An unrolled strip, in the plane with its first fold on the y axis.

    Attributes
    ----------
    name : str
        `SG-03` lies between generatrices 3 and 4, `SP-03` between parallels 3 and 4.
    left, right : (k + 1, 2) float, mm
        Ends of the fold lines, the strip's own ends included; seen from outside, walking from the first to the last.
    sagitta : float, mm
        Largest distance of the middles of the fold lines from the chord between the first and the last.
    """

    name: str
    along: Along
    number: int
    left: Floats
    right: Floats
    sagitta: float

    def __post_init__(self) -> None:
        read_only(self.left)
        read_only(self.right)

    @property
    def outline(self) -> Floats:
        """Counter-clockwise outline (2k + 2, 2) mm."""
        return np.concatenate([self.right, self.left[::-1]])

    @property
    def folds(self) -> Floats:
        """Inner fold lines (k − 1, 2, 2) mm."""
        return np.stack([self.left[1:-1], self.right[1:-1]], axis=1)


def unroll_strips(mesh: Mesh, along: Along) -> tuple[Strip, ...]:
    """Unroll all strips between neighbouring generatrices, or between neighbouring parallels.

    A strip that runs round a closed direction is cut open at its first fold.

    Raises
    ------
    Refused
        If panels of a strip are cut or missing, or a strip lies on itself when it is flat.
    """
    index = 1 if along == "generatrix" else 0
    numbers = np.unique(mesh.face_ij[:, index]).tolist()
    width = max(2, len(str(numbers[-1])))
    prefix = "SG" if along == "generatrix" else "SP"
    return tuple(_unroll(mesh, along, number, f"{prefix}-{number:0{width}d}") for number in numbers)


def _unroll(mesh: Mesh, along: Along, number: int, name: str) -> Strip:
    """Lay quadrilateral after quadrilateral down, each at the fold that it shares with the one before."""
    rows = _in_order(mesh, along, number)
    # Corners of a quad, walking up a strip: near left, near right, far right, far left.
    order = [0, 1, 2, 3] if along == "generatrix" else [3, 0, 1, 2]
    corners = mesh.nodes[_whole(mesh, rows, along)[:, order]]
    width = float(np.linalg.norm(corners[0, 1] - corners[0, 0]))
    left, right = [np.array([0.0, width])], [np.array([0.0, 0.0])]
    for quad in corners:
        far_left, far_right = (_lay(quad, point, left[-1], right[-1]) for point in (quad[3], quad[2]))
        left.append(far_left)
        right.append(far_right)
    sides = np.array(left), np.array(right)
    strip = Strip(name, along, number, *sides, _sagitta((sides[0] + sides[1]) / 2))
    _refuse_overlap(strip)
    return strip


def _refuse_overlap(strip: Strip) -> None:
    """A ring that turns by a whole turn when it lies flat ends on its beginning: no sheet holds both."""
    if not shapely.is_simple(shapely.LinearRing(round_outline(strip.outline))):
        raise Refused(
            "E-STRIP",
            "deliver.strips",
            f"strip {strip.name}, which lies on itself when it is flat",
            "strips with an outline that does not meet itself",
            f'Leave "{strip.along}" out of deliver.strips.',
        )


def _whole(mesh: Mesh, rows: Ints, along: Along) -> Ints:
    """Corners (k, 4) of a strip's panels, each of which must share a fold with the next."""
    corners = mesh.table(mesh.faces)[rows][:, :4]
    steps = np.diff(mesh.face_ij[rows, 0 if along == "generatrix" else 1])
    if np.any(mesh.kind[corners] == NodeKind.SUPPORT) or np.any(mesh.sizes[rows] != 4) or np.any(steps != 1):
        raise Refused(
            "E-STRIP",
            "deliver.strips",
            f"a strip along {'generatrices' if along == 'generatrix' else 'parallels'} with cut panels, a gap or a lid",
            "strips of whole panels",
            "Leave deliver.strips out for trimmed surfaces and those that pass poles.",
        )
    return corners


def _in_order(mesh: Mesh, along: Along, number: int) -> Ints:
    across, walked = (1, 0) if along == "generatrix" else (0, 1)
    rows = np.flatnonzero(mesh.face_ij[:, across] == number)
    return rows[np.argsort(mesh.face_ij[rows, walked], kind="stable")]


def _lay(quad: Floats, point: Floats, left: Floats, right: Floats) -> Floats:
    """Flat place (2,) of a corner of a quad whose near side lies at left and right: same distances, far side ahead."""
    near = quad[0] - quad[1]
    length = np.linalg.norm(near)
    reach = np.dot(point - quad[1], near) / length
    height = np.linalg.norm(np.cross(point - quad[1], near)) / length
    across = (left - right) / length
    ahead = np.array([across[1], -across[0]])
    return right + reach * across + height * ahead


def _sagitta(middles: Floats) -> float:
    chord = middles[-1] - middles[0]
    away = middles - middles[0]
    return float(np.max(np.abs(chord[0] * away[:, 1] - chord[1] * away[:, 0])) / np.linalg.norm(chord))
