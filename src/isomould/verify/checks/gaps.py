"""V26: the placed panels keep their gap in space, and the placed parts are those of the part files."""

from dataclasses import dataclass

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, one_outline
from isomould.verify.read.glb import Placed
from isomould.verify.read.solid import Solid
from isomould.verify.read.tables import number, pairs
from isomould.verify.rules import Floats, Ints, Measured, Rule, Unreadable, worst_of

ROUNDING = 0.003
"""Corners of two panels and their placing, each rounded to 0.001 mm, mm."""
PART_FILE = 0.001
"""Outlines are multiples of 0.001 mm; the model holds 32-bit floats, mm."""


@dataclass(frozen=True, eq=False)
class _Panels:
    """Panels in space: corners (f, 2, k, 3) at both levels, the last repeated; how far each is off its class."""

    corners: Floats
    deviation: Floats

    @property
    def points(self) -> Floats:
        """All corners (f, 2k, 3)."""
        return self.corners.reshape(len(self.corners), -1, 3)


def clear_distances(delivery: Delivery) -> Measured:
    """How much the clear distance of panels that share a node falls short of the gap, beyond their classes' deviation.

    Two convex bodies are no nearer to each other than their extents along any one direction. The directions
    tried are the normals of all edges' faces, that of the beam between the panels, and the line of the nearest corners.
    """
    mesh = delivery.mesh
    panels, couples = _panels(delivery), _couples(mesh.faces, mesh.face_offsets)
    if not len(couples):
        return worst_of([], [], none="no two panels meet")
    clear = _clear(panels, couples, _beams(delivery, couples))
    allowed = 2 * panels.deviation[couples].sum(axis=1)
    gap = float(delivery.design.raw["panel"]["gap_mm"])
    names = [" and ".join(mesh.face_location[pair]) for pair in couples]
    return worst_of(gap - clear - allowed, names)


def _panels(delivery: Delivery) -> _Panels:
    mesh = delivery.mesh
    placed = {part.location: part for part in delivery.model.parts}
    corners = [_corners(delivery, placed[str(location)]) for location in mesh.face_location]
    most = max(points.shape[1] for points in corners)
    padded = [np.pad(points, ((0, 0), (0, most - points.shape[1]), (0, 0)), mode="edge") for points in corners]
    deviation = pairs(delivery.table("panel_instances"), "location", "deviation_mm")
    return _Panels(np.stack(padded), np.array([number(deviation[str(where)]) for where in mesh.face_location]))


def _corners(delivery: Delivery, part: Placed) -> Floats:
    """Corners (2, n, 3) of a panel in space: the outline of its part file, at the levels of the model's shape."""
    outline = one_outline(_drawing(delivery.panels, part.mark)).points
    levels = delivery.model.shapes[part.mark].vertices[:, 2]
    flat = np.stack([np.insert(outline, 2, level, axis=1) for level in (levels.min(), levels.max())])
    return flat @ part.matrix[:3, :3].T + part.matrix[:3, 3]


def _drawing(drawings: dict[str, Drawing], mark: str) -> Drawing:
    if mark not in drawings:
        message = f"{mark}.dxf is missing"
        raise Unreadable(message)
    return drawings[mark]


def _couples(faces: Ints, offsets: Ints) -> Ints:
    """Pairs (p, 2) of faces with a node in common."""
    face = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    order = np.argsort(faces, kind="stable")
    groups = np.split(face[order], np.flatnonzero(np.diff(faces[order])) + 1)
    found = [np.stack(np.triu_indices(len(group), 1), axis=-1) for group in groups]
    rows = np.concatenate([group[pair] for group, pair in zip(groups, found, strict=True)])
    return np.unique(np.sort(rows, axis=1), axis=0)


