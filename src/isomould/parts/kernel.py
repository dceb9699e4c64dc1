"""Round and long bodies for the solid kernel; round surfaces have facets (fabrication, Node solids)."""

import manifold3d as m3
import numpy as np
import shapely

from isomould.arrays import Floats

CHORD = 0.002
"""Largest distance (mm) between a round surface and its facets."""

OVERLAP = 5.0
"""How far (mm) cutters stand out of what they cut: faces are never flush."""


def facets(radius: float) -> int:
    """Number of facets, a multiple of four, that keeps a round surface within `CHORD` of the true one.

    >>> facets(50.0)
    352
    """
    return 4 * int(np.ceil(np.pi / np.arccos(1 - CHORD / max(radius, 1.0)) / 4))


def cylinder(radius: float, low: float, high: float) -> m3.Manifold:
    """Give a cylinder about the node axis between two levels."""
    return m3.Manifold.cylinder(high - low, radius, radius, facets(radius)).translate((0.0, 0.0, low))


def block(low: tuple[float, float, float], high: tuple[float, float, float]) -> m3.Manifold:
    """Give the box between two corners."""
    size = np.subtract(high, low)
    return m3.Manifold.cube(tuple(size)).translate(low)


def join(parts: list[m3.Manifold]) -> m3.Manifold:
    """Give the union of parts."""
    return m3.Manifold.batch_boolean(parts, m3.OpType.Add)


def ring(radius: float) -> Floats:
    """Corners (n, 2) of the contour that `cylinder` gives a round body."""
    angle = np.arange(facets(radius)) * 2 * np.pi / facets(radius)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def disc(radius: float, x: float = 0.0) -> shapely.Polygon:
    """Give the cross-section of a cylinder as planar geometry, its centre at (x, 0)."""
    return shapely.Polygon(np.array([x, 0.0]) + ring(radius))


def annulus(inner: float, outer: float) -> shapely.Polygon:
    """Give the cross-section of a pipe as planar geometry."""
    return shapely.Polygon(ring(outer), [ring(inner)])
