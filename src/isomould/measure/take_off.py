"""Quantities of a mesh of any origin that cost money: what mesh families are priced by (paper Table 5 in money)."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats
from isomould.form.mesh import Mesh
from isomould.measure.faces import faces_by_corners
from isomould.measure.joints import edge_lengths
from isomould.parts.arms import Arms
from isomould.parts.quality import node_torsion
from isomould.ties import first_least_of_rows

TORSION_DEG = 0.01
"""Nodes twisted by more than this cannot have all their beams upright on one axis; the limit of the certificate."""


@dataclass(frozen=True, eq=False)
class TakeOff:
    """Quantities of a mesh, on system lines.

    Attributes
    ----------
    twisted
        Number of nodes with torsion.
    length
        Sum of the member lengths, mm.
    area, contour
        Sums over the panels: mm², mm.
    boxes : (f, 2) float, mm
        Smallest rectangle around each panel, longer side first.
    """

    twisted: int
    length: float
    area: float
    contour: float
    boxes: Floats


def take_off(mesh: Mesh, arms: Arms) -> TakeOff:
    """Take the quantities off a mesh; panels that are not planar are flattened on their mean plane."""
    area, contour, boxes = 0.0, 0.0, np.empty((len(mesh.face_ij), 2))
    for rows, corners in faces_by_corners(mesh):
        flat = _flat(corners)
        area += float(_areas(flat).sum())
        contour += float(np.linalg.norm(np.roll(flat, -1, axis=1) - flat, axis=2).sum())
        boxes[rows] = _boxes(flat)
    twisted = int(np.count_nonzero(node_torsion(mesh, arms) > np.radians(TORSION_DEG)))
    return TakeOff(twisted, float(edge_lengths(mesh).sum()), area, contour, boxes)


def _flat(corners: Floats) -> Floats:
    """Lay polygons (f, n, 3) in the plane (f, n, 2), their first side along x."""
    centred = corners - corners[:, :1]
    normal = np.cross(centred, np.roll(centred, -1, axis=1)).sum(axis=1)
    along = centred[:, 1] / np.linalg.norm(centred[:, 1], axis=1)[:, None]
    across = np.cross(normal, along)
    across /= np.linalg.norm(across, axis=1)[:, None]
    return np.stack([np.einsum("fnk,fk->fn", centred, axis) for axis in (along, across)], axis=-1)


def _areas(flat: Floats) -> Floats:
    x, y = flat[..., 0], flat[..., 1]
    return np.abs((x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1)) / 2


def _boxes(flat: Floats) -> Floats:
    """Sides (f, 2) of the smallest rectangles: one of their sides lies along a side of a convex polygon."""
    sides = np.roll(flat, -1, axis=1) - flat
    along = sides / np.linalg.norm(sides, axis=2, keepdims=True)
    across = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    spans = np.stack([np.ptp(np.einsum("fmk,fnk->fnm", flat, axis), axis=2) for axis in (along, across)], axis=-1)
    best = first_least_of_rows(spans.prod(axis=2))
    return np.sort(spans[np.arange(len(flat)), best], axis=1)[:, ::-1]
