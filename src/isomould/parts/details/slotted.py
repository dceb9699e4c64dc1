"""Slotted drums: a radial slot for every plate, all parallel to the node axis (fabrication, Node solids).

The plates are welded in their slots, or held by the lips of caps (`caps`).
"""

from dataclasses import asdict, dataclass
from typing import Any, ClassVar

import manifold3d as m3
import numpy as np
import shapely
import shapely.affinity

from isomould.arrays import Floats
from isomould.errors import Refused
from isomould.form.mesh import Family
from isomould.parts.catalogue import AnySection, PlateSection
from isomould.parts.details.caps import Cap, cap_needs, hold_plates
from isomould.parts.details.joint import (
    Carving,
    Counts,
    Joint,
    Limit,
    MemberEnd,
    body_corners,
    refuse_limits,
    smallest_diameter,
    turned,
)
from isomould.parts.kernel import OVERLAP, block, cylinder, disc, join
from isomould.parts.nodes import NodeArms, NodeParts
from isomould.parts.settings import MemberSettings, SlottedSettings

_STEP = 0.002
"""Lower steps (mm) between body and tongue are left out: there the tongue is as high as the body."""

_WAY_OUT = "Divide the curves more finely (flatter arms), or use a smaller drum or a deeper section."


@dataclass(frozen=True, eq=False)
class SlottedJoint(Joint):
    """A drum with radial slots; lengths in mm, distances from the axis.

    Attributes
    ----------
    slot_widths : (s,) float
        Of the slots in the order of the arms.
    slot_clearance : float
        What they are wider than the plates.
    slot_floor, plate_end : float
        Of the slots' floors and the plates' ends.
    nose : bool
        Whether the slots end round.
    cap : Cap, optional
        Without it the plates are welded.
    """

    slot_widths: Floats
    slot_clearance: float
    slot_floor: float
    plate_end: float
    nose: bool
    cap: Cap | None

    planned: ClassVar[bool] = True
    leans: ClassVar[bool] = True

    @property
    def shoulder(self) -> float:
        """Distance of the plates' shoulders from the axis."""
        return self.radius + self.clearance

    @property
    def tag(self) -> int:
        """The height of the drum in µm: tongues are as high."""
        return round(self.height * 1000)

    @property
    def counts(self) -> Counts:
        """Slots and the bore."""
        return Counts(slots=len(self.slot_widths), holes=int(self.bore > 0))

    @property
    def sizes(self) -> dict[str, Any]:
        """Slots, plate ends, shoulders and caps, the same in all nodes."""
        return {
            "retention": "lipped-cap" if self.cap else "weld",
            "slot_floor_mm": self.slot_floor,
            "plate_end_mm": self.plate_end,
            "shoulder_mm": self.shoulder,
            "slot_clearance_mm": self.slot_clearance,
            "slot_end": "round" if self.nose else "square",
            "cap": asdict(self.cap) if self.cap else None,
        }

    @property
    def weld_length(self) -> float:
        """Both sides of every slot; nothing where caps hold the plates."""
        return 0.0 if self.cap else 2.0 * self.height * len(self.slot_widths)

    def end(self, section: AnySection, elevation: float) -> MemberEnd:
        """Body corner, shoulder, tongue with its notches, shoulder, body corner."""
        set_back = self.plate_end / np.cos(elevation)
        outline = turned(_end_points(self, section, elevation), elevation)
        return MemberEnd(section, outline, -elevation, float(set_back))

    def carve(self) -> Carving:
        """Cut slots, bore and the grooves of the caps' lips from a cylinder, all longer than it."""
        cutters = [*_slots(self), *_bore(self), *(self.cap.grooves(self.high) if self.cap else ())]
        blank = cylinder(self.radius, self.low, self.high)
        return Carving(blank, join(cutters), _volume(self))


def size_slotted(nodes: NodeParts, members: MemberSettings, settings: SlottedSettings) -> tuple[Joint, ...]:
    """Give one drum diameter for the design, the smallest that suits every node class or the one asked for.

    Raises
    ------
    Refused
        If members are no plates, a given diameter or slot depth is too small, or a drum would be lower than 0.6 of
        the members' depth.
    """
    _refuse_tubes(members)
    held = [arms.held for arms in nodes.arms]
    depth = _slot_depth(held, members, settings)
    floor = max(_needed_floor(arms, members, settings) for arms in nodes.arms)
    diameter = smallest_diameter(2 * (floor + depth), settings.drum_diameter, settings.diameter_step)
    joints = tuple(_joint(arms, (diameter, depth), members, settings) for arms in nodes.arms)
    for joint, mark in zip(joints, nodes.marks, strict=True):
        refuse_limits(joint.limits, mark, _WAY_OUT)
    return joints


