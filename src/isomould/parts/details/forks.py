"""How a plate is bolted in a fork of two fins: pattern, bolts, hardware, room for the tool (fabrication, Node solids).

All lengths along a member are from the work point, heights from its axis to the outside.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from isomould.errors import Refused
from isomould.parts.catalogue import PlateSection
from isomould.parts.details.joint import Limit
from isomould.parts.features import Hole
from isomould.parts.hardware import Bolt, Item, find_bolt, next_length
from isomould.parts.settings import FinnedSettings

EDGE, PITCH = 1.2, 2.4
"""Least distances of holes from edges and from each other, in hole diameters (EN 1993-1-8, Table 3.3)."""


@dataclass(frozen=True)
class Pattern:
    """The holes of all forks and members' ends of a design; lengths in mm.

    Attributes
    ----------
    bolt : Bolt
    grade : str
    levels, columns : tuple of float
        The y of the rows, and the distances of the columns behind the first one.
    """

    bolt: Bolt
    grade: str
    levels: tuple[float, ...]
    columns: tuple[float, ...]

    @property
    def hole(self) -> float:
        """Diameter of the holes."""
        return self.bolt.clearance_hole

    @property
    def edge(self) -> float:
        """Least distance of a hole from any edge."""
        return round(EDGE * self.hole, 6)

    @property
    def count(self) -> int:
        """Bolts of one end."""
        return len(self.levels) * len(self.columns)

    @property
    def highest(self) -> float:
        """The y of the uppermost row; the lowest is as far on the other side."""
        return max(self.levels)

    def length(self, distance: float) -> float:
        """Where the fins end whose first column is at this distance."""
        return distance + self.columns[-1] + float(np.ceil(self.edge))

    def holes(self, distance: float) -> tuple[Hole, ...]:
        """The holes, the first column at this distance."""
        return tuple(Hole(distance + x, y, self.hole) for x in self.columns for y in self.levels)

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Bolts clear of each other, with room for a socket beside the next head."""
        steps = [np.diff(places).min() for places in (self.levels, self.columns) if len(places) > 1]
        least = max(PITCH * self.hole, (self.bolt.tool + self.bolt.across_corners) / 2)
        return (Limit("pitch of bolts", float(min(steps)), least),) if steps else ()


@dataclass(frozen=True)
class Fork:
    """Two fins with the end of a plate between them; lengths in mm.

    Attributes
    ----------
    gap : float
        Clear distance of the fins.
    fin : float
        Thickness of each.
    """

    section: PlateSection
    pattern: Pattern
    gap: float
    fin: float
    bolt_length: float

    @property
    def half(self) -> float:
        """From the beam plane to the outer faces of the fins."""
        return self.gap / 2 + self.fin

    @property
    def envelope(self) -> float:
        """From the beam plane to the end of nut or head, whichever stands out further."""
        bolt, grip = self.pattern.bolt, self.gap + 2 * self.fin
        nut = self.bolt_length - grip - bolt.washer_thickness
        return self.half + max(nut, bolt.washer_thickness + bolt.head_height)

    @property
    def reach(self) -> float:
        """From the beam plane to the head of a bolt whose tip is about to go in."""
        return self.half + self.bolt_length + self.pattern.bolt.head_height

    @cached_property
    def hardware(self) -> tuple[Item, ...]:
        """Bolts, nuts and washers of one fork."""
        bolt, count = self.pattern.bolt, self.pattern.count
        return (
            Item("bolt", f"{bolt.size}x{self.bolt_length:g} {self.pattern.grade}", "ISO 4017", count),
            Item("nut", bolt.size, "ISO 4032", count),
            Item("washer", bolt.size, "ISO 7089", 2 * count),
        )


def lay_pattern(depth: float, fin_height: float, settings: FinnedSettings) -> Pattern:
    """Spread the rows over a depth as fins of this height allow, the columns as bolts and tool do, in whole mm."""
    bolt = find_bolt(settings.hardware.bolt)
    rows, columns = settings.bolt_rows, settings.bolt_columns
    widest = np.floor((fin_height - 2 * EDGE * bolt.clearance_hole) / max(rows - 1, 1))
    spacing = settings.bolt_spacing or min(depth / rows, float(widest))
    least = max(PITCH * bolt.clearance_hole, (bolt.tool + bolt.across_corners) / 2)
    pitch = settings.bolt_pitch or float(np.ceil(round(least, 6)))
    levels = (np.arange(rows) - (rows - 1) / 2) * spacing
    return Pattern(
        bolt=bolt,
        grade=settings.hardware.grade,
        levels=tuple(np.round(levels, 3).tolist()),
        columns=tuple(np.round(np.arange(columns) * pitch, 3).tolist()),
    )


def make_fork(section: PlateSection, pattern: Pattern, settings: FinnedSettings) -> Fork:
    """Give the fork of a section; two threads stand out of the nut.

    Raises
    ------
    Refused
        If the longest bolt is too short.
    """
    bolt, gap = pattern.bolt, section.thickness + settings.clearance
    least = gap + 2 * settings.fin_thickness + 2 * bolt.washer_thickness + bolt.nut_height + 2 * bolt.pitch
    length = next_length(least)
    if length is None:
        raise Refused(
            "E-NODE-BOLT",
            "nodes.fin_thickness",
            f"{settings.fin_thickness:g} mm: a bolt of {least:.1f} mm",
            "the longest bolt of the table, 500 mm",
            "Give thinner fins.",
        )
    return Fork(section, pattern, gap, settings.fin_thickness, float(length))
