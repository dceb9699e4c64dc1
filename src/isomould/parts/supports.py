"""Base plates under the supports: a plate parallel to the trimming plane, a stem that carries the drum (fabrication).

Everything is in the frame of the node. `up` is the trimming plane's normal towards what is kept; the plate's frame has
x along the projection of the node's axis, y across, z up, its origin on the plate's top under the work point.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import shapely

from isomould.arrays import Floats, read_only, round_um
from isomould.errors import Refused
from isomould.form.mesh import Family, Mesh, NodeKind
from isomould.form.trim import Cut
from isomould.parts.arms import normalised
from isomould.parts.details.joint import Joint
from isomould.parts.features import Hole
from isomould.parts.nodes import NodeArms, NodeParts
from isomould.parts.outline import area, round_outline
from isomould.parts.plates import Shape, extrude, hole_contour
from isomould.parts.settings import BasePlateSettings, MemberSettings
from isomould.ties import first_least_of_rows

_SEAT = 0.9
"""Share of the drum's chord through the work point that the stem carries at most."""


@dataclass(frozen=True, eq=False)
class Base:
    """The base of one node class.

    Attributes
    ----------
    frame : (4, 4) float, mm
        From the plate's frame to the node's.
    level : float, mm
        Of the plate's top below the work point.
    plate, stem : (n, 2) float, mm
        Outlines: of the plate in its frame, of the stem with x as the plate's and y up.
    holes : tuple of Hole
        In the plate's frame.
    plate_thickness, stem_thickness : float, mm
    """

    frame: Floats
    level: float
    plate: Floats
    stem: Floats
    holes: tuple[Hole, ...]
    plate_thickness: float
    stem_thickness: float

    def __post_init__(self) -> None:
        read_only(self.frame)

    @property
    def volume(self) -> float:
        """Steel of plate and stem, mm³."""
        bored = sum(np.pi / 4 * hole.diameter**2 for hole in self.holes)
        return (area(self.plate) - bored) * self.plate_thickness + area(self.stem) * self.stem_thickness

    @property
    def stem_frame(self) -> Floats:
        """Transform (4, 4) from the stem's frame to the node's."""
        x, y, z, origin = self.frame.T
        return np.stack([x, z, -y, origin], axis=-1)

    @property
    def shapes(self) -> tuple[Shape, Shape]:
        """Plate and stem as solids, in their frames."""
        half = self.stem_thickness / 2
        plate = extrude(self.plate, -self.plate_thickness, 0.0, map(hole_contour, self.holes))
        return plate, extrude(self.stem, -half, half)


def up_directions(mesh: Mesh, cuts: Sequence[Cut]) -> Floats:
    """Give the normal (n, 3) of the nearest trimming plane at every support; zeros at all other nodes."""
    up = np.zeros_like(mesh.nodes)
    if cuts:
        heights = np.abs(np.stack([cut.heights(mesh.nodes) for cut in cuts], axis=1))
        up[:] = np.stack([cut.normal for cut in cuts])[first_least_of_rows(heights)]
    up[mesh.kind != NodeKind.SUPPORT] = 0.0
    return up


def make_bases(
    nodes: NodeParts, joints: Sequence[Joint], members: MemberSettings, settings: BasePlateSettings | None
) -> tuple[Base | None, ...]:
    """Give the base of every node class; None for nodes that are no supports.

    Raises
    ------
    Refused
        If the holes lie too near to the plate's edges, to each other or to the drum, or a facet leaves the stem nothing
        to carry.
    """
    if settings is None:
        return (None,) * len(nodes.marks)
    _refuse_holes(settings)
    rows = zip(nodes.arms, nodes.up, joints, nodes.marks, strict=True)
    return tuple(
        _make_base(up, Drum.of(joint), _reach(arms, up, joint, members), settings, mark) if up.any() else None
        for arms, up, joint, mark in rows
    )


@dataclass(frozen=True, eq=False)
class Drum:
    """What a base carries: radius and levels (mm) of a drum about its axis, and planes (k, 4) that cut it."""

    radius: float
    low: float
    high: float
    planes: Floats

    @classmethod
    def of(cls, joint: Joint) -> Self:
        """Take the drum of a node."""
        return cls(joint.radius, joint.low, joint.high, joint.planes)


