"""Dividing a curve: the lattice that a request stands for, and the polygon that comes of it (geometry §2)."""

from dataclasses import dataclass

import numpy as np

from isomould.curves.curve import PlanarCurve
from isomould.curves.turning import Arcs, Spans, arcs, spans
from isomould.errors import Refused
from isomould.form.arc_lattices import residual_lattices, several_lattices, shared_lattices
from isomould.form.chords import drawn_polygon, station_polygon
from isomould.form.closing import closed_polygon, open_polygon
from isomould.form.kept_ends import keep_ends, refuse_kept_ends
from isomould.form.lattice import EvenLattice, Lattice
from isomould.form.long_edges import divide_long_edges
from isomould.form.polygon import CurvePolygon
from isomould.form.settings import FormLimits, GeneratrixDivide, RailDivide, Treatment
from isomould.form.size_limit import refuse_size
from isomould.form.tangents import refuse_noise, split_at_inflections, tangent_edges
from isomould.form.walks import from_direction, from_inflection

_WHOLE = 1e-9
_OWN_TANGENTS = ("residual", "fit")
"""Ways in which the tangents at inflections are edges, so that no other direction can be prescribed."""


@dataclass(frozen=True)
class Request:
    """Everything that dividing one curve needs besides the curve; `field` names its table in errors."""

    field: str
    divide: RailDivide | GeneratrixDivide
    treatment: Treatment
    limits: FormLimits


def divide_curve(curve: PlanarCurve, request: Request) -> CurvePolygon:
    """Divide a rail or a generatrix by stations, as drawn, or into an isogonal tangent polygon.

    Raises
    ------
    Refused
        If the curve has kinks, too little or noisy curvature, or the request does not fit it.
    """
    divide = request.divide
    if divide.keep_ends:
        refuse_kept_ends(request.field, request.treatment.inflections, closed=curve.closed)
    if isinstance(divide.stations, int):
        refuse_size(divide.stations, request.limits)
    if divide.stations is not None:
        polygon = station_polygon(curve, divide.stations, request.field)
    elif not _asks_for_angles(divide):
        polygon = drawn_polygon(curve, request.field)
    else:
        polygon = _tangent_polygon(curve, request)
    return divide_long_edges(curve, polygon, request.treatment.max_edge, request.limits)


def _tangent_polygon(curve: PlanarCurve, request: Request) -> CurvePolygon:
    """Divide a curve by angles (paper §4.1)."""
    _refuse_first(request)
    turns = smooth_spans(curve, request.field)
    return _divide_closed(curve, turns, request) if curve.closed else _divide_open(curve, turns, request)


def _asks_for_angles(divide: RailDivide | GeneratrixDivide) -> bool:
    per_arc = getattr(divide, "per_arc", None)
    return any(way is not None for way in (divide.nodes, divide.angle_deg, divide.angles, per_arc))


def smooth_spans(curve: PlanarCurve, field: str) -> Spans:
    """Spans of a curve without kinks (failure mode B1)."""
    turns = spans(curve)
    if len(turns.kink_angle):
        worst = int(np.argmax(np.abs(turns.kink_angle)))
        x, y = turns.kink_point[worst]
        raise Refused(
            "E-CURVE-KINK",
            f"{field}.curve",
            f"a kink of {np.degrees(turns.kink_angle[worst]):.6f}° at ({x:.3f}, {y:.3f}) mm",
            "a smooth curve (kinks below 1e-9 rad)",
            f"Fillet it, or take the vertices as drawn: surface.kind = 'moulding' without {field}.divide.",
        )
    return turns


def turning_angle(curve: PlanarCurve, request: Request) -> float:
    """Turning angle α (rad) of a division by nodes or angle, whatever the curve's inflections."""
    turns = smooth_spans(curve, request.field)
    if curve.closed:
        return 2 * np.pi / _closed_count(arcs(turns), request)
    return _open_lattice(turns, arcs(turns), request).step


def _divide_open(curve: PlanarCurve, turns: Spans, request: Request) -> CurvePolygon:
    runs = arcs(turns)
    refuse_straight(runs, request.field)
    lattices = _open_lattices(curve, turns, request)
    _refuse_incommensurable(turns, runs, lattices, request)
    edges = tangent_edges(curve, turns, lattices, request.field)
    if request.divide.keep_ends and len(edges.index):
        edges = keep_ends(curve, turns, edges, lattices, request.limits.min_member)
    edges = split_at_inflections(edges) if request.treatment.flat_nodes else edges
    prescribed = request.divide.angle_deg is not None or request.divide.angles is not None
    shortest = request.limits.min_member if prescribed else 0.0
    return open_polygon(curve, turns, edges, shortest, request.field)


