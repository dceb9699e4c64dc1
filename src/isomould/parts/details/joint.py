"""What every node detail gives: a sized node, its limits with margins, and what it asks of the members' ends."""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, ClassVar

import manifold3d as m3
import numpy as np

from isomould.arrays import Floats, read_only
from isomould.errors import Refused
from isomould.parts.catalogue import AnySection
from isomould.parts.features import EndPlate, Hole
from isomould.parts.hardware import Item
from isomould.parts.nodes import NodeArms

_NOISE = 1e-9


@dataclass(frozen=True)
class Limit:
    """An inequality of a detail, in mm: `value` is at least `required`."""

    name: str
    value: float
    required: float

    @property
    def margin(self) -> float:
        """What is left."""
        return self.value - self.required


@dataclass(frozen=True)
class Counts:
    """What is worked into a node: slots, facets, fins on it, holes with the bore, threads among them."""

    slots: int = 0
    facets: int = 0
    fins: int = 0
    holes: int = 0
    threads: int = 0


@dataclass(frozen=True)
class Fin:
    """A flat plate on a hub. Lengths in mm, x from the work point along the member that it holds, y to the outside.

    It is drawn for an arm that rises or is level; turned over about x it is the one for an arm that falls.
    """

    thickness: float
    corners: tuple[tuple[float, float], ...]
    holes: tuple[Hole, ...]


@dataclass(frozen=True, eq=False)
class MemberEnd:
    """What a node asks of the start of a member: x from the work point along the system line, y to the outside.

    Attributes
    ----------
    section : PlateSection or RhsSection
    outline : (n, 2) float, mm
        The end's contour from top to bottom.
    angle : float, rad
        End cut: 0 square, positive where the top is longer.
    set_back : float, mm
        Along the system line from the work point to the cut.
    reach : float, mm
        How far along the member its holes reach.
    holes : tuple of Hole
    plate : EndPlate, optional
    """

    section: AnySection
    outline: Floats
    angle: float
    set_back: float
    reach: float = 0.0
    holes: tuple[Hole, ...] = ()
    plate: EndPlate | None = None

    def __post_init__(self) -> None:
        read_only(self.outline)


@dataclass(frozen=True, eq=False)
class Carving:
    """How a node's solid is made: a blank less what is cut out, and the volume (mm³) that both should leave."""

    blank: m3.Manifold
    cutters: m3.Manifold
    volume: float


@dataclass(frozen=True, eq=False)
class Joint(ABC):
    """A sized node class. Lengths in mm, levels along the node axis from the work point.

    Attributes
    ----------
    arms : NodeArms
        The arms that the node holds.
    diameter, bore, low, high : float
        Of the drum, low and high its lowest and highest level.
    clearance : float
        Between the node and what stands beside it.
    limits : tuple of Limit
    hardware : tuple of Item
        Per node.
    stack : tuple of (radius, height)
        What stands around the axis above the work point, drum, cap and bolt head, the widest first.
    """

    arms: NodeArms
    diameter: float
    bore: float
    low: float
    high: float
    clearance: float
    limits: tuple[Limit, ...]
    hardware: tuple[Item, ...]
    stack: tuple[tuple[float, float], ...]

    planned: ClassVar[bool]
    """Whether a plan describes it, the same all along its axis."""

    leans: ClassVar[bool]
    """Whether end cuts follow the elevation of the arms; else members are cut square."""

    @property
    def radius(self) -> float:
        """Half the diameter."""
        return self.diameter / 2

    @property
    def height(self) -> float:
        """Height of the drum."""
        return round(self.high - self.low, 3)

    @property
    def under(self) -> tuple[tuple[float, float], ...]:
        """What stands around the axis below the work point, as (radius, depth): the same as above it."""
        return self.stack

    @property
    def planes(self) -> Floats:
        """Planes (k, 4) that cut the drum: unit normals to the outside, and their distances from the work point."""
        return np.empty((0, 4))

    @property
    def proud(self) -> bool:
        """Whether something may stand above the members: members that lean end lower than their drum."""
        return len(self.stack) > 1 or not self.leans

    @property
    def stack_height(self) -> float:
        """Highest level of all that stands on the node."""
        return max(height for _, height in self.stack)

    @property
    def stack_radius(self) -> float:
        """Largest distance from the axis of all that stands on the node."""
        return max(radius for radius, _ in self.stack)

    def reach(self, elevation: float) -> float:
        """Give how far the node reaches in a direction of this elevation: `r cos e + z |sin e|` at most."""
        steps = [*self.stack, (self.radius, -self.low)]
        return max(radius * np.cos(elevation) + height * abs(np.sin(elevation)) for radius, height in steps)

    @property
    @abstractmethod
    def tag(self) -> int:
        """What of the node, beside the arm's angles, shapes a member's end: equal tags, equal ends."""

    @property
    @abstractmethod
    def counts(self) -> Counts:
        """What is worked into the node."""

    @property
    def genus(self) -> int:
        """How many holes go through its solid."""
        return int(self.bore > 0)

    @property
    def fins(self) -> tuple[Fin, ...]:
        """The fin of every arm; two of each stand on the node."""
        return ()

    @property
    @abstractmethod
    def sizes(self) -> dict[str, Any]:
        """Sizes that all nodes of the design share, as data for the verifier."""

    @property
    def weld_length(self) -> float:
        """Length of the welds that hold the members."""
        return 0.0

    def turned_volume(self, volume: float) -> float:
        """Give what is turned from a bar of a solid of this volume, mm³: all of it, where nothing is welded on."""
        return volume

    def hold(self, section: AnySection) -> tuple[float, float]:
        """Give breadth and reach from the work point, mm, of what holds a member of this section outside the drum."""
        return section.width, 0.0

    @abstractmethod
    def end(self, section: AnySection, elevation: float) -> MemberEnd:
        """Give the end of a member of this section that leaves the node at this elevation (rad)."""

    @abstractmethod
    def carve(self) -> Carving:
        """Build the bodies of the solid in the node's frame."""


