"""Drawings as DXF, 1:1 in mm, one process per layer, the same bytes every time."""

import io
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from functools import singledispatch
from pathlib import Path

from ezdxf import options  # pyright: ignore[reportPrivateImportUsage]
from ezdxf.document import Drawing
from ezdxf.filemanagement import new
from ezdxf.layouts.layout import Modelspace

from isomould.documents.drawing import Circle, CutDrawing, Entity, Label, Layer, Polyline, Segment3D
from isomould.documents.drawing_checks import check_drawing
from isomould.writers.disk import write_bytes
from isomould.writers.settings import Version, layer_names

_MILLIMETRES = 4
_METRIC = 1
_COLOURS: dict[Layer, int] = {
    "CUT": 1,
    "CUT_INNER": 6,
    "DRILL": 4,
    "ENGRAVE": 3,
    "SCORE": 5,
    "SHEET": 8,
    "INFO": 7,
}


def write_dxf(
    path: Path,
    drawing: CutDrawing,
    layers: Mapping[Layer, str] | None = None,
    version: Version = "R2010",
) -> None:
    """Write a drawing for machines.

    Parameters
    ----------
    path : Path
    drawing : CutDrawing
    layers : mapping, optional
        Names of the shop for our layers; those that are not named keep their own.
    version : "R2010" or "R12"
        R12 has no units and no LWPOLYLINE; its polylines are old-style ones.

    Raises
    ------
    Refused
        If a machine cannot work the drawing (`check_drawing`).
    OutputFault
        If the file cannot be written.
    """
    names = layer_names(layers or {})
    check_drawing(drawing)
    with fixed_meta_data():
        data = dxf_bytes(_document(drawing, names, version))
    write_bytes(path, data)


def _document(drawing: CutDrawing, names: Mapping[Layer, str], version: Version) -> Drawing:
    document = new(version, units=_MILLIMETRES)
    document.header["$MEASUREMENT"] = _METRIC
    for layer, name in names.items():
        document.layers.add(name, color=_COLOURS[layer])
    for entity in drawing.entities:
        _add(entity, document.modelspace(), names[entity.layer])
    return document


@singledispatch
def _add(entity: Entity, space: Modelspace, layer: str) -> None:
    """Add an entity to the model space; colour and line type are the layer's."""
    raise NotImplementedError(type(entity).__name__)


@_add.register
def _(entity: Polyline, space: Modelspace, layer: str) -> None:
    bulges = [0.0] * len(entity.points) if entity.bulges is None else entity.bulges.tolist()
    points = [(x, y, bulge) for (x, y), bulge in zip(entity.points.tolist(), bulges, strict=True)]
    add = space.add_polyline2d if space.dxfversion == "AC1009" else space.add_lwpolyline
    add(points, format="xyb", close=entity.closed, dxfattribs={"layer": layer})


@_add.register
def _(entity: Circle, space: Modelspace, layer: str) -> None:
    space.add_circle(entity.centre, entity.radius, dxfattribs={"layer": layer})


@_add.register
def _(entity: Segment3D, space: Modelspace, layer: str) -> None:
    space.add_line(entity.start, entity.end, dxfattribs={"layer": layer})


@_add.register
def _(entity: Label, space: Modelspace, layer: str) -> None:
    space.add_text(entity.text, height=entity.height, dxfattribs={"layer": layer, "insert": entity.position})


def dxf_bytes(document: Drawing) -> bytes:
    """Export a document; ezdxf would list the classes in use in the order of a set."""
    for name in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(name)
    stream = io.StringIO(newline="")
    document.write(stream)
    return document.encode(stream.getvalue())


@contextmanager
def fixed_meta_data() -> Generator[None]:
    """Keep dates, user and GUIDs out of the file, from making the document to writing it."""
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before
