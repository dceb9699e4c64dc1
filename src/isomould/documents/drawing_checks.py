"""What a machine cannot work is refused here, before a drawing is written (failure mode G2)."""

from collections.abc import Iterator

import numpy as np

from isomould.documents.drawing import (
    WORKED,
    Circle,
    CutDrawing,
    Entity,
    Label,
    Polyline,
    bulges,
    segment_ends,
    signed_area,
)
from isomould.errors import Refused


def check_drawing(drawing: CutDrawing) -> CutDrawing:
    """Return the drawing if a machine can work it.

    Raises
    ------
    Refused
        If a number is not finite, a segment has no length or is there twice on a worked layer, text
        holds control characters, or a contour of CUT is not counter-clockwise or of CUT_INNER not
        clockwise (`deliverables`, DXF for machines).
    """
    for entity in drawing.entities:
        _check_entity(entity)
    _check_duplicates(drawing)
    return drawing


def _check_entity(entity: Entity) -> None:
    _check_finite(entity)
    if isinstance(entity, Polyline):
        _check_polyline(entity)
    if isinstance(entity, Label) and (not entity.text.isprintable() or not entity.text or "%%" in entity.text):
        raise _refused(entity, repr(entity.text), "one line of text without control codes")


def _check_finite(entity: Entity) -> None:
    numbers = np.concatenate([np.ravel(value) for value in vars(entity).values() if _numeric(value)])
    if not np.isfinite(numbers).all():
        raise _refused(entity, "a coordinate that is no number", "finite coordinates")
    if isinstance(entity, Circle) and entity.radius <= 0:
        raise _refused(entity, f"radius {entity.radius:g} mm", "above 0")


def _numeric(value: object) -> bool:
    return isinstance(value, float | int | tuple | np.ndarray)


def _check_polyline(polyline: Polyline) -> None:
    start, end = segment_ends(polyline)
    if len(start) == 0 or (start == end).all(axis=1).any():
        raise _refused(polyline, "a segment without length", "no repeated vertex")
    turn = {"CUT": 1, "CUT_INNER": -1}.get(polyline.layer)
    if turn and not (polyline.closed and signed_area(polyline) * turn > 0):
        direction = "counter-clockwise" if turn > 0 else "clockwise"
        raise _refused(polyline, "an open, empty or turned contour", f"closed and {direction}")


def _check_duplicates(drawing: CutDrawing) -> None:
    seen: set[object] = set()
    for entity in drawing.entities:
        for key in _keys(entity):
            if key in seen:
                raise _refused(entity, f"the same segment twice: {key}", "each line once")
            seen.add(key)


def _keys(entity: Entity) -> Iterator[object]:
    """Name the worked segments of an entity, whatever their direction."""
    if entity.layer not in WORKED:
        return
    if isinstance(entity, Circle):
        yield entity.centre, entity.radius
    if isinstance(entity, Polyline):
        yield from map(_segment_key, *(part.tolist() for part in segment_ends(entity)), bulges(entity).tolist())


def _segment_key(start: list[float], end: list[float], bulge: float) -> object:
    return (*start, *end, bulge) if start <= end else (*end, *start, -bulge)


def _refused(entity: Entity, found: str, limit: str) -> Refused:
    field = f"drawing, {type(entity).__name__} on {entity.layer}"
    return Refused("E-OUT-02", field, found, limit, "Nothing was written; please report the project file.")
