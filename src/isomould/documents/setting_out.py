"""Setting out: system lines, work points and node axes in the datum of the site, as drawing and as table."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.documents.drawing import CutDrawing, Entity, Label, Segment3D
from isomould.documents.info import DatumSettings
from isomould.documents.table import Table, make_table
from isomould.parts.kit import Kit

_TEXT_HEIGHT = 40.0


@dataclass(frozen=True, eq=False)
class SettingOut:
    """Work points of the nodes, top and bottom of their axes (n, 3) in the datum of the site, mm, and their names."""

    marks: tuple[str, ...]
    locations: tuple[str, ...]
    work_points: Floats
    tops: Floats
    bottoms: Floats
    edges: Ints


def set_out(kit: Kit, depth: float, datum: DatumSettings) -> SettingOut:
    """Give every node's work point and its axis over the members' depth (mm) in the datum of the site."""
    mesh = kit.mesh
    reach = axis_reach(kit, depth)[:, None] * mesh.axes
    marks = tuple(kit.nodes.marks[k] for k in kit.nodes.classes.of)
    places = (place(points, datum) for points in (mesh.nodes, mesh.nodes + reach, mesh.nodes - reach))
    return SettingOut(marks, kit.nodes.locations, *places, edges=mesh.edges)


def place(points: Floats, datum: DatumSettings) -> Floats:
    """Move points (n, 3) mm from the project's frame to the datum of the site: turn about the vertical, then shift.

    The model stays near its own origin, where floats are fine; only the result is large (failure mode J3).
    """
    c, s = np.cos(np.radians(datum.rotation_deg)), np.sin(np.radians(datum.rotation_deg))
    return points @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + datum.origin


def setting_out_drawing(found: SettingOut) -> CutDrawing:
    """Draw every system line and every node axis, with mark and location at its top."""
    lines = [_line(*found.work_points[edge]) for edge in found.edges]
    axes = [_line(*ends) for ends in zip(found.bottoms, found.tops, strict=True)]
    texts = zip(found.marks, found.locations, found.tops, strict=True)
    labels: list[Entity] = [Label("INFO", f"{mark} {where}", _point(top), _TEXT_HEIGHT) for mark, where, top in texts]
    return CutDrawing((*lines, *axes, *labels))


def setting_out_table(found: SettingOut) -> Table:
    """Make the table "setting_out": a row per node."""
    places = {"": found.work_points, "top_": found.tops, "bottom_": found.bottoms}
    columns = {f"{name}{axis}_mm": at[:, k].tolist() for name, at in places.items() for k, axis in enumerate("xyz")}
    return make_table("setting_out", {"location": list(found.locations), "mark": list(found.marks), **columns})


def axis_reach(kit: Kit, depth: float) -> Floats:
    """Distance (n,) mm along every node axis to its work point at the top: the furthest that a member reaches.

    A member's top meets the axis at `(h/2)/sin(edge, axis)` (geometry §4).
    """
    reach = np.where(kit.arms.sill, 0.0, depth / 2 / np.cos(kit.arms.elevation))
    return np.maximum.reduceat(reach, kit.arms.offsets[:-1])


def _line(start: Floats, end: Floats) -> Segment3D:
    return Segment3D("INFO", _point(start), _point(end))


def _point(values: Floats) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in np.round(values, 6) + 0.0)
    return x, y, z
