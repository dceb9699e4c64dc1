"""Which side is outside: declared, never guessed from the drawing direction (geometry §0)."""

from typing import Literal

import numpy as np

from isomould.arrays import Floats
from isomould.curves.curve import PlanarCurve, ends
from isomould.errors import Refused
from isomould.form.polygon import cross

_CLEAR = 1e-6
"""Share of the chord below which a curve does not tell its sides apart."""


def orient_rail(
    curve: PlanarCurve, outside: Literal["outer", "inner"] | tuple[float, float], field: str = "rail"
) -> PlanarCurve:
    """Reverse a rail if need be, so that its outside lies to the right.

    Parameters
    ----------
    outside
        "outer" or "inner" for a closed rail, a direction in its plane for an open one.
    """
    if curve.closed != isinstance(outside, str):
        raise Refused(
            "E-RAIL-OUTSIDE",
            f"{field}.outside",
            f"{_spelt(outside)}, and the rail is {'closed' if curve.closed else 'open'}",
            "'outer' or 'inner' for a closed rail, a direction [x, y] in its plane for an open one",
            f"Set {field}.outside = 'outer', or 'inner' if the building's outside is enclosed by the rail."
            if curve.closed
            else f"Set {field}.outside to a direction that points to the outside, such as [0, 1].",
        )
    if isinstance(outside, str):
        forwards = signed_area(curve) > 0
        return curve if forwards == (outside == "outer") else curve.reversed()
    return orient_open(curve, outside, field)


def _spelt(outside: str | tuple[float, float]) -> str:
    return f"'{outside}'" if isinstance(outside, str) else f"the direction [{outside[0]:g}, {outside[1]:g}]"


def orient_open(curve: PlanarCurve, outside: tuple[float, float], field: str) -> PlanarCurve:
    """Reverse an open curve if need be, so that the direction `outside` lies to its right."""
    starts, finishes = ends(curve)
    chord = finishes[-1] - starts[0]
    reach = float(np.hypot(*chord)) * float(np.hypot(*outside))
    side = float(cross(np.array(outside), chord))
    if abs(side) <= _CLEAR * reach or reach == 0:
        raise Refused(
            "E-CURVE-OUTSIDE",
            f"{field}.outside",
            f"[{outside[0]:g}, {outside[1]:g}] runs along the line from the curve's start to its end",
            "a direction to one side of that line",
            f"Give {field}.outside another direction.",
        )
    return curve if side > 0 else curve.reversed()


def place_generatrix(
    curve: PlanarCurve, origin: tuple[float, float], axes: Literal["dz", "zd"], outside: tuple[float, float]
) -> PlanarCurve:
    """Bring a drawn generatrix into coordinates (d, z), its own origin at `origin`, its outside to the right.

    A closed profile runs counter-clockwise.
    """
    turn = np.eye(2) if axes == "dz" else np.eye(2)[::-1]
    placed = curve.mapped(turn, np.array(origin))
    if placed.closed:
        return placed if signed_area(placed) > 0 else placed.reversed()
    return orient_open(placed, outside, "generatrix")


def signed_area(curve: PlanarCurve) -> float:
    """Area (mm²) inside a closed curve, positive counter-clockwise; sampled, for its sign only."""
    piece = np.repeat(np.arange(len(curve.pieces)), 64)
    parameter = np.tile(np.arange(64) / 64, len(curve.pieces))
    points = curve.point(piece, parameter)
    return _shoelace(points - points[0])


def _shoelace(points: Floats) -> float:
    return float(cross(points, np.roll(points, -1, axis=0)).sum()) / 2
