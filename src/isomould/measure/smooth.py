"""The smooth surface that a mesh stands for: distances from it, and its radii of curvature (geometry §0)."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.curves.curve import PlanarCurve
from isomould.curves.plane import Plane
from isomould.form.assemble import Form
from isomould.form.deviation import nearest_places
from isomould.form.polygon import cross
from isomould.form.spatial import SpatialPolygon


@dataclass(frozen=True, eq=False)
class Smooth:
    """The moulding surface `c(s) + d(t) N(s) + z(t) B` of two oriented curves, outsides to the right."""

    rail: PlanarCurve
    generatrix: PlanarCurve
    plane: Plane

    def point(self, rail: tuple[Ints, Floats], generatrix: tuple[Ints, Floats]) -> Floats:
        """Give the points (m, n, 3) mm at n places of the rail and m of the generatrix."""
        section = self.generatrix.point(*generatrix)
        flat = self.rail.point(*rail) + np.multiply.outer(section[:, 0], self.right(*rail))
        return self.lifted(flat, section[:, 1])

    def right(self, piece: Ints, parameter: Floats) -> Floats:
        """Outside normals (n, 2) of the rail in its plane."""
        return right(self.rail, piece, parameter)

    def lifted(self, flat: Floats, z: Floats) -> Floats:
        """Give points (m, n, 3) mm in space from points (m, n, 2) in the rail's plane and heights (m,) above it."""
        axes = np.stack([self.plane.x_axis, self.plane.y_axis])
        normal = np.cross(self.plane.x_axis, self.plane.y_axis)
        return self.plane.origin + flat @ axes + np.multiply.outer(z, normal)[:, None]


def right(curve: PlanarCurve, piece: Ints, parameter: Floats) -> Floats:
    """Unit normals (n, 2) to the right of a curve."""
    along = curve.derivative(piece, parameter)
    return np.stack([along[:, 1], -along[:, 0]], axis=-1) / np.linalg.norm(along, axis=1)[:, None]


def surface_distances(smooth: Smooth, points: Floats) -> Floats:
    """Give the distances (k,) mm of points (k, 3) from the smooth surface.

    The surface's normals lie in the normal planes of its rail: the distance is that of (d, z) from the generatrix,
    d being the signed distance from the rail. Beyond an open end of the rail the way back to it is added.
    """
    plane, away = smooth.plane, points - smooth.plane.origin
    flat = away @ np.stack([plane.x_axis, plane.y_axis], axis=1)
    place = nearest_places(smooth.rail, flat)
    step, normal = flat - smooth.rail.point(*place), smooth.right(*place)
    d, beyond = np.einsum("ij,ij->i", step, normal), cross(step, normal)
    section = np.stack([d, away @ np.cross(plane.x_axis, plane.y_axis)], axis=-1)
    foot = smooth.generatrix.point(*nearest_places(smooth.generatrix, section))
    return np.hypot(np.linalg.norm(section - foot, axis=1), beyond)


def curvature(curve: PlanarCurve, piece: Ints, parameter: Floats) -> Floats:
    """Signed curvature (n,) 1/mm of a curve, positive where it turns left."""
    speed = curve.derivative(piece, parameter)
    return cross(speed, curve.second(piece, parameter)) / np.linalg.norm(speed, axis=1) ** 3


def radii_ratios(smooth: Smooth, form: Form) -> Floats:
    """Give the ratio R1/R2 >= 1 of the principal radii (rows, strips) where each panel touches the surface (Table 4).

    Infinite where one of the curves is straight.
    """
    across, along = np.abs(principal_curvatures(smooth, form))
    lesser, greater = np.minimum(across, along), np.maximum(across, along)
    return np.divide(greater, lesser, out=np.full_like(greater, np.inf), where=lesser > 0)


def principal_curvatures(smooth: Smooth, form: Form) -> tuple[Floats, Floats]:
    """Give the principal curvatures (rows, strips) 1/mm where each panel touches the surface.

    The first is that of the parallels, `cos μ · κ / (1 + κ d)`: κ is the rail's curvature, d the distance from it, μ
    the normal's latitude. The second is that of the generatrix, the same in every strip.

    Raises
    ------
    TypeError
        For a rail in space.
    """
    if isinstance(form.rail, SpatialPolygon):
        message = "a rail in space has no principal radii in one plane"
        raise TypeError(message)
    rail, generatrix = form.rail.edges, form.generatrix.edges
    kappa = curvature(smooth.rail, rail.piece, rail.parameter)
    bend = curvature(smooth.generatrix, generatrix.piece, generatrix.parameter)
    across = np.cos(form.surface.profile.latitude)[:, None] * kappa / (1 + kappa * generatrix.contact[:, :1])
    return across, np.broadcast_to(bend[:, None], across.shape)
