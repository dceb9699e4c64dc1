"""V8-V10: the rail and generatrix polygons turn as declared, touch their curves and close (geometry §2)."""

from collections.abc import Callable

import numpy as np

from isomould.verify.curve import distance_to, evaluate, is_loop, turned_at
from isomould.verify.delivery import Delivery
from isomould.verify.read.design import Line, edge_vectors
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, worse, worst_of
from isomould.verify.space import SEAM, frame_gap

ANGLE = 1e-11
LENGTH = 1e-6
_EPS = float(np.finfo(np.float64).eps)


def _both(delivery: Delivery, measure: Callable[[str, Line], Measured], *, in_space: bool = False) -> Measured:
    """Measure the lines, a rail in space only if told to; not applicable only if no line can answer."""
    lines = {"generatrix": delivery.design.generatrix}
    if delivery.design.plane is not None or in_space:
        lines = {"rail": delivery.design.rail, **lines}
    found, answers = list[Measured](), list[str]()
    for name, line in lines.items():
        try:
            found.append(measure(name, line))
        except NotApplicable as answer:
            answers.append(str(answer))
    if not found:
        raise NotApplicable("; ".join(answers))
    return worse(*found)


def turning(delivery: Delivery) -> Measured:
    """Compare turning of vertices, directions of edges and steps of the lattice with what is declared."""
    return _both(delivery, _turning)


def _turning(name: str, line: Line) -> Measured:
    edges = edge_vectors(line)
    found = np.arctan2(_cross(np.roll(edges, 1, axis=0), edges), (np.roll(edges, 1, axis=0) * edges).sum(axis=1))
    steps = line.directions - np.roll(line.directions, 1)
    if not line.closed:
        found, steps, declared = found[1:], steps[1:], line.turning[1:-1]
    else:
        declared = line.turning
    inner = np.flatnonzero(line.inner if line.closed else line.inner[1:-1])
    found, steps, declared = found[inner], steps[inner], declared[inner]
    off = [_wrapped(found - declared), _wrapped(steps - declared), _off_lattice(line, declared)]
    names = [f"{name} vertex {k + (not line.closed)}" for k in inner]
    limit = max(ANGLE, 8 * _EPS * abs(line.vertices).max() / np.linalg.norm(edges, axis=1).min())
    return worst_of(np.max(np.abs(off), axis=0), names, limit=float(limit), none=f"the {name} has no inner vertex")


def _off_lattice(line: Line, declared: Floats) -> Floats:
    """Give the distance of every turning from +α, −α and 0, if an α is declared for the whole line."""
    if line.declared is None:
        return np.zeros_like(declared)
    return abs(declared[:, None] - np.array([-1, 0, 1]) * line.declared).min(axis=1)


def _wrapped(angle: Floats) -> Floats:
    return np.remainder(angle + np.pi, 2 * np.pi) - np.pi


def _cross(a: Floats, b: Floats) -> Floats:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def curvature(delivery: Delivery) -> Measured:
    """Integral of curvature between consecutive points of tangency against the step (paper eq. 6)."""
    return _both(delivery, _curvature)


def _curvature(name: str, line: Line) -> Measured:
    tangents = [k for k, role in enumerate(line.roles) if role == "tangent" and line.contacts[k] is not None]
    if len(tangents) < 2:
        raise NotApplicable(f"the {name} has fewer than two tangent edges")
    contacts = [contact for k in tangents if (contact := line.contacts[k]) is not None]
    loop = line.closed or is_loop(line.curve)
    angles, round_trip = turned_at(line.curve, contacts, closed=loop)
    passed = np.array([here > there for here, there in zip(contacts, contacts[1:] + contacts[:1], strict=True)])
    curved = np.roll(angles, -1) - angles + np.where(passed & loop, round_trip, 0.0)
    summed = np.array([_between(line, a, b) for a, b in zip(tangents, tangents[1:] + tangents[:1], strict=True)])
    count = len(tangents) if line.closed else len(tangents) - 1
    apart = np.array([_apart(line, a, b) for a, b in zip(tangents, tangents[1:] + tangents[:1], strict=True)])
    off = np.where(apart, 0.0, abs(curved - summed))
    return worst_of(off[:count], [f"{name} edge {k}" for k in tangents])


