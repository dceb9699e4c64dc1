"""Where the building stands: the project's frame is brought near a rail that was drawn far from its origin.

Everything is computed, cut and proved near the origin. What the site needs comes back as the datum: setting out is in
the coordinates that the rail was drawn in, as if nothing had been moved.
"""

import numpy as np

from isomould.arrays import Floats
from isomould.curves.origins import REMOTE, WHOLE
from isomould.documents.info import DatumSettings
from isomould.errors import Note
from isomould.form.settings import TrimSettings
from isomould.project.schema import Project


def site_of(place: Floats) -> Floats:
    """Give the origin (3,) mm of the project's frame for a rail near a place (3,): whole metres, 0 along near axes."""
    return np.where(np.abs(place) > REMOTE, WHOLE * np.round(place / WHOLE), 0.0)


def on_site(project: Project, origin: Floats) -> Project:
    """Give the project with its frame moved to an origin (3,) mm: trimming planes and datum move with it."""
    if not origin.any():
        return project
    trim = tuple(_moved_plane(table, origin) for table in project.surface.trim)
    surface = project.surface.model_copy(update={"trim": trim})
    info = project.project.model_copy(update={"datum": _moved_datum(project.project.datum, origin)})
    return project.model_copy(update={"surface": surface, "project": info})


def site_notes(project: Project, origin: Floats) -> tuple[Note, ...]:
    """Say that the frame was moved, and where it lies on the site."""
    if not origin.any():
        return ()
    place = ", ".join(f"{coordinate / 1000:.0f}" for coordinate in origin)
    datum = ", ".join(f"{coordinate / 1000:.3f}" for coordinate in project.project.datum.origin)
    text = (
        f"drawn far from the origin: model and drawings are measured from ({place}) m of the drawing; "
        f"the datum of the site lies at ({datum}) m, and setting out is in its coordinates"
    )
    return (Note("W-RAIL-SITE", "rail.curve", text),)


def _moved_plane(table: TrimSettings, origin: Floats) -> TrimSettings:
    plane = table.plane
    at = np.array(plane.origin) - origin
    moved = {"z": None if plane.z is None else plane.z - float(origin[2]), "origin": tuple(at.tolist())}
    return table.model_copy(update={"plane": plane.model_copy(update=moved)})


def _moved_datum(datum: DatumSettings, origin: Floats) -> DatumSettings:
    """Give the datum of a frame whose origin lies at a place of the former frame."""
    turn = np.radians(datum.rotation_deg)
    c, s = (0.0 if abs(value) < _SQUARE else value for value in (np.cos(turn), np.sin(turn)))
    east, north = c * origin[0] - s * origin[1], s * origin[0] + c * origin[1]
    place = np.array(datum.origin) + np.array([east, north, origin[2]])
    return datum.model_copy(update={"origin": tuple(place.tolist())})


_SQUARE = 1e-15
"""A cosine that is none but for rounding."""
