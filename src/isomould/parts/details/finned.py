"""Finned hubs: a round hub with a fork of two fins for every plate, bolted in double shear (fabrication, Node solids).

The plates' middle planes stay in the beam planes. Fins are welded to the hub from outside, along their whole height.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import manifold3d as m3
import numpy as np
import shapely
import shapely.affinity

from isomould.arrays import Floats
from isomould.errors import Refused
from isomould.form.mesh import Family
from isomould.parts.catalogue import AnySection, PlateSection
from isomould.parts.details.forks import Fork, Pattern, lay_pattern, make_fork
from isomould.parts.details.joint import (
    Carving,
    Counts,
    Fin,
    Joint,
    Limit,
    MemberEnd,
    along_arm,
    body_corners,
    refuse_limits,
    share,
    smallest_diameter,
    turned,
)
from isomould.parts.hardware import gather
from isomould.parts.kernel import OVERLAP, cylinder, disc, join
from isomould.parts.nodes import NodeArms, NodeParts
from isomould.parts.outline import area, round_outline
from isomould.parts.settings import FinnedSettings, MemberSettings

_SEAT = 1.25
"""Least radius of the hub in half widths of a fork: there its faces meet the hub at 53° from its radii at most."""

_NOISE = 6
"""Decimals of elevations (rad) that tell fins apart."""

_WAY_OUT = (
    "Divide the curves more finely, use a deeper section or smaller bolts, give other bolts (nodes.bolt_spacing, "
    "bolt_pitch), or leave nodes.drum_diameter, fin_height and bolt_distance out for what fits."
)


@dataclass(frozen=True, eq=False)
class FinnedJoint(Joint):
    """A hub with a fork per arm, the holes of all forks at one distance from the work point; lengths in mm.

    Attributes
    ----------
    distance : float
        Along the members' axes to the first column of bolts.
    fin_height : float
        Across the members, the same in the whole design.
    families : dict of int to Fork
        The fork of every `Family`.
    """

    distance: float
    fin_height: float
    families: dict[int, Fork]

    planned: ClassVar[bool] = True
    leans: ClassVar[bool] = True

    @property
    def forks(self) -> tuple[Fork, ...]:
        """The fork of each arm."""
        return tuple(self.families[family] for family in self.arms.family.tolist())

    @property
    def pattern(self) -> Pattern:
        """The holes of every fork."""
        return next(iter(self.families.values())).pattern

    @property
    def shoulder(self) -> float:
        """Distance of the plates' ends from the axis."""
        return self.radius + self.clearance

    @property
    def tag(self) -> int:
        """The distance of the bolts in µm."""
        return round(self.distance * 1000)

    @property
    def counts(self) -> Counts:
        """Fins, their holes, and the bore."""
        fins = 2 * len(self.forks)
        return Counts(fins=fins, holes=fins * self.pattern.count + int(self.bore > 0))

    @property
    def genus(self) -> int:
        """Every hole of a fin goes through it, and the bore through the hub."""
        return self.counts.holes

    @property
    def fins(self) -> tuple[Fin, ...]:
        """One per arm, with square corners at its free end."""
        pairs = zip(self.forks, self.arms.elevation.tolist(), strict=True)
        return tuple(self._fin(fork, elevation) for fork, elevation in pairs)

    def _fin(self, fork: Fork, elevation: float) -> Fin:
        """A fin whose foot touches the hub with its inner edge; the wedge that is left outside is for the weld."""
        foot, rise = _foot(self.radius, fork.gap / 2), round(abs(elevation), _NOISE)
        half, end = self.fin_height / 2, fork.pattern.length(self.distance)
        low, high = ((foot + y * np.sin(rise)) / np.cos(rise) for y in (-half, half))
        corners = round_outline(np.array([[low, -half], [end, -half], [end, half], [high, half]]))
        return Fin(fork.fin, tuple((float(x), float(y)) for x, y in corners), fork.pattern.holes(self.distance))

    @property
    def sizes(self) -> dict[str, Any]:
        """Bolts and fins, the same in all nodes; the forks of every section."""
        forks = {fork.section.name: fork.gap for fork in self.families.values()}
        return {
            "shoulder_mm": self.shoulder,
            "bolt_distance_mm": self.distance,
            "bolt_columns_mm": list(self.pattern.columns),
            "bolt_levels_mm": list(self.pattern.levels),
            "hole_mm": self.pattern.hole,
            "tool_mm": self.pattern.bolt.tool,
            "fin_thickness_mm": next(iter(self.families.values())).fin,
            "fin_height_mm": self.fin_height,
            "fork_gaps_mm": forks,
        }

    @property
    def weld_length(self) -> float:
        """One seam per fin, along its foot."""
        return float(2 * np.sum(self.fin_height / np.cos(self.arms.elevation)))

    def turned_volume(self, volume: float) -> float:
        """The hub alone."""
        del volume
        return _hub_area(self) * self.height

    def hold(self, section: AnySection) -> tuple[float, float]:
        """Both fins with heads and nuts, to the fins' ends."""
        widths = [2 * fork.envelope for fork in self.families.values() if fork.section == section]
        return max(widths), self.pattern.length(self.distance)

    def end(self, section: AnySection, elevation: float) -> MemberEnd:
        """A cut parallel to the node's axis, clear of the hub, and the holes of the fork."""
        top, bottom = body_corners(section, elevation, self.shoulder)
        return MemberEnd(
            section=section,
            outline=turned([(self.shoulder, top), (self.shoulder, bottom)], elevation),
            angle=-elevation,
            set_back=float(self.shoulder / np.cos(elevation)),
            reach=self.pattern.length(self.distance),
            holes=self.pattern.holes(self.distance),
        )

    def carve(self) -> Carving:
        """Weld fins that reach into the hub to it, then drill them and the bore."""
        arms, bodies, holes, volume = range(len(self.forks)), list[m3.Manifold](), list[m3.Manifold](), 0.0
        for arm in arms:
            inward = _reaching_in(self, arm)
            bodies += [along_arm(plate, self.arms, arm) for plate in _plates(inward, self.forks[arm])]
            holes += [along_arm(hole, self.arms, arm) for hole in _drills(self)]
            volume += _standing_out(self, arm, inward)
        bore = [cylinder(self.bore / 2, self.low - OVERLAP, self.high + OVERLAP)] if self.bore > 0 else []
        blank = join([cylinder(self.radius, self.low, self.high), *bodies])
        return Carving(blank, join([*holes, *bore]), _hub_area(self) * self.height + volume)


