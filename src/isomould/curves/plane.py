"""The plane that a curve lies in."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, read_only
from isomould.curves.plane_settings import PlaneSettings, PlaneTable
from isomould.errors import Refused

SQUARE = 1e-9
"""Largest cosine between axes that were meant to be perpendicular."""

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


@dataclass(frozen=True, eq=False)
class Plane:
    """A plane with perpendicular unit axes; its normal is x_axis × y_axis (geometry §0)."""

    origin: Floats
    """(3,) mm."""
    x_axis: Floats
    """(3,) unit vector."""
    y_axis: Floats
    """(3,) unit vector."""


def build_plane(settings: PlaneSettings, field: str = "plane") -> Plane:
    """Give the plane of a project's `plane` entry.

    Raises
    ------
    Refused
        E-PLANE-AXES if an axis is zero or the axes are not perpendicular within 1e-9.

    Examples
    --------
    >>> build_plane("xz").y_axis
    array([0., 0., 1.])
    """
    if not isinstance(settings, PlaneTable):
        return _plane(np.zeros(3), np.array(_AXES[settings[0]]), np.array(_AXES[settings[1]]))
    x, y = (_unit(axis, f"{field}.{name}") for name, axis in _axes_of(settings))
    _refuse_oblique(float(x @ y), field)
    square = y - (x @ y) * x
    return _plane(np.array(settings.origin), x, square / np.linalg.norm(square))


def project(plane: Plane, points: Floats) -> tuple[Floats, Floats]:
    """Give the coordinates (n, 2) in the plane of points (n, 3), mm, and their distances (n,) from it."""
    away = points - plane.origin
    normal = np.cross(plane.x_axis, plane.y_axis)
    return away @ np.column_stack([plane.x_axis, plane.y_axis]), np.abs(away @ normal)


def _plane(origin: Floats, x: Floats, y: Floats) -> Plane:
    return Plane(read_only(origin), read_only(x), read_only(y))


def _axes_of(table: PlaneTable) -> tuple[tuple[str, Floats], tuple[str, Floats]]:
    return ("x_axis", np.array(table.x_axis)), ("y_axis", np.array(table.y_axis))


def _unit(axis: Floats, field: str) -> Floats:
    size = float(np.linalg.norm(axis))
    if not 0 < size < np.inf:
        raise Refused(
            code="E-PLANE-AXES",
            field=field,
            found=f"a direction of length {size:g}",
            limit="more than 0",
            way_out="Give a direction such as [1, 0, 0].",
        )
    return axis / size


def _refuse_oblique(cosine: float, field: str) -> None:
    if abs(cosine) > SQUARE:
        raise Refused(
            code="E-PLANE-AXES",
            field=field,
            found=f"axes at {np.degrees(np.arccos(np.clip(cosine, -1, 1))):.9g} degrees",
            limit=f"perpendicular, cosine within {SQUARE:g}",
            way_out="Give perpendicular axes with enough decimals.",
        )
