"""Corners of panels clear of what stands proud on the nodes: caps and bolts (fabrication, Panels).

A stack is a cylinder about the node's axis. Where it reaches the underside of a panel, the panel's corner is cut off
square to its bisector, so far that the stack stays clear of it at both levels; both legs of such a chamfer are equal.
"""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, read_only, round_um
from isomould.errors import Refused
from isomould.form.mesh import Mesh
from isomould.parts.arms import across, normalised
from isomould.ties import first_least_of_rows

_ON_LINE = 1e-9
"""Points that are less far (mm) outside a side are on it."""

_SHARE = 0.5
"""Of a side, what chamfers at its two ends may take together."""


@dataclass(frozen=True, eq=False)
class Stacks:
    """What stands on the nodes: a `radius` for all and the heights `top` (n,) above the work points, mm.

    −∞ stands for a node on which nothing stands.
    """

    radius: float
    top: Floats

    def __post_init__(self) -> None:
        read_only(self.top)


@dataclass(frozen=True, eq=False)
class Undersides:
    """Corners (k, 3) of panels' undersides and the panels' unit normals (k, 3) to the outside, one per corner."""

    corners: Floats
    normals: Floats
    thickness: float


def chamfer_legs(mesh: Mesh, panels: Undersides, stacks: Stacks, clearance: float) -> Floats:
    """Give the legs (k,) mm of the chamfers that keep corners clear of the stacks; 0 where nothing is in the way."""
    axis, normal, corner = mesh.axes[mesh.faces], panels.normals, panels.corners
    ahead, behind = _sides(mesh, corner)
    bisector = normalised(ahead + behind)
    upright = _dot(axis, normal)
    height = _dot(corner - mesh.nodes[mesh.faces], normal) / upright
    reach = stacks.radius + clearance
    lowest = height - reach * np.sqrt(np.maximum(0.0, 1 - upright**2)) / upright
    levels = np.stack([height, height + panels.thickness / upright])
    axis_at = _dot(mesh.nodes[mesh.faces] - corner, bisector) + levels * _dot(axis, bisector)
    wanted = axis_at.max(axis=0) + reach * _spread(axis, normal, bisector)
    leg = np.maximum(0.0, wanted) / _dot(ahead, bisector)
    return np.where(lowest < stacks.top[mesh.faces] + clearance, leg, 0.0)


def _sides(mesh: Mesh, corner: Floats) -> tuple[Floats, Floats]:
    """Unit directions (k, 3) from every corner to the next and to the last one of its panel."""
    return normalised(corner[mesh.ahead] - corner), normalised(corner[np.argsort(mesh.ahead)] - corner)


def _dot(a: Floats, b: Floats) -> Floats:
    return np.einsum("ki,ki->k", a, b)


def _spread(axis: Floats, normal: Floats, way: Floats) -> Floats:
    """How far (k,) a cylinder of radius 1 reaches along a direction in the plane that cuts it, from its axis."""
    slide = _dot(way, axis) / _dot(axis, normal)
    return np.hypot(*(_dot(way, side) - slide * _dot(side, normal) for side in across(axis)))


def refuse_long_chamfers(mesh: Mesh, corners: Floats, legs: Floats, names: list[str]) -> None:
    """Refuse chamfers that leave less than half of a side; `names` are of the sides (k,)."""
    length = np.linalg.norm(corners[mesh.ahead] - corners, axis=1)
    share = (legs + legs[mesh.ahead]) / length
    worst = int(np.argmax(share))
    if share[worst] > _SHARE:
        raise Refused(
            "E-PANEL-CORNER",
            f"panels ({names[worst]})",
            f"chamfers at the nodes take {legs[worst] + legs[mesh.ahead[worst]]:.3f} mm of {length[worst]:.3f} mm",
            f"at most {_SHARE:g} of a side",
            "Divide the curves more coarsely, use smaller or lower caps, or a thicker spacer.",
        )


def chamfered(outline: Floats, legs: Floats) -> Floats:
    """Cut the corners (n, 2) of an outline by chamfers with the legs (n,); corners with none stay.

    The result begins with the first side still. New corners are rounded to the inside, so that the part lies within
    the blank that is nested in its place.

    >>> square = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    >>> chamfered(square, np.array([2.0, 0.0, 0.0, 0.0])).tolist()
    [[2.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [0.0, 2.0]]
    """
    ways = [normalised(np.roll(outline, step, axis=0) - outline) for step in (1, -1)]
    sides = [np.stack([-way[:, 1], way[:, 0]], axis=-1) * turn for way, turn in zip(ways, (-1, 1), strict=True)]
    exact = [outline + legs[:, None] * way for way in ways]
    both = np.stack([_rounded_in(*sets, outline) for sets in zip(exact, sides, strict=True)], axis=1)
    kept = np.stack([np.ones(len(legs), dtype=bool), legs > 0], axis=1)
    return read_only(np.roll(both[kept] + 0.0, -int(legs[0] > 0), axis=0))


def _rounded_in(points: Floats, inward: Floats, on: Floats) -> Floats:
    """Round points (n, 2) to the nearest 0.001 mm on the inner side of lines through points with these normals."""
    steps = np.stack(np.meshgrid(*[[-0.001, 0.0, 0.001]] * 2), axis=-1).reshape(-1, 2)
    near = round_um(round_um(points)[:, None] + steps)
    outside = np.einsum("nki,ni->nk", near - on[:, None], inward) < -_ON_LINE
    away = np.where(outside, np.inf, np.linalg.norm(near - points[:, None], axis=-1))
    return near[np.arange(len(points)), first_least_of_rows(away)]
