"""`model/design.json`: what was asked for, the two polygons and the limits."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from isomould.verify.read.text import Json, read_json, refusing
from isomould.verify.rules import Bools, Floats


@dataclass(frozen=True, eq=False)
class Line:
    """A rail or generatrix: input curve and the polygon made of it.

    `vertices` (n, 2 or 3) mm; `directions` (edges,) rad; `turning` (n,) rad, NaN at open ends; `contacts`
    of the edges are (piece, t) or None. Turning is NaN beside an edge of the role "gap" too.
    """

    closed: bool
    curve: tuple[Json, ...]
    vertices: Floats
    directions: Floats
    turning: Floats
    declared: float | None
    roles: tuple[str, ...]
    contacts: tuple[tuple[int, float] | None, ...]

    @property
    def gap(self) -> Bools:
        """True (edges,) where the line is open: between strips that no member or panel joins."""
        return np.array([role == "gap" for role in self.roles])

    @property
    def inner(self) -> Bools:
        """True (n,) at vertices with an edge on both sides."""
        none = self.gap
        return ~(none | np.roll(none, 1)) if self.closed else ~(np.append(True, none) | np.append(none, True))


@dataclass(frozen=True, eq=False)
class Design:
    """The file, with its two lines and the rail's plane (origin, x axis, y axis: (3, 3), or None) parsed."""

    kind: str
    offset: str
    rail: Line
    generatrix: Line
    plane: Floats | None
    raw: Json


@refusing
def read_design(path: Path) -> Design:
    """Read the design; a field that is missing or not finite makes it unreadable."""
    raw = read_json(path)
    return Design(raw["kind"], raw["offset"], _line(raw["rail"]), _line(raw["generatrix"]), _plane(raw["plane"]), raw)


def _line(raw: Json) -> Line:
    edges: list[Json] = raw["edges"]
    vertices, turning = np.array(raw["vertices"], dtype=np.float64), _with_gaps(raw["turning"])
    directions = np.array(raw["directions"] or [], dtype=np.float64)
    count = len(vertices) if raw["closed"] else len(vertices) - 1
    if not (len(edges) == count and len(turning) == len(vertices) and np.isfinite(vertices).all()):
        message = f"{len(vertices)} vertices, {len(turning)} turnings and {len(edges)} edges do not make a polygon"
        raise ValueError(message)
    contacts = tuple(_contact(edge["contact"]) for edge in edges)
    roles = tuple(str(edge["role"]) for edge in edges)
    return Line(raw["closed"], tuple(raw["curve"]), vertices, directions, turning, raw["declared"], roles, contacts)


def _contact(raw: Any) -> tuple[int, float] | None:
    return None if raw is None else (int(raw[0]), float(raw[1]))


def _with_gaps(values: list[float | None]) -> Floats:
    return np.array([np.nan if value is None else value for value in values], dtype=np.float64)


def _plane(raw: Json | None) -> Floats | None:
    return None if raw is None else np.array([raw["origin"], raw["x_axis"], raw["y_axis"]], dtype=np.float64)


def edge_vectors(line: Line) -> Floats:
    """Give the polygon's edges as vectors, (edges, 2 or 3) mm; a closed polygon has one that closes it."""
    following = np.roll(line.vertices, -1, axis=0)
    return (following - line.vertices)[: len(line.roles)]
