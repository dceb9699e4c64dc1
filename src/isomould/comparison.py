"""One design as every mesh family: the same rail, generatrix and counts (paper Tables 1 and 5)."""

from collections.abc import Callable
from dataclasses import astuple, dataclass, fields

import numpy as np

from isomould.design import Design, division_request, kit_settings
from isomould.documents.table import Table, make_table
from isomould.errors import Refused
from isomould.form.assemble import Form, RailInPlane, RailInSpace, make_form
from isomould.form.division import Request
from isomould.form.mesh import Mesh, make_mesh
from isomould.form.settings import GeneratrixDivide, Kind, RailDivide, SurfaceSettings
from isomould.measure.families import scale_trans, triangulated
from isomould.measure.report import Measured, measure_mesh
from isomould.measure.smooth import Smooth
from isomould.measure.take_off import TakeOff, take_off
from isomould.parts.arms import find_arms
from isomould.project.schema import Project


@dataclass(frozen=True)
class Compared:
    """A mesh family, measured and taken off; or why the design has no such mesh."""

    family: str
    measured: Measured | None
    reason: str
    taken: TakeOff | None = None


def compare_families(design: Design) -> tuple[Compared, ...]:
    """Build the design's surface as every mesh family and measure them all alike.

    Parallels and generatrices are as many as the design has; where the angles decide it, as near as they admit. They
    are the curvature lines of the surface (paper §3.1): divided into equal lengths, and made exact by mitres, they
    are its planar and conical mesh.
    """
    rail = _planar(design)
    smooth = Smooth(rail.curve, design.generatrix, rail.plane)
    edges = len(design.form.rail.lengths), len(design.form.generatrix.lengths)
    makers: dict[str, Callable[[], Mesh]] = {
        "triangulated": lambda: triangulated(smooth, edges),
        "scale-trans": lambda: scale_trans(smooth, edges),
        "pq-conical": lambda: _moulding(design, "moulding"),
        "isogonal": lambda: _moulding(design, "isogonal"),
        "edge-offset": lambda: _moulding(design, "edge-offset"),
    }
    return tuple(_measured(family, make, smooth, design) for family, make in makers.items())


def planar_rail_of(rail: RailInPlane | RailInSpace, form: Form, project: Project) -> RailInPlane:
    """Hold a design to what all families can be made of: a planar rail, no gap at a pole, nothing trimmed.

    Raises
    ------
    Refused
        E-COMPARE, if it has none of all that.
    """
    whole = form.surface.profile.whole and not project.surface.trim
    if isinstance(rail, RailInPlane) and whole:
        return rail
    raise Refused(
        "E-COMPARE",
        "surface",
        "a rail in space, a gap or cap at a pole or a trimmed surface",
        "a planar rail and a whole surface, from which every mesh family can be made",
        "Compare without surface.trim, or with a planar rail.",
    )


def families_table(compared: tuple[Compared, ...]) -> Table:
    """Give the table of a comparison: one row per family, blanks for what a family does not have."""
    names = [field.name for field in fields(Measured)]
    rows = [[None] * len(names) if c.measured is None else _row(c.measured) for c in compared]
    data = {_COLUMNS.get(name, name): [row[k] for row in rows] for k, name in enumerate(names)}
    heads = {"family": [c.family for c in compared]}
    return make_table("families", {**heads, **data, "reason": [c.reason for c in compared]})


_COLUMNS = {
    "nodes": "nodes_count",
    "members": "members_count",
    "panels": "panels_count",
    "interior": "interior_node_classes",
    "shortest": "shortest_mm",
    "longest": "longest_mm",
    "spread": "length_spread_percent",
    "planarity": "planarity_mm",
    "conical": "conical_deg",
    "circular": "circular_deg",
    "cone": "cone_spread_deg",
    "mismatch": "mismatch_mm",
    "torsion": "torsion_deg",
    "deviation": "deviation_mm",
    "levels": "horizontal_parallels",
}
"""Columns of the measures that are named otherwise here, with their units."""


def _row(measured: Measured) -> list[float | int | None]:
    factor = {"deg": 180 / np.pi, "percent": 100.0}
    names = [_COLUMNS.get(field.name, field.name) for field in fields(Measured)]
    scaled = [
        value * factor[name.rpartition("_")[2]] if name.rpartition("_")[2] in factor else value
        for name, value in zip(names, astuple(measured), strict=True)
    ]
    return [None if np.isnan(value) else value for value in scaled]


def _measured(family: str, make: Callable[[], Mesh], smooth: Smooth, design: Design) -> Compared:
    try:
        mesh = make()
    except Refused as refused:
        return Compared(family, None, str(refused))
    depth, tolerance = design.project.members.section.depth, kit_settings(design.project).tolerance
    return Compared(family, measure_mesh(mesh, smooth, depth, tolerance), "", take_off(mesh, find_arms(mesh)))


def _moulding(design: Design, kind: Kind) -> Mesh:
    """Give the design's own curves divided for a kind; the project's own division where it fits the kind."""
    project = design.project
    requests = _rail_request(design, kind), _generatrix_request(design, kind)
    surface = SurfaceSettings(kind=kind, min_pole_angle_deg=project.surface.min_pole_angle_deg)
    ends = None if kind == "edge-offset" != project.surface.kind else project.rail.ends
    rail = _planar(design)._replace(ends=ends)
    form = make_form(rail, design.generatrix, requests, surface, project.members.section.depth)
    return make_mesh(form.surface)


def _rail_request(design: Design, kind: Kind) -> Request:
    own, count = division_request("rail", design.project), len(design.form.rail.lengths)
    if kind == "moulding":
        return _divided(own, RailDivide(stations=count))
    angles = own.divide.nodes is not None or own.divide.angle_deg is not None
    return own if angles else _divided(own, RailDivide(nodes=_inner(count, _planar(design).curve.closed)))


def _generatrix_request(design: Design, kind: Kind) -> Request:
    own, count = division_request("generatrix", design.project), len(design.form.generatrix.edges.index)
    if kind == "moulding":
        return _divided(own, GeneratrixDivide(stations=count))
    if kind == "edge-offset":
        fits = design.project.surface.kind == "edge-offset"
        return own if fits else _divided(own, GeneratrixDivide(phase="centre"))
    fits = design.project.surface.kind == "isogonal" and own.divide.stations is None
    return own if fits else _divided(own, GeneratrixDivide(nodes=_inner(count, design.generatrix.closed)))


def _inner(edges: int, closed: bool) -> int:
    """Nodes that give so many edges: all of a closed curve, the inner ones of an open one."""
    return edges if closed else max(edges - 1, 1)


def _planar(design: Design) -> RailInPlane:
    return planar_rail_of(design.rail, design.form, design.project)


def _divided(own: Request, divide: RailDivide | GeneratrixDivide) -> Request:
    """Divide another way, without the limit on the deviation, which is measured here."""
    limits = own.limits.model_copy(update={"max_deviation": None})
    treatment = own.treatment.model_copy(update={"max_edge": None})  # the counts have its flat nodes already
    return Request(own.field, divide, treatment, limits)
