"""How a hollow section is bolted to a facet from inside: end plate, bolts, access holes, room for the tool."""

from dataclasses import dataclass
from functools import cached_property

from isomould.errors import Refused
from isomould.parts.catalogue import RhsSection
from isomould.parts.details.joint import Limit
from isomould.parts.features import EndPlate, Hole
from isomould.parts.hardware import Bolt, Item, find_bolt, next_length
from isomould.parts.settings import FacetedSettings

_TWO_BOLTS = 100.0
"""Members of this depth (mm) or more have two bolts."""

_BRIDGE = 10.0
"""Least wall between access holes, and length of an access hole beyond the bolt's, mm."""


@dataclass(frozen=True)
class Bolting:
    """The bolted end of a hollow section; lengths in mm.

    Attributes
    ----------
    levels : tuple of float
        The y of the bolts, from the member's axis to the outside.
    plate : EndPlate
    bolt_length, hole_depth : float
        Of every bolt, and of the threaded hole in the drum, from the facet.
    """

    section: RhsSection
    bolt: Bolt
    grade: str
    levels: tuple[float, ...]
    plate: EndPlate
    bolt_length: float
    hole_depth: float

    @property
    def access(self) -> tuple[float, float]:
        """Length and width of an access hole: the whole bolt and 10 mm, the width of the tool."""
        length = self.bolt_length + self.bolt.head_height + _BRIDGE
        return max(length, self.bolt.tool), self.bolt.tool

    def access_holes(self, cut: float) -> tuple[Hole, ...]:
        """One hole in the front per bolt, from the inside of the end plate on; `cut` is the x of the member's cut."""
        length, width = self.access
        middle = round(cut + self.plate.thickness + length / 2, 3)
        return tuple(Hole(middle, level, width, lengthening=length - width) for level in self.levels)

    def reach(self, cut: float) -> float:
        """Where the access holes of an end at `cut` end."""
        return cut + self.plate.thickness + self.access[0]

    @property
    def hardware(self) -> tuple[Item, ...]:
        """Bolts and washers of one end."""
        count = len(self.levels)
        size = f"{self.bolt.size}x{self.bolt_length:g} {self.grade}"
        return Item("bolt", size, "ISO 4017", count), Item("washer", self.bolt.size, "ISO 7089", count)

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Bolts clear of edges (EN 1993-1-8, Table 3.3), of each other and of the walls, with room for the tool."""
        section, bolt, level = self.section, self.bolt, max(self.levels)
        beside, above = section.width / 2 - section.wall, section.depth / 2 - section.wall - level
        length, width = self.access
        found = [
            Limit("edge of the end plate beside its bolts", min(beside, above), 1.2 * bolt.clearance_hole),
            Limit("room for the tool beside a bolt", min(beside, above), bolt.tool / 2),
            Limit("length of access holes", length, self.bolt_length + _BRIDGE),
            Limit("flat wall beside access holes", section.depth / 2 - section.radii[0] - level - width / 2, 0.0),
        ]
        if len(self.levels) > 1:
            pitch = max(2.4 * bolt.clearance_hole, (bolt.tool + bolt.across_corners) / 2)
            found += [Limit("pitch of bolts", 2 * level, pitch)]
            found += [Limit("wall between access holes", 2 * level - width, _BRIDGE)]
        return tuple(found)


def bolt_members(section: RhsSection, settings: FacetedSettings) -> Bolting:
    """Bolt a section: one bolt on its axis, two in members of 100 mm or more.

    The shortest nominal length is taken that goes through plate and washer and leaves the engagement asked for; the
    threaded hole is three pitches deeper than the bolt.

    Raises
    ------
    Refused
        If the longest bolt is too short.
    """
    bolt = find_bolt(settings.hardware.bolt)
    grip = settings.end_plate + bolt.washer_thickness
    length = next_length(grip + settings.engagement * bolt.diameter)
    if length is None:
        raise Refused(
            "E-NODE-BOLT",
            "nodes.end_plate",
            f"{settings.end_plate:g} mm",
            "what the longest bolt of the table reaches through",
            "Give a thinner plate.",
        )
    spacing = settings.bolt_spacing or section.depth / 2
    levels = (-spacing / 2, spacing / 2) if section.depth >= _TWO_BOLTS else (0.0,)
    return Bolting(
        section=section,
        bolt=bolt,
        grade=settings.hardware.grade,
        levels=levels,
        plate=EndPlate(settings.end_plate, bolt.clearance_hole, levels),
        bolt_length=float(length),
        hole_depth=length - grip + 3 * bolt.pitch,
    )
