"""The points of a curve's table: two coordinates each or, for a rail in space, three."""

from collections.abc import Sequence
from typing import Annotated

from pydantic import AfterValidator

from isomould.errors import Refused
from isomould.units import Number


def _two_or_three(values: tuple[float, ...]) -> tuple[float, ...]:
    if len(values) not in (2, 3):
        message = f"a point with {len(values)} coordinates; [x, y], or [x, y, z] for a rail in space"
        raise ValueError(message)
    return values


def _all_alike(points: tuple[tuple[float, ...], ...]) -> tuple[tuple[float, ...], ...]:
    if len({len(point) for point in points}) > 1:
        message = "some points have two coordinates, others three; all in one way"
        raise ValueError(message)
    return points


Point = Annotated[tuple[Number, ...], AfterValidator(_two_or_three)]
Points = Annotated[tuple[Point, ...], AfterValidator(_all_alike)]
"""Points in the units of their table, all in a plane or all in space."""


def are_spatial(points: Sequence[Sequence[float]]) -> bool:
    """Tell whether points have three coordinates."""
    return len(points) > 0 and len(points[0]) == 3


def refuse_spatial(points: Sequence[Sequence[float]], field: str) -> None:
    """Refuse points in space for a curve that lies in a plane."""
    if are_spatial(points):
        raise Refused(
            code="E-CURVE-SPATIAL",
            field=f"{field}.points",
            found="points with three coordinates",
            limit="[x, y] in the curve's plane",
            way_out="Draw it in its plane; only the rail of surface.kind = 'monge' may lie in space.",
        )