def size_finned(nodes: NodeParts, members: MemberSettings, settings: FinnedSettings) -> tuple["FinnedJoint", ...]:
    """Give one diameter of hubs, one height of fins and one distance of bolts, the smallest that suit every node class.

    Raises
    ------
    Refused
        If members are no plates, or a node breaks one of its limits.
    """
    depth, plates = members.section.depth, _plate_sections(members)
    forks = _forks(plates, lay_pattern(depth, depth, settings), settings)
    held = [arms.held for arms in nodes.arms]
    needed = max(_needed_radius(arms, forks, settings) for arms in held)
    diameter = smallest_diameter(2 * needed, settings.drum_diameter, settings.diameter_step)
    height = settings.fin_height or min(_fin_height(arms, diameter / 2, members, settings) for arms in held)
    forks = _forks(plates, lay_pattern(depth, height, settings), settings)
    least = max(_needed_distance(arms, forks, diameter / 2, settings) for arms in held)
    distance = settings.bolt_distance or float(np.ceil(round(least, 6)))
    joints = tuple(_joint(arms, (diameter, height, distance), forks, members, settings) for arms in held)
    for joint, mark in zip(joints, nodes.marks, strict=True):
        refuse_limits(joint.limits, mark, _WAY_OUT)
    return joints


def _plate_sections(members: MemberSettings) -> dict[int, PlateSection]:
    found = {int(family): members.of(family) for family in (Family.GENERATRIX, Family.PARALLEL)}
    plates = {family: section for family, section in found.items() if isinstance(section, PlateSection)}
    if len(plates) == len(found):
        return plates
    raise Refused(
        "E-NODE-SECTION",
        "members.section",
        f"{next(section.name for section in found.values() if not isinstance(section, PlateSection))} in a fork",
        "plates",
        "Give plates, or nodes.detail = 'faceted' for hollow sections.",
    )


def _forks(plates: dict[int, PlateSection], pattern: Pattern, settings: FinnedSettings) -> dict[int, Fork]:
    return {family: make_fork(section, pattern, settings) for family, section in plates.items()}


def _each(arms: NodeArms, forks: dict[int, Fork]) -> list[Fork]:
    return [forks[family] for family in arms.family.tolist()]


def _foot(radius: float, aside: float) -> float:
    """Distance from the axis, along an arm, of the hub's surface beside its beam plane."""
    return float(np.sqrt(max(radius**2 - aside**2, 0.0)))


def _needed_feet(arms: NodeArms, forks: dict[int, Fork], settings: FinnedSettings) -> Floats:
    """Distance (v,) from the axis at which the outer faces of the fins may meet the hub."""
    widths = np.array([fork.half for fork in _each(arms, forks)]) + settings.weld_access
    return share(arms, widths)


