"""What each kind of DXF entity draws, as shapes in space in drawing units, measured from a point of its own.

The entities are the DXF reader's; damaged ones make these functions raise what `dxf` turns into refusals.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from isomould.arrays import Floats
from isomould.curves import shapes
from isomould.curves.bspline import Nurbs, interpolated
from isomould.curves.pieces import Ellipse, Line, Piece
from isomould.curves.spatial import Shape, anchors, shapes_of
from isomould.curves.sweep import FULL, counter_clockwise
from isomould.curves.tidy_splines import has_doubled_ends, tidied_segments

_SMOOTHED = 2 | 4
"""Flags of a polyline that is smoothed by arcs or by a spline."""

_FRAME_VERTEX = 16
"""Flag of a vertex that only holds the spline that a polyline is smoothed by."""


def name_of(entity: Any) -> str:
    """Give type and handle, as messages call an entity."""
    handle = entity.dxf.get("handle")
    return f"{entity.dxftype()} {handle}" if handle else entity.dxftype()


def says_closed(entity: Any) -> bool:
    """Tell whether a spline's flags say closed or periodic."""
    return entity.dxftype() == "SPLINE" and bool(entity.dxf.get("flags", 0) & 3)


def is_mesh(entity: Any) -> bool:
    """Tell whether a polyline is no line but a mesh of faces."""
    return entity.dxftype() == "POLYLINE" and not (entity.is_2d_polyline or entity.is_3d_polyline)


def is_smoothed(entity: Any) -> bool:
    """Tell whether an entity is a smoothed polyline, whose file holds the vertices that CAD made of it."""
    return entity.dxftype() == "POLYLINE" and bool(entity.dxf.flags & _SMOOTHED)


class Drawn(NamedTuple):
    """What an entity draws: shapes whose anchors are measured from a point of its own.

    Small shapes far from the origin, such as a rail in the coordinates of a country, so keep all digits.
    """

    base: Floats
    """(3,) in the drawing."""
    shapes: list[Shape]


def _line(entity: Any) -> Drawn:
    ends = np.array([entity.dxf.start, entity.dxf.end], float)
    return Drawn(ends[0], [Shape(Line, ends - ends[0])])


def _circle(entity: Any) -> Drawn:
    return _arc_of(entity, (0.0, FULL))


def _arc(entity: Any) -> Drawn:
    return _arc_of(entity, counter_clockwise(*np.radians([entity.dxf.start_angle, entity.dxf.end_angle]).tolist()))


def _arc_of(entity: Any, range_: tuple[float, float]) -> Drawn:
    axes = _positive(entity.dxf.radius) * np.eye(2)
    arc = shapes.ellipse(np.zeros(2), axes[0], axes[1], range_)
    return _lifted((arc,), entity, np.array(entity.dxf.center, float))


def _ellipse(entity: Any) -> Drawn:
    centre = np.array(entity.dxf.center, float)
    tips = np.array([(0.0, 0.0, 0.0), entity.dxf.major_axis, entity.minor_axis], float)
    range_ = counter_clockwise(entity.dxf.start_param, entity.dxf.end_param)
    return Drawn(centre, [Shape(Ellipse, tips, range_)])


def _lwpolyline(entity: Any) -> Drawn:
    rows = np.array(entity.get_points("xyb"), float).reshape(-1, 3)
    return _bulged(rows, entity.closed, entity, entity.dxf.elevation)


def _polyline(entity: Any) -> Drawn:
    # the frame of a smoothed polyline is beside the curve that CAD shows
    vertices = [vertex for vertex in entity.vertices if not vertex.dxf.flags & _FRAME_VERTEX]
    places = np.array([vertex.dxf.location for vertex in vertices], float).reshape(-1, 3)
    if entity.is_3d_polyline:
        base = _first_of(places)
        following = np.roll(places, -1, axis=0)[: len(places) - (not entity.is_closed)]
        edges = zip(places - base, following - base, strict=False)
        return Drawn(base, [Shape(Line, np.array(edge)) for edge in edges])
    bulges = [vertex.dxf.get("bulge", 0.0) for vertex in vertices]
    height = entity.dxf.get("elevation", (0.0, 0.0, 0.0))[2]
    return _bulged(np.column_stack([places[:, :2], bulges]), entity.is_closed, entity, height)


