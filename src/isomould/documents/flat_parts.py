"""Flat plates beside members and panels: fittings, base plates, stems; their drawings and NC1 files."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, round_um
from isomould.documents.cut_sheets import part_drawing
from isomould.documents.drawing import CutDrawing, Polyline
from isomould.documents.holes import front_holes
from isomould.documents.nc_parts import Blank, NcPart, nc_part, plate_profile
from isomould.parts.details.fittings import Fitting
from isomould.parts.features import Hole
from isomould.parts.supports import Base
from isomould.units import MassUnit


@dataclass(frozen=True, eq=False)
class FlatPart:
    """A plate with holes. Lengths in mm, all in one frame.

    Attributes
    ----------
    file : str
        Its files in the folder, without their endings.
    mark, kind : str
        What is engraved; what it is, in words.
    outline, bulges : (n, 2) and (n,) float
    footprint : (k, 2) float, optional
        Where another plate stands on it: engraved.
    """

    file: str
    mark: str
    kind: str
    quantity: int
    thickness: float
    outline: Floats
    bulges: Floats | None = None
    holes: tuple[Hole, ...] = ()
    footprint: Floats | None = None

    @property
    def reserved(self) -> list[Floats]:
        """What the mark keeps clear of."""
        return [] if self.footprint is None else [self.footprint]


def fitting_parts(fittings: Iterable[Fitting]) -> tuple[FlatPart, ...]:
    """Give the flat ones of the fittings; caps are turned."""
    return tuple(
        FlatPart(
            file=f"fittings/{fitting.mark}",
            mark=fitting.mark,
            kind=fitting.kind.replace("-", " "),
            quantity=fitting.quantity,
            thickness=fitting.thickness,
            outline=fitting.outline[0],
            bulges=fitting.outline[1],
            holes=fitting.holes,
        )
        for fitting in fittings
        if fitting.outline
    )


def base_parts(mark: str, quantity: int, base: Base) -> tuple[FlatPart, FlatPart]:
    """Give the plate, seen from above with +x where the node's axis leans, and the stem, standing on its foot."""
    file, stem = f"nodes/{mark}", f"{mark}-STEM"
    plate = FlatPart(
        file, mark, "base plate", quantity, base.plate_thickness, base.plate, None, base.holes, _footprint(base)
    )
    return plate, FlatPart(f"{file}-stem", stem, "stem", quantity, base.stem_thickness, base.stem)


def flat_drawing(part: FlatPart) -> CutDrawing:
    """Draw a plate for a machine."""
    note = f"{part.kind} {part.thickness:g} mm"
    drawn = part_drawing(
        part.mark, part.outline, part.bulges, front_holes(part.holes), note=note, reserved=part.reserved
    )
    return CutDrawing((*drawn.entities, *(Polyline("ENGRAVE", foot, closed=True) for foot in part.reserved)))


def flat_nc_part(part: FlatPart, grade: str, density: float, unit: MassUnit) -> NcPart:
    """Give the NC1 file of a plate; the profile is the box around it."""
    height = round(float(np.ptp(part.outline[:, 1])), 2)
    profile = plate_profile(f"FL{height:g}*{part.thickness:g}", height, part.thickness, density, unit)
    blank = Blank(
        mark=part.mark,
        quantity=part.quantity,
        grade=grade,
        outline=part.outline,
        bulges=part.bulges,
        holes=part.holes,
        notes=(part.kind.upper(),),
        reserved=tuple(part.reserved),
    )
    return nc_part(blank, profile)


def _footprint(base: Base) -> Floats:
    """Corners (4, 2) of the stem's foot on the plate."""
    half = base.stem_thickness / 2
    left, right = base.stem[:, 0].min(), base.stem[:, 0].max()
    return round_um(np.array([[left, -half], [right, -half], [right, half], [left, half]]))