def tightest(joints: tuple[Joint, ...]) -> tuple[tuple[str, float, float], ...]:
    """Give the tightest case (name, value, required) of every limit of the design."""
    worst: dict[str, Limit] = {}
    for limit in (limit for joint in joints for limit in joint.limits):
        if limit.name not in worst or limit.margin < worst[limit.name].margin:
            worst[limit.name] = limit
    return tuple((limit.name, limit.value, limit.required) for limit in worst.values())


def refuse_limits(limits: Iterable[Limit], where: str, way_out: str) -> None:
    """Refuse a node that breaks one of its limits."""
    broken = next((limit for limit in limits if limit.margin < -_NOISE), None)
    if broken is not None:
        found = f"{broken.name} is {broken.value:.3f} mm"
        raise Refused("E-NODE-LIMIT", f"nodes ({where})", found, f"at least {broken.required:.3f} mm", way_out)


def smallest_diameter(needed: float, asked: float | None, step: float) -> float:
    """Round the diameter that is needed up to the step, or hold the one that was asked for to it.

    Raises
    ------
    Refused
        If the one asked for is too small.
    """
    if asked is None:
        return step * float(np.ceil(round(needed / step, 9)))
    if asked < needed - _NOISE:
        raise Refused(
            "E-NODE-DRUM",
            "nodes.drum_diameter",
            f"a drum of {asked:.3f} mm leaves no room for its arms",
            f"at least {needed:.3f} mm",
            f"Give {np.ceil(needed):g} mm or more, or leave the field out for the smallest drum that fits.",
        )
    return asked


def share(arms: NodeArms, widths: Floats) -> Floats:
    """Distance (v,) from the axis where parts of these half widths end, before their neighbours' half planes begin.

    `(w/2)/tan(γ/2)`: from there on they stay on their sides of the planes halfway between the arms.
    """
    wider = np.maximum(widths, np.roll(widths, -1))
    after = wider / np.tan(np.minimum(arms.held_gap, np.pi) / 2)
    return np.maximum(after, np.roll(after, 1))


def along_arm(body: m3.Manifold, arms: NodeArms, arm: int) -> m3.Manifold:
    """Turn a body with x along a member, y across and z along its depth into the node's frame."""
    return body.rotate((0.0, -float(np.degrees(arms.elevation[arm])), float(np.degrees(arms.azimuth[arm]))))


def body_corners(section: AnySection, elevation: float, shoulder: float) -> tuple[float, float]:
    """Levels at which the top and bottom edges of a member meet a line parallel to the axis, at this distance."""
    sine, cosine = np.sin(elevation), np.cos(elevation)
    top, bottom = ((side * section.depth / 2 + shoulder * sine) / cosine for side in (1, -1))
    return float(top), float(bottom)


def turned(points: Iterable[tuple[float, float]], elevation: float) -> Floats:
    """Turn points (r, z) of a node's half-plane into the frame (x, y) of the member there."""
    r, z = np.array(list(points)).T
    sine, cosine = np.sin(elevation), np.cos(elevation)
    return np.stack([r * cosine + z * sine, -r * sine + z * cosine], axis=-1)
