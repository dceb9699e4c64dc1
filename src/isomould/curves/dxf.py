"""Reading what is drawn on a layer of a DXF file (failure modes A1 to A7).

The file is read strictly: what a lenient reader would repair or leave out is refused.
"""

import logging
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from ezdxf.document import Drawing as Document
from ezdxf.entities.dxfgfx import DXFGraphic
from ezdxf.filemanagement import readfile
from ezdxf.lldxf.const import DXFError

from isomould.arrays import Floats
from isomould.curves.entities import TRACERS, name_of, says_closed
from isomould.curves.spatial import Shape, Traced
from isomould.errors import Note, OutputFault, Refused
from isomould.units import MM_PER_UNIT, LengthUnit

LARGEST_FILE = 100 * 2**20
"""Bytes; a drawing of one curve is far smaller."""

# ezdxf logs its warnings; without a handler Python would print them
logging.getLogger("ezdxf").addHandler(logging.NullHandler())

_MM_PER_INSUNITS = {1: 25.4, 2: 304.8, 4: 1.0, 5: 10.0, 6: 1000.0, 7: 1e6, 10: 914.4, 14: 100.0}
_FAULTS = (
    DXFError, OSError, ValueError, TypeError, ArithmeticError, LookupError, AttributeError, StopIteration,
    RecursionError,
)  # fmt: skip


class Drawing(NamedTuple):
    """Which curve of which file."""

    path: Path
    layer: str
    units: LengthUnit | None
    """Of a drawing that does not say; otherwise it must agree."""


class _Found(NamedTuple):
    """A visible entity of the layer, how messages call it, and where its blocks put it."""

    entity: DXFGraphic
    name: str
    place: Floats
    """(4, 4), for rows (x, y, z, 1) from the left."""


def trace_layer(drawing: Drawing, field: str) -> tuple[list[Traced], tuple[Note, ...]]:
    """Give what is drawn on the drawing's layer as shapes in space, mm, entity by entity.

    Raises
    ------
    Refused
        E-DXF-FILE, -UNITS, -LAYER, -ENTITY or -BLOCK, E-SPLINE-….
    OutputFault
        If the system does not let the file be read.
    """
    document = _open(drawing.path, field)
    factor = _factor(document, drawing.units, field)
    found = _on_layer(document, drawing.layer, field)
    return [_traced(one, factor, field) for one in found], _remarks(found, field)


def trace_layers(
    path: Path, layers: Sequence[str], units: LengthUnit | None, field: str
) -> tuple[list[list[Traced]], list[str]]:
    """Give what is drawn on each of some layers, mm, and the names of all other layers that hold anything.

    The first layer has to hold something. Errors are those of `trace_layer`.
    """
    document = _open(path, field)
    factor = _factor(document, units, field)
    found = [_on_layer(document, layers[0], field), *(_visible_on(document, layer, field) for layer in layers[1:])]
    known = {layer.casefold() for layer in layers}
    others = {entity.dxf.layer for entity in document.modelspace() if entity.dxf.layer.casefold() not in known}
    return [[_traced(one, factor, field) for one in layer] for layer in found], sorted(others)


# --- the file


def _open(path: Path, field: str) -> Document:
    _refuse_no_dxf(path, field)
    with _guarded("E-DXF-FILE", field, f"{path.name} is damaged"):
        return readfile(path)


def _refuse_no_dxf(path: Path, field: str) -> None:
    """Refuse what is no complete text DXF before the reader sees it (failure mode A1)."""
    size = _size(path, field)
    if not 0 < size <= LARGEST_FILE:
        _refuse("FILE", field, f"{path.name} has {size} bytes", f"1 to {LARGEST_FILE}", "Save the curve alone.")
    head, tail = _head_and_tail(path, size)
    if head.startswith(b"AutoCAD Binary DXF"):
        _refuse("FILE", field, f"{path.name} is a binary DXF", "a text DXF", "Save it as a text (ASCII) DXF.")
    if tail.split()[-2:] != [b"0", b"EOF"]:
        found = f"{path.name} does not end like a DXF file (cut off, or another format)"
        _refuse("FILE", field, found, "a complete DXF file", "Save it again as DXF.")


def _size(path: Path, field: str) -> int:
    if not path.is_file():
        _refuse("FILE", field, f"{path} is no file", "an existing DXF file", "Check the name and its folder.")
    return path.stat().st_size


