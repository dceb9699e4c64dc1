"""From a project to its parts: curves, form, kit, in this order. No files are written."""

from dataclasses import dataclass
from pathlib import Path

from isomould.curves.curve import PlanarCurve
from isomould.curves.plane import Plane, build_plane
from isomould.curves.settings import build_curve
from isomould.errors import Note
from isomould.form.assemble import Form, make_form
from isomould.form.division import Request
from isomould.form.mesh import make_mesh
from isomould.form.orientation import orient_rail, place_generatrix
from isomould.form.settings import FormLimits, Treatment
from isomould.measure.offsets import DoubleLayer, make_double_layer
from isomould.parts.kit import Kit, KitSettings, make_kit
from isomould.parts.settings import CongruenceSettings
from isomould.project.schema import GeneratrixTable, Project, RailTable


@dataclass(frozen=True, eq=False)
class Design:
    """A project with its curves, surface and parts, and what should be known about them."""

    project: Project
    plane: Plane
    rail: PlanarCurve
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
    plane, rail, rail_notes = _rail(project.rail, folder)
    generatrix, generatrix_notes = _generatrix(project.generatrix, folder)
    form = make_form(
        rail,
        generatrix,
        plane,
        project.rail.ends,
        (division_request("rail", project), division_request("generatrix", project)),
        project.surface,
        project.members.section.depth,
    )
    kit = make_kit(make_mesh(form.surface), kit_settings(project))
    layers = _double_layer(form, project)
    notes = (*rail_notes, *generatrix_notes, *form.notes, *kit.notes, *(layers.notes if layers else ()))
    return Design(project, plane, rail, generatrix, form, kit, notes, layers)


def _double_layer(form: Form, project: Project) -> DoubleLayer | None:
    asked = project.deliver.double_layer
    return None if asked is None else make_double_layer(form, asked.offset, asked.distance)


def kit_settings(project: Project) -> KitSettings:
    """Gather what the parts need to know."""
    tolerance = CongruenceSettings(length=project.tolerances.length, angle_deg=project.tolerances.angle_deg)
    return KitSettings(project.members, project.nodes, project.panels, tolerance)


def _rail(table: RailTable, folder: Path) -> tuple[Plane, PlanarCurve, tuple[Note, ...]]:
    plane = build_plane(table.plane, "rail.plane")
    curve, notes = build_curve(table.curve, folder, plane, "rail.curve")
    return plane, orient_rail(curve, table.outside), notes


def _generatrix(table: GeneratrixTable, folder: Path) -> tuple[PlanarCurve, tuple[Note, ...]]:
    curve, notes = build_curve(table.curve, folder, None, "generatrix.curve")
    return place_generatrix(curve, table.origin, table.axes, table.outside), notes


def division_request(field: str, project: Project) -> Request:
    """Give what dividing the rail or the generatrix (`field`) needs, as the project says it."""
    table = project.rail if field == "rail" else project.generatrix
    limits = FormLimits(
        min_member=project.tolerances.min_member,
        max_deviation=project.tolerances.max_deviation,
        max_turning_deg=project.tolerances.max_turning_deg,
        max_panels=project.limits.max_panels,
    )
    return Request(field, table.divide, Treatment(inflections=table.inflections, flat_nodes=table.flat_nodes), limits)
