"""Faceted drums: a plane facet with threaded holes for every hollow section (fabrication, Node solids).

Members are cut square, perpendicular to their axis, and bolted from inside through a plate in their end.
"""

from dataclasses import dataclass
from itertools import permutations
from typing import Any, ClassVar

import manifold3d as m3
import numpy as np
from scipy.spatial import ConvexHull, HalfspaceIntersection

from isomould.arrays import Floats
from isomould.errors import Refused
from isomould.form.mesh import Family
from isomould.parts.catalogue import AnySection, RhsSection
from isomould.parts.details.bolting import Bolting, bolt_members
from isomould.parts.details.joint import (
    Carving,
    Counts,
    Joint,
    Limit,
    MemberEnd,
    along_arm,
    refuse_limits,
    share,
    smallest_diameter,
)
from isomould.parts.hardware import gather
from isomould.parts.kernel import OVERLAP, block, cylinder, disc, facets, join
from isomould.parts.nodes import NodeArms, NodeParts
from isomould.parts.settings import FacetedSettings, MemberSettings

_WAY_OUT = "Divide the curves more finely, give a larger nodes.facet_distance, or use smaller sections or bolts."


@dataclass(frozen=True, eq=False)
class FacetedJoint(Joint):
    """A drum with a facet per arm, all at one distance from the work point; lengths in mm.

    Attributes
    ----------
    distance : float
        s, along the members' axes to the facets.
    border, cover : float
        Of the drum beside, above and below the members.
    families : dict of int to Bolting
        How the members of every `Family` are bolted.
    """

    distance: float
    border: float
    cover: float
    families: dict[int, Bolting]

    planned: ClassVar[bool] = False
    leans: ClassVar[bool] = False

    @property
    def bolting(self) -> tuple[Bolting, ...]:
        """How the member of each arm is bolted."""
        return tuple(self.families[family] for family in self.arms.family.tolist())

    @property
    def under(self) -> tuple[tuple[float, float], ...]:
        """The drum alone, which may reach less far below the work point than above it, or further."""
        return ((self.radius, -self.low),)

    @property
    def planes(self) -> Floats:
        """The facets."""
        return np.column_stack([_axes(self.arms), np.full(len(self.arms.azimuth), self.distance)])

    @property
    def tag(self) -> int:
        """The distance of the facets in µm."""
        return round(self.distance * 1000)

    @property
    def counts(self) -> Counts:
        """Facets, a tapped hole for every bolt, and the bore."""
        threads = sum(len(bolting.levels) for bolting in self.bolting)
        return Counts(facets=len(self.bolting), holes=threads + int(self.bore > 0), threads=threads)

    @property
    def sizes(self) -> dict[str, Any]:
        """Facets and bolts, the same in all nodes; what every section's end has."""
        ends = {
            bolting.section.name: {
                "thickness_mm": bolting.plate.thickness,
                "hole_mm": bolting.plate.diameter,
                "thread_mm": bolting.bolt.diameter,
                "hole_depth_mm": bolting.hole_depth,
                "bolts_mm": list(bolting.levels),
            }
            for bolting in self.families.values()
        }
        return {"facet_distance_mm": self.distance, "border_mm": self.border, "cover_mm": self.cover, "ends": ends}

    def end(self, section: AnySection, elevation: float) -> MemberEnd:
        """A square cut, an end plate inside it, and an access hole per bolt."""
        bolting = next(each for each in self.families.values() if each.section == section)
        half, s = section.depth / 2, self.distance
        outline = np.array([[s, half], [s, -half]])
        holes = bolting.access_holes(s)
        return MemberEnd(section, outline, 0.0, s, bolting.reach(s), holes, bolting.plate)

    def carve(self) -> Carving:
        """Cut facets, threaded holes and bore from a cylinder."""
        axes = _axes(self.arms)
        cutters = [_beyond(self, axis) for axis in axes]
        cutters += [hole for k, _ in enumerate(axes) for hole in _holes(self, k)]
        cutters += [cylinder(self.bore / 2, self.low - OVERLAP, self.high + OVERLAP)] if self.bore > 0 else []
        return Carving(cylinder(self.radius, self.low, self.high), join(cutters), _volume(self, axes))


def size_faceted(nodes: NodeParts, members: MemberSettings, settings: FacetedSettings) -> tuple["FacetedJoint", ...]:
    """Give one distance of all facets and one drum diameter for the design, the smallest that suit every node class.

    Raises
    ------
    Refused
        If members are no hollow sections, or a node breaks one of its limits.
    """
    sections = _tubes(members)
    bolting = {family: bolt_members(section, settings) for family, section in sections.items()}
    held = [arms.held for arms in nodes.arms]
    needed = max(_needed_distance(arms, bolting, settings) for arms in held)
    distance = settings.facet_distance or float(np.ceil(round(needed, 6)))
    reach = max(_needed_radius(arms, bolting, distance, settings) for arms in held)
    diameter = smallest_diameter(2 * reach, settings.drum_diameter, settings.diameter_step)
    joints = tuple(_joint(arms, (diameter, distance), bolting, settings) for arms in held)
    for joint, mark in zip(joints, nodes.marks, strict=True):
        refuse_limits(joint.limits, mark, _WAY_OUT)
    return joints


