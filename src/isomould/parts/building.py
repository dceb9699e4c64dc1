"""The building as shapes: one per mark, and every part with its mark, its location and where it stands."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats
from isomould.parts.bodies import member_body
from isomould.parts.kit import Kit, KitSettings
from isomould.parts.members import MemberParts
from isomould.parts.nodes import NodeParts
from isomould.parts.panels import PanelParts
from isomould.parts.plates import Shape, extrude, shape_of
from isomould.parts.poses import member_poses, node_poses, panel_poses
from isomould.parts.solid import Solid

BASE = ("plate", "stem")
"""Parts of a base, as their marks end."""


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


def make_shapes(kit: Kit, settings: KitSettings, solids: Sequence[Solid | Shape]) -> dict[str, Shape]:
    """Give one shape per mark, in the frame of its class: nodes, members, panels, bases."""
    thickness = settings.panels.thickness
    shapes = {mark: Shape(s.vertices, s.triangles) for mark, s in zip(kit.nodes.marks, solids, strict=True)}
    shapes |= {
        mark: shape_of(member_body(shape)) for mark, shape in zip(kit.members.marks, kit.members.shapes, strict=True)
    }
    return (
        shapes
        | {
            mark: extrude(outline, 0.0, thickness)
            for mark, outline in zip(kit.panels.marks, kit.panels.outlines, strict=True)
        }
        | _base_shapes(kit)
    )


def _base_shapes(kit: Kit) -> dict[str, Shape]:
    """Plate and stem of every class of supports that stands on a base: `N03-plate`, `N03-stem`."""
    made = [(mark, base.shapes) for mark, base in zip(kit.nodes.marks, kit.bases, strict=True) if base]
    return {f"{mark}-{name}": shape for mark, both in made for name, shape in zip(BASE, both, strict=True)}


def place_bases(kit: Kit) -> Standing:
    """Say where plates and stems stand, in the order of the nodes."""
    poses, nodes = node_poses(kit.mesh, kit.nodes), kit.nodes
    rows = [(k, base) for k, of in enumerate(nodes.classes.of.tolist()) if (base := kit.bases[of])]
    found = [
        (f"{nodes.marks[nodes.classes.of[k]]}-{name}", nodes.locations[k], poses[k] @ frame)
        for k, base in rows
        for name, frame in zip(BASE, (base.frame, base.stem_frame), strict=True)
    ]
    marks, locations, placed = zip(*found, strict=True) if found else ((), (), np.empty((0, 4, 4)))
    return Standing(marks, locations, np.array(placed))


def place_parts(kit: Kit, settings: KitSettings) -> tuple[Standing, Standing, Standing]:
    """Say where nodes, members and panels stand."""
    return (
        _standing(kit.nodes, node_poses(kit.mesh, kit.nodes)),
        _standing(kit.members, member_poses(kit.mesh, kit.members)),
        _standing(kit.panels, panel_poses(kit.mesh, kit.panels, settings.panels.thickness)),
    )


def _standing(parts: NodeParts | MemberParts | PanelParts, poses: Floats) -> Standing:
    return Standing([parts.marks[k] for k in parts.classes.of], parts.locations, poses)