def _needed_radius(arms: NodeArms, forks: dict[int, Fork], settings: FinnedSettings) -> float:
    """Smallest hub that carries the forks, leaves room to weld them, and has a wall around its bore."""
    wall = settings.bore / 2 + max(settings.min_core, settings.fin_thickness)
    if not len(arms.azimuth):
        return wall
    halves = np.array([fork.half for fork in _each(arms, forks)])
    feet = np.hypot(_needed_feet(arms, forks, settings), halves)
    return max(wall, float(feet.max()), _SEAT * float(halves.max()))


def _low_tops(arms: NodeArms, radius: float, members: MemberSettings) -> float:
    """Lowest level of the members' edges over the hub: `min over arms [(h/2)/cos e − R tan|e|]`; nothing is higher."""
    rise = np.abs(arms.elevation)
    return float((members.section.depth / 2 / np.cos(rise) - radius * np.tan(rise)).min())


def _fin_height(arms: NodeArms, radius: float, members: MemberSettings, settings: FinnedSettings) -> float:
    """Height of fins, in whole mm, whose feet are on a hub that no member's edge is below."""
    if not len(arms.elevation):
        return float(np.floor(members.section.depth - 2 * settings.fin_cover))
    rise, top = np.abs(arms.elevation), _low_tops(arms, radius, members) - settings.fin_cover
    return float(np.floor(round(float((2 * np.cos(rise) * (top - radius * np.tan(rise))).min()), 6)))


def _hub_half(arms: NodeArms, radius: float, fin_height: float, settings: FinnedSettings) -> float:
    """Half the height of a hub that the fins' feet do not leave, rounded up to 0.001 mm."""
    rise = np.abs(arms.elevation) if len(arms.elevation) else np.zeros(1)
    half = float((fin_height / 2 / np.cos(rise) + radius * np.tan(rise)).max()) + settings.fin_cover
    return float(np.ceil(round(half * 1000, 3)) / 1000)


def _tool_rooms(arms: NodeArms, forks: dict[int, Fork]) -> Floats:
    """Distance (v,) from the axis at which a socket, and a bolt on its way in, are clear of the next fork's bolts.

    The near edge of a tool at the distance r, at the end of a bolt that reaches L from its beam plane, is
    `r sin γ − L cos γ` away from the beam plane at the angle γ.
    """
    each = _each(arms, forks)
    gaps = np.minimum(arms.held_gap, np.pi - 1e-3)
    reach, beside = (np.array([getattr(fork, name) for fork in each]) for name in ("reach", "envelope"))
    after = (np.roll(beside, -1) + reach * np.cos(gaps)) / np.sin(gaps)
    turned_gaps = np.roll(gaps, 1)
    before = (np.roll(beside, 1) + reach * np.cos(turned_gaps)) / np.sin(turned_gaps)
    return np.maximum(np.maximum(after, before), 0.0)


def _needed_reach(arms: NodeArms, forks: dict[int, Fork], radius: float, settings: FinnedSettings) -> Floats:
    """Distance (v,) from the axis that bolts need: for the plate's end, the tool at the hub, and beside others."""
    pattern = next(iter(forks.values())).pattern
    end, tool = radius + settings.end_gap + pattern.edge, pattern.bolt.tool / 2
    return np.maximum(np.maximum(end, radius + tool), _tool_rooms(arms, forks) + tool)


def _needed_distance(arms: NodeArms, forks: dict[int, Fork], radius: float, settings: FinnedSettings) -> float:
    """Smallest distance of the first bolts along the members: `r = x cos e − |y sin e|`."""
    if not len(arms.azimuth):
        return 0.0
    highest = next(iter(forks.values())).pattern.highest
    level = highest * np.abs(np.sin(arms.elevation))
    return float(((_needed_reach(arms, forks, radius, settings) + level) / np.cos(arms.elevation)).max())


def _joint(
    arms: NodeArms,
    sizes: tuple[float, float, float],
    forks: dict[int, Fork],
    members: MemberSettings,
    settings: FinnedSettings,
) -> FinnedJoint:
    """Size one class: diameter of the hub, height of the fins and distance of the bolts are the design's."""
    diameter, fin_height, distance = sizes
    half = _hub_half(arms, diameter / 2, fin_height, settings)
    return FinnedJoint(
        arms=arms,
        diameter=diameter,
        bore=settings.bore,
        low=-half,
        high=half,
        clearance=settings.end_gap,
        limits=_limits(arms, sizes, forks, members, settings),
        hardware=gather(item for fork in _each(arms, forks) for item in fork.hardware),
        stack=((diameter / 2, half),),
        distance=distance,
        fin_height=fin_height,
        families=forks,
    )