def _make_base(up: Floats, drum: Drum, reach: float, settings: BasePlateSettings, mark: str) -> Base:
    """Make a base for a drum under parts that reach so far down."""
    level = float(np.ceil(round(reach + settings.clearance, 6)))
    axes = _axes(up)
    lean, rise = float(axes[0, 2]), float(up[2])
    ends = np.array([drum.low, drum.high]) * lean
    beside = drum.radius * abs(rise)
    sizes = np.array([[beside - ends.min(), drum.radius], [beside + ends.max(), drum.radius]])
    low, high = np.ceil(np.round(sizes + settings.margin, 6)) * [[-1], [1]]
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = axes.T, -level * up
    return Base(
        frame=frame,
        level=level,
        plate=round_outline(np.array([low, [high[0], low[1]], high, [low[0], high[1]]])),
        stem=_stem(axes, drum, level, settings, mark),
        holes=_holes(low, high, settings, mark),
        plate_thickness=settings.thickness,
        stem_thickness=settings.stem_thickness,
    )


def _axes(up: Floats) -> Floats:
    """Axes (3, 3) of the plate: along the node axis' projection (arm 1's if the axis stands upright), across, up."""
    axis, arm = np.eye(3)[[2, 0]]
    towards = axis if np.hypot(up[0], up[1]) > 1e-6 else arm
    x = normalised(towards - (towards @ up) * up)
    return np.stack([x, np.cross(up, x), up])


def _reach(arms: NodeArms, up: Floats, joint: Joint, members: MemberSettings) -> float:
    """How far drum, members and sills reach below the work point."""
    flat = float(np.hypot(up[0], up[1]))
    below = [radius * flat - height * up[2] for radius, height in joint.stack]
    below += [radius * flat + depth * up[2] for radius, depth in joint.under]
    below += [members.of(Family.SILL).depth / 2] * int((arms.family == Family.SILL).any())
    below += [float(-(_end_corners(*arm, joint, members) @ up).min()) for arm in _held(arms)]
    return float(max(below))


def _held(arms: NodeArms) -> list[tuple[float, float, int]]:
    held = arms.held
    return list(zip(held.azimuth.tolist(), held.elevation.tolist(), held.family.tolist(), strict=True))


def _end_corners(azimuth: float, elevation: float, family: int, joint: Joint, members: MemberSettings) -> Floats:
    """Corners (k, 3) of a member's end, as broad as what holds it."""
    section = members.of(family)
    level, rise = np.cos(elevation), np.sin(elevation)
    out, aside = np.array([np.cos(azimuth), np.sin(azimuth), 0.0]), np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    axis = np.array([0.0, 0.0, 1.0])
    points = joint.end(section, elevation).outline @ np.stack([level * out + rise * axis, level * axis - rise * out])
    return np.concatenate([points + side * joint.hold(section)[0] / 2 * aside for side in (1, -1)])


def _stem(axes: Floats, drum: Drum, level: float, settings: BasePlateSettings, mark: str) -> Floats:
    """Outline of the stem: from the plate up to the drum's section in the stem's plane, a rectangle that leans."""
    lean, rise = float(axes[0, 2]), float(axes[2, 2])
    along, aside = np.array([lean, rise]), np.array([-rise, lean]) * drum.radius
    corners = [drum.high * along + aside, drum.low * along + aside, drum.low * along - aside, drum.high * along - aside]
    section = shapely.Polygon(corners)
    left, right = _seat(section, _facet_lines(axes, drum.planes, settings.stem_thickness / 2), level, mark)
    under = shapely.box(left, -level, right, 0.0).difference(section)
    points = shapely.get_coordinates(shapely.normalize(under))[:-1] + np.array([0.0, level])
    return round_outline(points if area(points) > 0 else points[::-1])


