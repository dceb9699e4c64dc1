"""From a project to its parts: curves, form, kit, in this order. No files are written."""

from dataclasses import dataclass
from pathlib import Path
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from isomould.arrays import Floats, read_only
from isomould.curves.curve import PlanarCurve
from isomould.curves.local_curves import build_local_curve
from isomould.curves.origins import REMOTE
from isomould.curves.plane import Plane, build_plane
from isomould.curves.spatial_settings import build_spatial_curve
from isomould.errors import Attempt, Gathering, Note, Refused
from isomould.form.assemble import (
    Form,
    RailInPlane,
    RailInSpace,
    divide_generatrix,
    divide_rail,
    make_form,
)
from isomould.form.clash import refuse_clashes
from isomould.form.division import Request
from isomould.form.fitting import fit_curve
from isomould.form.mesh import Mesh, make_mesh
from isomould.form.orientation import orient_rail, place_generatrix
from isomould.form.settings import FormLimits, Treatment
from isomould.form.slivers import weigh_panels
from isomould.form.trim import make_cut, trim_mesh
from isomould.measure.offsets import DoubleLayer, make_double_layer
from isomould.measure.trim_cost import trim_cost_notes
from isomould.parts.kit import Kit, KitSettings, TriedKit, try_kit
from isomould.parts.settings import CongruenceSettings
from isomould.project.schema import GeneratrixTable, Project, RailTable
from isomould.project.site import on_site, site_notes, site_of

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Design:
    """A project with its curves, surface and parts, and what should be known about them."""

    project: Project
    rail: RailInPlane | RailInSpace
    generatrix: PlanarCurve
    form: Form
    kit: Kit
    notes: tuple[Note, ...]
    layers: DoubleLayer | None = None

    @property
    def name(self) -> str:
        """The name of the project, of which every shape has its own."""
        return self.project.project.name

    @property
    def mesh(self) -> Mesh:
        """The mesh of which the parts are made, trimmed."""
        return self.kit.mesh


def make_design(project: Project, folder: Path) -> Design:
    """Compute a design; `folder` is where the project's file references start.

    Raises
    ------
    Refused
        If the project asks for something that cannot be made.
    """
    with Gathering() as faults:
        return try_design(project, folder, faults).design


@dataclass(frozen=True, eq=False)
class Sketch:
    """What is known of a design before its parts: curves, surface, mesh, and what should be known about them."""

    rail: RailInPlane | RailInSpace
    generatrix: PlanarCurve
    form: Form
    mesh: Mesh
    notes: tuple[Note, ...]
    project: Project
    """Its frame near the rail."""


@dataclass(frozen=True, eq=False)
class TriedDesign:
    """A design as far as it can be made."""

    project: Project
    sketch: Attempt[Sketch]
    parts: Attempt[TriedKit]
    layers: Attempt[DoubleLayer | None]

    @property
    def design(self) -> Design:
        """The design, if all of it can be made.

        Raises
        ------
        Refused
            The first that ended a stage.
        """
        drawn, kit, layers = self.sketch.value, self.parts.value.kit, self.layers.value
        cost = _trim_cost(drawn.project, drawn.form, kit)
        notes = (*drawn.notes, *kit.notes, *cost, *(layers.notes if layers else ()))
        return Design(drawn.project, drawn.rail, drawn.generatrix, drawn.form, kit, notes, layers)


def try_design(project: Project, folder: Path, faults: Gathering) -> TriedDesign:
    """Compute a design as far as it can be made; `faults` gathers what ends the rest."""
    drawn = try_sketch(project, folder, faults)
    parts = faults.run(lambda: try_kit(drawn.value.mesh, kit_settings(drawn.value.project), faults))
    layers = faults.run(lambda: _double_layer(drawn.value.form, project))
    return TriedDesign(project, drawn, parts, layers)


def sketch(project: Project, folder: Path) -> Sketch:
    """Compute curves, surface and mesh; `folder` is where the project's file references start.

    Raises
    ------
    Refused
        If the surface cannot be made.
    """
    with Gathering() as faults:
        return try_sketch(project, folder, faults).value


def try_sketch(project: Project, folder: Path, faults: Gathering) -> Attempt[Sketch]:
    """Compute curves, surface and mesh as far as they can be made; `faults` gathers what ends the rest."""
    rail, generatrix = _try_curves(project, folder, faults)
    if rail.refused or generatrix.refused:
        _try_divisions(project, rail, generatrix, faults)
    requests, depth = requests_of(project), project.members.section.depth
    form = faults.run(lambda: make_form(rail.value.curve, generatrix.value.curve, requests, project.surface, depth))
    placed = faults.run(lambda: on_site(project, rail.value.site))
    trimmed = faults.run(
        lambda: trim_mesh(make_mesh(form.value.surface), placed.value.surface, project.tolerances.min_member)
    )
    slivers = faults.run(lambda: weigh_panels(trimmed.value[0]))
    faults.run(lambda: refuse_clashes(trimmed.value[0], depth))
    mesh = faults.run(lambda: _Made(*trimmed.value, slivers.value))
    return faults.run(lambda: _sketched(placed.value, rail.value, generatrix.value, form.value, mesh.value))


class _Drawn(NamedTuple, Generic[T]):
    """A curve in its place, what should be known about it, and the origin (3,) mm that it is measured from."""

    curve: T
    notes: tuple[Note, ...]
    site: Floats


class _Made(NamedTuple):
    """A trimmed mesh, and what should be known about the trimming and the panels."""

    mesh: Mesh
    trim_notes: tuple[Note, ...]
    panel_notes: tuple[Note, ...]