def _between(line: Line, a: int, b: int) -> float:
    """Sum the turning of the vertices from edge a on to edge b, round the end of a closed line if need be."""
    after = line.turning[a + 1 : b + 1] if b > a else np.concatenate((line.turning[a + 1 :], line.turning[: b + 1]))
    return float(after.sum())


def _apart(line: Line, a: int, b: int) -> bool:
    """Tell whether a gap lies between edge a and edge b."""
    return bool(line.gap[a:b].any() if b > a else line.gap[a:].any() or line.gap[:b].any())


def tangency(delivery: Delivery) -> Measured:
    """Distance of a contact from its edge's line; how far tangent and edge part over the edge's length."""
    return _both(delivery, _tangency)


def _tangency(name: str, line: Line) -> Measured:
    edges, off, names = edge_vectors(line), list[float](), list[str]()
    for k, (role, contact) in enumerate(zip(line.roles, line.contacts, strict=True)):
        if contact is not None and role != "chord":
            p0, p1, _ = evaluate(line.curve[contact[0]], np.array([contact[1]]))[:, 0]
            apart = abs(_cross(edges[k], p0 - line.vertices[k])) / np.linalg.norm(edges[k])
            bent = abs(_cross(edges[k], p1)) / np.linalg.norm(p1) if role == "tangent" else 0.0
            off.append(float(max(apart, bent)))
            names.append(f"{name} edge {k}")
    return worst_of(off, names, none=f"the {name} has no edge that touches its curve")


def deviation(delivery: Delivery) -> Measured:
    """Largest distance of a polygon vertex from its curve; the limit is the project's, if it gives one."""
    given = delivery.design.raw["limits"]["max_deviation_mm"]
    limit = np.inf if given is None else float(given)
    found = _both(delivery, _deviation, in_space=True)
    return Measured(found.count, found.worst, found.where, limit)


def _deviation(name: str, line: Line) -> Measured:
    names = [f"{name} vertex {k}" for k in range(len(line.vertices))]
    return worst_of(distance_to(line.curve, line.vertices), names)


def closing(delivery: Delivery) -> Measured:
    """Measure how far the edges of closed lines, the closing one too, leave their directions (mm).

    Of a closed rail in space, measure how far its frame misses itself.
    """
    design = delivery.design
    if design.plane is None and design.rail.closed:
        return worst_of([frame_gap(design)], ["frame of the rail"], limit=SEAM)
    return _both(delivery, _closing)


def _closing(name: str, line: Line) -> Measured:
    if not line.closed:
        raise NotApplicable(f"the {name} is open")
    along = np.column_stack((np.cos(line.directions), np.sin(line.directions)))
    off = np.where((edge_vectors(line) * along).sum(axis=1) > 0, abs(_cross(along, edge_vectors(line))), np.inf)
    rounds = (abs(float(line.turning.sum())) - 2 * np.pi) * np.linalg.norm(edge_vectors(line), axis=1).max()
    names = [f"{name} edge {k}" for k in range(len(off))]
    return worse(worst_of(off, names), worst_of([abs(rounds)], [f"{name}: total turning"]))


RULES = (
    Rule("V8", "polygon vertices turn by the declared angles", ANGLE, "rad", turning),
    Rule("V8b", "curvature between points of tangency integrates to the step", ANGLE, "rad", curvature),
    Rule("V9", "polygon edges touch their curve", LENGTH, "mm", tangency),
    Rule("V9b", "deviation of the polygons from their curves", 0, "mm", deviation),
    Rule("V10", "closed polygons close", LENGTH, "mm", closing),
)
