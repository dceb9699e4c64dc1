"""How large a mesh will be at least, told from turning angles before any curve is divided (failure mode J1)."""

import numpy as np

from isomould.curves.curve import PlanarCurve
from isomould.curves.space_curve import SpatialCurve
from isomould.curves.turning import arcs
from isomould.form.division import Request, smooth_spans
from isomould.form.size_limit import refuse_size

Curve = PlanarCurve | SpatialCurve


def refuse_expected_size(rail: Curve, generatrix: Curve, requests: tuple[Request, Request]) -> None:
    """Refuse divisions that give more panels than the project allows, before anything is made of them.

    Raises
    ------
    Refused
        E-SIZE, with the least number of panels that both divisions give.
    """
    rail_edges = least_edges(rail, requests[0])
    generatrix_edges = least_edges(generatrix, requests[1])
    if requests[1].divide.phase is not None:  # pyright: ignore[reportAttributeAccessIssue]
        generatrix_edges = _least_slopes(rail, generatrix, rail_edges)
    refuse_size(rail_edges * generatrix_edges, requests[0].limits, "at least")


def least_edges(curve: Curve, request: Request) -> float:
    """Give how many edges a division gives at least; 1 where it does not say before it is made."""
    divide = request.divide
    if divide.stations is not None:
        return divide.stations if isinstance(divide.stations, int) else len(divide.stations) + 1
    angles = [part.angle_deg for part in divide.angles or ()]
    angle = divide.angle_deg or max(angles, default=None)
    if angle is not None and isinstance(curve, PlanarCurve):
        return max(1.0, np.floor(_turning(curve, request.field) / np.radians(angle)))
    return divide.nodes or getattr(divide, "per_arc", None) or 1


def _least_slopes(rail: Curve, generatrix: Curve, rail_edges: float) -> float:
    """Give how many edges the slopes of an edge offset mesh make at least: half as many as turns of the rail's angle.

    Their steps are as wide as the rail's angle where the generatrix runs level, and narrower elsewhere.
    """
    if not isinstance(rail, PlanarCurve) or not isinstance(generatrix, PlanarCurve):
        return 1.0
    angle = _turning(rail, "rail") / max(rail_edges, 1.0)
    return max(1.0, _turning(generatrix, "generatrix") / angle / 2) if angle > 0 else 1.0


def _turning(curve: PlanarCurve, field: str) -> float:
    """Give the angle, rad, by which a curve turns in all, to either side."""
    return float(np.abs(arcs(smooth_spans(curve, field)).turning).sum())
