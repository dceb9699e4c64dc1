"""From two curves to the surface: orientation, division, frame, product (geometry §0–§5)."""

from dataclasses import dataclass

import numpy as np
import shapely

from isomould.arrays import Bools, Floats
from isomould.curves.curve import PlanarCurve
from isomould.curves.plane import Plane
from isomould.errors import Note, Refused
from isomould.form.division import Request, divide_curve
from isomould.form.edge_offset import divide_for_edge_offset
from isomould.form.lattice import KoebeLattice
from isomould.form.polygon import FLAT, CurvePolygon
from isomould.form.profile import make_profile
from isomould.form.rail import Ends, planar_rail
from isomould.form.settings import GeneratrixDivide, SurfaceSettings
from isomould.form.surface import Surface, make_surface, refuse_flips
from isomould.form.survey import division_notes


@dataclass(frozen=True, eq=False)
class Form:
    """The surface and the two polygons that it is made of, with what should be known about them."""

    surface: Surface
    rail: CurvePolygon
    generatrix: CurvePolygon
    notes: tuple[Note, ...]


def make_form(
    rail_curve: PlanarCurve,
    generatrix_curve: PlanarCurve,
    plane: Plane,
    ends: Ends | None,
    requests: tuple[Request, Request],
    settings: SurfaceSettings,
    depth: float,
) -> Form:
    """Divide both curves and multiply them out.

    Parameters
    ----------
    rail_curve, generatrix_curve
        Oriented curves, their outsides to the right.
    plane
        Plane of the rail.
    ends
        Treatment of open rail ends; None for the kind's default.
    requests
        How rail and generatrix are divided.
    settings
        The `[surface]` table.
    depth
        Depth of the members in mm: both their layers must keep every edge's direction.

    Raises
    ------
    Refused
        If the design asks for what the surface cannot have.
    """
    rail_request, generatrix_request = requests
    rail = divide_curve(rail_curve, rail_request)
    _hold_to_one_angle(rail, settings)
    generatrix, lattice = _divide_generatrix(generatrix_curve, rail, generatrix_request, settings)
    _refuse_size(rail, generatrix, rail_request)
    for polygon, request in ((rail, rail_request), (generatrix, generatrix_request)):
        _refuse_deviation(polygon, request)
    edge_offset = settings.kind == "edge-offset"
    frame = planar_rail(rail, plane, ends or ("mitred" if edge_offset else "square"))
    surface = make_surface(frame, make_profile(generatrix, lattice))
    refuse_flips(surface, depth, rail_request.limits.min_member)
    _refuse_crossings(rail, generatrix, surface)
    notes = (*_turning_notes(rail), *_flat_notes(rail, edge_offset), *division_notes(rail, rail_request))
    return Form(surface, rail, generatrix, (*notes, *division_notes(generatrix, generatrix_request)))


def _divide_generatrix(
    curve: PlanarCurve, rail: CurvePolygon, request: Request, settings: SurfaceSettings
) -> tuple[CurvePolygon, KoebeLattice | None]:
    divide = request.divide
    if settings.kind != "edge-offset" or not isinstance(divide, GeneratrixDivide):
        return divide_curve(curve, request), None
    limit = float(np.radians(settings.min_pole_angle_deg))
    return divide_for_edge_offset(curve, rail.angle or 0.0, divide.phase or "centre", limit, request)


def _hold_to_one_angle(rail: CurvePolygon, settings: SurfaceSettings) -> None:
    if settings.kind != "edge-offset" or rail.angle is not None:
        return
    raise Refused(
        "E-RAIL-ANGLES",
        "rail.divide",
        "nodes that turn by different angles",
        f"one turning angle |α| at all nodes for surface.kind = '{settings.kind}'",
        "Divide the rail by nodes or angle_deg, or use surface.kind = 'moulding'.",
    )


def _refuse_size(rail: CurvePolygon, generatrix: CurvePolygon, request: Request) -> None:
    """Forecast the panels before anything large is made (failure mode J1)."""
    count = len(rail.edges.index) * len(generatrix.edges.index)
    if count > request.limits.max_panels:
        raise Refused(
            "E-SIZE",
            "limits.max_panels",
            f"{count} panels",
            f"{request.limits.max_panels}",
            "Divide the curves more coarsely, or raise the limit (about 2 kB of memory a panel).",
        )


def _refuse_deviation(polygon: CurvePolygon, request: Request) -> None:
    limit = request.limits.max_deviation
    if limit is not None and polygon.deviation > limit:
        raise Refused(
            "E-DEVIATION",
            f"{request.field}.divide",
            f"the polygon lies up to {polygon.deviation:.3f} mm off the curve",
            f"tolerances.max_deviation = {limit:g} mm",
            "Divide the curve into more nodes, or raise the limit.",
        )


def _refuse_crossings(rail: CurvePolygon, generatrix: CurvePolygon, surface: Surface) -> None:
    """Refuse rails, profiles and parallels that cross themselves (failure modes B6, C5)."""
    for polygon, field in ((rail, "rail"), (generatrix, "generatrix")):
        if not _is_simple(polygon.vertices[None], polygon.closed).all():
            raise Refused(
                "E-CURVE-CROSSING",
                f"{field}.curve",
                "a polygon that crosses itself",
                "none",
                "Redraw the curve.",
            )
    frame = surface.rail
    axes = np.stack([frame.directions[0], frame.outward[0]])
    mitre, base = frame.A @ axes.T, frame.R @ axes.T
    parallels = base + np.multiply.outer(surface.profile.d, mitre)
    simple = _is_simple(parallels, rail.closed)
    if not simple.all():
        raise Refused(
            "E-SURFACE-CROSSING",
            "generatrix.origin",
            f"parallel {int(np.argmin(simple))} crosses itself: the surface passes through itself",
            "parallels without crossings",
            "Move the generatrix towards the outside, or widen the rail.",
        )


def _is_simple(lines: Floats, closed: bool) -> Bools:
    """Whether polylines (k, n, 2) are free of crossings."""
    rings = np.concatenate([lines, lines[:, :1]], axis=1) if closed else lines
    return np.atleast_1d(shapely.is_simple(shapely.linestrings(rings)))


def _turning_notes(rail: CurvePolygon) -> tuple[Note, ...]:
    steepest = float(np.degrees(np.nanmax(np.abs(rail.turning))))
    if steepest <= 30.0:
        return ()
    return (Note("W-RAIL-COARSE", "rail.divide", f"the rail turns by {steepest:.2f}° at a node, more than 30°"),)


def _flat_notes(rail: CurvePolygon, edge_offset: bool) -> tuple[Note, ...]:
    flat = int(np.count_nonzero(np.abs(np.nan_to_num(rail.turning, nan=1.0)) <= FLAT))
    if not (edge_offset and flat):
        return ()
    text = f"{flat} flat rail nodes: their beams do not meet exactly (see the mismatch of the nodes)"
    return (Note("W-RAIL-FLAT", "rail.flat_nodes", text),)
