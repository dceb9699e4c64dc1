"""From a project to its parts: curves, form, kit, in this order. No files are written."""

from dataclasses import dataclass
from pathlib import Path
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from isomould.curves.construction import build_curve
from isomould.curves.curve import PlanarCurve
from isomould.curves.plane import build_plane
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
        cost = _trim_cost(self.project, drawn.form, kit)
        notes = (*drawn.notes, *kit.notes, *cost, *(layers.notes if layers else ()))
        return Design(self.project, drawn.rail, drawn.generatrix, drawn.form, kit, notes, layers)


def try_design(project: Project, folder: Path, faults: Gathering) -> TriedDesign:
    """Compute a design as far as it can be made; `faults` gathers what ends the rest."""
    drawn = try_sketch(project, folder, faults)
    parts = faults.run(lambda: try_kit(drawn.value.mesh, kit_settings(project), faults))
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
    trimmed = faults.run(
        lambda: trim_mesh(make_mesh(form.value.surface), project.surface, project.tolerances.min_member)
    )
    slivers = faults.run(lambda: weigh_panels(trimmed.value[0]))
    faults.run(lambda: refuse_clashes(trimmed.value[0], depth))
    return faults.run(lambda: _sketched(rail.value, generatrix.value, form.value, trimmed.value, slivers.value))


class _Drawn(NamedTuple, Generic[T]):
    """A curve in its place, and what should be known about it."""

    curve: T
    notes: tuple[Note, ...]


_Rail = _Drawn[RailInPlane | RailInSpace]
_Generatrix = _Drawn[PlanarCurve]


def _sketched(
    rail: _Rail,
    generatrix: _Generatrix,
    form: Form,
    trimmed: tuple[Mesh, tuple[Note, ...]],
    panel_notes: tuple[Note, ...],
) -> Sketch:
    mesh, trim_notes = trimmed
    notes = (*rail.notes, *generatrix.notes, *form.notes, *trim_notes, *panel_notes)
    return Sketch(rail.curve, generatrix.curve, form, mesh, notes)


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
        spatial, notes = build_spatial_curve(table.curve, folder, "rail.curve")
        return _Drawn(RailInSpace(spatial, np.array(table.up)), notes)
    plane = build_plane(table.plane, "rail.plane")
    fitted, fit_notes = fit_curve(table.curve, request)
    curve, notes = build_curve(fitted, folder, plane, "rail.curve")
    drawn = RailInPlane(orient_rail(curve, table.outside or (0.0, 0.0)), plane, table.ends)
    return _Drawn(drawn, (*notes, *fit_notes))


def _generatrix(table: GeneratrixTable, request: Request, folder: Path) -> _Generatrix:
    fitted, fit_notes = fit_curve(table.curve, request)
    curve, notes = build_curve(fitted, folder, None, "generatrix.curve")
    placed = place_generatrix(curve, table.origin, table.axes, table.outside)
    return _Drawn(placed, (*notes, *fit_notes))


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
