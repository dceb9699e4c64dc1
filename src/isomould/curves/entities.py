"""What each kind of DXF entity draws, as shapes in space in drawing units.

The entities are the DXF reader's; damaged ones make these functions raise what `dxf` turns into refusals.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from isomould.arrays import Floats
from isomould.curves import shapes
from isomould.curves.bspline import Nurbs, interpolated, segments
from isomould.curves.pieces import Ellipse, Line, Piece
from isomould.curves.spatial import Shape, anchors, shapes_of


def name_of(entity: Any) -> str:
    """Give type and handle, as messages call an entity."""
    handle = entity.dxf.get("handle")
    return f"{entity.dxftype()} {handle}" if handle else entity.dxftype()


def says_closed(entity: Any) -> bool:
    """Tell whether a spline's flags say closed or periodic."""
    return entity.dxftype() == "SPLINE" and bool(entity.dxf.get("flags", 0) & 3)


def _line(entity: Any) -> list[Shape]:
    return [Shape(Line, np.array([entity.dxf.start, entity.dxf.end], float))]


def _circle(entity: Any) -> list[Shape]:
    return _arc_of(entity, 0.0, 360.0)


def _arc(entity: Any) -> list[Shape]:
    return _arc_of(entity, entity.dxf.start_angle, entity.dxf.end_angle)


def _arc_of(entity: Any, start_deg: float, end_deg: float) -> list[Shape]:
    centre = np.array(entity.dxf.center, float)
    axes = _positive(entity.dxf.radius) * np.eye(2)
    arc = shapes.ellipse(centre[:2], axes[0], axes[1], _range(*np.radians([start_deg, end_deg])))
    return _lifted((arc,), entity, centre[2])


def _ellipse(entity: Any) -> list[Shape]:
    centre = np.array(entity.dxf.center, float)
    tips = centre + np.array([entity.dxf.major_axis, entity.minor_axis], float)
    return [Shape(Ellipse, np.vstack([centre, tips]), _range(entity.dxf.start_param, entity.dxf.end_param))]


def _lwpolyline(entity: Any) -> list[Shape]:
    rows = np.array(entity.get_points("xyb"), float).reshape(-1, 3)
    return _lifted(shapes.polyline(rows[:, :2], rows[:, 2], entity.closed), entity, entity.dxf.elevation)


def _polyline(entity: Any) -> list[Shape]:
    places = np.array([vertex.dxf.location for vertex in entity.vertices], float).reshape(-1, 3)
    if entity.dxf.flags & 6 or not (entity.is_2d_polyline or entity.is_3d_polyline):
        message = "a mesh or a smoothed polyline"
        raise ValueError(message)
    if entity.is_3d_polyline:
        following = np.roll(places, -1, axis=0)[: len(places) - (not entity.is_closed)]
        return [Shape(Line, np.array(pair)) for pair in zip(places, following, strict=False)]
    bulges = np.array([vertex.dxf.get("bulge", 0.0) for vertex in entity.vertices], float)
    height = entity.dxf.get("elevation", (0.0, 0.0, 0.0))[2]
    return _lifted(shapes.polyline(places[:, :2], bulges, entity.is_closed), entity, height)


def _spline(entity: Any) -> list[Shape]:
    if not len(entity.control_points):
        return _through_fit_points(entity)
    points, knots = np.array(entity.control_points, float), np.array(entity.knots, float)
    weights = np.array(entity.weights, float) if len(entity.weights) else np.ones(len(points))
    return shapes_of(segments(Nurbs(entity.dxf.degree, points, weights, knots), name_of(entity)))


def _through_fit_points(entity: Any) -> list[Shape]:
    """Lay the cubic of CAD programs through the fit points of a spline that has no control points."""
    closed = says_closed(entity)
    points, _ = shapes.distinct(np.array(entity.fit_points, float).reshape(-1, 3), closed, name_of(entity))
    if len(points) < 2 + closed:
        message = f"{len(points)} different fit points"
        raise ValueError(message)
    if closed:
        return shapes_of(interpolated(np.vstack([points, points[:1]]), "periodic"))
    tangents = [np.array(entity.dxf.get(name, (0, 0, 0)), float) for name in ("start_tangent", "end_tangent")]
    if not any(t.any() for t in tangents):
        return shapes_of(interpolated(points, "natural"))
    return shapes_of(interpolated(points, (_unit(tangents[0]), _unit(tangents[1]))))


def _lifted(pieces: tuple[Piece, ...], entity: Any, height: float) -> list[Shape]:
    """Place pieces drawn in the entity's own coordinate system in space: a mirrored one comes out right."""
    ocs = entity.ocs()
    axes = np.array([ocs.to_wcs(axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))], float)
    return [
        Shape(type(piece), np.column_stack([flat, np.full(len(flat), height)]) @ axes, numbers)
        for piece in pieces
        for flat, numbers in [anchors(piece)]
    ]


def _range(start: float, end: float) -> tuple[float, float]:
    """Give the range of an arc that goes counter-clockwise from start to end, rad."""
    end = end if end > start else end + 2 * np.pi
    if not end - start < 2 * np.pi * (1 + 1e-9):
        message = f"an arc over {np.degrees(end - start):g} degrees"
        raise ValueError(message)
    return float(start), float(end)


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


TRACERS: dict[str, Callable[[Any], list[Shape]]] = {
    "LINE": _line,
    "CIRCLE": _circle,
    "ARC": _arc,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
}
"""Entity type to the function that traces it, in the direction it is drawn."""