def _refuse_tubes(members: MemberSettings) -> None:
    sections = [members.of(family) for family in (Family.GENERATRIX, Family.PARALLEL)]
    tube = next((section for section in sections if not isinstance(section, PlateSection)), None)
    if tube is not None:
        raise Refused(
            "E-NODE-SECTION",
            "members.section",
            f"{tube.name} in a slot",
            "plates",
            "Give plates, or nodes.detail = 'faceted' for hollow sections.",
        )


def _widths(arms: NodeArms, members: MemberSettings) -> Floats:
    """Thickness (s,) mm of the plates in the slots."""
    return np.array([members.of(family).width for family in arms.family])


def _slot_depth(held: list[NodeArms], members: MemberSettings, settings: SlottedSettings) -> float:
    """Depth of all slots: end gap and the engagement of the thickest plate."""
    needed = settings.end_gap + max(_engagement(arms, members, settings) for arms in held)
    if settings.slot_depth is None or settings.slot_depth >= needed - 1e-9:
        return settings.slot_depth or needed
    raise Refused(
        "E-NODE-SLOT",
        "nodes.slot_depth",
        f"a slot of {settings.slot_depth:.3f} mm holds too little of the plate",
        f"at least {needed:.3f} mm (end gap and an engagement of 25 mm or twice the thickness)",
        f"Give {needed:g} mm or more, or leave the field out.",
    )


def _engagement(arms: NodeArms, members: MemberSettings, settings: SlottedSettings) -> float:
    """Least length of plate in the slots: 25 mm, twice the thickness, or what hooks behind lips need."""
    thickness = float(_widths(arms, members).max(initial=0.0))
    needs = [25.0, 2 * thickness]
    return max(needs + ([cap_needs(settings.cap, thickness)] if settings.retention == "lipped-cap" else []))


def _noses(widths: Floats, settings: SlottedSettings) -> float:
    return float(widths.max(initial=0.0)) / 2 if settings.slot_end == "round" else 0.0


def _half_width(arms: NodeArms, widths: Floats, nose: float) -> Floats:
    """What two neighbouring slots take of the distance between their floors, halved: corners, or round noses."""
    gaps = np.minimum(arms.held_gap, np.pi)
    mean = (widths + np.roll(widths, -1)) / 2
    return np.full_like(gaps, nose) if nose else mean / 2 * np.cos(gaps / 2)


def _needed_floor(arms: NodeArms, members: MemberSettings, settings: SlottedSettings) -> float:
    """Smallest slot floor ρ with `2(ρ sin(γ/2) − (w/2) cos(γ/2)) ≥ web` for all azimuth gaps γ, clear of the bore."""
    widths = _widths(arms.held, members) + settings.clearance
    nose = _noses(widths, settings)
    gaps = np.minimum(arms.held_gap, np.pi)
    webs = (settings.min_web / 2 + _half_width(arms, widths, nose)) / np.sin(gaps / 2)
    return max(float(webs.max(initial=0.0)), settings.bore / 2 + settings.min_core + nose)