_Rail = _Drawn[RailInPlane | RailInSpace]
_Generatrix = _Drawn[PlanarCurve]


def _sketched(project: Project, rail: _Rail, generatrix: _Generatrix, form: Form, made: _Made) -> Sketch:
    placed = site_notes(project, rail.site)
    notes = (*rail.notes, *placed, *generatrix.notes, *form.notes, *made.trim_notes, *made.panel_notes)
    return Sketch(rail.curve, generatrix.curve, form, made.mesh, notes, project)


def try_curves(project: Project, folder: Path, faults: Gathering) -> None:
    """Draw and divide both curves, each by itself, to see what ends that."""
    _try_divisions(project, *_try_curves(project, folder, faults), faults)


def _try_curves(project: Project, folder: Path, faults: Gathering) -> tuple[Attempt[_Rail], Attempt[_Generatrix]]:
    requests = requests_of(project)
    rail = faults.run(_rail, project.rail, requests[0], folder)
    return rail, faults.run(_generatrix, project.generatrix, requests[1], folder)


def _try_divisions(project: Project, rail: Attempt[_Rail], generatrix: Attempt[_Generatrix], faults: Gathering) -> None:
    requests = requests_of(project)
    divided = faults.run(lambda: divide_rail(rail.value.curve, requests[0], project.surface))
    faults.run(lambda: divide_generatrix(generatrix.value.curve, divided, requests[1], project.surface))


def _double_layer(form: Form, project: Project) -> DoubleLayer | None:
    asked = project.deliver.double_layer
    if asked is None:
        return None
    if project.surface.trim or not form.surface.profile.whole:
        raise Refused(
            "E-LAYER-WHOLE",
            "deliver.double_layer",
            "a trimmed surface or one with a gap or cap at a pole",
            "a whole surface",
            "Leave double_layer out, or surface.trim.",
        )
    return make_double_layer(form, asked.offset, asked.distance)


def _trim_cost(project: Project, form: Form, kit: Kit) -> tuple[Note, ...]:
    """Say what the planes of a trimmed surface cost."""
    return trim_cost_notes(form, kit, kit_settings(project).tolerance) if project.surface.trim else ()


def kit_settings(project: Project) -> KitSettings:
    """Gather what the parts need to know."""
    tolerance = CongruenceSettings(length=project.tolerances.length, angle_deg=project.tolerances.angle_deg)
    cuts = tuple(make_cut(table, number) for number, table in enumerate(project.surface.trim))
    return KitSettings(project.members, project.nodes, project.panels, tolerance, cuts)


def requests_of(project: Project) -> tuple[Request, Request]:
    """Say how rail and generatrix are to be divided."""
    return division_request("rail", project), division_request("generatrix", project)


def _rail(table: RailTable, request: Request, folder: Path) -> _Rail:
    if table.up is not None:
        spatial = build_spatial_curve(table.curve, folder, "rail.curve")
        return _Drawn(RailInSpace(spatial.curve, np.array(table.up)), spatial.notes, spatial.origin)
    plane = build_plane(table.plane, "rail.plane")
    fitted, fit_notes = fit_curve(table.curve, request)
    local = build_local_curve(fitted, folder, plane, "rail.curve")
    # the plane's origin goes to the curve's, and then the project's origin near both
    place = plane.origin + local.origin @ np.stack([plane.x_axis, plane.y_axis])
    site = site_of(place)
    near = Plane(read_only(place - site), plane.x_axis, plane.y_axis)
    drawn = RailInPlane(orient_rail(local.curve, table.outside or (0.0, 0.0)), near, table.ends)
    return _Drawn(drawn, (*local.notes, *fit_notes), site)


def _generatrix(table: GeneratrixTable, request: Request, folder: Path) -> _Generatrix:
    fitted, fit_notes = fit_curve(table.curve, request)
    local = build_local_curve(fitted, folder, None, "generatrix.curve")
    drawn_at = local.origin if table.axes == "dz" else local.origin[::-1]
    at = np.array(table.origin) + drawn_at
    _refuse_remote(at, -drawn_at)
    placed = place_generatrix(local.curve, (float(at[0]), float(at[1])), table.axes, table.outside)
    return _Drawn(placed, (*local.notes, *fit_notes), np.zeros(3))


def _refuse_remote(at: Floats, wanted: Floats) -> None:
    """Refuse a generatrix whose place beside the rail nobody said: it was drawn somewhere on a map."""
    if np.abs(at).max() > REMOTE:
        found = f"a generatrix drawn {np.abs(at).max() / 1e6:.0f} km from the rail"
        corner = ", ".join(f'"{value / 1000:.0f} m"' for value in wanted)
        way_out = f"Set generatrix.origin, such as [{corner}] for the corner of what was drawn, or draw it near 0, 0."
        raise Refused("E-GENERATRIX-REMOTE", "generatrix.origin", found, "10 km", way_out)


def division_request(field: str, project: Project) -> Request:
    """Give what dividing the rail or the generatrix (`field`) needs, as the project says it."""
    table = project.rail if field == "rail" else project.generatrix
    limits = FormLimits(
        min_member=project.tolerances.min_member,
        same_length=project.tolerances.length,
        max_deviation=project.tolerances.max_deviation,
        max_turning_deg=project.tolerances.max_turning_deg,
        max_panels=project.limits.max_panels,
    )
    treatment = Treatment(inflections=table.inflections, flat_nodes=table.flat_nodes, max_edge=table.max_edge)
    return Request(field, table.divide, treatment, limits)
