"""DXF files, read strictly, as plain outlines and circles by layer."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from ezdxf.filemanagement import readfile

from isomould.verify.read.text import refusing
from isomould.verify.rules import Floats, Unreadable

_CAP = 200_000_000


@dataclass(frozen=True, eq=False)
class Outline:
    """A flat polyline, lightweight or of the old kind: `points` (n, 2) mm, `bulges` (n,), one per segment."""

    layer: str
    points: Floats
    bulges: Floats
    closed: bool


@dataclass(frozen=True)
class Entity:
    """Any other entity: type, layer, its points (x, y, z), radius and text (0 and empty where it has none), mm."""

    kind: str
    layer: str
    points: tuple[tuple[float, float, float], ...]
    radius: float
    text: str = ""


@dataclass(frozen=True, eq=False)
class Drawing:
    """A drawing file: unit code, what the auditor found, outlines and other entities of the model space."""

    name: str
    units: int
    findings: tuple[str, ...]
    outlines: tuple[Outline, ...]
    entities: tuple[Entity, ...]
    version: str = "AC1024"


@refusing
def read_dxf(path: Path) -> Drawing:
    """Read a drawing. A file without its end mark is truncated, whatever the parser says."""
    _refuse_broken(path)
    document = readfile(path)
    audit = document.audit()
    found = tuple(str(entry.message) for entry in (*audit.errors, *audit.fixes))
    space = list(document.modelspace())
    read = _OUTLINES.get(document.dxfversion, _OUTLINES["AC1024"])
    outlines = tuple(read[1](entity) for entity in space if entity.dxftype() == read[0])
    others = tuple(_entity(entity) for entity in space if entity.dxftype() != read[0])
    units = int(document.header.get("$INSUNITS", 0))
    return Drawing(path.stem, units, found, outlines, others, document.dxfversion)


def _refuse_broken(path: Path) -> None:
    if path.stat().st_size > _CAP:
        message = f"{path.stat().st_size} bytes, more than {_CAP}"
        raise Unreadable(message)
    if path.read_bytes()[-16:].split()[-1:] != [b"EOF"]:
        message = "truncated: no EOF at the end"
        raise Unreadable(message)


def _outline(entity: Any) -> Outline:
    rows = np.array(entity.get_points("xyb"), dtype=np.float64).reshape(-1, 3)
    height, up = float(entity.dxf.elevation), tuple(entity.dxf.extrusion)
    if height or up != (0.0, 0.0, 1.0):
        message = f"polyline {entity.dxf.handle} at z = {height} with extrusion {up}"
        raise Unreadable(message)
    return Outline(entity.dxf.layer, rows[:, :2], rows[:, 2], bool(entity.closed))


def _old_outline(entity: Any) -> Outline:
    """Read a polyline of R12: vertices of their own, each with a place in space."""
    rows = np.array([(*v.dxf.location.xyz, v.dxf.bulge) for v in entity.vertices], dtype=np.float64).reshape(-1, 4)
    if not entity.is_2d_polyline or rows[:, 2].any():
        message = f"polyline {entity.dxf.handle} is not flat on z = 0"
        raise Unreadable(message)
    return Outline(entity.dxf.layer, rows[:, :2], rows[:, 3], bool(entity.is_closed))


_OUTLINES = {"AC1009": ("POLYLINE", _old_outline), "AC1024": ("LWPOLYLINE", _outline)}
"""The kind of polyline that a version has, and how it is read."""


def _entity(entity: Any) -> Entity:
    dxf = entity.dxf
    names = [name for name in ("start", "end", "center", "insert") if dxf.hasattr(name)]
    points = tuple(dxf.get(name).xyz for name in names)
    radius = float(dxf.radius) if dxf.is_supported("radius") else 0.0
    text = str(dxf.text) if dxf.is_supported("text") else ""
    return Entity(entity.dxftype(), dxf.layer, points, radius, text)


def with_layers(drawing: Drawing, names: dict[str, str]) -> Drawing:
    """Give the drawing with its layers renamed; those that are not named keep their own."""
    if not names:
        return drawing
    outlines = tuple(replace(o, layer=names.get(o.layer, o.layer)) for o in drawing.outlines)
    entities = tuple(replace(e, layer=names.get(e.layer, e.layer)) for e in drawing.entities)
    return replace(drawing, outlines=outlines, entities=entities)


def outlines_on(drawing: Drawing, layer: str) -> list[Outline]:
    """Give the outlines of one layer."""
    return [outline for outline in drawing.outlines if outline.layer == layer]


def one_outline(drawing: Drawing, layer: str = "CUT") -> Outline:
    """Give the only outline of a layer."""
    found = outlines_on(drawing, layer)
    if len(found) != 1:
        message = f"{drawing.name}.dxf has {len(found)} outlines on {layer}, not one"
        raise Unreadable(message)
    return found[0]


def area(outline: Outline) -> float:
    """Give the signed area with its arcs (a bulge b spans the angle 4·atan b), mm²."""
    here = outline.points - outline.points[0]  # near the origin: no cancellation
    there = np.roll(here, -1, axis=0)
    angle = 4 * np.arctan(outline.bulges)
    chord = np.linalg.norm(there - here, axis=1)
    radius = np.divide(chord, 2 * np.sin(angle / 2), out=np.zeros_like(chord), where=angle != 0)
    straight = here[:, 0] * there[:, 1] - here[:, 1] * there[:, 0]
    return float((straight + radius**2 * (angle - np.sin(angle))).sum() / 2)


def net_area(drawing: Drawing) -> float:
    """Give the area of a part: its one outer contour less inner contours and drilled holes, mm²."""
    inner = sum(abs(area(outline)) for outline in outlines_on(drawing, "CUT_INNER"))
    holes = sum(np.pi * entity.radius**2 for entity in drawing.entities if entity.layer == "DRILL")
    return abs(area(one_outline(drawing))) - inner - float(holes)
