"""Long edges divided equally by flat nodes, which keep every plane and angle (paper §4.4, geometry §2)."""

from dataclasses import replace

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.curves.curve import PlanarCurve
from isomould.form.deviation import curve_distance
from isomould.form.polygon import CurvePolygon, Role, unit
from isomould.form.settings import FormLimits
from isomould.form.size_limit import refuse_size

_SETTLED = 1e-9
"""Share of a part by which rounding may lengthen an edge before it is divided once more."""


def divide_long_edges(
    curve: PlanarCurve, polygon: CurvePolygon, max_edge: float | None, limits: FormLimits
) -> CurvePolygon:
    """Divide edges equally by flat nodes, so that none is longer than `max_edge` (mm); None leaves all as they are.

    The new vertices lie on the old edges, so that all directions stay what they are. Gaps are no edges.

    Raises
    ------
    Refused
        E-SIZE, if that makes more edges than the project allows.
    """
    if max_edge is None:
        return polygon
    built = np.where(polygon.gap, 0.0, polygon.lengths)
    parts = equal_parts(built, max_edge, limits)
    if parts.max() == 1:
        return polygon
    row, share = pieces(parts)
    step = polygon.lengths[row] / parts[row]
    vertices = polygon.vertices[row] + (share * step)[:, None] * unit(polygon.edges.direction[row])
    turning = np.where(share == 0, polygon.turning[row], 0.0)
    if not polygon.closed:
        vertices = np.vstack([vertices, polygon.vertices[-1:]])
        turning = np.append(turning, polygon.turning[-1])
    divided = replace(polygon, vertices=vertices, edges=polygon.edges.take(row), turning=turning)
    on_chords = Role.CHORD in polygon.edges.role  # points of a chord leave the arc by less than its sagitta
    return divided if on_chords else replace(divided, deviation=curve_distance(curve, vertices))


def equal_parts(lengths: Floats, max_edge: float, limits: FormLimits) -> Ints:
    """Give the number of parts (m,) of edges with the lengths (m,) mm.

    Edges that count as equal (`limits.same_length`) get equal parts, those that the longest of them needs: otherwise
    two edges beside a multiple of `max_edge` would be divided apart, and so would their members and panels.

    >>> equal_parts(np.array([999.9, 1000.1, 400.0]), 1000.0, FormLimits()).tolist()
    [2, 2, 1]
    """
    needed = np.maximum(np.ceil(lengths / max_edge - _SETTLED), 1.0)
    refuse_size(float(needed.sum()), limits)
    parts = np.ones(len(lengths), dtype=np.int64)
    longest, count = np.inf, 1
    for edge in np.argsort(-lengths, kind="stable").tolist():
        if longest - lengths[edge] > limits.same_length:
            longest, count = lengths[edge], int(needed[edge])
        parts[edge] = count
    return parts


def pieces(parts: Ints) -> tuple[Ints, Ints]:
    """Give the edge (k,) that each piece is of, and its number (k,) there from 0.

    >>> [values.tolist() for values in pieces(np.array([1, 3]))]
    [[0, 1, 1, 1], [0, 0, 1, 2]]
    """
    row = np.repeat(np.arange(len(parts)), parts)
    first = np.repeat(np.cumsum(parts) - parts, parts)
    return row, np.arange(len(row)) - first