def _open_lattices(curve: PlanarCurve, turns: Spans, request: Request) -> tuple[Lattice, ...]:
    """Give the lattice of every arc: from the start tangent, or from a prescribed first direction."""
    ranges = request.divide.angles
    if ranges is None:
        return _lattices(curve, turns, _open_lattice(turns, arcs(turns), request), request)
    _refuse_several(curve, request)
    for part in ranges:
        _check_angle(float(np.radians(part.angle_deg)), arcs(turns), request)
    first = _first(float(turns.theta0[0]), request)
    return several_lattices(curve, turns, ranges, first, request.field)


def _lattices(curve: PlanarCurve, turns: Spans, lattice: EvenLattice, request: Request) -> tuple[Lattice, ...]:
    """Give the lattice of every arc for one turning angle, by the way that inflections are treated."""
    _check_angle(lattice.step, arcs(turns), request)
    shared = shared_lattices(turns, lattice)
    if request.treatment.inflections != "residual" or len(shared) == 1:
        return shared
    refuse_noise(curve, turns, shared, request.field)
    return residual_lattices(turns, lattice.step)


def _first(start: float, request: Request) -> float:
    """Direction (rad) of the first edge: as prescribed, else that of the curve's start."""
    first = request.divide.first_deg
    return start if first is None else _branch(np.radians(first), start)


def _open_lattice(turns: Spans, runs: Arcs, request: Request) -> EvenLattice:
    """Give the lattice of an open curve: from its start tangent, or from a prescribed first direction."""
    divide, start = request.divide, float(turns.theta0[0])
    total = float(np.abs(runs.turning).sum())
    if divide.nodes is not None:
        return EvenLattice(start, total / divide.nodes)
    if isinstance(divide, GeneratrixDivide) and divide.per_arc is not None:
        return EvenLattice(start, _equal_arcs(runs, request.field) / divide.per_arc)
    return EvenLattice(_first(start, request), float(np.radians(divide.angle_deg or 0.0)))


def _branch(direction: float, near: float) -> float:
    """Give the direction plus the multiple of 2π that brings it nearest to `near`."""
    return float(direction + 2 * np.pi * np.rint((near - direction) / (2 * np.pi)))


def _equal_arcs(runs: Arcs, field: str) -> float:
    """Turning that all arcs share, for a division by nodes per arc."""
    turned = np.abs(runs.turning[runs.sign != 0])
    if np.ptp(turned) > _WHOLE * turned.max():
        listed = ", ".join(f"{angle:.6f}°" for angle in np.degrees(turned))
        raise Refused(
            "E-CURVE-ARCS",
            f"{field}.divide.per_arc",
            f"the arcs between inflections turn by {listed}",
            "equal arcs, so that one angle divides them all",
            "Give divide.angle_deg or divide.nodes instead.",
        )
    return float(turned.mean())


def _divide_closed(curve: PlanarCurve, turns: Spans, request: Request) -> CurvePolygon:
    total = float((turns.theta1 - turns.theta0).sum())
    refuse_not_simple(total, request.field)
    _refuse_several(curve, request)
    walk = from_direction(curve, turns, np.radians(request.divide.first_deg or 0.0), np.sign(total), request.field)
    if _begins_at_inflections(request) and len(arcs(walk).sign) > 1:
        walk = from_inflection(walk)
    lattice = EvenLattice(float(walk.theta0[0]), 2 * np.pi / _closed_count(arcs(turns), request))
    lattices = _lattices(curve, walk, lattice, request)
    _refuse_incommensurable(walk, arcs(walk), lattices, request)
    edges = tangent_edges(curve, walk, lattices, request.field)
    edges = edges if walk.closed else edges.take(np.arange(len(edges.index) - 1))
    edges = split_at_inflections(edges) if request.treatment.flat_nodes else edges
    return closed_polygon(curve, edges, float(np.sign(total)) * 2 * np.pi, request.field)


def _begins_at_inflections(request: Request) -> bool:
    """Whether a closed curve is divided from an inflection tangent on, and not from a direction that was given."""
    way = request.treatment.inflections
    return way in _OWN_TANGENTS or (way == "refuse" and request.divide.first_deg is None)


def _closed_count(runs: Arcs, request: Request) -> int:
    """Give k of α = 2π/k: the count asked for, shared out over all turning where there are inflections."""
    divide, turned = request.divide, float(np.abs(runs.turning).sum())
    if divide.angle_deg is not None:
        return _whole_turns(divide.angle_deg, request.field)
    count = int(np.rint((divide.nodes or 0) * 2 * np.pi / turned))
    if count < 3:
        raise Refused(
            "E-CURVE-COUNT",
            f"{request.field}.divide.nodes",
            f"{divide.nodes} nodes on a closed curve",
            f"at least {int(np.ceil(3 * turned / (2 * np.pi)))}",
            "Give more nodes.",
        )
    return count


