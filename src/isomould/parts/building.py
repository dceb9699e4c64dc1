"""The building as shapes: one per mark, and every part with its mark, its location and where it stands."""

from collections.abc import Sequence
from dataclasses import dataclass

from isomould.arrays import Floats
from isomould.parts.kit import Kit, KitSettings
from isomould.parts.members import MemberParts
from isomould.parts.nodes import NodeParts
from isomould.parts.panels import PanelParts
from isomould.parts.plates import Shape, extrude, hole_contour
from isomould.parts.poses import member_poses, node_poses, panel_poses
from isomould.parts.solid import Solid


@dataclass(frozen=True, eq=False)
class Standing:
    """Where the parts of one kind stand.

    Attributes
    ----------
    marks, locations : sequence of str
        One per part.
    poses : (n, 4, 4) float, mm
        From the frame of the class to the building.
    """

    marks: Sequence[str]
    locations: Sequence[str]
    poses: Floats


def make_shapes(kit: Kit, settings: KitSettings, solids: tuple[Solid, ...]) -> dict[str, Shape]:
    """Give one shape per mark, in the frame of its class: nodes, members, panels."""
    half, thickness = settings.members.section.thickness / 2, settings.panels.thickness
    shapes = {mark: Shape(s.vertices, s.triangles) for mark, s in zip(kit.nodes.marks, solids, strict=True)}
    shapes |= {
        mark: extrude(shape.outline, -half, half, map(hole_contour, shape.holes))
        for mark, shape in zip(kit.members.marks, kit.members.shapes, strict=True)
    }
    return shapes | {
        mark: extrude(outline, 0.0, thickness)
        for mark, outline in zip(kit.panels.marks, kit.panels.outlines, strict=True)
    }


def place_parts(kit: Kit, settings: KitSettings) -> tuple[Standing, Standing, Standing]:
    """Say where nodes, members and panels stand."""
    return (
        _standing(kit.nodes, node_poses(kit.mesh, kit.nodes)),
        _standing(kit.members, member_poses(kit.mesh, kit.members)),
        _standing(kit.panels, panel_poses(kit.mesh, kit.panels, settings.panels.thickness)),
    )


def _standing(parts: NodeParts | MemberParts | PanelParts, poses: Floats) -> Standing:
    return Standing([parts.marks[k] for k in parts.classes.of], parts.locations, poses)
