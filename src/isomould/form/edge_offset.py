"""The slopes of edge offset meshes on a generatrix (paper §3.6, §4.3, geometry §5)."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from isomould.arrays import Floats
from isomould.curves.curve import PlanarCurve
from isomould.curves.turning import Spans, arcs
from isomould.errors import Note, Refused
from isomould.form.arc_lattices import shared_lattices
from isomould.form.caps import cap_notes, find_caps
from isomould.form.closing import open_polygon
from isomould.form.division import Request, refuse_not_simple, refuse_straight, smooth_spans
from isomould.form.kept_ends import keep_end, refuse_kept_ends
from isomould.form.lattice import KoebeLattice, half_width
from isomould.form.long_edges import divide_long_edges
from isomould.form.phase import choose_lattice
from isomould.form.pole_advice import Strip, refuse_pole
from isomould.form.poles import Strips, chain, strips_between_poles
from isomould.form.polygon import FLAT, CurvePolygon
from isomould.form.profile import Caps
from isomould.form.settings import GeneratrixDivide, SlopePhase, SurfaceSettings
from isomould.form.tangents import split_at_inflections, tangent_edges
from isomould.form.walks import from_direction


class Divided(NamedTuple):
    """A generatrix divided for an edge offset mesh: latitudes λ (n,) rad of its vertices, and what closes poles."""

    polygon: CurvePolygon
    parallels: Floats | None
    caps: Caps
    notes: tuple[Note, ...]


def divide_for_edge_offset(
    curve: PlanarCurve, rail: CurvePolygon, settings: SurfaceSettings, request: Request
) -> Divided:
    """Divide a generatrix into the slopes of an edge offset mesh (paper §4.3, geometry §5).

    Parameters
    ----------
    curve
        Generatrix in coordinates (d, z), its outside to the right.
    rail
        The divided rail, with one turning angle |α|.
    settings
        How near the normal may come to the rail's axis, and what becomes of the poles.
    request
        Phase, limits and field names.

    Returns
    -------
    The polygon is open, with a gap at every pole that the generatrix passes; the notes say what was left out there.
    """
    turning, limits = rail.angle or 0.0, request.limits
    _refuse_way(request)
    if request.divide.keep_ends:
        refuse_kept_ends(request.field, request.treatment.inflections, closed=curve.closed)
    turns = _upright(curve, request.field)
    refuse_straight(arcs(turns), request.field)
    strips = strips_between_poles(curve, turns, float(np.radians(settings.min_pole_angle_deg)))
    if not strips.spans or (settings.pole == "refuse" and not strips.whole):
        first = [Strip(spans, _lattice(curve, spans, turning, request)) for spans in strips.spans[:1]]
        refuse_pole(curve, turns, first[0] if first else None, rail, settings, limits.min_member)
    drawn = _drawn_ends(strips, request)
    divided = [
        _divide_strip(curve, strip, turning, request, ends) for strip, ends in zip(strips.spans, drawn, strict=True)
    ]
    polygon, parallels = chain([strip for strip, _ in divided]), np.concatenate([own for _, own in divided])
    caps = find_caps(strips, polygon, rail, limits.min_member) if settings.pole == "cap" else Caps()
    return Divided(polygon, parallels, caps, (*_pole_notes(strips, settings), *cap_notes(caps, rail)))


def edge_offset_residual(latitude: Floats, turning: float) -> Floats:
    """How far consecutive rows of a moulding mesh are from those of an edge offset mesh (geometry §5).

    Parameters
    ----------
    latitude : (e,) float, rad
        Latitudes m of the profile edges' normals, in order.
    turning : float, rad
        The rail's constant |α|.

    Returns
    -------
    (e − 1,) float, rad
        `m_{i+1} − σ h_{i+1} − m_i − σ h_i` with σ = sign(m_{i+1} − m_i), 0 at all vertices of an edge offset
        mesh. Equal slopes share a latitude whatever they are.
    """
    step = np.where(np.abs(np.diff(latitude)) <= FLAT, 0.0, np.diff(latitude))
    return step - np.sign(step) * (half_width(latitude[:-1], turning) + half_width(latitude[1:], turning))


def vertex_parallels(polygon: CurvePolygon, lattice: KoebeLattice) -> Floats:
    """Latitudes λ (n,) of the vertices: what the two edges of a vertex share (geometry §5).

    Edge k lies between λ_k and λ_{k+1}. Edges k and k ± 1 share λ of the larger index. A flat node inside an edge may
    take either latitude of that edge, and takes the one nearer to the equator: so edges with slopes of both signs are
    divided by the same nodes. An open end takes the latitude that its edge does not share.
    """
    index = polygon.edges.index
    before, after = index[:-1], index[1:]
    inner = np.where(before == after, _nearer_to_equator(before, lattice), np.maximum(before, after))
    turns = inner[before != after]
    first, last = (turns[0], turns[-1]) if len(turns) else (index[0], index[-1] + 1)
    ends = _other_end(index[0], first), _other_end(index[-1], last)
    return lattice.latitude(np.concatenate([[ends[0]], inner, [ends[1]]]))


def _nearer_to_equator(edge: Floats, lattice: KoebeLattice) -> Floats:
    """Give the latitude index (n,) of the flatter end of edges (n,); of an edge astride the equator the lower one."""
    lower, upper = (np.abs(lattice.start + lattice.step * (edge + k)) for k in (0, 1))
    return np.where(upper < lower - FLAT, edge + 1, edge)


def _other_end(edge: float, shared: float) -> float:
    """Latitude index at the free end of an end edge, whose other end has the index `shared`."""
    return edge if shared == edge + 1 else edge + 1


def _drawn_ends(strips: Strips, request: Request) -> list[tuple[bool, bool]]:
    """Which ends of every strip are to stay: those of the drawn curve, not those that were cut near a pole."""
    last = len(strips.spans) - 1
    kept = request.divide.keep_ends
    first_stays, last_stays = (kept and not cut for cut in strips.cut)
    return [(first_stays and row == 0, last_stays and row == last) for row in range(last + 1)]


def _divide_strip(
    curve: PlanarCurve, strip: Spans, turning: float, request: Request, kept: tuple[bool, bool]
) -> tuple[CurvePolygon, Floats]:
    """Divide a stretch of the generatrix without poles; `kept` says which of its ends stay as drawn."""
    lattice = _lattice(curve, strip, turning, request)
    edges = tangent_edges(curve, strip, shared_lattices(strip, lattice), request.field)
    for last, stays in enumerate(kept):
        if stays and len(edges.index):
            edges = keep_end(curve, strip, edges, lattice, request.limits.min_member, last=bool(last))
    edges = split_at_inflections(edges) if request.treatment.flat_nodes else edges
    polygon = open_polygon(curve, strip, edges, request.limits.min_member, request.field)
    polygon = divide_long_edges(curve, polygon, request.treatment.max_edge, request.limits)
    return polygon, vertex_parallels(polygon, lattice)


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


def _pole_notes(strips: Strips, settings: SurfaceSettings) -> tuple[Note, ...]:
    if strips.whole or settings.pole == "cap":
        return ()
    text = f"nothing is built nearer than {settings.min_pole_angle_deg:g}° to a pole"
    text += f": {len(strips.spans)} strips with open ends"
    return (Note("W-GENERATRIX-POLE", "surface.pole", text),)


def _lattice(curve: PlanarCurve, strip: Spans, turning: float, request: Request) -> KoebeLattice:
    return choose_lattice(curve, strip, turning, _phase(request), request.field)


def _phase(request: Request) -> str | SlopePhase:
    divide = request.divide
    return (divide.phase if isinstance(divide, GeneratrixDivide) else None) or "centre"


def _upright(curve: PlanarCurve, field: str) -> Spans:
    """Give the spans in the branch around π/2, where normals have latitude 0; a closed curve begins there."""
    turns = smooth_spans(curve, field)
    if curve.closed:
        refuse_not_simple(float((turns.theta1 - turns.theta0).sum()), field)
        turns = from_direction(curve, turns, np.pi / 2, 1.0, field)
    middle = turns.theta0[0] if curve.closed else (turns.theta0.min() + turns.theta1.max()) / 2
    shift = 2 * np.pi * np.rint((np.pi / 2 - middle) / (2 * np.pi))
    return replace(turns, theta0=turns.theta0 + shift, theta1=turns.theta1 + shift)