def _beams(delivery: Delivery, couples: Ints) -> Floats:
    """Normals (p, 3) of the beams between panels that share a side; zeros where they share a corner only."""
    mesh = delivery.mesh
    corners = [set(nodes.tolist()) for nodes in np.split(mesh.faces, mesh.face_offsets[1:-1])]
    normals = np.zeros((len(couples), 3))
    for row, (one, other) in enumerate(couples.tolist()):
        shared = sorted(corners[one] & corners[other])
        if len(shared) == 2:
            start, end = shared
            normals[row] = np.cross(mesh.nodes[end] - mesh.nodes[start], mesh.node_axes[shared].sum(axis=0))
    return normals


def _clear(panels: _Panels, couples: Ints, beams: Floats) -> Floats:
    """Largest distance (p,) of the extents of two panels along a direction, mm."""
    one, other = np.moveaxis(panels.points[couples], 1, 0)
    sides = _side_normals(panels.corners)[couples].reshape(len(couples), -1, 3)
    directions = np.concatenate([beams[:, None], _nearest(one, other)[:, None], sides], axis=1)
    length = np.linalg.norm(directions, axis=2, keepdims=True)
    unit = np.divide(directions, length, out=np.zeros_like(directions), where=length > 1e-9)
    near, far = (np.einsum("pkx,pcx->pck", points, unit) for points in (one, other))
    apart = np.maximum(far.min(axis=2) - near.max(axis=2), near.min(axis=2) - far.max(axis=2))
    return np.where(length[..., 0] > 1e-9, apart, -np.inf).max(axis=1)


def _side_normals(corners: Floats) -> Floats:
    """Normals (f, k, 3) of the edges' faces."""
    low, high = np.moveaxis(corners, 1, 0)
    return np.cross(np.roll(low, -1, axis=1) - low, high - low)


def _nearest(one: Floats, other: Floats) -> Floats:
    """Vectors (p, 3) between the nearest corners of two panels."""
    apart = other[:, None] - one[:, :, None]
    rows = np.arange(len(one))
    flat = apart.reshape(len(one), -1, 3)
    return flat[rows, np.linalg.norm(flat, axis=2).argmin(axis=1)]


def placed_parts(delivery: Delivery) -> Measured:
    """Corners of the part files' outlines against those of the model's panels and plates, at both levels.

    Hollow sections have round corners: of them the extents along and across are compared.
    """
    drawings, hollow = delivery.panels | delivery.members, _hollow(delivery)
    found = {mark: shape for mark, shape in delivery.model.shapes.items() if mark in drawings}
    off = [(_off_extents if mark in hollow else _off_outline)(shape, drawings[mark]) for mark, shape in found.items()]
    largest = max((float(np.abs(shape.vertices).max()) for shape in found.values()), default=0.0)
    resolved = float(np.spacing(np.float32(largest)))
    return worst_of(off, list(found), limit=max(PART_FILE, resolved))


def _hollow(delivery: Delivery) -> set[str]:
    """Marks of the members that are hollow sections."""
    sections = delivery.design.raw["member"]["sections"]
    named = pairs(delivery.table("members"), "mark", "section")
    return {mark for mark, name in named.items() if sections[name]["kind"] == "rhs"}


def _off_extents(shape: Solid, drawing: Drawing) -> float:
    """Largest difference of the lowest and highest coordinates of an outline from those of the shape."""
    points, own = one_outline(drawing).points, shape.vertices[:, :2]
    low, high = points.min(axis=0) - own.min(axis=0), points.max(axis=0) - own.max(axis=0)
    return float(abs(np.concatenate([low, high])).max())


def _off_outline(shape: Solid, drawing: Drawing) -> float:
    """Largest distance of a corner of the outline from the corners of the shape, on either of its two levels."""
    points, level = one_outline(drawing).points, shape.vertices[:, 2]
    corners = [shape.vertices[np.isclose(level, end), :2] for end in (level.min(), level.max())]
    there = [np.linalg.norm(points[:, None] - own, axis=2).min(axis=1).max() for own in corners]
    return float(max(there))


RULES = (
    Rule("V26", "neighbouring panels keep their gap at all levels", ROUNDING, "mm", clear_distances),
    Rule("V26b", "parts of the model are those of the part files", PART_FILE, "mm", placed_parts),
)
