"""The polygon that replaces a rail or generatrix: straight edges, each with a direction and a contact.

Vertex k joins edge k−1 to edge k (counted modulo n on a closed curve). Directions come from the lattice
and not from the vertices, so that node angles are exact whatever the size of the curve.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from isomould.arrays import Bools, Floats, Ints, read_only


class Role(StrEnum):
    """How an edge meets its curve."""

    TANGENT = "tangent"
    INFLECTION = "inflection"
    STRAIGHT = "straight"
    CHORD = "chord"
    END = "end"
    """Through an end of the curve that stays where it was drawn."""
    GAP = "gap"
    """No edge at all: between the strips on the two sides of a pole."""


@dataclass(frozen=True, eq=False)
class Edges:
    """Lines that become the edges of a polygon, in order.

    Attributes
    ----------
    index : (m,) float
        Number of the direction in its lattice.
    direction : (m,) float, rad
        Unwrapped tangent direction.
    contact : (m, 2) float, mm
        A point of the curve on the line.
    piece, parameter : (m,) int, (m,) float
        Where on the curve the contact lies.
    role : tuple of Role
    """

    index: Floats
    direction: Floats
    contact: Floats
    piece: Ints
    parameter: Floats
    role: tuple[Role, ...]

    def __post_init__(self) -> None:
        for array in (self.index, self.direction, self.contact, self.piece, self.parameter):
            read_only(array)

    def take(self, rows: Ints) -> "Edges":
        """Give the edges with the numbers `rows`, in that order."""
        return Edges(
            self.index[rows],
            self.direction[rows],
            self.contact[rows],
            self.piece[rows],
            self.parameter[rows],
            tuple(self.role[row] for row in rows),
        )


@dataclass(frozen=True, eq=False)
class CurvePolygon:
    """A divided curve.

    Attributes
    ----------
    vertices : (n, 2) float, mm
        n = m + 1 on an open polygon, n = m on a closed one.
    edges : Edges
        The m edges.
    turning : (n,) float, rad
        Signed turning at each vertex, positive to the left; 0 at flat nodes, NaN at open ends and beside gaps.
    closed : bool
    deviation : float, mm
        Largest distance of a vertex from the curve.
    """

    vertices: Floats
    edges: Edges
    turning: Floats
    closed: bool
    deviation: float

    def __post_init__(self) -> None:
        read_only(self.vertices)
        read_only(self.turning)

    @property
    def lengths(self) -> Floats:
        """Signed lengths (m,) mm of the edges along their directions; negative where an edge runs backwards."""
        ahead = np.roll(self.vertices, -1, axis=0) if self.closed else self.vertices[1:]
        steps = ahead - self.vertices[: len(ahead)]
        return np.einsum("ij,ij->i", steps, unit(self.edges.direction))

    @property
    def gap(self) -> Bools:
        """True (m,) where an edge is a gap."""
        return np.array([role is Role.GAP for role in self.edges.role])

    @property
    def angle(self) -> float | None:
        """The turning angle |α| (rad) that all vertices share, flat ones and ends apart; None if they differ."""
        turns = np.abs(self.turning[np.isfinite(self.turning) & (np.abs(self.turning) > FLAT)])
        if len(turns) == 0 or np.ptp(turns) > 1e-9:
            return None
        return float(np.median(turns))


FLAT = 1e-9
"""Turning (rad) below which a vertex counts as flat, and a kink as none (failure mode B1)."""


def unit(direction: Floats) -> Floats:
    """Unit vectors (n, 2) of directions (n,) rad."""
    return np.stack([np.cos(direction), np.sin(direction)], axis=-1)


def cross(a: Floats, b: Floats) -> Floats:
    """Signed areas (n,) of the parallelograms of a (n, 2) and b (n, 2)."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def joints(edges: Edges) -> Floats:
    """Intersections (m − 1, 2) mm of consecutive lines; the shared contact where a flat node splits an edge."""
    here, ahead = unit(edges.direction[:-1]), unit(edges.direction[1:])
    sine = cross(here, ahead)
    flat = np.abs(np.diff(edges.direction)) <= FLAT
    reach = cross(edges.contact[1:] - edges.contact[:-1], ahead) / np.where(flat, 1.0, sine)
    return edges.contact[:-1] + np.where(flat, 0.0, reach)[:, None] * here


def foot(edges: Edges, row: int, point: Floats) -> Floats:
    """Foot (2,) mm of the perpendicular from a point (2,) onto the line of edge `row`."""
    along = unit(edges.direction[[row]])[0]
    return edges.contact[row] + np.dot(point - edges.contact[row], along) * along