def _tubes(members: MemberSettings) -> dict[int, RhsSection]:
    found = {int(family): members.of(family) for family in (Family.GENERATRIX, Family.PARALLEL)}
    tubes = {family: section for family, section in found.items() if isinstance(section, RhsSection)}
    if len(tubes) == len(found):
        return tubes
    raise Refused(
        "E-NODE-SECTION",
        "members.section",
        f"{next(section.name for section in found.values() if not isinstance(section, RhsSection))} on a facet",
        "hollow sections",
        "Give hollow sections such as 'RHS 100x50x4', or nodes.detail = 'slotted' for plates.",
    )


def _axes(arms: NodeArms) -> Floats:
    """Unit directions (v, 3) of the arms in the node's frame."""
    level = np.cos(arms.elevation)
    return np.stack([level * np.cos(arms.azimuth), level * np.sin(arms.azimuth), np.sin(arms.elevation)], axis=-1)


def _frames(arms: NodeArms) -> tuple[Floats, Floats]:
    """Unit directions (v, 3), (v, 3) across the arms and along their depth, to the outside."""
    sine, cosine = np.sin(arms.azimuth), np.cos(arms.azimuth)
    across = np.stack([-sine, cosine, np.zeros_like(sine)], axis=-1)
    return across, np.cross(_axes(arms), across)


def _half_widths(arms: NodeArms, bolting: dict[int, Bolting], settings: FacetedSettings) -> Floats:
    """Half the width (v,) of every facet: the member's and the border."""
    return np.array([bolting[family].section.width / 2 + settings.facet_border for family in arms.family.tolist()])


def _half_depth(bolting: dict[int, Bolting]) -> float:
    return next(iter(bolting.values())).section.depth / 2


def _cut_free(arms: NodeArms, widths: Floats, half_depth: float) -> float:
    """Smallest distance of all facets at which no facet's plane cuts another facet.

    A corner c of facet 1 at the distance s lies inside facet 2 when `(s d₁ + c)·d₂ ≤ s`.
    """
    axes, (across, up) = _axes(arms), _frames(arms)
    signs = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]])
    corners = [signs @ np.array([widths[k] * across[k], half_depth * up[k]]) for k in range(len(axes))]
    pairs = permutations(range(len(axes)), 2)
    return max((float((corners[a] @ axes[b]).max() / max(1 - axes[a] @ axes[b], 1e-12)) for a, b in pairs), default=0.0)


def _hole_ends(arms: NodeArms, bolting: dict[int, Bolting]) -> tuple[Floats, Floats]:
    """How far (v,) the holes go in from the facets, and how far their axes are from the member's."""
    each = [bolting[family] for family in arms.family.tolist()]
    return np.array([b.hole_depth for b in each]), np.array([max(abs(y) for y in b.levels) for b in each])


def _needed_hole_reach(arms: NodeArms, bolting: dict[int, Bolting], settings: FacetedSettings) -> Floats:
    """Distance (v,) from the node axis at which the holes must end: a web between them, a core to the bore.

    Two holes of diameter d whose axes are in half planes at the angle γ are a web apart when `2 ρ sin(γ/2) ≥ d + web`.
    """
    each = [bolting[family] for family in arms.family.tolist()]
    diameter = max(b.bolt.diameter for b in each)
    gaps = np.minimum(arms.held_gap, np.pi)
    after = (diameter + settings.min_web) / (2 * np.sin(gaps / 2))
    core = settings.bore / 2 + settings.min_core + diameter / 2 * np.abs(np.sin(arms.elevation))
    return np.maximum(np.maximum(after, np.roll(after, 1)), core)


def _needed_distance(arms: NodeArms, bolting: dict[int, Bolting], settings: FacetedSettings) -> float:
    """Smallest distance of the facets that keeps every limit of one node class; 0 where only sills meet."""
    if not len(arms.azimuth):
        return 0.0
    sine, cosine = np.abs(np.sin(arms.elevation)), np.cos(arms.elevation)
    widths, half = _half_widths(arms, bolting, settings), _half_depth(bolting)
    depth, level = _hole_ends(arms, bolting)
    beside = (share(arms, widths) + half * sine) / cosine
    holes = depth + (_needed_hole_reach(arms, bolting, settings) + level * sine) / cosine
    return max(float(beside.max()), float(holes.max()), _cut_free(arms, widths, half))


