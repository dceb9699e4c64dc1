"""From two curves to the surface: orientation, division, frame, product (geometry §0–§5)."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from isomould.arrays import Floats
from isomould.curves.curve import PlanarCurve
from isomould.curves.plane import Plane
from isomould.curves.space_curve import SpatialCurve
from isomould.errors import Attempt, Gathering, Note, Refused
from isomould.form.crossing import overhang_notes, refuse_crossing, refuse_crossing_parallels
from isomould.form.division import Request, divide_curve
from isomould.form.edge_offset import Divided, divide_for_edge_offset
from isomould.form.expected_size import refuse_expected_size
from isomould.form.frame import refuse_twist, spatial_rail
from isomould.form.lattice import half_width
from isomould.form.polygon import FLAT, CurvePolygon
from isomould.form.profile import Caps, make_profile
from isomould.form.rail import Rail, planar_rail
from isomould.form.settings import Ends, SurfaceSettings
from isomould.form.size_limit import refuse_size
from isomould.form.spatial import SpatialPolygon, divide_in_space
from isomould.form.surface import Surface, make_surface, parallel_lengths, refuse_flips
from isomould.form.survey import division_notes

_COARSE_DEG, _ROUNDING_DEG = 30.0, 1e-9
"""A rail that turns by more at a node is noted (failure mode B9); twelve nodes round a circle turn by 30°."""


class RailInPlane(NamedTuple):
    """A rail's oriented curve, the plane that it lies in, and its open ends (None: as the kind has them)."""

    curve: PlanarCurve
    plane: Plane
    ends: Ends | None


class RailInSpace(NamedTuple):
    """A rail's curve in space, and the direction (3,) that the first edge's W is nearest to."""

    curve: SpatialCurve
    up: Floats


@dataclass(frozen=True, eq=False)
class Form:
    """The surface and the two polygons that it is made of, with what should be known about them."""

    surface: Surface
    rail: CurvePolygon | SpatialPolygon
    generatrix: CurvePolygon
    notes: tuple[Note, ...]


def make_form(
    drawn: RailInPlane | RailInSpace,
    generatrix_curve: PlanarCurve,
    requests: tuple[Request, Request],
    settings: SurfaceSettings,
    depth: float,
) -> Form:
    """Divide both curves and multiply them out.

    Parameters
    ----------
    drawn
        The rail.
    generatrix_curve
        In coordinates (d, z), its outside to the right.
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
    refuse_expected_size(drawn.curve, generatrix_curve, requests)
    with Gathering() as faults:
        rail_divided = faults.run(divide_rail, drawn, rail_request, settings)
        divided = faults.run(divide_generatrix, generatrix_curve, rail_divided, generatrix_request, settings)
        for polygon, request in ((rail_divided, rail_request), (divided, generatrix_request)):
            faults.run(_refuse_deviation, polygon, request)
    (rail, frame), (generatrix, parallels, caps, pole_notes) = rail_divided.value, divided.value
    rows = int(np.count_nonzero(~generatrix.gap)) + len(caps.rows)
    refuse_size(len(rail.lengths) * rows + len(caps.lids), rail_request.limits)
    surface = make_surface(frame, make_profile(generatrix, parallels, caps))
    seam_notes = refuse_twist(frame, surface.profile)
    refuse_flips(surface, depth, rail_request.limits.min_member)
    _refuse_crossings(rail, generatrix, surface)
    hanging = () if generatrix_curve.closed else overhang_notes(surface.profile)  # what is closed hangs over by nature
    long = _long_notes(surface, rail_request)
    notes = (*_turning_notes(rail), *hanging, *pole_notes, *_sagitta_notes(rail), *seam_notes, *long)
    if settings.kind == "edge-offset" and isinstance(rail, CurvePolygon):
        notes += _flat_notes(rail, surface, depth)
    if isinstance(rail, CurvePolygon):
        notes += division_notes(rail, rail_request)
    return Form(surface, rail, generatrix, (*notes, *division_notes(generatrix, generatrix_request)))


DividedRail = tuple[CurvePolygon | SpatialPolygon, Rail]
"""The rail's polygon, and the frame along it."""


def divide_rail(drawn: RailInPlane | RailInSpace, request: Request, settings: SurfaceSettings) -> DividedRail:
    """Divide the rail and carry its frame.

    Raises
    ------
    Refused
        If the rail cannot be divided so.
    """
    if isinstance(drawn, RailInSpace):
        polygon = divide_in_space(drawn.curve, request)
        return polygon, spatial_rail(polygon, drawn.up)
    polygon = divide_curve(drawn.curve, request)
    _hold_to_one_angle(polygon, settings)
    ends = drawn.ends or ("mitred" if settings.kind == "edge-offset" else "square")
    return polygon, planar_rail(polygon, drawn.plane, ends)