def _facet_lines(axes: Floats, planes: Floats, half: float) -> Floats:
    """Lines (k, 3) in the stem's plane, as normals and distances, inside which facets are off the whole stem."""
    local = planes[:, :3] @ axes.T
    return np.column_stack([local[:, [0, 2]], planes[:, 3] - half * np.abs(local[:, 1])])


def _seat(section: shapely.Polygon, lines: Floats, level: float, mark: str) -> tuple[float, float]:
    """Where (from, to) the stem may carry: 0.9 of the drum's chord through the work point, short of facets' edges."""
    chord = section.intersection(shapely.LineString([(-1e5, 0.0), (1e5, 0.0)])).bounds
    left, right = _SEAT * chord[0], _SEAT * chord[2]
    rim = section.exterior.intersection(shapely.box(left, -level, right, 0.0))
    for a, b, distance in lines.tolist():
        rim = rim.intersection(_half_plane(a, b, distance))
    found = [part.bounds for part in shapely.get_parts(shapely.line_merge(shapely.union_all([rim])))]
    under = [(low, high) for low, _, high, _ in found if low <= 0.0 <= high]
    if not under:
        what = "a facet takes the drum's side away under the work point"
        way_out = "Divide the curves differently, or leave nodes.base_plate out."
        raise Refused("E-BASE-SEAT", f"nodes.base_plate ({mark})", what, "round drum for the stem to carry", way_out)
    return under[0]


def _half_plane(a: float, b: float, distance: float) -> shapely.Polygon:
    """All points (x, z) near the drum with `a x + b z` up to a distance."""
    size = float(np.hypot(a, b))
    if size < 1e-9:
        return shapely.box(-1e5, -1e5, 1e5, 1e5 if distance >= 0 else -1e5)
    normal = np.array([a, b]) / size
    foot, way = normal * distance / size, np.array([-normal[1], normal[0]]) * 1e5
    return shapely.Polygon([foot + way, foot - way, foot - way - 1e5 * normal, foot + way - 1e5 * normal])


def _holes(low: Floats, high: Floats, settings: BasePlateSettings, mark: str) -> tuple[Hole, ...]:
    """Holes at the corners, and at the middles of the longer sides (6) or of all (8)."""
    middle = (low + high) / 2
    x, y = round_um((high - low) / 2 - settings.edge_distance)
    places = [(i * x, j * y) for i in (-1, 1) for j in (-1, 1)]
    longer = [(0.0, y), (0.0, -y)] if x >= y else [(x, 0.0), (-x, 0.0)]
    shorter = [(x, 0.0), (-x, 0.0)] if x >= y else [(0.0, y), (0.0, -y)]
    places += longer[: 2 * (settings.holes > 4)] + shorter[: 2 * (settings.holes > 6)]
    steps = {4: (2.0, 2.0), 6: (1.0, 2.0) if x >= y else (2.0, 1.0), 8: (1.0, 1.0)}[settings.holes]
    apart = float(min(x * steps[0], y * steps[1]))
    if apart < 2.4 * settings.hole_diameter:
        _refuse("holes", f"{mark}: holes {apart:.3f} mm apart", 2.4 * settings.hole_diameter, "2.4 hole diameters")
    return tuple(Hole(float(middle[0] + px), float(middle[1] + py), settings.hole_diameter) for px, py in places)


def _refuse_holes(settings: BasePlateSettings) -> None:
    """Refuse holes near the edges (EN 1993-1-8, table 3.3) and margins without room for washer and spanner."""
    edge, diameter = settings.edge_distance, settings.hole_diameter
    if edge < 1.2 * diameter:
        _refuse("edge_distance", f"{edge:g} mm from hole to edge", 1.2 * diameter, "1.2 hole diameters")
    if settings.margin < edge + diameter:
        needed = "edge distance and hole diameter, so that washer and spanner pass the drum"
        _refuse("margin", f"{settings.margin:g} mm beyond the drum", edge + diameter, needed)


def _refuse(field: str, found: str, limit: float, why: str) -> None:
    way_out = "Give larger plates (margin), smaller or fewer holes."
    raise Refused("E-BASE-HOLES", f"nodes.base_plate.{field}", found, f"at least {limit:g} mm, {why}", way_out)
