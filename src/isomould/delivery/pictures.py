"""Pictures of a design, for whoever asks and for the page of its delivery."""

from collections.abc import Callable

from isomould.design import Design
from isomould.documents.building_picture import Caught, building_picture
from isomould.documents.camera import AZIMUTH_DEG, ELEVATION_DEG, Camera, make_camera
from isomould.documents.graph import curvature_picture
from isomould.documents.picture import Picture
from isomould.documents.viewing import Seen, SpaceView, View
from isomould.documents.views import counts_text, developed_picture, space_picture
from isomould.errors import Refused
from isomould.form.assemble import RailInSpace
from isomould.form.spatial import SpatialPolygon


def design_picture(design: Design, seen: Seen) -> Picture:
    """Draw a design.

    Raises
    ------
    Refused
        If the view does not suit it: strips of a ragged mesh, the curvature of a rail in space, angles of a view
        that has its own, flat drawings in the style of a building.
    """
    name, view = design.name, seen.view
    if view in ("curvature", "developed"):
        _refuse_in_space(seen)
        return _curvature(design, name) if view == "curvature" else developed_picture(design.kit, name)
    camera = _camera(view, seen)
    north = design.project.project.datum.rotation_deg
    if seen.style == "classes" and view != "section":
        return space_picture(design.kit, name, view, camera, north)
    said = Caught(name, counts_text(design.kit), north)
    return building_picture(design.kit, said, camera, cut=view == "section")


def _camera(view: SpaceView, seen: Seen) -> Camera:
    """Place the camera, which can be moved in axonometries alone."""
    asked = (seen.azimuth_deg, seen.elevation_deg)
    if view != "axonometry" and asked != (None, None):
        found, limit = f"angles of the view {view!r}", "angles of an axonometry"
        raise Refused("E-DRAW-ANGLES", "--azimuth, --elevation", found, limit, "Leave them out, or --view.")
    azimuth, elevation = (given if given is not None else usual for given, usual in zip(asked, _USUAL, strict=True))
    if not 0 <= elevation <= 90:
        way_out = "Look from the ground up to straight down."
        raise Refused("E-DRAW-ANGLES", "--elevation", f"{elevation:g}°", "from 0° to 90°", way_out)
    return make_camera(view, azimuth, elevation)


_USUAL = (AZIMUTH_DEG, ELEVATION_DEG)


def _refuse_in_space(seen: Seen) -> None:
    if seen.style == "building" or (seen.azimuth_deg, seen.elevation_deg) != (None, None):
        found, limit = f"the view {seen.view!r}", "a view of the building in space"
        raise Refused("E-DRAW-ANGLES", "--style, --azimuth, --elevation", found, limit, "Leave them out, or --view.")


def flat_pictures(design: Design) -> tuple[Picture, ...]:
    """Draw what a model to turn does not show, as far as it suits the design."""
    views: tuple[View, ...] = ("curvature", "developed")
    drawn = (_unless_refused(lambda view=view: design_picture(design, Seen(view))) for view in views)
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
