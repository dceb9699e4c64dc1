"""The slopes of edge offset meshes on a generatrix (paper §3.6, §4.3, geometry §5)."""

from dataclasses import replace

import numpy as np

from isomould.curves.curve import PlanarCurve
from isomould.curves.turning import Spans, arcs
from isomould.errors import Refused
from isomould.form.arc_lattices import shared_lattices
from isomould.form.closing import open_polygon, split_straights
from isomould.form.division import Request, refuse_straight, smooth_spans
from isomould.form.lattice import KoebeLattice, koebe_lattice
from isomould.form.polygon import CurvePolygon
from isomould.form.settings import SlopePhase
from isomould.form.tangents import split_at_inflections, tangent_edges


def divide_for_edge_offset(
    curve: PlanarCurve, turning: float, phase: str | SlopePhase, min_pole_angle: float, request: Request
) -> tuple[CurvePolygon, KoebeLattice]:
    """Divide an open generatrix into the slopes of an edge offset mesh (paper §4.3, geometry §5).

    Parameters
    ----------
    curve
        Generatrix in coordinates (d, z), its outside to the right.
    turning
        The rail's constant |α|, rad.
    phase
        "centre", "node", or the normal latitude of one edge.
    min_pole_angle
        How near (rad) an edge's normal may come to the rail's axis.
    request
        For the limits and field names.
    """
    _refuse_way(request)
    turns = _upright(smooth_spans(curve, request.field))
    refuse_straight(arcs(turns), request.field)
    lattice = koebe_lattice(turning, np.radians(phase.slope_deg) if isinstance(phase, SlopePhase) else phase)
    _refuse_pole(turns, lattice, min_pole_angle, request.field)
    edges = tangent_edges(curve, turns, shared_lattices(turns, lattice), request.field)
    edges = split_at_inflections(edges) if request.treatment.flat_nodes else edges
    polygon = open_polygon(curve, edges, request.limits.min_member, request.field)
    return split_straights(curve, polygon, request.treatment.max_edge), lattice


def _refuse_way(request: Request) -> None:
    """Refuse ways that leave the lattice: all slopes of an edge offset mesh are given."""
    way = request.treatment.inflections
    if way in ("residual", "fit"):
        raise Refused(
            "E-GENERATRIX-WAY",
            f"{request.field}.inflections",
            f"'{way}' for an edge offset mesh, whose slopes are given",
            "'nearest'",
            "Set inflections = 'nearest', or surface.kind = 'isogonal'.",
        )


def _upright(turns: Spans) -> Spans:
    """Bring the directions of a generatrix into the branch around π/2, where normals have latitude 0."""
    middle = (turns.theta0.min() + turns.theta1.max()) / 2
    shift = 2 * np.pi * np.rint((np.pi / 2 - middle) / (2 * np.pi))
    return replace(turns, theta0=turns.theta0 + shift, theta1=turns.theta1 + shift)


def _refuse_pole(turns: Spans, lattice: KoebeLattice, min_angle: float, field: str) -> None:
    """Refuse normals too near the rail's axis, with the rows that it would take (failure mode C1)."""
    slopes = np.concatenate([turns.theta0, turns.theta1]) - np.pi / 2
    steepest = float(np.abs(slopes).max())
    limit = np.pi / 2 - min_angle
    if steepest <= limit:
        return
    rows = int(np.ceil((np.arctanh(np.tan(limit / 2)) - lattice.start) / lattice.step))
    raise Refused(
        "E-GENERATRIX-POLE",
        "generatrix.curve",
        f"its normal comes within {90 - np.degrees(steepest):.4f}° of the rail's axis, a pole that an edge offset mesh "
        f"never reaches ({rows} rows lead from the phase to the limit)",
        f"at least surface.min_pole_angle_deg = {np.degrees(min_angle):g}°",
        f"Cut the generatrix where its normal's latitude is {np.degrees(limit):g}°.",
    )
