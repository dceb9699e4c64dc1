"""Flat parts as solids: an outline with holes, extruded by a thickness."""

from collections.abc import Iterable
from dataclasses import dataclass

import manifold3d as m3
import numpy as np

from isomould.arrays import Floats, Ints, read_only
from isomould.parts.features import Hole
from isomould.parts.kernel import facets


@dataclass(frozen=True, eq=False)
class Shape:
    """The surface of a part in its own frame: vertices (n, 3) mm, triangles (t, 3) counter-clockwise from outside."""

    vertices: Floats
    triangles: Ints

    def __post_init__(self) -> None:
        read_only(self.vertices)
        read_only(self.triangles)


def extrude(outline: Floats, low: float, high: float, inner: Iterable[Floats] = ()) -> Shape:
    """Give the prism between two levels over a counter-clockwise outline (n, 2) mm.

    `inner` are contours (k, 2) of what is cut out, in either direction.
    """
    section = m3.CrossSection([outline], m3.FillRule.Positive)
    for contour in inner:
        section -= m3.CrossSection([contour], m3.FillRule.NonZero)
    return shape_of(m3.Manifold.extrude(section, high - low).translate((0.0, 0.0, low)))


def shape_of(solid: m3.Manifold) -> Shape:
    """Take vertices and triangles out of the solid kernel."""
    mesh = solid.to_mesh64()
    vertices = np.array(mesh.vert_properties, dtype=np.float64)[:, :3]
    return Shape(vertices, np.array(mesh.tri_verts, dtype=np.int64))


def hole_contour(hole: Hole) -> Floats:
    """Contour (k, 2) of a round hole or a slot, its arcs in chords, counter-clockwise.

    >>> hole_contour(Hole(10.0, 0.0, 4.0, lengthening=6.0)).max(axis=0).tolist()
    [15.0, 2.0]
    """
    count, radius = facets(hole.diameter / 2), hole.diameter / 2
    angle = np.arange(count + 1) / count * 2 * np.pi - np.pi / 2
    right = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)[: count // 2 + 1]
    half = np.array([hole.lengthening / 2, 0.0])
    ends = np.concatenate([right + half, -right - half])
    distinct = np.any(np.abs(ends - np.roll(ends, 1, axis=0)) > 1e-9, axis=1)
    return ends[distinct] + np.array([hole.x, hole.y])
