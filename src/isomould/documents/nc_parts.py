"""Parts as NC1 sees them: one code, one profile, contour and holes measured from the lower left corner of each view."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from isomould.arrays import Floats
from isomould.documents.drawing import Polyline
from isomould.documents.engraving import Stamp, free_area, place_at_start, place_in_middle
from isomould.documents.holes import front_holes
from isomould.parts.catalogue import RhsSection
from isomould.parts.features import Face, Hole
from isomould.units import MassUnit

Code = Literal["B", "M"]
"""Plates and flat bars; hollow sections."""

View = Literal["v", "h", "o", "u"]

"""What line 15 of the header holds: exporters write kg/m for bars, kg/m² for plates."""

_VIEWS: dict[Face, View] = {"front": "v", "back": "h", "top": "o", "bottom": "u"}


@dataclass(frozen=True)
class NcProfile:
    """What a part is cut from: lines 7, 8 and 10 to 16 of the header. Lengths in mm, coating in m² per metre.

    Of a plate, `height` is its width and the three others are its thickness; of a hollow section, `width` lies across
    its height, and `flange` and `web` are its wall.
    """

    code: Code
    name: str
    height: float
    width: float
    flange: float
    web: float
    radius: float
    mass: float
    paint: float


@dataclass(frozen=True)
class NcHole:
    """A hole in a view, mm: its centre, or that of a slot's first end; centre distance of a slot's ends along x."""

    view: View
    x: float
    y: float
    diameter: float
    lengthening: float = 0.0


@dataclass(frozen=True, eq=False)
class NcPart:
    """One file: `contour` (n, 2) mm with `bulges` (n,) for plates only, `stamp` in the front view, up to 4 notes."""

    mark: str
    quantity: int
    grade: str
    profile: NcProfile
    length: float
    saw_length: float
    holes: tuple[NcHole, ...]
    contour: Floats | None = None
    bulges: Floats | None = None
    stamp: Stamp | None = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Blank:
    """A part as the workshop has it: its outline (n, 2) mm and holes in one frame, and what its file says besides.

    `along` is true of members, which have a start and an end: their mark stands at the start. It keeps clear of the
    polygons (k, 2) that are `reserved`.
    """

    mark: str
    quantity: int
    grade: str
    outline: Floats
    bulges: Floats | None = None
    holes: tuple[Hole, ...] = ()
    notes: tuple[str, ...] = ()
    along: bool = False
    reserved: tuple[Floats, ...] = ()


def plate_profile(name: str, width: float, thickness: float, density: float, unit: MassUnit) -> NcProfile:
    """Give the header of a plate or flat bar; thickness three times, because exporters differ on lines 11 to 13.

    >>> plate_profile("FL200*15", 200, 15, 7850, "kg/m").mass
    23.55
    """
    across = width / 1e3 if unit == "kg/m" else 1.0
    mass, paint = across * thickness / 1e3 * density, 2 * (width + thickness) / 1e3
    return NcProfile("B", name, width, *[thickness] * 3, radius=0.0, mass=mass, paint=paint)


def tube_profile(section: RhsSection, density: float) -> NcProfile:
    """Give the header of a hollow section.

    >>> round(tube_profile(RhsSection(depth=120, width=80, wall=5), 7850).mass, 1)
    14.4
    """
    sizes = (section.depth, section.width, section.wall, section.wall, section.radii[0])
    return NcProfile("M", section.name, *sizes, mass=section.area * density / 1e6, paint=section.girth / 1e3)


def nc_part(blank: Blank, profile: NcProfile) -> NcPart:
    """Move a part to the lower left corner of its views; a hollow section, which is cut square, keeps no contour."""
    corner = blank.outline.min(axis=0)
    plate = profile.code == "B"
    length = float(np.ptp(blank.outline[:, 0]))
    stamp = _stamp(blank)
    return NcPart(
        mark=blank.mark,
        quantity=blank.quantity,
        grade=blank.grade,
        profile=profile,
        length=length,
        saw_length=length,
        holes=tuple(_moved(hole, corner, profile) for hole in blank.holes),
        contour=blank.outline - corner if plate else None,
        bulges=blank.bulges if plate else None,
        stamp=stamp and Stamp(stamp.text, stamp.middle - corner, stamp.height, stamp.turned),
        notes=blank.notes,
    )


def _moved(hole: Hole, corner: Floats, profile: NcProfile) -> NcHole:
    """Measure a hole in its view: y from the lower edge in v and h, from the front edge in o and u."""
    x = hole.x - float(corner[0]) - hole.lengthening / 2
    y = hole.y + (profile.width / 2 if hole.face in {"top", "bottom"} else -float(corner[1]))
    return NcHole(_VIEWS[hole.face], x, y, hole.diameter, hole.lengthening)


def _stamp(blank: Blank) -> Stamp | None:
    """Place the mark where the drawing engraves it (`cut_sheets.part_drawing`)."""
    free = free_area(Polyline("CUT", blank.outline, True, blank.bulges), front_holes(blank.holes), blank.reserved)
    return place_at_start(blank.mark, blank.outline, free) if blank.along else place_in_middle(blank.mark, free)
