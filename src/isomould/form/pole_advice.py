"""Where to cut the generatrix of an edge offset mesh that meets a pole (failure mode C1, geometry §5)."""

from typing import NamedTuple

import numpy as np

from isomould.arrays import Floats
from isomould.curves.curve import PlanarCurve
from isomould.curves.turning import Spans
from isomould.errors import Refused
from isomould.form.arc_lattices import shared_lattices
from isomould.form.lattice import KoebeLattice
from isomould.form.polygon import CurvePolygon, Edges, joints
from isomould.form.settings import SurfaceSettings
from isomould.form.tangents import tangent_edges


class Strip(NamedTuple):
    """The stretch of a generatrix between poles, and the slopes that it would be divided by."""

    spans: Spans
    lattice: KoebeLattice


def refuse_pole(
    curve: PlanarCurve,
    turns: Spans,
    strip: Strip | None,
    rail: CurvePolygon,
    settings: SurfaceSettings,
    shortest: float,
) -> None:
    """Refuse normals too near the rail's axis, with the rows that it would take, and the cut that would pass.

    Parameters
    ----------
    strip
        The first stretch that keeps off the poles; None if nothing does.
    shortest
        mm: no edge is shorter (`tolerances.min_member`).
    """
    limit = 90 - settings.min_pole_angle_deg
    edges = None if strip is None else _edges(curve, strip)
    forecast = "" if strip is None or edges is None else _forecast(strip, edges, limit)
    passing = "" if strip is None or edges is None else _passing(strip, edges, rail, shortest)
    raise Refused(
        "E-GENERATRIX-POLE",
        "generatrix.curve",
        f"its normal {_reach(turns)}, a pole that an edge offset mesh never reaches{forecast}",
        f"at least surface.min_pole_angle_deg = {settings.min_pole_angle_deg:g}°",
        f"Cut the generatrix before its normal's latitude is {limit:g}°{passing}: a dome has an eye there. With "
        "surface.kind = 'isogonal' and an eye its rows keep their height. Or leave a gap there: surface.pole = 'open'; "
        "'cap' closes it with flat panels.",
    )


def _edges(curve: PlanarCurve, strip: Strip) -> Edges:
    return tangent_edges(curve, strip.spans, shared_lattices(strip.spans, strip.lattice), "generatrix")


def _reach(turns: Spans) -> str:
    every = np.concatenate([turns.theta0, turns.theta1])
    if np.floor(every.min() / np.pi) != np.ceil(every.max() / np.pi) - 1:
        return "passes the direction of the rail's axis"
    nearest = np.degrees(np.abs(every - np.pi * np.rint(every / np.pi)).min())
    return f"comes within {nearest:.4f}° of the rail's axis"


def _forecast(strip: Strip, edges: Edges, limit_deg: float) -> str:
    """Say how many rows lead from the phase to the limit, and how high the lowest of them is."""
    lattice = strip.lattice
    rows = int(np.ceil((np.arctanh(np.tan(np.radians(limit_deg) / 2)) - lattice.start) / lattice.step))
    heights = _heights(edges)
    lowest = f", the lowest of them {heights.min():.1f} mm high" if len(heights) else ""
    return f" ({rows} rows lead from the phase to the limit{lowest})"


def _heights(edges: Edges) -> Floats:
    """Heights (e − 2,) mm of the rows between the first and the last edge."""
    return np.linalg.norm(np.diff(joints(edges), axis=0), axis=1)


def _passing(strip: Strip, edges: Edges, rail: CurvePolygon, shortest: float) -> str:
    """Say at which latitude and where the generatrix may end, so that no edge is shorter than `shortest`."""
    latitude = np.degrees(edges.direction - np.pi / 2 - strip.lattice.half * np.pi)
    order = np.arange(len(latitude))
    if len(order) < 3:
        return ""
    order = order if abs(latitude[-1]) >= abs(latitude[0]) else order[::-1]  # towards the pole
    towards = edges.take(order)
    corners = joints(towards)
    long_enough = _parallels(rail, corners[:, 0]).min(axis=1) >= shortest
    long_enough[1:] &= _heights(towards) >= shortest
    flattest = int(np.argmin(np.abs(latitude[order])))
    short = np.flatnonzero(~long_enough[flattest:])
    last = flattest + (int(short[0]) if len(short) else len(corners) - flattest)
    if last < 2:
        return ""
    d, z = towards.contact[last]
    return f", at most where it is {abs(latitude[order[last]]):.2f}°, at (d, z) = ({d:.0f}, {z:.0f}) mm"


def _parallels(rail: CurvePolygon, d: Floats) -> Floats:
    """Lengths (n, m) mm of the edges of parallels at offsets d (n,) from a planar rail (geometry §3)."""
    half = np.tan(np.nan_to_num(rail.turning) / 2)
    growth = half[: len(rail.lengths)] + np.roll(half, -1)[: len(rail.lengths)]
    return rail.lengths + np.multiply.outer(d, growth)
