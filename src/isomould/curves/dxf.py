"""A DXF drawing as a source of curves: its unit, its layers, and what is drawn on one (failure modes A1 to A7)."""

import logging
from collections import Counter
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from ezdxf.lldxf.const import DXFError

from isomould.curves.drawing_units import INSUNITS, FoundUnit, refuse_no_unit, unit_of
from isomould.curves.dxf_blocks import LAYER_0, Expansion, Shown
from isomould.curves.dxf_entities import angles_of, coordinates_of, load_entity
from isomould.curves.dxf_file import DxfFile, Entity, open_dxf
from isomould.curves.dxf_origins import NEAR, Far, far_of
from isomould.curves.entities import TRACERS, Drawn, is_mesh, is_smoothed, repeats_an_end, says_closed
from isomould.curves.layer_names import layer_key, quoted
from isomould.curves.layers import LayerContent, LayerDrawing
from isomould.curves.printed import lost_in_print
from isomould.curves.spatial import Traced
from isomould.errors import Note, Refused
from isomould.units import LengthUnit

# ezdxf logs its warnings; without a handler Python would print them
logging.getLogger("ezdxf").addHandler(logging.NullHandler())

_FAULTS = (
    DXFError, OSError, ValueError, TypeError, ArithmeticError, LookupError, AttributeError, StopIteration,
    RecursionError,
)  # fmt: skip

_DOUBLED = "an end control point drawn twice is read once, which changes the curve near it: look at it in the report"

_IN_OCS = {"ARC", "CIRCLE", "LWPOLYLINE", "POLYLINE"}
_UPRIGHT = (0.0, 0.0, 1.0)


class _Found(NamedTuple):
    """A visible entity of the layer, interpreted, and how messages call it."""

    shown: Shown
    entity: Any
    name: str
    is_near: bool
    """Whether it is measured from the origin of the layer."""