def _head_and_tail(path: Path, size: int) -> tuple[bytes, bytes]:
    try:
        with path.open("rb") as file:
            head = file.read(32)
            file.seek(max(0, size - 64))
            return head, file.read()
    except OSError as error:
        message = f"{path}: {error.strerror}"
        raise OutputFault(message) from error


def _factor(document: Document, units: LengthUnit | None, field: str) -> float:
    """Give mm per drawing unit (failure mode A3)."""
    code = int(document.header.get("$INSUNITS", 0))
    said, asked = _MM_PER_INSUNITS.get(code), MM_PER_UNIT.get(units or "")
    if code != 0 and said is None:
        _refuse("UNITS", field, f"drawing units $INSUNITS {code}", "mm, cm, dm, m, km, in, ft or yd", _CONVERT)
    if said is None and asked is None:
        _refuse("UNITS", f"{field}.units", "a drawing without units", "known units", 'Set units, such as "mm".')
    if said is not None and asked is not None and said != asked:
        found = f"{units} ({asked:g} mm), but the drawing says $INSUNITS {code} ({said:g} mm)"
        _refuse("UNITS", f"{field}.units", found, "agreement", "Leave units out, or correct the drawing.")
    return said or asked or 1.0


_CONVERT = "Convert the drawing to millimetres."


# --- the layer


def _on_layer(document: Document, layer: str, field: str) -> list[_Found]:
    found = _visible_on(document, layer, field)
    if not found:
        layers = sorted({entity.dxf.layer for entity in document.modelspace()})
        limit = f"one of {', '.join(layers[:12])}" if layers else "a drawing with entities"
        _refuse("LAYER", f"{field}.layer", f"nothing on layer {layer!r}", limit, "Check the layer's name.")
    _refuse_hidden(document, layer, field)
    return found


def _visible_on(document: Document, layer: str, field: str) -> list[_Found]:
    with _guarded("E-DXF-BLOCK", field, "the blocks cannot be read"):
        scope = _Scope(document, layer, None, np.eye(4))
        return [f for entity in document.modelspace() for f in _visible(entity, scope, field)]


class _Scope(NamedTuple):
    """What is looked for, and in which place: the model, or a block that is inserted in it."""

    document: Document
    layer: str
    parent: str | None
    """Layer of the INSERT: what a block holds on layer 0 is on it."""
    place: Floats


def _visible(entity: DXFGraphic, scope: _Scope, field: str) -> Iterator[_Found]:
    """Give the entity, or what an INSERT holds, if it is on the wanted layer."""
    own = scope.parent if scope.parent is not None and entity.dxf.layer == "0" else entity.dxf.layer
    if entity.dxftype() == "INSERT":
        yield from _inserted(entity, scope._replace(parent=own), field)
    elif own.casefold() == scope.layer.casefold():
        yield _Found(entity, name_of(entity), scope.place)


def _inserted(insert: Any, scope: _Scope, field: str) -> list[_Found]:
    """Give what an INSERT shows on the wanted layer, in its place: any affine map, exactly (failure mode A4)."""
    block = insert.block()
    if block is None or block.block.is_xref or block.block.is_xref_overlay:
        return _refuse_xref(insert, scope, field)
    name = f"{name_of(insert)} (block {insert.dxf.name})"
    found = [
        inner._replace(name=f"{inner.name} in {name}")
        for one in (insert.multi_insert() if insert.mcount > 1 else [insert])
        for entity in block
        if entity.dxftype() != "ATTDEF"
        for inner in _visible(entity, scope._replace(place=_matrix(one) @ scope.place), field)
    ]
    if found:
        _refuse_collapsed(scope.document, insert, name, field)
        _refuse_hidden(scope.document, scope.parent or "", field)
    return found


def _matrix(insert: Any) -> Floats:
    """Give where an INSERT puts its block: (4, 4) for rows from the left."""
    return np.array(list(insert.matrix44()), float).reshape(4, 4)


def _refuse_xref(insert: Any, scope: _Scope, field: str) -> list[_Found]:
    if scope.layer.casefold() == (scope.parent or "").casefold():
        found = f"{name_of(insert)} refers to another drawing, or to no block"
        _refuse("BLOCK", field, found, "a curve in this file", "Bind the reference into the drawing.")
    return []


