"""The building as it will stand: solid bars, quiet nodes, glass with the sky in it, on the ground."""

from dataclasses import dataclass

import numpy as np
import shapely

from isomould.arrays import Bools, Floats
from isomould.documents.camera import Camera
from isomould.documents.picture import Caption, Frame, Item, Picture, Shape, blend, fit
from isomould.documents.surroundings import (
    SKY_HIGH,
    SKY_LOW,
    compass,
    footprint,
    ground,
    person,
    scale_bar,
    shadow,
    sky,
)
from isomould.parts.kit import Kit
from isomould.parts.poses import member_poses

WIDTH, MARGIN, FOOT = 1200.0, 36.0, 44.0
_STEEL_LIGHT, _STEEL_DARK, _NODE = "#8d959d", "#333b43", "#565f67"
_GLASS, _GLASS_EDGE, _INSIDE = "#8fb4c9", "#5f7f91", "#9fb6c0"
_LIGHT = np.array([0.35, -0.55, 0.76])
_NEAR = 1e-3
"""mm; how much nearer what stands before a panel is painted."""


@dataclass(frozen=True, eq=False)
class _Painted:
    """An item and how near it is to the eye, mm."""

    depth: float
    item: Item


@dataclass(frozen=True)
class Caught:
    """What a picture says beside what it shows: title, and where north is (degrees, as `compass` takes it)."""

    name: str
    text: str
    north_deg: float = 0.0


def building_picture(kit: Kit, said: Caught, camera: Camera, cut: bool = False) -> Picture:
    """Give the building seen by a camera.

    Parameters
    ----------
    cut
        Whether the half before the middle is taken away: a section.
    """
    corners = footprint(kit.mesh.nodes, _feet(kit))
    frame = fit(camera.flat(np.vstack([kit.mesh.nodes, corners])), WIDTH, MARGIN, FOOT)
    behind = _behind(kit, camera) if cut else _all(kit)
    panels = np.split(kit.panels.corners, kit.mesh.face_offsets[1:-1])
    painted = [
        *_glass(kit, panels, camera, frame, behind.faces),
        *_bars(kit, camera, frame, behind.edges),
        *_drums(kit, camera, frame, behind.nodes),
    ]
    order = np.argsort([each.depth for each in painted], kind="stable")
    faces = np.split(kit.mesh.nodes[kit.mesh.faces], kit.mesh.face_offsets[1:-1])
    items: list[Item] = [
        *sky(WIDTH, frame.height),
        *ground(corners, camera, frame, WIDTH),
        *shadow(faces, corners, camera, frame),
        *(painted[k].item for k in order),
        *(_cut_line(kit, panels, camera, frame) if cut else []),
        *person(corners, camera, frame),
        *scale_bar(frame, (MARGIN, 0.75 * FOOT)),
        *compass(camera, (WIDTH - 70.0, 0.9 * FOOT), said.north_deg),
        Caption(f"{said.name}: {said.text}", (MARGIN, 0.3 * FOOT), 13.0),
    ]
    return Picture(f"{said.name}, as built", WIDTH, frame.height, tuple(items))


@dataclass(frozen=True, eq=False)
class _Chosen:
    """Which faces, edges and nodes are painted."""

    faces: Bools
    edges: Bools
    nodes: Bools


def _all(kit: Kit) -> _Chosen:
    counts = (len(kit.mesh.face_ij), len(kit.mesh.edges), len(kit.mesh.nodes))
    return _Chosen(*(np.ones(count, dtype=bool) for count in counts))


def _feet(kit: Kit) -> float:
    """Height of the ground, mm: the lowest end of a drum stands on it."""
    half = np.array([joint.height for joint in kit.joints])[kit.nodes.classes.of] / 2
    return float((kit.mesh.nodes[:, 2] - half * np.abs(kit.mesh.axes[:, 2])).min())


def _middle(kit: Kit, camera: Camera) -> float:
    depth = camera.depth(kit.mesh.nodes)
    return float(depth.min() + depth.max()) / 2


def _behind(kit: Kit, camera: Camera) -> _Chosen:
    """Choose what lies behind the middle."""
    depth, middle = camera.depth(kit.mesh.nodes), _middle(kit, camera)
    return _Chosen(_face_depth(kit, depth) <= middle, depth[kit.mesh.edges].mean(axis=1) <= middle, depth <= middle)


def _face_depth(kit: Kit, depth: Floats) -> Floats:
    sums = np.add.reduceat(depth[kit.mesh.faces], kit.mesh.face_offsets[:-1])
    return sums / kit.mesh.sizes


def _glass(kit: Kit, panels: list[Floats], camera: Camera, frame: Frame, chosen: Bools) -> list[_Painted]:
    """Panes mirror the sky, the more the flatter they are looked at (Schlick's rule)."""
    depth = _face_depth(kit, camera.depth(kit.mesh.nodes))
    facing = kit.panels.normals @ camera.eye
    mirrored = 2 * facing[:, None] * kit.panels.normals - camera.eye
    return [
        _Painted(
            float(depth[k]),
            Shape(
                frame.place(camera.flat(panels[k])),
                True,
                _tint(float(mirrored[k, 2]), float(facing[k])),
                _GLASS_EDGE,
                0.3,
                _cover(float(facing[k])),
            ),
        )
        for k in np.flatnonzero(chosen).tolist()
    ]