def _whole_turns(angle_deg: float, field: str) -> int:
    count = 360.0 / angle_deg
    if abs(count - round(count)) > _WHOLE * count or count < 2.5:
        near = ", ".join(f"{360 / n:.6f}°" for n in (int(count) + 1, max(int(count), 3)))
        raise Refused(
            "E-CURVE-ANGLE",
            f"{field}.divide.angle_deg",
            f"{angle_deg:g}° on a closed curve",
            "a whole fraction of 360°, at most 120°",
            f"The nearest ones are {near}.",
        )
    return round(count)


def _check_angle(step: float, runs: Arcs, request: Request) -> None:
    refuse_size(float(np.abs(runs.turning).sum()) / step, request.limits)
    if np.degrees(step) > request.limits.max_turning_deg:
        raise Refused(
            "E-CURVE-ANGLE",
            f"{request.field}.divide",
            f"a turning angle of {np.degrees(step):.4f}°",
            f"at most tolerances.max_turning_deg = {request.limits.max_turning_deg:g}°",
            "Divide the curve into more nodes.",
        )


def refuse_straight(runs: Arcs, field: str) -> None:
    """Refuse curves that do not turn at all."""
    if not np.any(runs.sign):
        raise Refused(
            "E-CURVE-STRAIGHT",
            f"{field}.curve",
            "a straight line",
            "a curve that turns (a straight line has no isogonal subdivision and, as generatrix, no edge offset mesh: "
            "paper §4.3)",
            "Draw a curve, or use surface.kind = 'moulding' with divide.stations.",
        )


def refuse_not_simple(total: float, field: str) -> None:
    """Refuse closed curves that do not turn round once (failure mode B7)."""
    turns = total / (2 * np.pi)
    if abs(abs(turns) - 1) > 1e-6:
        raise Refused(
            "E-CURVE-LOOP",
            f"{field}.curve",
            f"a closed curve that turns round {turns:.4f} times",
            "once (a simple loop without self-intersection)",
            "Redraw the curve without crossings.",
        )


def _refuse_first(request: Request) -> None:
    if request.divide.first_deg is not None and request.treatment.inflections in _OWN_TANGENTS:
        raise Refused(
            "E-CURVE-FIRST",
            f"{request.field}.divide.first_deg",
            f"{request.divide.first_deg:g}° beside inflections = '{request.treatment.inflections}'",
            "none: the directions follow from the tangents at inflections",
            "Leave out first_deg, or set inflections = 'nearest'.",
        )


def _refuse_several(curve: PlanarCurve, request: Request) -> None:
    """Hold several angles to what they can have: an open curve, and one rule for its inflections."""
    way = request.treatment.inflections
    if request.divide.angles is not None and (curve.closed or way in _OWN_TANGENTS):
        raise Refused(
            "E-CURVE-ANGLES",
            f"{request.field}.divide.angles",
            "several angles on a closed curve" if curve.closed else f"several angles with inflections = '{way}'",
            "an open curve, and inflections = 'nearest' or 'refuse'",
            "Give one angle_deg or nodes, or change the above.",
        )


def _refuse_incommensurable(turns: Spans, runs: Arcs, lattices: tuple[Lattice, ...], request: Request) -> None:
    """Hold arcs to whole numbers of steps where the project asks for it (inflections = "refuse", "fit")."""
    if request.treatment.inflections not in ("refuse", "fit"):
        return
    ends = np.stack([turns.theta0[runs.first], turns.theta1[runs.last]], axis=1)
    steps = np.array([abs(np.diff(lattice.index(pair))[0]) for lattice, pair in zip(lattices, ends, strict=True)])
    off = np.abs(steps - np.rint(steps)) > 1e-9 * np.maximum(steps, 1)
    if np.any(off & (runs.sign != 0)):
        angles = np.degrees(np.abs(runs.turning[runs.sign != 0]))
        near = angles / np.maximum(np.rint(steps[runs.sign != 0]), 1)
        raise Refused(
            "E-CURVE-ARCS",
            f"{request.field}.divide",
            f"arcs that turn by {', '.join(f'{angle:.6f}°' for angle in angles)}",
            f"whole multiples of the turning angle (inflections = '{request.treatment.inflections}')",
            f"Nearest admissible angles by arc: {', '.join(f'{angle:.6f}°' for angle in near)}; "
            "or inflections = 'nearest'.",
        )
