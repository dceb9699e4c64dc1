"""The setting-out drawing: system lines and node axes in space, with marks and locations."""

import numpy as np

from isomould.arrays import Floats
from isomould.documents.drawing import CutDrawing, Entity, Label, Segment3D
from isomould.parts.kit import Kit

_TEXT_HEIGHT = 40.0


def setting_out_drawing(kit: Kit, depth: float) -> CutDrawing:
    """Draw every system line, every node axis over the members' depth (mm), and the location at its top."""
    mesh = kit.mesh
    reach = axis_reach(kit, depth)[:, None] * mesh.axes
    lines = [_line(*mesh.nodes[edge]) for edge in mesh.edges]
    axes = [_line(node - up, node + up) for node, up in zip(mesh.nodes, reach, strict=True)]
    marks = [kit.nodes.marks[k] for k in kit.nodes.classes.of]
    texts = zip(marks, kit.nodes.locations, mesh.nodes + reach, strict=True)
    labels: list[Entity] = [Label("INFO", f"{mark} {where}", _point(top), _TEXT_HEIGHT) for mark, where, top in texts]
    return CutDrawing((*lines, *axes, *labels))


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
