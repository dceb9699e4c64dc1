"""Dividing a curve: the lattice that a request stands for, and the polygon that comes of it (geometry §2)."""

from dataclasses import dataclass, replace

import numpy as np

from isomould.curves.curve import PlanarCurve
from isomould.curves.turning import Arcs, Spans, arcs, spans, tangency
from isomould.errors import Refused
from isomould.form.chords import drawn_polygon, station_polygon
from isomould.form.closing import closed_polygon, open_polygon
from isomould.form.lattice import EvenLattice, Lattice
from isomould.form.polygon import CurvePolygon, unit
from isomould.form.settings import FormLimits, GeneratrixDivide, RailDivide, Treatment
from isomould.form.tangents import split_at_inflections, tangent_edges

_WHOLE = 1e-9


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
    if isinstance(divide.stations, int):
        refuse_size(divide.stations, request.limits)
    if divide.stations is not None:
        return station_polygon(curve, divide.stations, request.field)
    if not _asks_for_angles(divide):
        return drawn_polygon(curve, request.field)
    turns = smooth_spans(curve, request.field)
    if curve.closed:
        return _divide_closed(curve, turns, request)
    return _divide_open(curve, turns, request)


def refuse_size(count: float, limits: FormLimits) -> None:
    """Refuse more panels than the project allows, before anything large is made (failure mode J1)."""
    if count > limits.max_panels:
        raise Refused(
            "E-SIZE",
            "limits.max_panels",
            f"{count:.0f} panels",
            f"{limits.max_panels}",
            "Divide the curves more coarsely, or raise the limit (about 2 kB of memory a panel).",
        )


def _asks_for_angles(divide: RailDivide | GeneratrixDivide) -> bool:
    per_arc = getattr(divide, "per_arc", None)
    return divide.nodes is not None or divide.angle_deg is not None or per_arc is not None


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


def _divide_open(curve: PlanarCurve, turns: Spans, request: Request) -> CurvePolygon:
    runs = arcs(turns)
    refuse_straight(runs, request.field)
    lattice = _open_lattice(turns, runs, request)
    _check_angle(lattice.step, runs, request)
    _refuse_incommensurable(turns, runs, lattice, request)
    edges = tangent_edges(curve, turns, lattice, request.field)
    edges = split_at_inflections(edges) if request.treatment.flat_nodes else edges
    shortest = request.limits.min_member if request.divide.angle_deg is not None else 0.0
    return open_polygon(curve, turns, edges, shortest, request.field)


def _open_lattice(turns: Spans, runs: Arcs, request: Request) -> EvenLattice:
    """Give the lattice of an open curve: from its start tangent, or from a prescribed first direction."""
    divide, start = request.divide, float(turns.theta0[0])
    total = float(np.abs(runs.turning).sum())
    if divide.nodes is not None:
        return EvenLattice(start, total / divide.nodes)
    if isinstance(divide, GeneratrixDivide) and divide.per_arc is not None:
        return EvenLattice(start, _equal_arcs(runs, request.field) / divide.per_arc)
    first = start if divide.first_deg is None else _branch(np.radians(divide.first_deg), start)
    return EvenLattice(first, float(np.radians(divide.angle_deg or 0.0)))


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
    runs = arcs(turns)
    total = float((turns.theta1 - turns.theta0).sum())
    refuse_not_simple(total, request.field)
    count = _closed_count(runs, request)
    step = 2 * np.pi / count
    _check_angle(step, runs, request)
    walk = from_direction(curve, turns, np.radians(request.divide.first_deg or 0.0), np.sign(total), request.field)
    lattice = EvenLattice(float(walk.theta0[0]), step)
    _refuse_incommensurable(walk, arcs(walk), lattice, request)
    edges = tangent_edges(curve, walk, lattice, request.field)
    edges = edges.take(np.arange(len(edges.index) - 1))
    edges = split_at_inflections(edges) if request.treatment.flat_nodes else edges
    return closed_polygon(curve, edges, float(np.sign(total)) * 2 * np.pi, request.field)


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


def from_direction(curve: PlanarCurve, turns: Spans, first: float, sense: float, field: str) -> Spans:
    """Cut a closed curve's spans open at its outermost tangent of direction `first` (rad).

    The drawing's start point has no influence: of several tangents with this direction, the one that supports the
    whole curve is taken, and of a straight part its middle.
    """
    lower = np.minimum(turns.theta0, turns.theta1)
    upper = np.maximum(turns.theta0, turns.theta1)
    direction = first + 2 * np.pi * np.ceil((lower - first - _WHOLE) / (2 * np.pi))
    candidates = np.flatnonzero((direction <= upper + _WHOLE) & (turns.sign != -sense))
    if len(candidates) == 0:
        candidates = np.flatnonzero(direction <= upper + _WHOLE)
    candidates = candidates[np.argsort(turns.sign[candidates] != 0, kind="stable")]
    target = np.clip(direction[candidates], lower[candidates], upper[candidates])
    middle = (turns.t0[candidates] + turns.t1[candidates]) / 2
    straight = turns.sign[candidates] == 0
    parameter = np.where(straight, middle, tangency(curve, turns, candidates, target))
    support = curve.point(turns.piece[candidates], parameter) @ unit(np.array([first - sense * np.pi / 2]))[0]
    best = int(np.argmax(np.round(support, 6)))
    return _cut_open(turns, int(candidates[best]), float(parameter[best]), float(direction[candidates[best]]))


def _cut_open(turns: Spans, span: int, parameter: float, direction: float) -> Spans:
    """Start the spans of a closed curve inside one of them, where it has the given direction."""
    order = np.concatenate([np.arange(span, len(turns.sign)), np.arange(span + 1)])
    full = float((turns.theta1 - turns.theta0).sum())
    shift = np.where(np.arange(len(order)) < len(turns.sign) - span, 0.0, full)
    t0, t1 = turns.t0[order].copy(), turns.t1[order].copy()
    theta0, theta1 = turns.theta0[order] + shift, turns.theta1[order] + shift
    t0[0], theta0[0], t1[-1], theta1[-1] = parameter, direction, parameter, direction + full
    return replace(
        turns,
        piece=turns.piece[order],
        t0=t0,
        t1=t1,
        theta0=theta0,
        theta1=theta1,
        sign=turns.sign[order],
        closed=False,
    )


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


def _refuse_incommensurable(turns: Spans, runs: Arcs, lattice: Lattice, request: Request) -> None:
    """Hold arcs to whole numbers of steps where the project asks for it (inflections = "refuse")."""
    if request.treatment.inflections != "refuse":
        return
    steps = np.abs(lattice.index(turns.theta1[runs.last]) - lattice.index(turns.theta0[runs.first]))
    off = np.abs(steps - np.rint(steps)) > 1e-9 * np.maximum(steps, 1)
    if np.any(off & (runs.sign != 0)):
        angles = np.degrees(np.abs(runs.turning[runs.sign != 0]))
        near = angles / np.maximum(np.rint(steps[runs.sign != 0]), 1)
        raise Refused(
            "E-CURVE-ARCS",
            f"{request.field}.divide",
            f"arcs that turn by {', '.join(f'{angle:.6f}°' for angle in angles)}",
            "whole multiples of the turning angle (inflections = 'refuse')",
            f"Nearest admissible angles by arc: {', '.join(f'{angle:.6f}°' for angle in near)}; "
            "or inflections = 'nearest'.",
        )
