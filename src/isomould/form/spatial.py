"""The polygon of a rail in space: stations on a curve joined by chords, or a polyline as drawn (geometry §3).

Tangents of a curve in space do not meet, so there is no tangent polygon.
"""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints, read_only
from isomould.curves.pieces import Line
from isomould.curves.space_curve import SpatialCurve
from isomould.errors import Refused
from isomould.form.chords import corners, stations
from isomould.form.division import Request
from isomould.form.long_edges import equal_parts, pieces

_SHORT = 1e-6
"""Edges shorter than this (mm), or unit edges whose sum is shorter, have no bisecting plane."""


@dataclass(frozen=True, eq=False)
class SpatialPolygon:
    """A divided rail in space, counted like a `CurvePolygon`.

    Attributes
    ----------
    vertices : (n, 3) float, mm
    piece, parameter : (m,) int, (m,) float
        Where on the curve the edges start.
    closed : bool
    deviation : float, mm
        Largest sagitta of the chords.
    """

    vertices: Floats
    piece: Ints
    parameter: Floats
    closed: bool
    deviation: float

    def __post_init__(self) -> None:
        for array in (self.vertices, self.piece, self.parameter):
            read_only(array)

    @property
    def steps(self) -> Floats:
        """The edges (m, 3) mm as vectors."""
        return np.roll(self.vertices, -1, axis=0)[: len(self.piece)] - self.vertices[: len(self.piece)]

    @property
    def lengths(self) -> Floats:
        """Lengths (m,) mm of the edges."""
        return np.linalg.norm(self.steps, axis=1)

    @property
    def directions(self) -> Floats:
        """Unit directions (m, 3) of the edges."""
        return self.steps / self.lengths[:, None]

    @property
    def turning(self) -> Floats:
        """Angles (n,) rad from edge to edge, never negative; NaN at open ends."""
        along = self.directions
        sine = np.linalg.norm(np.cross(np.roll(along, 1, axis=0), along), axis=1)
        turning = np.arctan2(sine, np.einsum("ij,ij->i", np.roll(along, 1, axis=0), along))
        return turning if self.closed else np.concatenate([[np.nan], turning[1:], [np.nan]])


def divide_in_space(curve: SpatialCurve, request: Request) -> SpatialPolygon:
    """Divide a rail in space by stations, or take a polyline as drawn.

    Raises
    ------
    Refused
        E-CURVE-DIVIDE and -STATION as in the plane; E-RAIL-BACK for edges without length or that run back on the
        edge before (failure mode B13).
    """
    field, asked = request.field, request.divide.stations
    straight = all(isinstance(piece.plan, Line) for piece in curve.pieces)
    found = corners(curve, straight, field) if asked is None else stations(curve, asked, field)
    count = len(found.vertices) - (not curve.closed)
    polygon = SpatialPolygon(
        found.vertices, found.piece[:count].copy(), found.parameter[:count].copy(), curve.closed, found.sagitta
    )
    _refuse_short(polygon, field)
    _refuse_back(polygon, field)
    return _divide_long_chords(polygon, request)


def _divide_long_chords(polygon: SpatialPolygon, request: Request) -> SpatialPolygon:
    """Divide chords longer than `max_edge` equally by flat nodes: the frame passes them unchanged."""
    limit = request.treatment.max_edge
    if limit is None:
        return polygon
    parts = equal_parts(polygon.lengths, limit, request.limits)
    row, share = pieces(parts)
    vertices = polygon.vertices[row] + (share / parts[row])[:, None] * polygon.steps[row]
    ends = polygon.vertices[len(polygon.piece) :]
    divided = np.vstack([vertices, ends])
    piece, parameter = polygon.piece[row], polygon.parameter[row]
    return SpatialPolygon(divided, piece, parameter, polygon.closed, polygon.deviation)


def _refuse_short(polygon: SpatialPolygon, field: str) -> None:
    row = int(np.argmin(polygon.lengths))
    if polygon.lengths[row] <= _SHORT:
        _refuse(field, f"edge {row} is {polygon.lengths[row]:.3g} mm long", f"more than {_SHORT:g} mm")


def _refuse_back(polygon: SpatialPolygon, field: str) -> None:
    along = polygon.directions
    bisector = np.linalg.norm(np.roll(along, 1, axis=0) + along, axis=1)
    bisector[0] = bisector[0] if polygon.closed else 2.0
    vertex = int(np.argmin(bisector))
    if bisector[vertex] < _SHORT:
        x, y, z = polygon.vertices[vertex]
        found = f"the edge after vertex {vertex} at ({x:.3f}, {y:.3f}, {z:.3f}) mm runs back on the edge before it"
        _refuse(field, found, "edges with a bisecting plane between them")


def _refuse(field: str, found: str, limit: str) -> None:
    raise Refused("E-RAIL-BACK", f"{field}.curve", found, limit, "Redraw the rail there, or give more stations.")