def _joint(
    arms: NodeArms, sizes: tuple[float, float], members: MemberSettings, settings: SlottedSettings
) -> SlottedJoint:
    """Size one class: drum diameter and slot depth are the design's."""
    diameter, depth = sizes
    held, floor = arms.held, diameter / 2 - depth
    widths = _widths(held, members) + settings.clearance
    height = _height(held, members.section, diameter / 2 + settings.end_gap)
    plate_end = floor + settings.end_gap
    nose = _noses(widths, settings)
    gaps = np.minimum(arms.held_gap, np.pi)
    webs = 2 * (floor * np.sin(gaps / 2) - _half_width(arms, widths, nose))
    limits = (
        *([Limit("web between slots", float(webs.min()), settings.min_web)] if len(webs) else []),
        Limit("core between slots and bore", floor - settings.bore / 2 - nose, settings.min_core),
        Limit("engagement of plates", diameter / 2 - plate_end, _engagement(held, members, settings)),
        Limit("height of the drum", height, 0.6 * members.section.depth),
    )
    thickest = float(_widths(held, members).max(initial=0.0))
    caps = hold_plates((diameter, height, plate_end), thickest, settings)
    return SlottedJoint(
        arms=held,
        diameter=diameter,
        bore=settings.bore,
        low=-height / 2,
        high=height / 2,
        clearance=settings.end_gap,
        limits=(*limits, *caps.limits),
        hardware=caps.hardware,
        stack=caps.stack,
        slot_widths=widths,
        slot_clearance=settings.clearance,
        slot_floor=floor,
        plate_end=plate_end,
        nose=settings.slot_end == "round",
        cap=caps.cap,
    )


def _height(arms: NodeArms, section: AnySection, shoulder: float) -> float:
    """Drum height: `H/2 = min over arms [(h/2)/cos e − (R + end gap) tan|e|]`, rounded down to 0.001 mm.

    A drum without slots, where sills meet and nothing else, is as high as a level arm would make it.
    """
    if not len(arms.elevation):
        return section.depth
    half = section.depth / 2 / np.cos(arms.elevation) - shoulder * np.tan(np.abs(arms.elevation))
    return round(float(np.floor(round(2 * half.min() / 0.001, 3)) * 0.001), 3)


def _end_points(joint: SlottedJoint, section: AnySection, elevation: float) -> list[tuple[float, float]]:
    """Points (r, z) of a plate's end from top to bottom: r from the node axis, z along it."""
    half, shoulder, floor = joint.height / 2, joint.shoulder, joint.plate_end
    top, bottom = body_corners(section, elevation, shoulder)
    notch = joint.cap.notch(half, section.width) if joint.cap else []
    tongue = [(floor, half), (floor, -half)]
    upper = [(shoulder, half)] if top - half > _STEP else []
    lower = [(shoulder, -half)] if -half - bottom > _STEP else []
    under = [(r, -z) for r, z in reversed(notch)]
    return [(shoulder, top), *upper, *notch, *tongue, *under, *lower, (shoulder, bottom)]


def _slots(joint: SlottedJoint) -> list[m3.Manifold]:
    """One slot per arm: its full width reaches from the slot floor beyond the rim."""
    low, high, rim = joint.low - OVERLAP, joint.high + OVERLAP, joint.radius + OVERLAP
    slots = list[m3.Manifold]()
    for azimuth, width in zip(joint.arms.azimuth, joint.slot_widths.tolist(), strict=True):
        slot = block((joint.slot_floor, -width / 2, low), (rim, width / 2, high))
        if joint.nose:
            slot += cylinder(width / 2, low, high).translate((joint.slot_floor, 0.0, 0.0))
        slots.append(slot.rotate((0.0, 0.0, float(np.degrees(azimuth)))))
    return slots


def _bore(joint: SlottedJoint) -> list[m3.Manifold]:
    return [cylinder(joint.bore / 2, joint.low - OVERLAP, joint.high + OVERLAP)] if joint.bore > 0 else []


def _volume(joint: SlottedJoint) -> float:
    """Volume (mm³) by planar booleans, without the solid kernel: section times height, less grooves."""
    section = disc(joint.radius).difference(_openings(joint))
    grooves = shapely.intersection(joint.cap.groove, section).area * 2 * joint.cap.groove_depth if joint.cap else 0.0
    return float(section.area * joint.height - grooves)


def _openings(joint: SlottedJoint) -> shapely.Geometry:
    """Slots and bore in the plane."""
    rim = joint.radius + OVERLAP
    slots = list[shapely.Geometry]()
    for azimuth, width in zip(joint.arms.azimuth, joint.slot_widths.tolist(), strict=True):
        slot = shapely.box(joint.slot_floor, -width / 2, rim, width / 2)
        slot = slot.union(disc(width / 2, joint.slot_floor)) if joint.nose else slot
        slots.append(shapely.affinity.rotate(slot, float(azimuth), origin=(0, 0), use_radians=True))
    bore = [disc(joint.bore / 2)] if joint.bore > 0 else []
    return shapely.union_all([*slots, *bore])
