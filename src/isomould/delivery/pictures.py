"""Pictures of a design, for whoever asks and for the page of its delivery."""

from collections.abc import Callable
from typing import Literal

from isomould.design import Design
from isomould.documents.graph import curvature_picture
from isomould.documents.picture import Picture
from isomould.documents.views import SpaceView, developed_picture, space_picture
from isomould.errors import Refused
from isomould.form.assemble import RailInSpace
from isomould.form.spatial import SpatialPolygon

View = SpaceView | Literal["developed", "curvature"]


def design_picture(design: Design, view: View) -> Picture:
    """Draw a design.

    Raises
    ------
    Refused
        If the view does not suit it: strips of a ragged mesh, the curvature of a rail in space.
    """
    name = design.project.project.name
    if view == "curvature":
        return _curvature(design, name)
    return developed_picture(design.kit, name) if view == "developed" else space_picture(design.kit, name, view)


def flat_pictures(design: Design) -> tuple[Picture, ...]:
    """Draw what a model to turn does not show, as far as it suits the design."""
    views: tuple[View, ...] = ("curvature", "developed")
    drawn = (_unless_refused(lambda view=view: design_picture(design, view)) for view in views)
    return tuple(picture for picture in drawn if picture is not None)


def _unless_refused(draw: Callable[[], Picture]) -> Picture | None:
    try:
        return draw()
    except Refused:
        return None


def _curvature(design: Design, name: str) -> Picture:
    if isinstance(design.rail, RailInSpace) or isinstance(design.form.rail, SpatialPolygon):
        raise Refused("E-DRAW-VIEW", "--view", "curvature of a rail in space", "a planar rail", "Choose another view.")
    return curvature_picture(design.rail.curve, design.form.rail, name)
