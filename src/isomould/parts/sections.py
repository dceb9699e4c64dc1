"""Sections and outlines of solids, for drawings: plane polygons, whatever the detail of the node."""

from dataclasses import dataclass

import manifold3d as m3
import numpy as np

from isomould.arrays import Floats
from isomould.parts.solid import Solid

Polygons = tuple[Floats, ...]
"""Closed outlines (n, 2) mm: outer ones counter-clockwise, holes clockwise."""


@dataclass(frozen=True, eq=False)
class SolidViews:
    """A solid in its own frame, seen from outside along −z, and cut upright through its x axis (seen along +y).

    Attributes
    ----------
    plan, elevation : Polygons
        Outlines of the whole solid in x, y and in x, z.
    level, upright : Polygons
        Sections by the planes z = 0 and y = 0.
    """

    plan: Polygons
    level: Polygons
    elevation: Polygons
    upright: Polygons


def view_solid(solid: Solid) -> SolidViews:
    """Cut and project a solid."""
    vertices, triangles = np.array(solid.vertices, order="C"), solid.triangles.astype(np.uint64)
    lying = m3.Manifold(m3.Mesh64(vertices, triangles))
    turned = lying.rotate((-90.0, 0.0, 0.0))
    views = (lying.project(), lying.slice(0.0), turned.project(), turned.slice(0.0))
    return SolidViews(*(tuple(view.to_polygons()) for view in views))
