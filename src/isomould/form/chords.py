"""Polygons with their vertices on the curve: stations, and polylines taken as drawn (paper §3.3)."""

from typing import NamedTuple

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.curves.curve import Curve, PlanarCurve
from isomould.curves.lengths import length, parameter_at
from isomould.curves.pieces import Line
from isomould.errors import Refused
from isomould.form.polygon import CurvePolygon, Edges, Role

_BETWEEN = np.arange(1, 8) / 8
"""Where along each arc, as shares of its length, its distance from the chord is measured."""


class Chords(NamedTuple):
    """Vertices (n, 2 or 3) mm on a curve, the places (n,), (n,) where they lie, and the largest sagitta, mm."""

    vertices: Floats
    piece: Ints
    parameter: Floats
    sagitta: float


def station_polygon(curve: PlanarCurve, asked: int | tuple[float, ...], field: str) -> CurvePolygon:
    """Divide a curve by chords: into equal lengths along it, or at given inner stations (mm from its start).

    The deviation is the largest sagitta.
    """
    return _chord_polygon(stations(curve, asked, field), curve.closed)


def drawn_polygon(curve: PlanarCurve, field: str) -> CurvePolygon:
    """Take the vertices of a polyline as they are drawn."""
    straight = all(isinstance(piece, Line) for piece in curve.pieces)
    return _chord_polygon(corners(curve, straight, field), curve.closed)


def stations(curve: Curve, asked: int | tuple[float, ...], field: str) -> Chords:
    """Find the stations of `station_polygon` on a curve in the plane or in space."""
    total = length(curve)
    places = np.linspace(0.0, total, asked + 1) if isinstance(asked, int) else _inner(asked, total, field)
    piece, parameter = parameter_at(curve, places[:-1] if curve.closed else places)
    vertices = curve.point(piece, parameter)
    between = places[:-1] + np.multiply.outer(_BETWEEN, np.diff(places))
    arcs = curve.point(*parameter_at(curve, between.ravel())).reshape(*between.shape, -1)
    return Chords(vertices, piece, parameter, _sagitta(vertices, arcs, curve.closed))


def corners(curve: Curve, straight: bool, field: str) -> Chords:
    """Find the vertices of a polyline in the plane or in space; other curves (not `straight`) are refused."""
    if not straight:
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
    return Chords(curve.point(piece, parameter), piece, parameter, 0.0)


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


def _chord_polygon(chords: Chords, closed: bool) -> CurvePolygon:
    vertices, piece, parameter, deviation = chords
    ahead = np.roll(vertices, -1, axis=0) if closed else vertices[1:]
    count = len(ahead)
    step = ahead - vertices[:count]
    direction = np.unwrap(np.arctan2(step[:, 1], step[:, 0]))
    edges = Edges(
        np.arange(count, dtype=np.float64), direction, vertices[:count].copy(), piece[:count].copy(),
        parameter[:count].copy(), (Role.CHORD,) * count,
    )  # fmt: skip
    return CurvePolygon(vertices, edges, _turning(direction, closed), closed, deviation)


def _turning(direction: Floats, closed: bool) -> Floats:
    if not closed:
        return np.concatenate([[np.nan], np.diff(direction), [np.nan]])
    first = direction[0] - direction[-1]
    return np.concatenate([[first - 2 * np.pi * np.rint(first / (2 * np.pi))], np.diff(direction)])


def _sagitta(vertices: Floats, arcs: Floats, closed: bool) -> float:
    """Largest distance of points (k, e, 2 or 3) on the arcs from the chords (e,) under them."""
    ahead = np.roll(vertices, -1, axis=0) if closed else vertices[1:]
    chord = ahead - vertices[: len(ahead)]
    away = arcs - vertices[: len(ahead)]
    share = np.sum(away * chord, axis=-1) / np.maximum(np.sum(chord * chord, axis=-1), np.finfo(np.float64).tiny)
    return float(np.linalg.norm(away - share[..., None] * chord, axis=-1).max())
