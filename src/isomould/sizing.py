"""Sizes of a design, those first that an architect asks for, and what should be known about them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from isomould.cutting import member_parts
from isomould.design import Design
from isomould.documents.figures import Figure, class_figures, count_figures, edge_figures, panel_figures
from isomould.errors import Note
from isomould.estimate import estimate
from isomould.form.assemble import RailInPlane
from isomould.measure.anisotropy import anisotropy_at_apex
from isomould.measure.evenness import evenness_notes, measure_evenness
from isomould.measure.smooth import Smooth
from isomould.nesting.settings import StockSettings
from isomould.parts.panel_sizes import PanelSizes, measure_panels, trade_notes
from isomould.parts.plates import Shape


@dataclass(frozen=True, eq=False)
class Sized:
    """Figures in the order in which they are told, and notes."""

    figures: tuple[Figure, ...]
    notes: tuple[Note, ...]


def size_design(design: Design, bodies: Sequence[Shape]) -> Sized:
    """Measure a design.

    Parameters
    ----------
    bodies
        The surface of every node class.
    """
    project, kit = design.project, design.kit
    sizes = measure_panels(kit.panels, project.panels)
    estimated = estimate(design, bodies)
    stock = project.stock or StockSettings()
    figures = (
        *panel_figures(sizes),
        *edge_figures(kit),
        *estimated.figures(),
        *_on_sheets(sizes, stock),
        *_on_bars(design, stock),
        *class_figures(kit),
        *count_figures(kit),
        *apex_figures(design),
    )
    notes = (*trade_notes(sizes, project.limits), *curvature_notes(design), *estimated.notes)
    return Sized(figures, notes)


def curvature_notes(design: Design) -> tuple[Note, ...]:
    """Note where the surface is curved too little or too unequally for its panels; rails in space have no notes."""
    if not isinstance(design.rail, RailInPlane):
        return ()
    panels = design.mesh.face_ij
    smooth = Smooth(design.rail.curve, design.generatrix, design.rail.plane)
    measured = measure_evenness(design.form, smooth, panels)
    places = (tuple(place) for place in panels.tolist())
    names = dict(zip(places, design.kit.panels.locations, strict=True))
    return tuple(evenness_notes(measured, names)) if measured else ()


def apex_figures(design: Design) -> Iterator[Figure]:
    """Say how long the highest panel is for its width, and how the radii of curvature compare there (paper, Table 4).

    A rail in space has no radii; where a curve is straight, their ratio is no number.
    """
    if not isinstance(design.rail, RailInPlane):
        return
    found = anisotropy_at_apex(design.form, Smooth(design.rail.curve, design.generatrix, design.rail.plane))
    if found is None or not np.isfinite(found.radii):
        return
    rows = np.flatnonzero((design.mesh.face_ij == found.panel).all(axis=1))
    where = design.kit.panels.locations[rows[0]] if len(rows) else ""
    yield Figure("apex_aspect", "Highest panel, L/l", found.aspect, "", where)
    yield Figure("apex_radii", "Radii of curvature there, R1/R2", found.radii, "", where)


def _on_sheets(sizes: PanelSizes, stock: StockSettings) -> Iterator[Figure]:
    """Say how much of each stock sheet's sides the largest panel takes, turned as suits it."""
    for number, sheet in enumerate(stock.sheets, start=1):
        long, short = (side - 2 * stock.trim for side in sorted((sheet.width, sheet.height), reverse=True))
        share = 100 * np.maximum(sizes.width / long, sizes.height / short)
        worst = int(np.round(share, 6).argmax())
        label = f"Largest panel on sheet {sheet.name}, of its sides"
        yield Figure(f"panel_on_sheet_{number}", label, float(share[worst]), "%", sizes.where(worst))


def _on_bars(design: Design, stock: StockSettings) -> Iterator[Figure]:
    """Say how much of each stock bar the longest member of its section takes."""
    members = member_parts(design.kit.members)
    for number, bar in enumerate(stock.bars, start=1):
        held = [member for member in members if member.section == bar.section]
        if held:
            longest = max(held, key=lambda member: round(member.length, 6))
            share = 100 * longest.length / (bar.length - 2 * stock.bar_trim)
            label = f"Longest member on bar {bar.section} x {bar.length:g}"
            yield Figure(f"member_on_bar_{number}", label, share, "%", f"{longest.id} at {longest.locations[0]}")
