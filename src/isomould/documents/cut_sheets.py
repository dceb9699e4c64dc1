"""Cut drawings of single parts and of nested sheets."""

from collections.abc import Iterable, Sequence

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from isomould.arrays import Floats, round_um
from isomould.documents.drawing import (
    Circle,
    CutDrawing,
    Entity,
    Label,
    Layer,
    Polyline,
    chords,
    circle_points,
    signed_area,
)
from isomould.documents.orientation import point_to_side
from isomould.documents.stroke_font import text_strokes, text_width
from isomould.parts.features import Hole

TEXT_HEIGHTS = (20.0, 14.0, 10.0, 7.0, 5.0, 3.5, 2.5, 2.0)
"""Heights of engraved marks, tallest first (ISO 3098 steps), mm."""

_MARGIN = 0.5
"""Clear distance of the mark from the outline, in text heights."""

_INFO_HEIGHT = 10.0

_TURNS = (np.array([[1.0, 0.0], [0.0, 1.0]]), np.array([[0.0, 1.0], [-1.0, 0.0]]))
"""A mark stands level or turned by 90°."""

Placement = tuple[str, str, Floats]
"""Mark, location and the placed outline (n, 2), mm."""


def part_drawing(
    mark: str,
    outline: Floats,
    bulges: Floats | None = None,
    inner: Sequence[Polyline | Circle] = (),
    note: str = "",
    orientation: str | None = None,
    reserved: Sequence[Floats] = (),
) -> CutDrawing:
    """Draw one part in its own frame: contour, inner contours, engraved mark and a line of information.

    Parameters
    ----------
    mark : str
    outline : (n, 2) float, mm
        Counter-clockwise, first vertex not repeated.
    bulges : (n,) float, optional
    inner : sequence of Polyline or Circle
        Closed contours to cut inside, in either direction (CUT_INNER is clockwise by definition), and drilled holes.
    note : str
        What stands after the mark in the information below the part.
    orientation : str, optional
        Engrave an arrow to the outline's first side, and this text beside it.
    reserved : sequence of (k, 2) float, mm
        Polygons that are kept free of the mark.
    """
    contour = Polyline("CUT", outline, True, bulges)
    holes = [_inside(hole) for hole in inner]
    left, bottom = outline.min(axis=0)
    info = _info(f"{mark} {note}".strip(), left, bottom - 2 * _INFO_HEIGHT)
    free = shapely.Polygon(chords(contour), [_contour(hole) for hole in holes])
    free = free.difference(shapely.union_all([shapely.Polygon(taken) for taken in reserved]))
    return CutDrawing((contour, *holes, *_engraved(mark, free, outline, orientation), info))


def sheet_drawing(
    width: float,
    height: float,
    placements: Iterable[Placement],
    scores: Floats | None = None,
    orientation: str | None = None,
) -> CutDrawing:
    """Draw a nested sheet: stock outline, contours, engraved marks with locations, information.

    Parameters
    ----------
    width, height : float, mm
        Of the stock sheet, lower left corner at the origin.
    placements : iterable of (mark, location, points)
        Points (n, 2) of the placed outline; a part that was turned over comes clockwise.
    scores : (k, 2, 2) float, mm, optional
        Lines to score, in cutting order: then the contours go to INFO, because nothing is cut.
    orientation : str, optional
        Engrave an arrow to every part's first side, and this text beside it.
    """
    layer: Layer = "CUT" if scores is None else "INFO"
    stock = Polyline("SHEET", np.array([[0, 0], [width, 0], [width, height], [0, height]], float), True)
    lines = [Polyline("SCORE", line, False) for line in ([] if scores is None else scores)]
    parts = [entity for placement in placements for entity in _placed(layer, orientation, *placement)]
    return CutDrawing((stock, *parts, *lines))


