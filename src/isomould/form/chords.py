"""Polygons with their vertices on the curve: stations, and polylines taken as drawn (paper §3.3)."""

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.curves.curve import PlanarCurve
from isomould.curves.lengths import length, parameter_at
from isomould.curves.pieces import Line
from isomould.errors import Refused
from isomould.form.polygon import CurvePolygon, Edges, Role


def station_polygon(curve: PlanarCurve, asked: int | tuple[float, ...], field: str) -> CurvePolygon:
    """Divide a curve by chords: into equal lengths along it, or at given inner stations (mm from its start).

    The deviation is the largest sagitta.
    """
    total = length(curve)
    places = np.linspace(0.0, total, asked + 1) if isinstance(asked, int) else _inner(asked, total, field)
    piece, parameter = parameter_at(curve, places[:-1] if curve.closed else places)
    vertices = curve.point(piece, parameter)
    middles = curve.point(*parameter_at(curve, (places[:-1] + places[1:]) / 2))
    return _chord_polygon(curve, vertices, piece, parameter, _sagitta(vertices, middles, curve.closed))


def drawn_polygon(curve: PlanarCurve, field: str) -> CurvePolygon:
    """Take the vertices of a polyline as they are drawn."""
    if not all(isinstance(piece, Line) for piece in curve.pieces):
        raise Refused(
            "E-CURVE-DIVIDE",
            f"{field}.divide",
            "no division of a curve that is not a polyline",
            "one of nodes, angle_deg, stations",
            f"Say how {field} is to be divided.",
        )
    count = len(curve.pieces)
    piece, parameter = np.arange(count), np.zeros(count)
    if not curve.closed:
        piece, parameter = np.append(piece, count - 1), np.append(parameter, 1.0)
    return _chord_polygon(curve, curve.point(piece, parameter), piece, parameter, 0.0)


def _inner(asked: tuple[float, ...], total: float, field: str) -> Floats:
    places = np.concatenate([[0.0], asked, [total]])
    if np.any(np.diff(places) <= 0):
        raise Refused(
            "E-CURVE-STATION",
            f"{field}.divide.stations",
            f"{', '.join(f'{place:g}' for place in asked)} mm",
            f"increasing stations between 0 and the curve's length of {total:.3f} mm",
            "Sort the stations and keep them on the curve.",
        )
    return places


def _chord_polygon(
    curve: PlanarCurve, vertices: Floats, piece: Ints, parameter: Floats, deviation: float
) -> CurvePolygon:
    ahead = np.roll(vertices, -1, axis=0) if curve.closed else vertices[1:]
    count = len(ahead)
    step = ahead - vertices[:count]
    direction = np.unwrap(np.arctan2(step[:, 1], step[:, 0]))
    edges = Edges(
        np.arange(count, dtype=np.float64), direction, vertices[:count].copy(), piece[:count].copy(),
        parameter[:count].copy(), (Role.CHORD,) * count,
    )  # fmt: skip
    return CurvePolygon(vertices, edges, _turning(direction, curve.closed), curve.closed, deviation)


def _turning(direction: Floats, closed: bool) -> Floats:
    if not closed:
        return np.concatenate([[np.nan], np.diff(direction), [np.nan]])
    first = direction[0] - direction[-1]
    return np.concatenate([[first - 2 * np.pi * np.rint(first / (2 * np.pi))], np.diff(direction)])


def _sagitta(vertices: Floats, middles: Floats, closed: bool) -> float:
    ahead = np.roll(vertices, -1, axis=0) if closed else vertices[1:]
    chord = ahead - vertices[: len(ahead)]
    away = middles - vertices[: len(ahead)]
    twice_area = chord[:, 0] * away[:, 1] - chord[:, 1] * away[:, 0]
    return float(np.max(np.abs(twice_area) / np.linalg.norm(chord, axis=1)))
