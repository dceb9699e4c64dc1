"""The rail in space: nodes, edges and the mitre vectors that carry the profile along it (geometry §3)."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Bools, Floats, read_only
from isomould.curves.plane import Plane
from isomould.form.polygon import FLAT, CurvePolygon, unit
from isomould.form.settings import Ends


@dataclass(frozen=True, eq=False)
class Rail:
    """A divided rail with its frame: `V[i, j] = R[j] + d[i]·A[j] + z[i]·C[j]`.

    Attributes
    ----------
    R : (n, 3) float, mm
        Rail nodes.
    A, C : (n, 3) float
        Images of the profile's d and z axes at each node; on a planar rail |A| = 1/cos(α/2) and C is the normal.
    directions, outward : (m, 3) float
        Unit directions and outside normals of the m edges (m = n if closed, else n − 1).
    lengths : (m,) float, mm
    turning : (n,) float, rad
        Signed turning, positive away from the outside, and without sign in space; at an open end that of its mitre
        (0 if square).
    inner : (n,) bool
        False at open ends.
    closed : bool
    """

    R: Floats
    A: Floats
    C: Floats
    directions: Floats
    outward: Floats
    lengths: Floats
    turning: Floats
    inner: Bools
    closed: bool
    twist: float = 0.0

    def __post_init__(self) -> None:
        for array in (
            self.R,
            self.A,
            self.C,
            self.directions,
            self.outward,
            self.lengths,
            self.turning,
            self.inner,
        ):
            read_only(array)

    @property
    def flat(self) -> Bools:
        """True (n,) at inner nodes that do not turn."""
        return self.inner & (np.abs(self.turning) <= FLAT)

    @property
    def growth(self) -> Floats:
        """Growth (m, 2) of a parallel's edges per mm of d and of z (geometry §3)."""
        following = (np.arange(len(self.lengths)) + 1) % len(self.R)
        steps = np.stack([self.A[following], self.C[following]]) - np.stack([self.A, self.C])[:, : len(self.lengths)]
        return np.einsum("kij,ij->ik", steps, self.directions)


def planar_rail(polygon: CurvePolygon, plane: Plane, ends: Ends) -> Rail:
    """Give the frame of a planar rail: `A = (N₋ + N₊)/(1 + N₋·N₊)`, `C = B` (geometry §3).

    Parameters
    ----------
    polygon
        The divided rail in its plane, its outside to the right.
    plane
        Where the plane lies in space.
    ends
        Open ends: "square" (A = N of the end edge) or "mitred" (as if the rail went on turning by the
        nearest node's α). Ignored on closed rails.
    """
    along = unit(polygon.edges.direction)
    outward = np.stack([along[:, 1], -along[:, 0]], axis=-1)
    turning = np.where(np.isnan(polygon.turning), _end_turning(polygon, ends), polygon.turning)
    mitre = _mitres(along, outward, turning, polygon.closed)
    axes = np.stack([plane.x_axis, plane.y_axis])
    normal = np.cross(plane.x_axis, plane.y_axis)
    return Rail(
        R=plane.origin + polygon.vertices @ axes,
        A=mitre @ axes,
        C=np.tile(normal, (len(turning), 1)),
        directions=along @ axes,
        outward=outward @ axes,
        lengths=polygon.lengths,
        turning=turning,
        inner=np.isfinite(polygon.turning),
        closed=polygon.closed,
    )


def _end_turning(polygon: CurvePolygon, ends: Ends) -> Floats:
    """Turning (n,) that a mitred end borrows from the nearest node that turns; 0 for square ends."""
    turning = np.zeros(len(polygon.turning))
    turns = np.flatnonzero(np.nan_to_num(np.abs(polygon.turning)) > FLAT)
    if ends == "mitred" and len(turns):
        turning[0], turning[-1] = polygon.turning[turns[0]], polygon.turning[turns[-1]]
    return turning


def _mitres(along: Floats, outward: Floats, turning: Floats, closed: bool) -> Floats:
    """Mitre vectors (n, 2): the outside normal of the edge ahead, sheared back by tan(α/2)."""
    ahead = np.arange(len(turning)) if closed else np.minimum(np.arange(len(turning)), len(along) - 1)
    shear = -np.tan(turning / 2)
    if not closed:
        shear[-1] *= -1.0
    return outward[ahead] + shear[:, None] * along[ahead]