def hole_contours(holes: Iterable[Hole]) -> tuple[Polyline | Circle, ...]:
    """Give the holes in the front of a member: circles to drill, slots to cut."""
    return tuple(_opening(hole) for hole in holes if hole.face == "front")


def _opening(hole: Hole) -> Polyline | Circle:
    """A slot runs clockwise, its ends are half circles."""
    if not hole.lengthening:
        return Circle("DRILL", (hole.x, hole.y), hole.diameter / 2)
    x, y = hole.lengthening / 2, hole.diameter / 2
    corners = np.array([hole.x, hole.y]) + np.array([[-x, -y], [-x, y], [x, y], [x, -y]])
    return Polyline("CUT_INNER", corners, True, np.array([-1.0, 0.0, -1.0, 0.0]))


def _inside(hole: Polyline | Circle) -> Polyline | Circle:
    return hole if isinstance(hole, Circle) else _directed(hole.points, hole.bulges, "CUT_INNER")


def _contour(hole: Polyline | Circle) -> Floats:
    return circle_points(hole) if isinstance(hole, Circle) else chords(hole)


def _placed(layer: Layer, orientation: str | None, mark: str, location: str, points: Floats) -> list[Entity]:
    contour, text = _directed(points, None, layer), f"{mark} {location}"
    outline = shapely.Polygon(points)
    at = outline.representative_point()
    return [contour, *_engraved(text, outline, points, orientation), _info(text, at.x, at.y, TEXT_HEIGHTS[-1])]


def _directed(points: Floats, bulges: Floats | None, layer: Layer) -> Polyline:
    """Run a closed contour the way its layer asks, from the same first vertex."""
    contour = Polyline(layer, points, True, bulges)
    wanted = -1 if layer == "CUT_INNER" else 1
    return contour if signed_area(contour) * wanted > 0 else _reversed(contour)


def _reversed(contour: Polyline) -> Polyline:
    points = np.roll(contour.points[::-1], 1, axis=0)
    bulges = None if contour.bulges is None else -contour.bulges[::-1]
    return Polyline(contour.layer, points, True, bulges)


def _info(text: str, x: float, y: float, height: float = _INFO_HEIGHT) -> Label:
    return Label("INFO", text, (float(x), float(y), 0.0), height)


def _engraved(text: str, free: BaseGeometry, outline: Floats, orientation: str | None) -> list[Polyline]:
    """Engrave the mark, and before it the orientation if there is one."""
    arrow = [] if orientation is None else point_to_side(outline, free, orientation)
    if not arrow:
        return _engraving(text, free)
    taken = shapely.MultiPoint(np.concatenate([stroke.points for stroke in arrow])).envelope
    return [*arrow, *_engraving(text, free.difference(taken))]


def _engraving(text: str, free: BaseGeometry) -> list[Polyline]:
    """Engrave text at the tallest height that fits the free area; nothing when even the lowest does not."""
    middle = round_um(np.array(_middle(free).coords[0]))
    lines = ((height, turn) for height in TEXT_HEIGHTS for turn in _TURNS)
    found = next((line for line in lines if free.contains(_box(text, middle, *line))), None)
    return [] if found is None else _strokes(text, middle, *found)


def _middle(free: BaseGeometry) -> shapely.Point:
    return free.centroid if free.contains(free.centroid) else free.representative_point()


def _box(text: str, middle: Floats, height: float, turn: Floats) -> shapely.Polygon:
    """Box of a line of text about its middle, with the margin around it."""
    half = np.abs((_size(text, height) / 2 + _MARGIN * height) @ turn)
    return shapely.box(*(middle - half), *(middle + half))


def _size(text: str, height: float) -> Floats:
    return np.array([text_width(text, height), height])


def _strokes(text: str, middle: Floats, height: float, turn: Floats) -> list[Polyline]:
    centred = (stroke - _size(text, height) / 2 for stroke in text_strokes(text, height))
    return [Polyline("ENGRAVE", round_um(stroke @ turn + middle), closed=False) for stroke in centred]
