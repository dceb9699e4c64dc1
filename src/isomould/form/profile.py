"""The divided generatrix and its offset field: one-dimensional, because the surface is a product (geometry §4)."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from isomould.arrays import Bools, Floats, read_only
from isomould.form.polygon import FLAT, CurvePolygon

Offset = Literal["face", "edge"]


@dataclass(frozen=True)
class Caps:
    """What closes a surface at its poles without members.

    `rows` have panels between parallels i and i + 1, the last parallel and the first included (i = m − 1); `lids` are
    parallels that are the outline of one panel.
    """

    rows: tuple[int, ...] = ()
    lids: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class Profile:
    """The profile polygon in the plane perpendicular to the rail.

    Attributes
    ----------
    d, z : (m,) float, mm
        Coordinates of the vertices along the rail's outside N and normal B.
    a, b : (m,) float
        Offset field `O[i, j] = a[i]·A[j] + b[i]·C[j]`; its direction is the node axis.
    latitude : (e,) float, rad
        μ: latitude of the outward normals of the e edges.
    lengths : (e,) float, mm
    inner, flat : (m,) bool
        Vertices that are no open ends; those that do not turn.
    gap : (e,) bool
        Edges that are none: no member leads there.
    caps : Caps
        Gaps and ends that panels close.
    closed : bool
    offset : "face" or "edge"
    """

    d: Floats
    z: Floats
    a: Floats
    b: Floats
    latitude: Floats
    lengths: Floats
    inner: Bools
    flat: Bools
    gap: Bools
    closed: bool
    offset: Offset
    caps: Caps = Caps()

    @property
    def whole(self) -> bool:
        """Whether members lead everywhere, and each panel lies between four of them."""
        return not (self.gap.any() or self.caps.lids)

    def __post_init__(self) -> None:
        for name in ("d", "z", "a", "b", "latitude", "lengths", "inner", "flat", "gap"):
            read_only(getattr(self, name))


def make_profile(polygon: CurvePolygon, parallels: Floats | None, caps: Caps = Caps()) -> Profile:
    """Give the profile with the face offset, or with the edge offset of a Koebe mesh.

    Parameters
    ----------
    polygon
        The divided generatrix in coordinates (d, z), its outside to the right.
    parallels : (m,) float, rad
        Latitudes λ of the vertices' parallels on the Koebe mesh, for edge offset meshes; None for the others.
    caps
        What closes poles.
    """
    latitude = polygon.edges.direction - np.pi / 2
    turning = np.nan_to_num(polygon.turning)
    a, b = face_offset(polygon, latitude) if parallels is None else (np.cos(parallels), np.sin(parallels))
    inner = np.isfinite(polygon.turning)
    return Profile(
        d=polygon.vertices[:, 0].copy(),
        z=polygon.vertices[:, 1].copy(),
        a=a,
        b=b,
        latitude=latitude,
        lengths=polygon.lengths,
        inner=inner,
        flat=inner & (np.abs(turning) <= FLAT),
        gap=polygon.gap,
        closed=polygon.closed,
        offset="face" if parallels is None else "edge",
        caps=caps,
    )


def beside(polygon: CurvePolygon, values: Floats) -> tuple[Floats, Floats]:
    """Edge values (e,) on the two sides (n,), (n,) of every vertex; an open end sees its one edge twice."""
    if polygon.closed:
        return np.roll(values, 1), values
    return np.concatenate([values[:1], values]), np.concatenate([values, values[-1:]])


def face_offset(polygon: CurvePolygon, latitude: Floats) -> tuple[Floats, Floats]:
    """Vertices of the polygon circumscribed to the unit circle with the edges' normals (geometry §4)."""
    before, after = beside(polygon, latitude)
    middle, reach = (before + after) / 2, np.cos((after - before) / 2)
    if polygon.closed:
        middle[0] = latitude[0] - polygon.turning[0] / 2
        reach[0] = np.cos(polygon.turning[0] / 2)
    return np.cos(middle) / reach, np.sin(middle) / reach
