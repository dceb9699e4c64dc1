"""Flat parts as solids: an outline extruded by a thickness."""

import manifold3d as m3
import numpy as np

from isomould.arrays import Floats, Ints


def extrude(outline: Floats, low: float, high: float) -> tuple[Floats, Ints]:
    """Give the prism over a counter-clockwise outline (n, 2) mm between two levels.

    Returns
    -------
    vertices (v, 3) mm and triangles (t, 3), counter-clockwise from outside.
    """
    section = m3.CrossSection([outline], m3.FillRule.Positive)
    mesh = m3.Manifold.extrude(section, high - low).translate((0.0, 0.0, low)).to_mesh64()
    vertices = np.array(mesh.vert_properties, dtype=np.float64)[:, :3]
    return vertices, np.array(mesh.tri_verts, dtype=np.int64)