def _refuse_collapsed(document: Document, insert: Any, name: str, field: str) -> None:
    scale = [insert.dxf.get(axis, 1.0) for axis in ("xscale", "yscale", "zscale")]
    if not all(np.isfinite(scale)) or 0.0 in scale:
        found = f"{name} has scales {scale[0]:g}, {scale[1]:g}, {scale[2]:g}"
        _refuse("BLOCK", field, found, "finite scales that are not 0", "Explode the block in the drawing.")
    units = insert.block().units
    if units not in (0, document.header.get("$INSUNITS", 0)):
        found = f"{name} has units {units} of its own"
        _refuse("BLOCK", field, found, "the drawing's units", "Explode the block in the drawing.")


def _refuse_hidden(document: Document, name: str, field: str) -> None:
    layer = document.layers.get(name) if document.layers.has_entry(name) else None
    if layer is not None and (layer.is_frozen() or layer.is_off()):
        state = "frozen" if layer.is_frozen() else "off"
        _refuse(
            "LAYER",
            f"{field}.layer",
            f"layer {name!r} is {state}",
            "a visible layer",
            "Thaw it or turn it on.",
        )


def _traced(found: _Found, factor: float, field: str) -> Traced:
    """Turn an entity into shapes in space, mm."""
    entity, name, place = found
    trace = TRACERS.get(entity.dxftype())
    if trace is None or entity.dxf.get("invisible", 0):
        limit = f"visible {', '.join(sorted(TRACERS))}"
        way_out = "Move it to another layer, or convert it."
        raise Refused(code="E-DXF-ENTITY", field=field, found=name, limit=limit, way_out=way_out)
    with _guarded("E-DXF-ENTITY", field, name), np.errstate(all="ignore"):
        drawn = [
            shape._replace(anchors=factor * (shape.anchors @ place[:3, :3] + place[3, :3]))
            for shape in _located(trace, entity, field)
        ]
    return Traced(name, drawn, says_closed(entity))


def _located(trace: Callable[[Any], list[Shape]], entity: DXFGraphic, field: str) -> list[Shape]:
    """Trace the entity; a refusal by its handle gets the project's field before it."""
    try:
        return trace(entity)
    except Refused as error:
        where = f"{field}, {error.field}"
        raise Refused(error.code, where, error.found, error.limit, error.way_out) from None


# --- messages


def _remarks(found: list[_Found], field: str) -> tuple[Note, ...]:
    """Note what was transformed or interpreted (failure mode A4)."""
    return (
        *_remark("W-DXF-BLOCK", field, "placed as its INSERT says", [f for f in found if " in INSERT " in f.name]),
        *_remark("W-DXF-OCS", field, "drawn in a turned or mirrored system, read as CAD shows it", _turned(found)),
        *_remark(
            "W-DXF-FIT",
            field,
            "fit points only: a C2 cubic by chord length laid through them",
            _fitted(found),
        ),
    )


def _remark(code: str, field: str, text: str, found: list[_Found]) -> tuple[Note, ...]:
    names = ", ".join(f.name for f in found[:4]) + (f" and {len(found) - 4} more" if len(found) > 4 else "")
    return (Note(code, field, f"{names}: {text}"),) if found else ()


def _turned(found: list[_Found]) -> list[_Found]:
    in_ocs = {"ARC", "CIRCLE", "LWPOLYLINE", "POLYLINE"}
    upright = (0.0, 0.0, 1.0)
    return [
        f for f in found if f.entity.dxftype() in in_ocs and tuple(f.entity.dxf.get("extrusion", upright)) != upright
    ]


def _fitted(found: list[_Found]) -> list[_Found]:
    splines: list[tuple[_Found, Any]] = [(f, f.entity) for f in found if f.entity.dxftype() == "SPLINE"]
    return [f for f, spline in splines if not len(spline.control_points)]


@contextmanager
def _guarded(code: str, field: str, what: str) -> Generator[None]:
    """Turn whatever the reader throws at damaged data into a refusal."""
    try:
        yield
    except _FAULTS as error:
        raise Refused(
            code=code,
            field=field,
            found=f"{what} ({type(error).__name__}: {error})",
            limit="sound DXF data",
            way_out="Repair or redraw it in CAD and save again.",
        ) from error


def _refuse(what: str, field: str, found: str, limit: str, way_out: str) -> None:
    raise Refused(code=f"E-DXF-{what}", field=field, found=found, limit=limit, way_out=way_out)
