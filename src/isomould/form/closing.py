"""From tangent lines to the polygon: joints, ends, and what a polygon must not do."""

import numpy as np

from isomould.arrays import Floats
from isomould.curves.curve import PlanarCurve
from isomould.curves.turning import Spans
from isomould.errors import Refused
from isomould.form.deviation import curve_distance
from isomould.form.polygon import CurvePolygon, Edges, Role, foot, joints

_SETTLED = 1e-9


def open_polygon(curve: PlanarCurve, turns: Spans, edges: Edges, min_end: float, field: str) -> CurvePolygon:
    """Close the ends of a stretch of curve by the feet of the perpendiculars from its ends (geometry §2, §5).

    An end edge shorter than `min_end` (mm) is dropped: a lattice with a prescribed angle or slope stops anywhere.
    """
    _refuse_few(len(edges.index), 2, field)
    start, end = end_points(curve, turns)
    inner = joints(edges)
    first = foot(edges, 0, start)
    last = foot(edges, len(edges.index) - 1, end)
    polygon = _polygon(curve, np.vstack([first, inner, last]), edges, closed=False)
    keep = np.ones(len(edges.index), dtype=bool)
    keep[[0, -1]] = polygon.lengths[[0, -1]] >= min_end
    keep |= [role is Role.END for role in edges.role]
    if not keep.all() and min_end > 0:
        return open_polygon(curve, turns, edges.take(np.flatnonzero(keep)), min_end, field)
    return _forward(curve, polygon, field)


def end_points(curve: PlanarCurve, turns: Spans) -> Floats:
    """Give both ends (2, 2) mm of the stretch of curve that the spans cover."""
    return curve.point(turns.piece[[0, -1]], np.array([turns.t0[0], turns.t1[-1]]))


def closed_polygon(curve: PlanarCurve, edges: Edges, full: float, field: str) -> CurvePolygon:
    """Join the last line of a closed curve to the first; `full` is the curve's whole turning, ±2π."""
    _refuse_few(len(edges.index), 3, field)
    wrapped = edges.take(np.arange(-1, len(edges.index)))
    direction = wrapped.direction.copy()
    direction[0] -= full
    around = Edges(
        wrapped.index,
        direction,
        wrapped.contact.copy(),
        wrapped.piece.copy(),
        wrapped.parameter.copy(),
        wrapped.role,
    )
    vertices = joints(around)
    turning = np.diff(direction)
    polygon = CurvePolygon(vertices, edges, turning, closed=True, deviation=curve_distance(curve, vertices))
    return _forward(curve, polygon, field)


def _polygon(curve: PlanarCurve, vertices: Floats, edges: Edges, *, closed: bool) -> CurvePolygon:
    turning = np.concatenate([[np.nan], np.diff(edges.direction), [np.nan]])
    return CurvePolygon(vertices, edges, turning, closed, curve_distance(curve, vertices))


def _refuse_few(count: int, least: int, field: str) -> None:
    if count < least:
        raise Refused(
            "E-CURVE-FEW",
            f"{field}.divide",
            f"only {count} tangent lines fit the curve: it turns by less than one turning angle",
            f"at least {least}",
            "Choose a smaller turning angle or more nodes; a straight curve has no such division (paper §4.3).",
        )


def _forward(curve: PlanarCurve, polygon: CurvePolygon, field: str) -> CurvePolygon:
    """Refuse polygons with an edge that runs backwards."""
    row = int(np.argmin(polygon.lengths))
    if polygon.lengths[row] <= 0:
        x, y = polygon.vertices[row]
        raise Refused(
            "E-CURVE-BACK",
            f"{field}.divide",
            f"edge {row} at ({x:.3f}, {y:.3f}) mm would be {polygon.lengths[row]:.3f} mm long and run backwards",
            "edges that run forwards",
            _way_forward(curve, polygon, field),
        )
    return polygon


def _way_forward(curve: PlanarCurve, polygon: CurvePolygon, field: str) -> str:
    """Advise what keeps edges from running back: straight parts need a direction of the lattice to keep their place."""
    rows = np.flatnonzero([role is Role.STRAIGHT for role in polygon.edges.role])
    along = curve.derivative(polygon.edges.piece[rows], polygon.edges.parameter[rows])
    own = np.arctan2(along[:, 1], along[:, 0])
    if np.abs(np.sin(own - polygon.edges.direction[rows])).max(initial=0.0) <= _SETTLED:
        return "Choose a smaller turning angle, or smooth the curve near its inflections."
    every = ", ".join(f"{degrees:g}°" for degrees in np.unique(np.round(np.degrees(own) % 360, 4) % 360).tolist())
    return (
        f"Set {field}.divide.first_deg and the number of nodes so that straight parts have a direction of the lattice "
        f"({every}): the edges along them lean, and run into their neighbours."
    )
