"""Single DXF entities from their records: brought to the one form that ezdxf interprets alike in every version.

Files of old versions, or of none, hold entities of newer ones, with or without marks of subclasses, in tags that are
sorted in other ways. What an entity is follows from its tags alone: marks are set anew, and so every file is read as
if it were a new one (failure mode A2).
"""

import math
from collections.abc import Iterable
from typing import Any

from ezdxf.entities.factory import load
from ezdxf.lldxf.extendedtags import ExtendedTags
from ezdxf.lldxf.tagger import tag_compiler
from ezdxf.lldxf.types import DXFTag

from isomould.curves.dxf_file import DxfFile, Entity
from isomould.curves.dxf_origins import NEAR, Far, brought_near
from isomould.curves.dxf_records import Record, Tag
from isomould.curves.printed import PrintedAngle

_MARKS = {
    "LINE": "AcDbLine", "CIRCLE": "AcDbCircle", "ARC": "AcDbCircle", "ELLIPSE": "AcDbEllipse",
    "LWPOLYLINE": "AcDbPolyline", "SPLINE": "AcDbSpline", "POLYLINE": "AcDb2dPolyline", "VERTEX": "AcDbVertex",
}  # fmt: skip

_COMMON = {5, 6, 8, 48, 60, 62, 67, 284, 330, 347, 348, 360, 370, 380, 390, 410, 420, 430, 440}
"""Group codes that every entity may have."""

_FIRST_OF_EXTENDED = 1000
_POINT_CODES = range(10, 40)


def load_entity(file: DxfFile, entity: Entity, far: Far = NEAR) -> tuple[Any, bool]:
    """Give the entity as ezdxf interprets it, and whether its places are measured from an origin.

    A polyline comes with its vertices; one that lies in a turned system stays where it is.

    Raises
    ------
    Exception
        What ezdxf raises for damaged data.
    """
    record = file.lines.record(entity.number)
    if entity.kind != "POLYLINE":
        near = brought_near(record, far, in_world=False)
        return _loaded(near), near is not record
    loaded = _loaded(record)
    is_level = bool(loaded.is_3d_polyline) or brought_near(record, far, in_world=False) is not record
    for vertex in file.following(entity.number):
        if vertex.kind == "VERTEX":
            loaded.vertices.append(_loaded(brought_near(vertex, far, in_world=True) if is_level else vertex))
    return loaded, is_level and bool(far)


def coordinates_of(file: DxfFile, entity: Entity) -> list[str]:
    """Give the coordinates of an entity as they are printed in the file."""
    records = [file.lines.record(entity.number), *file.following(entity.number)]
    return [tag.value for record in records for tag in record.tags if tag.code in _POINT_CODES]


def angles_of(file: DxfFile, entity: Entity) -> list[PrintedAngle]:
    """Give the angles of an arc as they are printed; of other entities none."""
    record = file.lines.record(entity.number)
    if entity.kind == "ARC":
        radius = float(record.first(40) or 0)
        return [PrintedAngle(record.first(code), radius, math.radians(1)) for code in (50, 51)]
    if entity.kind == "ELLIPSE":
        radius = math.hypot(*(float(record.first(code) or 0) for code in (11, 21, 31)))
        return [PrintedAngle(record.first(code), radius, 1.0) for code in (41, 42)]
    return []


def _loaded(record: Record) -> Any:
    own = _without_extensions(record.tags)
    common = [tag for tag in own if tag.code in _COMMON]
    # a stable sort: codes 1x, 2x, 3x of one point come together, points of a list stay in order
    special = [tag for tag in own if tag.code not in _COMMON and tag.code != _MARK]
    ordered = _by_points(special) if record.kind == "LINE" else special
    marked = [(0, record.kind), *common[:1], (_MARK, "AcDbEntity"), *common[1:], *_marked(record.kind, ordered)]
    # the compiler looks one tag ahead, and loses a point at the very end
    *tags, _ = tag_compiler(iter([*(DXFTag(code, value) for code, value in marked), DXFTag(_COMMENT, "")]))
    return load(ExtendedTags(tags))


_MARK, _COMMENT = 100, 999


def _marked(kind: str, tags: list[Tag]) -> list[tuple[int, str]]:
    """Put the subclass marks before the tags; those of an arc's angles stand in a subclass of their own."""
    if kind != "ARC":
        return [(_MARK, _MARKS.get(kind, kind)), *tags]
    angles = [tag for tag in tags if tag.code in (50, 51)]
    rest = [tag for tag in tags if tag.code not in (50, 51)]
    return [(_MARK, "AcDbCircle"), *rest, (_MARK, "AcDbArc"), *angles]


def _by_points(tags: Iterable[Tag]) -> list[Tag]:
    """Sort the coordinates of a line, which some programs write as x₁, x₂, y₁, y₂."""
    return sorted(tags, key=lambda tag: (tag.code % 10, tag.code) if tag.code in _POINT_CODES else (99, 0))


def _without_extensions(tags: tuple[Tag, ...]) -> list[Tag]:
    """Leave out what programs attach to entities: groups in braces, and everything from the first extended datum."""
    kept = list[Tag]()
    inside = False
    for tag in tags:
        if tag.code >= _FIRST_OF_EXTENDED:
            break
        if tag.code == _GROUP:
            inside = tag.value.startswith("{")
        elif not inside:
            kept.append(tag)
    return kept


_GROUP = 102
