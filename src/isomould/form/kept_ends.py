"""Ends that stay where they were drawn: the end edge goes through the end (geometry §2).

As at inflections, one edge takes the lattice direction that is nearest to the curve's own, and goes through the point.
So every node turns by its angle, and slopes of edge offset meshes stay admissible. What it costs is tangency: the end
edge leaves the curve.
"""

import numpy as np

from isomould.arrays import Floats
from isomould.curves.curve import PlanarCurve
from isomould.curves.turning import Spans
from isomould.errors import Note, Refused
from isomould.form.closing import end_points
from isomould.form.lattice import Lattice
from isomould.form.polygon import CurvePolygon, Edges, Role, joints
from isomould.form.tangents import join

_ON_LATTICE = 1e-9


def refuse_kept_ends(field: str, inflections: str, *, closed: bool) -> None:
    """Refuse kept ends where there are none, or where the curve itself is moved.

    Raises
    ------
    Refused
        E-CURVE-ENDS.
    """
    if not closed and inflections != "fit":
        return
    raise Refused(
        "E-CURVE-ENDS",
        f"{field}.divide.keep_ends",
        "true on a closed curve" if closed else "true beside inflections = 'fit', which moves the curve",
        "an open curve that stays as it is drawn",
        "Leave it out." if closed else "Leave it out, or set inflections = 'nearest'.",
    )


def keep_ends(curve: PlanarCurve, turns: Spans, edges: Edges, lattices: tuple[Lattice, ...], shortest: float) -> Edges:
    """Let the first and the last edge go through the ends of a stretch of curve.

    Parameters
    ----------
    curve, turns
        The curve, and its spans in walking order.
    edges
        Its tangent lines, at least one.
    lattices
        The admissible directions of every arc.
    shortest
        mm: an end edge that would be shorter is not added, and the one before it goes through the end.
    """
    first = keep_end(curve, turns, edges, lattices[0], shortest, last=False)
    return keep_end(curve, turns, first, lattices[-1], shortest, last=True)


def keep_end(curve: PlanarCurve, turns: Spans, edges: Edges, lattice: Lattice, shortest: float, *, last: bool) -> Edges:
    """Let the first or the last edge go through the end: the nearest direction, half a step further at most."""
    row = len(edges.index) - 1 if last else 0
    own = float(turns.theta1[-1] if last else turns.theta0[0])
    here = np.rint(lattice.index(edges.direction[[row]]))
    beyond = float(lattice.index(np.array([own]))[0] - here[0])
    if abs(beyond) <= _ON_LATTICE:
        return edges
    rest = np.delete(np.arange(len(edges.index)), row)
    through = _joined(edges.take(rest), _through_end(curve, turns, lattice, here, last=last), last=last)
    if abs(beyond) < 0.5:
        return through
    further = _joined(edges, _through_end(curve, turns, lattice, here + np.sign(beyond), last=last), last=last)
    corner = joints(further)[-1 if last else 0]
    length = np.linalg.norm(corner - end_points(curve, turns)[1 if last else 0])
    return further if length >= max(shortest, _ON_LATTICE) else through


def kept_ends_notes(polygon: CurvePolygon, field: str) -> tuple[Note, ...]:
    """Say what kept ends cost: no angle, but two lengths of edges, and a distance from the curve."""
    ends = [row for row, role in enumerate(polygon.edges.role) if role is Role.END]
    if not ends:
        return ()
    lengths = " and ".join(f"{polygon.lengths[row]:.1f}" for row in ends)
    text = f"end edges of {lengths} mm lead to the drawn ends; no node turns by an angle of its own for that, and the"
    text += f" polygon leaves its curve by up to {polygon.deviation:.1f} mm"
    return (Note("W-CURVE-ENDS", f"{field}.divide.keep_ends", text),)


def _through_end(curve: PlanarCurve, turns: Spans, lattice: Lattice, number: Floats, *, last: bool) -> Edges:
    """Give the line of a lattice direction through an end."""
    row = -1 if last else 0
    parameter = turns.t1[[-1]] if last else turns.t0[[0]]
    piece = turns.piece[[row]]
    return Edges(number, lattice.direction(number), curve.point(piece, parameter), piece, parameter, (Role.END,))


def _joined(edges: Edges, end: Edges, *, last: bool) -> Edges:
    return join([edges, end] if last else [end, edges])