def divide_generatrix(
    curve: PlanarCurve, rail: Attempt[DividedRail], request: Request, settings: SurfaceSettings
) -> Divided:
    """Divide the generatrix; only the slopes of edge offset meshes need the rail, whose angle decides them.

    Raises
    ------
    Refused
        If the generatrix cannot be divided so.
    """
    if settings.kind != "edge-offset":
        return Divided(divide_curve(curve, request), None, Caps(), ())
    polygon, _ = rail.value
    if isinstance(polygon, SpatialPolygon):
        return Divided(divide_curve(curve, request), None, Caps(), ())
    return divide_for_edge_offset(curve, polygon, settings, request)


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


def _refuse_deviation(divided: Attempt[DividedRail] | Attempt[Divided], request: Request) -> None:
    polygon, limit = divided.value[0], request.limits.max_deviation
    if limit is not None and polygon.deviation > limit:
        raise Refused(
            "E-DEVIATION",
            f"{request.field}.divide",
            f"the polygon lies up to {polygon.deviation:.3f} mm off the curve",
            f"tolerances.max_deviation = {limit:g} mm",
            "Divide the curve into more nodes, or raise the limit.",
        )


def _refuse_crossings(rail: CurvePolygon | SpatialPolygon, generatrix: CurvePolygon, surface: Surface) -> None:
    """Refuse rails, profiles and parallels that cross themselves (failure modes B6, C5); in space the profile only."""
    refuse_crossing(generatrix.vertices, generatrix.closed, "generatrix")
    if isinstance(rail, SpatialPolygon):
        return
    refuse_crossing(rail.vertices, rail.closed, "rail")
    frame = surface.rail
    axes = np.stack([frame.directions[0], frame.outward[0]])
    mitre, base = frame.A @ axes.T, frame.R @ axes.T
    parallels = base + np.multiply.outer(surface.profile.d, mitre)
    refuse_crossing_parallels(parallels, rail.closed)


def _turning_notes(rail: CurvePolygon | SpatialPolygon) -> tuple[Note, ...]:
    steepest = float(np.degrees(np.nan_to_num(np.abs(rail.turning)).max()))
    if steepest <= _COARSE_DEG + _ROUNDING_DEG:
        return ()
    return (
        Note(
            "W-RAIL-COARSE", "rail.divide", f"the rail turns by {steepest:.2f}° at a node, more than {_COARSE_DEG:g}°"
        ),
    )


def _long_notes(surface: Surface, request: Request) -> tuple[Note, ...]:
    """Say which parallels are longer than the rail's `max_edge`: it holds on the rail, and they lie beside it."""
    limit = request.treatment.max_edge
    if limit is None:
        return ()
    offsets = np.column_stack([surface.profile.d, surface.profile.z])
    lengths = parallel_lengths(surface.rail, offsets)
    count = int(np.count_nonzero(lengths > limit + request.limits.same_length))
    text = f"{count} edges of parallels outside the rail are longer than {limit:g} mm, up to {lengths.max():.1f} mm"
    return (Note("W-CURVE-LONG", f"{request.field}.max_edge", text),) if count else ()


def _flat_notes(rail: CurvePolygon, surface: Surface, depth: float) -> tuple[Note, ...]:
    """Say what flat rail nodes cost: at them parallels run square to the node axis, generatrices do not."""
    flat = int(np.count_nonzero(np.abs(np.nan_to_num(rail.turning, nan=1.0)) <= FLAT))
    if flat == 0:
        return ()
    rise = float(half_width(surface.profile.latitude[~surface.profile.gap], rail.angle or 0.0).max())
    cost = depth / 2 * (1 / np.cos(rise) - 1)
    text = f"{flat} flat rail nodes: their beams do not meet exactly, but up to {cost:.3f} mm apart"
    return (Note("W-RAIL-FLAT", "rail.flat_nodes", text),)


def _sagitta_notes(rail: CurvePolygon | SpatialPolygon) -> tuple[Note, ...]:
    """Say how far the chords leave a rail in space: its tangents do not meet (geometry §3)."""
    if not isinstance(rail, SpatialPolygon) or rail.deviation == 0.0:
        return ()
    return (Note("W-RAIL-SAGITTA", "rail.divide", f"the rail's chords leave it by up to {rail.deviation:.3f} mm"),)
