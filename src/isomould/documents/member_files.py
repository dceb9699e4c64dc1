"""Members for machines: their drawings, and what their NC1 files say."""

import numpy as np

from isomould.documents.cut_sheets import part_drawing
from isomould.documents.drawing import CutDrawing
from isomould.documents.holes import front_holes
from isomould.documents.nc_parts import Blank, NcPart, NcProfile, nc_part, plate_profile, tube_profile
from isomould.parts.catalogue import AnySection, PlateSection
from isomould.parts.members import MemberParts, MemberShape
from isomould.parts.settings import MemberSettings
from isomould.units import MassUnit


def member_drawing(mark: str, shape: MemberShape) -> CutDrawing:
    """Draw one member: contour, holes of its front, and the mark at its start with an arrow to its end."""
    return part_drawing(mark, shape.outline, inner=front_holes(shape.holes), direction=True)


def member_nc_parts(members: MemberParts, asked: MemberSettings, unit: MassUnit) -> tuple[NcPart, ...]:
    """Give the NC1 file of every member class, in the order of the marks."""
    rows = zip(members.marks, members.classes.quantity.tolist(), members.shapes, strict=True)
    return tuple(
        nc_part(_blank(mark, quantity, shape, asked.grade), _profile(shape.section, asked.density, unit))
        for mark, quantity, shape in rows
    )


def _profile(section: AnySection, density: float, unit: MassUnit) -> NcProfile:
    if isinstance(section, PlateSection):
        return plate_profile(section.name, section.depth, section.thickness, density, unit)
    return tube_profile(section, density)


def _blank(mark: str, quantity: int, shape: MemberShape, grade: str) -> Blank:
    return Blank(mark, quantity, grade, shape.outline, holes=shape.holes, notes=_notes(shape), along=True)


def _notes(shape: MemberShape) -> tuple[str, ...]:
    """Long and short points along top and bottom, the end cuts, and how the part lies."""
    start, end = np.round(np.degrees(shape.end_angle), 2) + 0.0
    contour = ", IN CONTOUR" if isinstance(shape.section, PlateSection) else ""
    return (
        f"TOP {shape.top_length:.2f} BOTTOM {shape.bottom_length:.2f}",
        f"END CUTS {start:.2f} {end:.2f} DEG{contour}",
        "START LEFT, OUTSIDE UP",
    )
