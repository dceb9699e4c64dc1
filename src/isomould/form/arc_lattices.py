"""A lattice of directions for every arc of a curve: shared, with leftover turning, of several angles (geometry §2).

Neighbouring arcs share the direction of the edge between them, the one through the inflection or straight part.
"""

import numpy as np

from isomould.arrays import Floats
from isomould.curves.curve import PlanarCurve
from isomould.curves.lengths import length, parameter_at
from isomould.curves.turning import Arcs, Spans, arcs, turn
from isomould.errors import Refused
from isomould.form.lattice import EvenLattice, Lattice, ListedLattice
from isomould.form.settings import AngleRange
from isomould.form.tangents import nearest

_SETTLED = 1e-9


def shared_lattices(turns: Spans, lattice: Lattice) -> tuple[Lattice, ...]:
    """Give every arc the same lattice: the way `nearest`."""
    return (lattice,) * len(arcs(turns).sign)


def residual_lattices(turns: Spans, step: float) -> tuple[Lattice, ...]:
    """Keep the tangents of inflections, straight parts and ends; leftover turning goes to the nodes beside the former.

    An arc of turning A has n = round(A/α) nodes (one at least). All turn by α but those beside an inflection or
    straight part, which share A − nα among them.

    Parameters
    ----------
    turns
        Spans in walking order with at least one inflection or straight part.
    step
        α, rad.
    """
    runs = arcs(turns)
    count = len(runs.sign)
    takes = [(turns.closed or run > 0, turns.closed or run < count - 1) for run in range(count)]
    return tuple(_with_leftover(turns, runs, run, step, takes[run]) for run in range(count))


def _with_leftover(turns: Spans, runs: Arcs, run: int, step: float, takes: tuple[bool, bool]) -> Lattice:
    start, end = float(turns.theta0[runs.first[run]]), float(turns.theta1[runs.last[run]])
    if runs.sign[run] == 0:
        return EvenLattice(start, step)
    count = max(round(round(abs(end - start) / step, 9)), 1)
    share = np.zeros(count)
    share[[0]] += takes[0]
    share[[-1]] += takes[1]
    steps = step + (abs(end - start) - count * step) * share / share.sum()
    listed = start + runs.sign[run] * np.concatenate([[0.0], np.cumsum(steps)])
    listed[-1] = end
    return ListedLattice(listed[:: runs.sign[run]].copy())


def several_lattices(
    curve: PlanarCurve, turns: Spans, ranges: tuple[AngleRange, ...], first: float, field: str
) -> tuple[Lattice, ...]:
    """Walk an open curve in steps that change from range to range (paper §4.4).

    A node belongs to the range in which its middle direction lies, so that every node turns by exactly ±α of one
    range.

    Parameters
    ----------
    curve, turns
        An open curve and its spans.
    ranges
        Turning angles, and the length along the curve (mm) that each is valid until.
    first
        Direction (rad) of the first edge.
    field
        Name of the curve's table, for errors.
    """
    runs, borders = arcs(turns), _borders(curve, turns, ranges, field)
    lattices: list[Lattice] = []
    for run, sign in enumerate(runs.sign):
        if sign == 0:
            lattices.append(lattices[-1] if lattices else EvenLattice(first, _steps(ranges)[0]))
            continue
        lattices.append(_stepping(turns, runs, run, borders, _steps(ranges), first))
        first = nearest(lattices[-1], float(turns.theta1[runs.last[run]]))[1]
    return tuple(lattices)


def _steps(ranges: tuple[AngleRange, ...]) -> list[float]:
    return [float(np.radians(part.angle_deg)) for part in ranges]


def _stepping(
    turns: Spans, runs: Arcs, run: int, borders: list[tuple[int, float]], steps: list[float], first: float
) -> Lattice:
    """Give the directions of one arc from `first` on, through the ranges that it lies in."""
    sign, here, last = int(runs.sign[run]), int(runs.first[run]), int(runs.last[run])
    inside = [k for k, (span, _) in enumerate(borders) if here <= span <= last]
    opening = sum(span < here for span, _ in borders)
    walked = [steps[opening]]
    for k in inside:
        reach = sign * (borders[k][1] - first) - sum(walked[1:])
        walked += [steps[k]] * max(int(np.ceil(reach / steps[k] - 0.5 - _SETTLED)), 0)
    walked.append(steps[opening + len(inside)])
    listed = first + sign * (np.cumsum(walked) - walked[0])
    return ListedLattice(np.concatenate([[first - sign * walked[0]], listed])[::sign].copy())


def _borders(curve: PlanarCurve, turns: Spans, ranges: tuple[AngleRange, ...], field: str) -> list[tuple[int, float]]:
    """Span and direction (rad) at the end of every range but the last."""
    places = np.array([part.until for part in ranges if part.until is not None])
    _refuse_beyond(places, length(curve), field)
    return [_at(curve, turns, int(piece), float(t)) for piece, t in zip(*parameter_at(curve, places), strict=True)]


def _at(curve: PlanarCurve, turns: Spans, piece: int, parameter: float) -> tuple[int, float]:
    """Span and direction (rad) of the curve at a place."""
    span = int(np.flatnonzero((turns.piece == piece) & (turns.t0 <= parameter))[-1])
    places = np.array([piece, piece]), np.array([turns.t0[span], parameter])
    along = curve.derivative(*places)
    return span, float(turns.theta0[span] + turn(along[:1], along[1:])[0])


def _refuse_beyond(places: Floats, total: float, field: str) -> None:
    if len(places) and places[-1] >= total:
        raise Refused(
            "E-CURVE-RANGE",
            f"{field}.divide.angles",
            f"until = {places[-1]:g} mm",
            f"below the curve's length of {total:.3f} mm",
            "Shorten the range, or leave out the ranges after it.",
        )
