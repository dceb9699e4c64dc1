"""Part files of bases: the plate with its holes and where the stem stands on it, and the stem."""

import numpy as np

from isomould.arrays import Floats, round_um
from isomould.documents.cut_sheets import part_drawing
from isomould.documents.drawing import Circle, CutDrawing, Polyline
from isomould.parts.plates import hole_contour
from isomould.parts.supports import Base


def plate_drawing(mark: str, base: Base) -> CutDrawing:
    """Draw the base plate, seen from above: +x is the direction in which the node's axis leans."""
    reserved = [_footprint(base), *map(hole_contour, base.holes)]
    drawn = part_drawing(mark, base.plate, note=f"base plate {base.plate_thickness:g} mm", reserved=reserved)
    holes = tuple(Circle("DRILL", (hole.x, hole.y), hole.diameter / 2) for hole in base.holes)
    return CutDrawing((*drawn.entities, Polyline("ENGRAVE", _footprint(base), closed=True), *holes))


def stem_drawing(mark: str, base: Base) -> CutDrawing:
    """Draw the stem, standing on its foot."""
    return part_drawing(f"{mark}-STEM", base.stem, note=f"{base.stem_thickness:g} mm")


def _footprint(base: Base) -> Floats:
    """Corners (4, 2) of the stem's foot on the plate."""
    half = base.stem_thickness / 2
    left, right = base.stem[:, 0].min(), base.stem[:, 0].max()
    return round_um(np.array([[left, -half], [right, -half], [right, half], [left, half]]))
