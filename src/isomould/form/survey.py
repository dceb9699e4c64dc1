"""What became of a curve: how its arcs turn, which angles would divide them, and what should be known about it."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.curves.curve import PlanarCurve
from isomould.curves.space_curve import SpatialCurve
from isomould.curves.turning import arcs, spans
from isomould.errors import Note
from isomould.form.division import Request
from isomould.form.kept_ends import kept_ends_notes
from isomould.form.polygon import FLAT, CurvePolygon
from isomould.form.spatial import SpatialPolygon

_SAME = 1e-9


@dataclass(frozen=True)
class ArcTurning:
    """One arc between inflections or straight parts.

    `steps` is its turning over the curve's turning angle, `nearest_deg` the angle next to that which divides the
    arc into whole steps; None where the curve has no one angle.
    """

    turning_deg: float
    steps: float | None
    nearest_deg: float | None


@dataclass(frozen=True)
class NodeAngle:
    """A turning angle, and how many nodes of the polygon turn by it to either side (0: flat nodes)."""

    angle_deg: float
    nodes: int


@dataclass(frozen=True)
class Division:
    """A divided rail or generatrix: `field` says which; deviation of the polygon from the curve in mm."""

    field: str
    edges: int
    angles: tuple[NodeAngle, ...]
    arcs: tuple[ArcTurning, ...]
    deviation: float


def survey(curve: PlanarCurve | SpatialCurve, polygon: CurvePolygon | SpatialPolygon, request: Request) -> Division:
    """Describe how a curve was divided; most frequent angles first, arcs in the curve's own order.

    A rail in space has no arcs: it turns neither left nor right.
    """
    turned = _turned(curve) if isinstance(curve, PlanarCurve) else np.empty(0)
    angles, counts, _ = node_angles(polygon)
    step = _step(angles, request)
    return Division(
        field=request.field,
        edges=_edge_count(polygon),
        angles=tuple(NodeAngle(float(np.degrees(a)), int(n)) for a, n in zip(angles, counts, strict=True)),
        arcs=tuple(_arc(float(turning), step) for turning in turned),
        deviation=polygon.deviation,
    )


def _turned(curve: PlanarCurve) -> Floats:
    runs = arcs(spans(curve))
    return np.abs(runs.turning[runs.sign != 0])


def _edge_count(polygon: CurvePolygon | SpatialPolygon) -> int:
    gaps = int(np.count_nonzero(polygon.gap)) if isinstance(polygon, CurvePolygon) else 0
    return len(polygon.lengths) - gaps


def node_angles(polygon: CurvePolygon | SpatialPolygon) -> tuple[Floats, Ints, Ints]:
    """Sort the nodes by |turning|: angles (k,) rad, nodes (k,) of each, most frequent first, and class (n,) per vertex.

    Open ends, also those beside gaps, have the class −1.
    """
    turning = np.abs(polygon.turning)
    inner = np.flatnonzero(np.isfinite(turning))
    order = inner[np.argsort(turning[inner], kind="stable")]
    group = np.cumsum(np.diff(turning[order], prepend=turning[order[:1]]) > _SAME)
    counts = np.bincount(group)
    rank = np.argsort(-counts, kind="stable")
    angles = np.array([np.median(turning[order[group == k]]) for k in rank])
    of = np.full(len(turning), -1)
    of[order] = np.argsort(rank)[group]
    return np.where(angles <= FLAT, 0.0, angles), counts[rank], of


def _step(angles: Floats, request: Request) -> float | None:
    """Turning angle (rad) of a curve that has one: the most frequent, where the rest is flat or left over."""
    divide = request.divide
    if divide.nodes is None and divide.angle_deg is None and getattr(divide, "per_arc", None) is None:
        return None
    return float(angles[angles > 0][0])


def _arc(turning: float, step: float | None) -> ArcTurning:
    degrees = float(np.degrees(turning))
    if step is None:
        return ArcTurning(degrees, None, None)
    return ArcTurning(degrees, turning / step, degrees / max(round(turning / step), 1))


def division_notes(polygon: CurvePolygon, request: Request) -> tuple[Note, ...]:
    """Say what a division could not give, and what it cost: the count asked for, one angle, ends as drawn."""
    ends = kept_ends_notes(polygon, request.field)
    return (*_count_notes(polygon, request), *_leftover_notes(polygon, request), *ends)


def _count_notes(polygon: CurvePolygon, request: Request) -> tuple[Note, ...]:
    asked, given = request.divide.nodes, int(np.count_nonzero(np.abs(np.nan_to_num(polygon.turning)) > FLAT))
    if asked in (None, given):
        return ()
    text = f"{asked} nodes asked for, {given} obtained: the arcs are no whole multiples of the turning angle"
    return (Note("W-CURVE-COUNT", f"{request.field}.divide.nodes", text),)


def _leftover_notes(polygon: CurvePolygon, request: Request) -> tuple[Note, ...]:
    """Name the extra classes that leftover turning makes."""
    angles, _, of = node_angles(polygon)
    extra = np.flatnonzero(angles > 0)[1:].tolist() if request.treatment.inflections == "residual" else []
    named = [f"{np.degrees(angles[k]):.4f}° at {', '.join(str(j) for j in np.flatnonzero(of == k))}" for k in extra]
    text = f"leftover turning beside inflections makes classes of their own: nodes of {'; '.join(named)}"
    return (Note("W-CURVE-LEFTOVER", f"{request.field}.inflections", text),) if extra else ()
