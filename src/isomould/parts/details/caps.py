"""Lipped caps: discs on both ends of a slotted drum, on a centre bolt (fabrication, Node solids).

The ring lip of a cap stands in a groove of the drum and in a notch of every tongue, so that no plate can leave its
slot. Both caps of a node are the same part, and so are those of all nodes of a design.
"""

from dataclasses import dataclass

import manifold3d as m3
import numpy as np
import shapely

from isomould.errors import Refused
from isomould.parts.details.joint import Carving, Limit
from isomould.parts.hardware import Bolt, Item, find_bolt, next_length
from isomould.parts.kernel import OVERLAP, annulus, cylinder, join
from isomould.parts.settings import CapSettings, SlottedSettings


@dataclass(frozen=True)
class Cap:
    """A cap with its lip; lengths in mm, radii from the axis."""

    radius: float
    thickness: float
    hole: float
    lip_inner: float
    lip_outer: float
    lip_height: float
    clearance: float

    @property
    def groove_depth(self) -> float:
        """Depth of the drum's grooves, and of the notches."""
        return self.lip_height + self.clearance

    @property
    def groove(self) -> shapely.Polygon:
        """The groove in the plane of the drum's end."""
        return annulus(self.lip_inner - self.clearance, self.lip_outer + self.clearance)

    def grooves(self, high: float) -> list[m3.Manifold]:
        """Give the grooves in both ends of a drum between ±high, standing out of it."""
        outer, inner = self.lip_outer + self.clearance, self.lip_inner - self.clearance
        low, top = high - self.groove_depth, high + OVERLAP
        upper = cylinder(outer, low, top) - cylinder(inner, low - OVERLAP, top + OVERLAP)
        return [upper, upper.mirror((0.0, 0.0, 1.0))]

    def notch(self, half: float, thickness: float) -> list[tuple[float, float]]:
        """Points (r, z) of the notch in the upper edge, at the level `half`, of a tongue, from outside to inside.

        Beside the plate's middle plane the lip is nearer to the axis: by what its inner arc rises over the thickness.
        """
        outer = self.lip_outer + self.clearance
        inner = float(np.sqrt(self.lip_inner**2 - thickness**2 / 4)) - self.clearance
        floor = half - self.groove_depth
        return [(outer, half), (outer, floor), (inner, floor), (inner, half)]

    def carve(self) -> Carving:
        """Build a cap: its disc from level 0 upwards, the lip below, which is what is left around two cutters."""
        under, over = -self.lip_height - OVERLAP, self.thickness + OVERLAP
        blank = cylinder(self.radius, -self.lip_height, self.thickness)
        outside = cylinder(self.radius + OVERLAP, under, 0.0) - cylinder(self.lip_outer, under - OVERLAP, OVERLAP)
        cutters = [outside, cylinder(self.lip_inner, under, 0.0), cylinder(self.hole / 2, under, over)]
        lip = annulus(self.lip_inner, self.lip_outer).area * self.lip_height
        return Carving(blank, join(cutters), annulus(self.hole / 2, self.radius).area * self.thickness + lip)


@dataclass(frozen=True)
class Held:
    """How the plates of a node are held: what comes with it, and what stands on the node."""

    cap: Cap | None
    limits: tuple[Limit, ...]
    hardware: tuple[Item, ...]
    stack: tuple[tuple[float, float], ...]


def cap_needs(asked: CapSettings, thickness: float) -> float:
    """Give the engagement (mm) that a hook, a notch and the rim of the cap take.

    The rise of the lip's inner arc over a plate is less than 1/7 of the thickness where its radius is not smaller.
    """
    return asked.min_hook + thickness / 7 + asked.lip_width + 2 * asked.clearance + asked.rim


def hold_plates(sizes: tuple[float, float, float], thickness: float, settings: SlottedSettings) -> Held:
    """Say how plates of this thickness are held in a drum of this diameter, height and plate end.

    Raises
    ------
    Refused
        If the centre bolt does not go through the bore, or no bolt is long enough.
    """
    diameter, height, plate_end = sizes
    radius = diameter / 2
    if settings.retention == "weld":
        return Held(None, (), (), ((radius, height / 2),))
    asked, bolt = settings.cap, find_bolt(settings.hardware.bolt)
    _refuse_bore(bolt, settings)
    outer = radius - asked.rim
    cap = Cap(
        radius, asked.thickness, bolt.clearance_hole, outer - asked.lip_width, outer, asked.lip_height, asked.clearance
    )
    notch = cap.notch(height / 2, thickness)
    limits = (
        Limit("hook behind the lip", notch[-1][0] - plate_end, asked.min_hook),
        Limit("height of tongues between notches", 2 * notch[1][1], height / 2),
        Limit("radius inside the lip", cap.lip_inner, max(bolt.washer_diameter / 2, thickness)),
        Limit("edge of the cap around its bolt and the tool", radius, max(1.2 * bolt.clearance_hole, bolt.tool / 2)),
    )
    top = height / 2 + asked.thickness
    stack = (
        (radius, top),
        (bolt.washer_diameter / 2, top + bolt.washer_thickness),
        (bolt.across_corners / 2, top + bolt.washer_thickness + bolt.head_height),
    )
    return Held(cap, limits, _centre_bolt(bolt, height + 2 * asked.thickness, settings), stack)


def _refuse_bore(bolt: Bolt, settings: SlottedSettings) -> None:
    if settings.bore < bolt.clearance_hole:
        raise Refused(
            "E-NODE-BORE",
            "nodes.bore",
            f"{settings.bore:g} mm",
            f"at least {bolt.clearance_hole:g} mm for the centre bolt {bolt.size}",
            "Give a larger bore, or a smaller nodes.hardware.bolt.",
        )


def _centre_bolt(bolt: Bolt, grip: float, settings: SlottedSettings) -> tuple[Item, ...]:
    """List bolt, nut and two washers; two threads stand out of the nut."""
    least = grip + 2 * bolt.washer_thickness + bolt.nut_height + 2 * bolt.pitch
    length = next_length(least)
    if length is None:
        raise Refused(
            "E-NODE-BOLT",
            "nodes.hardware.bolt",
            f"a centre bolt of {least:.1f} mm",
            "the longest bolt of the table, 500 mm",
            "Use a lower section.",
        )
    grade = settings.hardware.grade
    return (
        Item("bolt", f"{bolt.size}x{length} {grade}", "ISO 4014", 1),
        Item("nut", bolt.size, "ISO 4032", 1),
        Item("washer", bolt.size, "ISO 7089", 2),
    )