def _bulged(rows: Floats, closed: bool, entity: Any, height: float) -> Drawn:
    """Draw the edges between rows (x, y, bulge) of the entity's own system."""
    base = _first_of(rows[:, :2])
    pieces = shapes.polyline(rows[:, :2] - base, rows[:, 2], closed)
    return _lifted(pieces, entity, np.append(base, height))


def repeats_an_end(entity: Any) -> bool:
    """Tell whether an entity is a spline that starts or ends with a control point twice."""
    return (
        entity.dxftype() == "SPLINE"
        and len(entity.control_points) > 0
        and has_doubled_ends(_nurbs_of(entity, np.zeros(3)))
    )


def _nurbs_of(entity: Any, base: Floats) -> Nurbs:
    points, knots = np.array(entity.control_points, float), np.array(entity.knots, float)
    weights = np.array(entity.weights, float) if len(entity.weights) else np.ones(len(points))
    return Nurbs(entity.dxf.degree, points - base, weights, knots)


def _spline(entity: Any) -> Drawn:
    if not len(entity.control_points):
        return _through_fit_points(entity)
    base = _first_of(np.array(entity.control_points, float))
    spline = _nurbs_of(entity, base)
    return Drawn(base, shapes_of(tidied_segments(spline, name_of(entity))))


def _through_fit_points(entity: Any) -> Drawn:
    """Lay the cubic of CAD programs through the fit points of a spline that has no control points."""
    closed = says_closed(entity)
    points, _ = shapes.distinct(np.array(entity.fit_points, float).reshape(-1, 3), closed, name_of(entity))
    if len(points) < 2 + closed:
        message = f"{len(points)} different fit points"
        raise ValueError(message)
    base = points[0]
    points = points - base
    if closed:
        return Drawn(base, shapes_of(interpolated(np.vstack([points, points[:1]]), "periodic")))
    tangents = [np.array(entity.dxf.get(name, (0, 0, 0)), float) for name in ("start_tangent", "end_tangent")]
    if not any(t.any() for t in tangents):
        return Drawn(base, shapes_of(interpolated(points, "natural")))
    return Drawn(base, shapes_of(interpolated(points, (_unit(tangents[0]), _unit(tangents[1])))))


def _lifted(pieces: tuple[Piece, ...], entity: Any, base: Floats) -> Drawn:
    """Place pieces drawn from a point (3,) of the entity's own system in space: a mirrored one comes out right."""
    ocs = entity.ocs()
    axes = np.array([ocs.to_wcs(axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))], float)
    lifted = [Shape(type(piece), flat @ axes[:2], numbers) for piece in pieces for flat, numbers in [anchors(piece)]]
    return Drawn(base @ axes, lifted)


def _first_of(points: Floats) -> Floats:
    if not len(points):
        message = "no points"
        raise ValueError(message)
    return points[0].copy()


def _positive(radius: float) -> float:
    if not 0 < radius < np.inf:
        message = f"radius {radius:g}"
        raise ValueError(message)
    return radius


def _unit(vector: Floats) -> Floats:
    size = float(np.linalg.norm(vector))
    if not 0 < size < np.inf:
        message = "only one of the two end tangents"
        raise ValueError(message)
    return vector / size


TRACERS: dict[str, Callable[[Any], Drawn]] = {
    "LINE": _line,
    "CIRCLE": _circle,
    "ARC": _arc,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
}
"""Entity type to the function that traces it, in the direction it is drawn."""