class DxfSource:
    """An opened drawing. Made by `open_dxf_source`."""

    def __init__(self, file: DxfFile, asked: LengthUnit | None, field: str) -> None:
        self._file, self._field = file, field
        self._expansion = Expansion(file, field)
        self.unit, self.notes = self._unit(asked)

    def layers(self) -> tuple[LayerContent, ...]:
        """Give every layer that is named in the file, with what the model shows on it and what lies elsewhere."""
        kinds = {key: Counter[str]() for key in self._names}
        for (key, kind), count in self._expansion.kinds.items():
            if kind != "INSERT":
                kinds[key][kind] += count
        return tuple(
            LayerContent(name, dict(sorted(kinds[key].items())), self._state(key), self._elsewhere(key))
            for key, name in sorted(self._names.items(), key=lambda item: (item[1].casefold(), item[1]))
        )

    def holds(self, layer: str) -> bool:
        """Tell whether the model shows anything on a layer."""
        key = layer_key(layer)
        return any(where == key and count for (where, _), count in self._expansion.kinds.items())

    def trace(self, layer: str, skip: Sequence[str] = ()) -> LayerDrawing:
        """Give what is drawn on a layer as shapes in space, mm, entity by entity.

        Parameters
        ----------
        skip
            Types of entities, such as "TEXT", that are left out with a note.

        Raises
        ------
        Refused
            E-DXF-UNITS, -LAYER, -ENTITY or -BLOCK, E-SPLINE-….
        """
        unit = self._known_unit()
        far = self._far(layer_key(layer), unit.mm)
        shown = self._on_layer(layer, far)
        left = [one for one in shown if one.entity.kind in skip]
        found = [self._interpreted(one, far) for one in shown if one.entity.kind not in skip]
        traced = [self._traced(one, unit.mm, far) for one in found]
        printed = self._lost([one.shown.entity for one in found])
        notes = (*self._remarks(found), *self._left_out(left, layer))
        return LayerDrawing(traced, notes, printed * unit.mm)

    # --- the file

    def _unit(self, asked: LengthUnit | None) -> tuple[FoundUnit | None, tuple[Note, ...]]:
        code = self._file.insunits
        if code != 0 and self._file.said_unit is None and asked is None:
            found = f"drawing units $INSUNITS {self._file.header['$INSUNITS']}"
            raise refuse_no_unit("E-DXF-UNITS", found, self._field)
        return unit_of(self._file.said_unit, asked, self._field)

    def _known_unit(self) -> FoundUnit:
        if self.unit is None:
            raise refuse_no_unit("E-DXF-UNITS", "a drawing without units", self._field)
        return self.unit

    # --- the layer

    @cached_property
    def _names(self) -> dict[str, str]:
        """The layers of the file by key: as the table writes them, else as the first entity does."""
        names = {key: state.name for key, state in self._file.layers.items()}
        within = [one for block in self._file.blocks.values() for one in block.entities]
        spaces = self._file.spaces
        for entity in (*spaces.model, *spaces.paper, *within):
            names.setdefault(layer_key(entity.layer), entity.layer)
        return names

    def _state(self, key: str) -> str:
        return self._file.layers[key].state if key in self._file.layers else ""

    def _elsewhere(self, key: str) -> tuple[str, ...]:
        """Say what is on a layer and is not shown in the model."""
        on_paper = Counter(one.kind for one in self._file.spaces.paper if layer_key(one.layer) == key)
        places = [f"{_counted(on_paper)} in paper space"] if on_paper else []
        inserted = self._inserted_blocks
        for name, block in self._file.blocks.items():
            inside = Counter(one.kind for one in block.entities if layer_key(one.layer) == key)
            if inside and name not in inserted and key != LAYER_0:
                where = "on another sheet" if name.startswith("*paper_space") else "which is never inserted"
                places.append(f"{_counted(inside)} in block {quoted(block.name)}, {where}")
        return tuple(places)

    @cached_property
    def _inserted_blocks(self) -> set[str]:
        """The keys of blocks that the model shows, directly or within others."""
        found, fresh = set[str](), {one.block for one in self._file.spaces.model if one.block}
        while fresh:
            found |= fresh
            blocks = [self._file.blocks[key] for key in fresh if key in self._file.blocks]
            fresh = {one.block for block in blocks for one in block.entities if one.block} - found
        return found

    def _far(self, key: str, mm: float) -> Far:
        """Give the origin that a layer is read from; of a polyline its vertices say where it is."""
        placing = list(self._expansion.placing(key))
        records = [self._file.lines.record(one.number) for one in placing]
        vertices = [vertex for one in placing if one.kind == "POLYLINE" for vertex in self._file.following(one.number)]
        return far_of([*records, *vertices], mm)

    def _on_layer(self, layer: str, far: Far) -> list[Shown]:
        key = layer_key(layer)
        shown = self._expansion.on_layer(layer, far)
        if not shown:
            self._refuse_absent(layer)
        inserts = {layer_key(insert.layer) for one in shown for insert in one.inserts}
        for visible in sorted({key} | inserts - {LAYER_0}):
            self._refuse_hidden(visible)
        return shown

    def _refuse_absent(self, layer: str) -> None:
        """Say what is there instead (intake K9)."""
        key, field = layer_key(layer), f"{self._field}.layer"
        elsewhere = self._elsewhere(key)
        if elsewhere:
            found = f"nothing on layer {quoted(layer)} in the model: {'; '.join(elsewhere)}"
            _refuse("LAYER", field, found, "a curve in model space", "Draw or insert it in the model.")
        filled = [content for content in self.layers() if content.kinds]
        there = "; ".join(f"{quoted(c.name)} ({_counted(Counter(c.kinds))})" for c in filled[:12])
        more = f" and {len(filled) - 12} more layers" if len(filled) > 12 else ""
        limit = f"one of {there}{more}" if filled else "a drawing with entities"
        empty = ", an empty layer" if key in self._names else ""
        _refuse("LAYER", field, f"nothing on layer {quoted(layer)}{empty}", limit, "Check the layer's name.")

    def _refuse_hidden(self, key: str) -> None:
        state = self._state(key)
        if state:
            found = f"layer {quoted(self._file.layers[key].name)} is {state}"
            _refuse("LAYER", f"{self._field}.layer", found, "a visible layer", "Thaw it or turn it on.")

    # --- the entities

    def _interpreted(self, shown: Shown, far: Far) -> _Found:
        inserts = "".join(f" in {self._file.called(insert)}" for insert in shown.inserts)
        name = f"{self._file.called(shown.entity)}{inserts}"
        if shown.entity.kind not in TRACERS:
            self._refuse_entity(name)
        with _guarded("E-DXF-ENTITY", self._field, name):
            entity, moved = load_entity(self._file, shown.entity, NEAR if shown.inserts else far)
        if entity.dxf.get("invisible", 0):
            self._refuse_entity(f"{name}, invisible")
        if is_mesh(entity):
            self._refuse_entity(f"{name}, a mesh of faces")
        return _Found(shown, entity, name, moved or shown.is_near)

    def _lost(self, entities: list[Entity]) -> float:
        """Give what the printing of entities loses, in the drawing's units."""
        texts = [text for entity in entities for text in coordinates_of(self._file, entity)]
        angles = [angle for entity in entities for angle in angles_of(self._file, entity)]
        return lost_in_print(texts, angles)

    def _refuse_entity(self, name: str) -> None:
        limit = f"visible {', '.join(sorted(TRACERS))}"
        _refuse("ENTITY", self._field, name, limit, "Move it to another layer, or convert it.")

    def _traced(self, found: _Found, factor: float, far: Far) -> Traced:
        """Turn an entity into shapes in space, mm."""
        away = np.array([float(far.x), float(far.y), 0.0])
        with _guarded("E-DXF-ENTITY", self._field, found.name), np.errstate(all="ignore"):
            drawn = self._located(TRACERS[found.shown.entity.kind], found.entity)
            place = found.shown.place
            shapes = [shape._replace(anchors=factor * (shape.anchors @ place[:3, :3])) for shape in drawn.shapes]
            base = drawn.base @ place[:3, :3] + place[3, :3] - (0.0 if found.is_near else away)
        return Traced(found.name, shapes, says_closed(found.entity), factor * base, factor * away)

    def _located(self, trace: Callable[[Any], Drawn], entity: Any) -> Drawn:
        """Trace the entity; a refusal by its handle gets the project's field before it."""
        try:
            return trace(entity)
        except Refused as error:
            where = f"{self._field}, {error.field}"
            raise Refused(error.code, where, error.found, error.limit, error.way_out) from None

    # --- messages

    def _remarks(self, found: list[_Found]) -> tuple[Note, ...]:
        """Note what was transformed or interpreted (failure mode A4)."""
        placed = [f for f in found if f.shown.inserts]
        turned = [f for f in found if f.entity.dxftype() in _IN_OCS and _is_turned(f.entity)]
        fitted = [f for f in found if f.entity.dxftype() == "SPLINE" and not len(f.entity.control_points)]
        smoothed = [f for f in found if is_smoothed(f.entity)]
        doubled = [f for f in found if repeats_an_end(f.entity)]
        return (
            *self._remark("W-DXF-BLOCK", "placed as its INSERT says", placed),
            *self._block_units(placed),
            *self._remark("W-DXF-OCS", "drawn in a turned or mirrored system, read as CAD shows it", turned),
            *self._remark("W-DXF-FIT", "fit points only: a C2 cubic by chord length laid through them", fitted),
            *self._remark("W-DXF-DOUBLED", _DOUBLED, doubled),
            *self._remark("W-DXF-FIT", "smoothed: the edges that CAD made of it, without their frame", smoothed),
        )

    def _remark(self, code: str, text: str, found: list[_Found]) -> tuple[Note, ...]:
        names = ", ".join(f.name for f in found[:4]) + (f" and {len(found) - 4} more" if len(found) > 4 else "")
        return (Note(code, self._field, f"{names}: {text}"),) if found else ()

    def _block_units(self, placed: list[_Found]) -> tuple[Note, ...]:
        """Note blocks that were drawn in units of their own: the scale of an INSERT already holds them."""
        keys = sorted({insert.block for f in placed for insert in f.shown.inserts if insert.block})
        units = {key: self._file.block_units.get(key, 0) for key in keys}
        other = [key for key, unit in units.items() if unit not in (0, self._file.insunits)]
        if not other:
            return ()
        said = ", ".join(f"{quoted(key)} ({INSUNITS.get(units[key], ('unknown', 0))[0]})" for key in other)
        text = f"blocks with units of their own, {said}: read as the INSERT scales them"
        return (Note("W-DXF-BLOCK", self._field, text),)

    def _left_out(self, left: list[Shown], layer: str) -> tuple[Note, ...]:
        if not left:
            return ()
        text = f"{_counted(Counter(one.entity.kind for one in left))} on layer {quoted(layer)} left out"
        return (Note("W-DXF-LEFT-OUT", self._field, text),)


def open_dxf_source(path: Path, units: LengthUnit | None, field: str) -> DxfSource:
    """Open a drawing.

    Raises
    ------
    Refused
        E-DXF-FILE as `open_dxf`; E-DXF-UNITS for a unit that no building is drawn in.
    OutputFault
        If the system does not let the file be read.
    """
    file, cleaned = open_dxf(path, field)
    source = DxfSource(file, units, field)
    source.notes = (*cleaned, *source.notes)
    return source


def _is_turned(entity: Any) -> bool:
    return tuple(entity.dxf.get("extrusion", _UPRIGHT)) != _UPRIGHT


def _counted(kinds: Counter[str]) -> str:
    return ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))


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