def _tint(height: float, facing: float) -> str:
    if facing < 0:
        return _INSIDE
    reflected = blend(SKY_LOW, SKY_HIGH, min(max(height, 0.0), 1.0))
    return blend(_GLASS, reflected, 0.25 + 0.6 * (1 - abs(facing)) ** 2)


def _cover(facing: float) -> float:
    mirror = 0.04 + 0.96 * (1 - abs(facing)) ** 5
    return round(0.36 + 0.5 * mirror, 3)


def _bars(kit: Kit, camera: Camera, frame: Frame, chosen: Bools) -> list[_Painted]:
    """Boxes as deep and as wide as their members: the sides that face the eye, light by their normal."""
    poses, depth = member_poses(kit.mesh, kit.members), _edge_depth(kit, camera)
    painted = list[_Painted]()
    for k in np.flatnonzero(chosen).tolist():
        shape = kit.members.shapes[kit.members.classes.of[k]]
        low, high = shape.outline.min(axis=0), shape.outline.max(axis=0)
        box = _box(low, high, shape.section.width / 2) @ poses[k, :3, :3].T + poses[k, :3, 3]
        for side in _SIDES:
            quad = box[list(side)]
            normal = np.cross(quad[1] - quad[0], quad[2] - quad[0])
            size = float(np.linalg.norm(normal))
            if float(normal @ camera.eye) > 1e-9 * size:
                share = 0.5 - 0.5 * float(normal @ _LIGHT) / size
                fill = blend(_STEEL_LIGHT, _STEEL_DARK, share)
                placed = frame.place(camera.flat(quad))
                painted.append(_Painted(float(depth[k]), Shape(placed, True, fill, fill, 0.3)))
    return painted


_SIDES = ((0, 1, 2, 3), (7, 6, 5, 4), (1, 0, 4, 5), (3, 2, 6, 7), (0, 3, 7, 4), (2, 1, 5, 6))
"""Corners of a box, counter-clockwise from outside."""


def _box(low: Floats, high: Floats, half: float) -> Floats:
    """Corners (8, 3): four with z = -half clockwise seen from +z, the same with z = half."""
    (x0, y0), (x1, y1) = low, high
    ring = np.array([[x0, y0], [x0, y1], [x1, y1], [x1, y0]])
    return np.vstack([np.column_stack([ring, np.full(4, z)]) for z in (-half, half)])


def _edge_depth(kit: Kit, camera: Camera) -> Floats:
    """Depth (e,) at which bars are painted: glass lies on their outside, before or behind them."""
    mesh = kit.mesh
    depth, facing = _face_depth(kit, camera.depth(mesh.nodes)), kit.panels.normals @ camera.eye
    face = mesh.per_corner(np.arange(len(depth)))
    lowest, highest = np.full(len(mesh.edges), np.inf), np.full(len(mesh.edges), -np.inf)
    seat = kit.panels.edges >= 0
    np.minimum.at(lowest, kit.panels.edges[seat], depth[face[seat]])
    np.maximum.at(highest, kit.panels.edges[seat], depth[face[seat]])
    inside = np.zeros(len(mesh.edges), dtype=bool)
    np.logical_or.at(inside, kit.panels.edges[seat], facing[face[seat]] < 0)
    alone = ~np.isfinite(lowest)
    own = camera.depth(mesh.nodes)[mesh.edges].mean(axis=1)
    return np.where(alone, own, np.where(inside, highest + _NEAR, lowest - _NEAR))


def _drums(kit: Kit, camera: Camera, frame: Frame, chosen: Bools) -> list[_Painted]:
    """Nodes as drums, just before the bars that meet there."""
    depth = np.full(len(kit.mesh.nodes), -np.inf)
    edge = _edge_depth(kit, camera)
    for end in (0, 1):
        np.maximum.at(depth, kit.mesh.edges[:, end], edge)
    turns = np.linspace(0.0, 2 * np.pi, 16, endpoint=False)
    painted = list[_Painted]()
    for k in np.flatnonzero(chosen & np.isfinite(depth)).tolist():
        joint = kit.joints[kit.nodes.classes.of[k]]
        axis, x = kit.mesh.axes[k], kit.nodes.reference[k]
        circle = joint.radius * (np.outer(np.cos(turns), x) + np.outer(np.sin(turns), np.cross(axis, x)))
        ends = [kit.mesh.nodes[k] + circle + side * joint.height / 2 * axis for side in (-1, 1)]
        hull = shapely.convex_hull(shapely.MultiPoint(frame.place(camera.flat(np.vstack(ends)))))
        ring = np.array(shapely.get_coordinates(hull))[:-1]
        painted.append(_Painted(float(depth[k]) + _NEAR / 2, Shape(ring, True, _NODE, None)))
    return painted


def _cut_line(kit: Kit, panels: list[Floats], camera: Camera, frame: Frame) -> list[Item]:
    """Give where the middle cuts the glass, as strong lines."""
    middle = _middle(kit, camera)
    lines = list[Item]()
    for panel in panels:
        depth = camera.depth(panel) - middle
        after, behind = np.roll(panel, -1, axis=0), np.roll(depth, -1)
        crossing = (depth <= 0) != (behind <= 0)
        if np.count_nonzero(crossing) == 2:
            share = depth[crossing] / (depth[crossing] - behind[crossing])
            ends = panel[crossing] + share[:, None] * (after[crossing] - panel[crossing])
            lines.append(Shape(frame.place(camera.flat(ends)), False, None, "#1c2329", 2.2))
    return lines