def _needed_radius(arms: NodeArms, bolting: dict[int, Bolting], distance: float, settings: FacetedSettings) -> float:
    """Radius of the drum that holds all facets: `hypot(s cos e + (h/2)|sin e|, w/2 + 3)`."""
    outwards = distance * np.cos(arms.elevation) + _half_depth(bolting) * np.abs(np.sin(arms.elevation))
    return float(np.hypot(outwards, _half_widths(arms, bolting, settings)).max(initial=0.0))


def _joint(
    arms: NodeArms, sizes: tuple[float, float], bolting: dict[int, Bolting], settings: FacetedSettings
) -> FacetedJoint:
    """Size one class: drum diameter and facet distance are the design's."""
    diameter, distance = sizes
    elevation = arms.elevation if len(arms.elevation) else np.zeros(1)
    middle, rise = distance * np.sin(elevation), _half_depth(bolting) * np.cos(elevation)
    low = float(np.floor(round(float((middle - rise).min() - settings.facet_cover) * 1000, 3)) / 1000)
    high = float(np.ceil(round(float((middle + rise).max() + settings.facet_cover) * 1000, 3)) / 1000)
    each = tuple(bolting[family] for family in arms.family.tolist())
    return FacetedJoint(
        arms=arms,
        diameter=diameter,
        bore=settings.bore,
        low=low,
        high=high,
        clearance=settings.end_gap,
        limits=(*_limits(arms, sizes, bolting, settings), *(limit for b in dict.fromkeys(each) for limit in b.limits)),
        hardware=gather(item for bolting in each for item in bolting.hardware),
        stack=((diameter / 2, high),),
        distance=distance,
        border=settings.facet_border,
        cover=settings.facet_cover,
        families=bolting,
    )


def _limits(
    arms: NodeArms, sizes: tuple[float, float], bolting: dict[int, Bolting], settings: FacetedSettings
) -> tuple[Limit, ...]:
    radius, distance = sizes[0] / 2, sizes[1]
    holds = Limit("radius that holds the facets", radius, _needed_radius(arms, bolting, distance, settings))
    if not len(arms.azimuth):
        return (holds,)
    sine, cosine = np.abs(np.sin(arms.elevation)), np.cos(arms.elevation)
    widths, half = _half_widths(arms, bolting, settings), _half_depth(bolting)
    depth, level = _hole_ends(arms, bolting)
    inner = [
        (distance * cosine - half * sine, share(arms, widths)),
        ((distance - depth) * cosine - level * sine, _needed_hole_reach(arms, bolting, settings)),
    ]
    beside, holes = (min(zip(value.tolist(), least.tolist(), strict=True), key=_margin) for value, least in inner)
    return (
        holds,
        Limit("distance of facets from the axis", *beside),
        Limit("distance of facets uncut by others", distance, _cut_free(arms, widths, half)),
        Limit("distance of threaded holes from the axis", *holes),
    )


def _margin(pair: tuple[float, float]) -> float:
    return pair[0] - pair[1]


def _beyond(joint: FacetedJoint, axis: Floats) -> m3.Manifold:
    """All of the blank that lies beyond the facet perpendicular to an axis."""
    arm = int(np.argmax(_axes(joint.arms) @ axis))
    wide = 2 * (joint.radius + max(joint.high, -joint.low) + OVERLAP)
    return along_arm(block((joint.distance, -wide, -wide), (joint.distance + wide, wide, wide)), joint.arms, arm)


def _holes(joint: FacetedJoint, arm: int) -> list[m3.Manifold]:
    """The threaded holes of an arm, at the diameter of the thread, from beyond the facet inwards."""
    bolting = joint.bolting[arm]
    start, end = joint.distance - bolting.hole_depth, joint.distance + OVERLAP
    hole = cylinder(bolting.bolt.diameter / 2, start, end).rotate((0.0, 90.0, 0.0))
    return [along_arm(hole.translate((0.0, 0.0, level)), joint.arms, arm) for level in bolting.levels]


def _volume(joint: FacetedJoint, axes: Floats) -> float:
    """Volume (mm³) without the solid kernel: the convex drum by its half-spaces, less bore and holes as prisms."""
    count, angle = facets(joint.radius), np.pi / facets(joint.radius)
    normals = np.pi * (2 * np.arange(count) + 1) / count
    walls = np.stack([np.cos(normals), np.sin(normals), 0 * normals], axis=-1)
    planes = [np.column_stack([walls, np.full(count, -joint.radius * np.cos(angle))])]
    planes += [np.array([[0, 0, 1, -joint.high], [0, 0, -1, joint.low]])]
    planes += [np.column_stack([axes, np.full(len(axes), -joint.distance)])]
    middle = np.array([0.0, 0.0, (joint.low + joint.high) / 2])
    drum = ConvexHull(HalfspaceIntersection(np.concatenate(planes), middle).intersections).volume
    bore = disc(joint.bore / 2).area * (joint.high - joint.low) if joint.bore > 0 else 0.0
    holes = sum(len(b.levels) * disc(b.bolt.diameter / 2).area * b.hole_depth for b in joint.bolting)
    return float(drum - bore - holes)
