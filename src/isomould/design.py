"""From a project to its parts: curves, form, kit, in this order. No files are written."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from isomould.curves.curve import PlanarCurve
from isomould.curves.plane import build_plane
from isomould.curves.settings import build_curve
from isomould.curves.spatial_settings import build_spatial_curve
from isomould.errors import Note, Refused
from isomould.form.assemble import Form, RailInPlane, RailInSpace, make_form
from isomould.form.clash import refuse_clashes
from isomould.form.division import Request
from isomould.form.fitting import fit_curve
from isomould.form.mesh import Mesh, make_mesh
from isomould.form.orientation import orient_rail, place_generatrix
from isomould.form.settings import FormLimits, Treatment
from isomould.form.slivers import weigh_panels
from isomould.form.trim import make_cut, trim_mesh
from isomould.measure.offsets import DoubleLayer, make_double_layer
from isomould.parts.kit import Kit, KitSettings, make_kit
from isomould.parts.settings import CongruenceSettings
from isomould.project.schema import GeneratrixTable, Project, RailTable


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


def make_design(project: Project, folder: Path) -> Design:
    """Compute a design; `folder` is where the project's file references start.

    Raises
    ------
    Refused
        If the project asks for something that cannot be made.
    """
    drawn = sketch(project, folder)
    kit = make_kit(drawn.mesh, kit_settings(project))
    layers = _double_layer(drawn.form, project)
    notes = (*drawn.notes, *kit.notes, *(layers.notes if layers else ()))
    return Design(project, drawn.rail, drawn.generatrix, drawn.form, kit, notes, layers)


@dataclass(frozen=True, eq=False)
class Sketch:
    """What is known of a design before its parts: curves, surface, mesh, and what should be known about them."""

    rail: RailInPlane | RailInSpace
    generatrix: PlanarCurve
    form: Form
    mesh: Mesh
    notes: tuple[Note, ...]


def sketch(project: Project, folder: Path) -> Sketch:
    """Compute curves, surface and mesh; `folder` is where the project's file references start.

    Raises
    ------
    Refused
        If the surface cannot be made.
    """
    requests = requests_of(project)
    rail, rail_notes = _rail(project.rail, requests[0], folder)
    generatrix, generatrix_notes = _generatrix(project.generatrix, requests[1], folder)
    form = make_form(rail, generatrix, requests, project.surface, project.members.section.depth)
    mesh, trim_notes = trim_mesh(make_mesh(form.surface), project.surface, project.tolerances.min_member)
    panel_notes = weigh_panels(mesh)
    refuse_clashes(mesh, project.members.section.depth)
    notes = (*rail_notes, *generatrix_notes, *form.notes, *trim_notes, *panel_notes)
    return Sketch(rail, generatrix, form, mesh, notes)


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


def kit_settings(project: Project) -> KitSettings:
    """Gather what the parts need to know."""
    tolerance = CongruenceSettings(length=project.tolerances.length, angle_deg=project.tolerances.angle_deg)
    cuts = tuple(make_cut(table, number) for number, table in enumerate(project.surface.trim))
    return KitSettings(project.members, project.nodes, project.panels, tolerance, cuts)


def requests_of(project: Project) -> tuple[Request, Request]:
    """Say how rail and generatrix are to be divided."""
    return division_request("rail", project), division_request("generatrix", project)


def _rail(table: RailTable, request: Request, folder: Path) -> tuple[RailInPlane | RailInSpace, tuple[Note, ...]]:
    if table.up is not None:
        spatial, notes = build_spatial_curve(table.curve, folder, "rail.curve")
        return RailInSpace(spatial, np.array(table.up)), notes
    plane = build_plane(table.plane, "rail.plane")
    fitted, fit_notes = fit_curve(table.curve, request)
    curve, notes = build_curve(fitted, folder, plane, "rail.curve")
    drawn = RailInPlane(orient_rail(curve, table.outside or (0.0, 0.0)), plane, table.ends)
    return drawn, (*notes, *fit_notes)


def _generatrix(table: GeneratrixTable, request: Request, folder: Path) -> tuple[PlanarCurve, tuple[Note, ...]]:
    fitted, fit_notes = fit_curve(table.curve, request)
    curve, notes = build_curve(fitted, folder, None, "generatrix.curve")
    return place_generatrix(curve, table.origin, table.axes, table.outside), (*notes, *fit_notes)


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