def _limits(
    arms: NodeArms,
    sizes: tuple[float, float, float],
    forks: dict[int, Fork],
    members: MemberSettings,
    settings: FinnedSettings,
) -> tuple[Limit, ...]:
    radius, fin_height, distance = sizes[0] / 2, sizes[1], sizes[2]
    wall = Limit("wall of the hub", radius - settings.bore / 2, max(settings.min_core, settings.fin_thickness))
    if not len(arms.azimuth):
        return (wall,)
    pattern, each = next(iter(forks.values())).pattern, _each(arms, forks)
    highest, tool = pattern.highest, pattern.bolt.tool / 2
    nearest = distance * np.cos(arms.elevation) - highest * np.abs(np.sin(arms.elevation))
    halves = [fork.half for fork in each]
    feet = [_foot(radius, half) for half in halves]
    hub = _hub_half(arms, radius, fin_height, settings)
    return (
        wall,
        Limit("radius of the hub under a fork", radius, _SEAT * max(halves)),
        _tightest("foot of fins from the axis", feet, _needed_feet(arms, forks, settings)),
        Limit("level of members' edges at the hub", _low_tops(arms, radius, members), hub),
        Limit("edge of the fins beside their bolts", fin_height / 2 - highest, pattern.edge),
        Limit("edge of the members beside their bolts", members.section.depth / 2 - highest, pattern.edge),
        Limit("end of the members before their bolts", float(nearest.min()) - radius - settings.end_gap, pattern.edge),
        Limit("room for the tool before the hub", float(nearest.min()) - radius, tool),
        _tightest("room for bolts and tool beside forks", nearest - tool, _tool_rooms(arms, forks)),
        *pattern.limits,
    )


def _tightest(name: str, values: Floats | list[float], required: Floats) -> Limit:
    pairs = zip(np.asarray(values).tolist(), required.tolist(), strict=True)
    return min((Limit(name, *pair) for pair in pairs), key=lambda limit: limit.margin)


def _hub_area(joint: FinnedJoint) -> float:
    """Cross-section of the hub, mm²."""
    return disc(joint.radius).area - (disc(joint.bore / 2).area if joint.bore > 0 else 0.0)


def _reaching_in(joint: FinnedJoint, arm: int) -> Floats:
    """Corners (4, 2) of an arm's fin that reaches into the hub, counter-clockwise, in the frame of the member."""
    fork, elevation = joint.forks[arm], joint.arms.elevation[arm]
    corners = np.array(joint.fins[arm].corners)
    inner = _foot(joint.radius, fork.half) - OVERLAP
    shift = (_foot(joint.radius, fork.gap / 2) - inner) / np.cos(elevation)
    extended = corners - [[shift, 0.0], [0.0, 0.0], [0.0, 0.0], [shift, 0.0]]
    return extended if elevation >= 0 else (extended * [1.0, -1.0])[::-1]


def _plates(outline: Floats, fork: Fork) -> list[m3.Manifold]:
    """Both fins of a fork: x along the member, y across, z along its depth."""
    face = m3.CrossSection([outline], m3.FillRule.Positive)
    plate = m3.Manifold.extrude(face, fork.fin).rotate((90.0, 0.0, 0.0))  # now from y = 0 to −thickness
    return [plate.translate((0.0, y, 0.0)) for y in (-fork.gap / 2, fork.half)]


def _drills(joint: FinnedJoint) -> list[m3.Manifold]:
    """Cylinders through both fins of a fork."""
    reach = max(fork.half for fork in joint.forks) + OVERLAP
    drill = cylinder(joint.pattern.hole / 2, -reach, reach).rotate((90.0, 0.0, 0.0))
    return [drill.translate((hole.x, 0.0, hole.y)) for hole in joint.pattern.holes(joint.distance)]


def _standing_out(joint: FinnedJoint, arm: int, outline: Floats) -> float:
    """Volume (mm³) of both fins of an arm outside the hub, less their holes, without the solid kernel.

    At the distance y from the beam plane the hub's surface is X(y) away along the arm: a fin of the height h_f, whose
    inner edge is x_in away in the middle, is inside the hub by `h_f (X/cos e − x_in)`.
    """
    fork, azimuth, elevation = joint.forks[arm], joint.arms.azimuth[arm], joint.arms.elevation[arm]
    inner = (outline[:, 0].min() + np.sort(outline[:, 0])[1]) / 2
    hub, volume = disc(joint.radius), 0.0
    for low, high in ((fork.gap / 2, fork.half), (-fork.half, -fork.gap / 2)):
        strip = shapely.affinity.rotate(
            shapely.box(0.0, low, joint.radius + OVERLAP, high), azimuth, origin=(0, 0), use_radians=True
        )
        within = shapely.intersection(hub, strip).area / np.cos(elevation) - fork.fin * inner
        volume += fork.fin * area(outline) - joint.fin_height * within
    holes = 2 * fork.fin * joint.pattern.count * disc(joint.pattern.hole / 2).area
    return float(volume - holes)
