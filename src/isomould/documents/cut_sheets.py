"""Cut drawings of single parts and of nested sheets."""

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from isomould.arrays import Floats
from isomould.documents.drawing import Circle, CutDrawing, Entity, Label, Layer, Polyline, signed_area
from isomould.documents.engraving import TEXT_HEIGHTS, engrave, free_area, place_at_start, place_in_middle
from isomould.documents.orientation import point_to_side
from isomould.documents.stroke_font import engravable

_INFO_HEIGHT = 10.0


class PartOnSheet(NamedTuple):
    """A part on its sheet: mark, location or nothing, the placed outline (n, 2) mm and its placed holes."""

    mark: str
    location: str
    points: Floats
    holes: Sequence[Polyline | Circle] = ()


def part_drawing(
    mark: str,
    outline: Floats,
    bulges: Floats | None = None,
    inner: Sequence[Polyline | Circle] = (),
    note: str = "",
    orientation: str | None = None,
    reserved: Sequence[Floats] = (),
    direction: bool = False,
) -> CutDrawing:
    """Draw one part in its own frame: contour, inner contours, engraved mark and a line of information.

    Parameters
    ----------
    mark : str
    outline : (n, 2) float, mm
        Counter-clockwise, first vertex not repeated.
    bulges : (n,) float, optional
    inner : sequence of Polyline or Circle
        Closed contours to cut inside, in either direction, CUT_INNER is clockwise by definition; holes to drill.
    note : str
        What stands after the mark in the information below the part.
    orientation : str, optional
        Engrave an arrow to the outline's first side, and this text beside it.
    reserved : sequence of (k, 2) float, mm
        Polygons that are kept free of the mark.
    direction : bool
        Engrave the mark at the start of the part, with an arrow to its end (fabrication, Marks and locations).
    """
    contour = Polyline("CUT", outline, True, bulges)
    holes = [_inner(hole) for hole in inner]
    left, bottom = outline.min(axis=0)
    info = _info(f"{mark} {note}".strip(), left, bottom - 2 * _INFO_HEIGHT)
    free = free_area(contour, holes, reserved)
    if direction:
        return CutDrawing((contour, *holes, *engrave(place_at_start(mark, outline, free)), info))
    return CutDrawing((contour, *holes, *_engraved(mark, free, outline, orientation), info))


def sheet_drawing(
    width: float,
    height: float,
    placements: Iterable[PartOnSheet],
    scores: Floats | None = None,
    orientation: str | None = None,
    material: str = "",
) -> CutDrawing:
    """Draw a nested sheet: stock outline, contours, engraved marks with locations, information.

    Parameters
    ----------
    width, height : float, mm
        Of the stock sheet, lower left corner at the origin.
    placements : iterable of PartOnSheet
        A part that was turned over comes clockwise.
    scores : (k, 2, 2) float, mm, optional
        Lines to score, in cutting order: then the contours go to INFO, because nothing is cut.
    orientation : str, optional
        Engrave an arrow to every part's first side, and this text beside it.
    material : str
        What the sheet is made of: information below it.
    """
    layer: Layer = "CUT" if scores is None else "INFO"
    stock = Polyline("SHEET", np.array([[0, 0], [width, 0], [width, height], [0, height]], float), True)
    lines = [Polyline("SCORE", line, False) for line in ([] if scores is None else scores)]
    parts = [entity for placement in placements for entity in _placed(layer, orientation, placement)]
    below = [_info(_literal(material), 0.0, -2 * _INFO_HEIGHT)] if material else []
    return CutDrawing((stock, *parts, *lines, *below))


def _placed(layer: Layer, orientation: str | None, part: PartOnSheet) -> list[Entity]:
    contour, text = _directed(part.points, None, layer), f"{part.mark} {part.location}".strip()
    outline = shapely.Polygon(part.points)
    holes = [_inner(hole) for hole in part.holes]
    free = free_area(contour, holes) if holes else outline
    at = outline.representative_point()
    label = _info(_literal(text), at.x, at.y, TEXT_HEIGHTS[-1])
    return [contour, *holes, *_engraved(engravable(text), free, part.points, orientation), label]


def _inner(hole: Polyline | Circle) -> Polyline | Circle:
    return hole if isinstance(hole, Circle) else _directed(hole.points, hole.bulges, "CUT_INNER")


def _directed(points: Floats, bulges: Floats | None, layer: Layer) -> Polyline:
    """Run a closed contour the way its layer asks, from the same first vertex."""
    contour = Polyline(layer, points, True, bulges)
    wanted = -1 if layer == "CUT_INNER" else 1
    return contour if signed_area(contour) * wanted > 0 else _reversed(contour)


def _reversed(contour: Polyline) -> Polyline:
    points = np.roll(contour.points[::-1], 1, axis=0)
    bulges = None if contour.bulges is None else -contour.bulges[::-1]
    return Polyline(contour.layer, points, True, bulges)


def _literal(text: str) -> str:
    """Keep signs from being codes of DXF: two of per cent, and a caret that no blank follows."""
    return re.sub(r"%(?=%)", "% ", text).replace("^", "^ ")


def _info(text: str, x: float, y: float, height: float = _INFO_HEIGHT) -> Label:
    return Label("INFO", text, (float(x), float(y), 0.0), height)


def _engraved(text: str, free: BaseGeometry, outline: Floats, orientation: str | None) -> list[Polyline]:
    """Engrave the mark, and before it the orientation if there is one."""
    arrow = [] if orientation is None else point_to_side(outline, free, orientation)
    if not arrow:
        return engrave(place_in_middle(text, free))
    taken = shapely.MultiPoint(np.concatenate([stroke.points for stroke in arrow])).envelope
    return [*arrow, *engrave(place_in_middle(text, free.difference(taken)))]
