"""What a part drawing holds, layer by layer: closed loops to cut, and layers that are not read."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, NoReturn

import numpy as np
import shapely

from isomould.arrays import Floats
from isomould.curves.chains import Chain, Stroke
from isomould.curves.doubles import without_doubles
from isomould.curves.joining import join_tolerance, joined
from isomould.curves.origins import origin_of, seen_from
from isomould.curves.pieces import Piece
from isomould.curves.sources import LayerContent, LayerDrawing, Source, open_source
from isomould.curves.spatial import Traced, laid_flat
from isomould.errors import Note, Refused
from isomould.intake.part_loops import (
    Loop,
    lies_on,
    loop_of_ring,
    make_loop,
    refuse_crossing,
    stroke_points,
    without_copies,
)
from isomould.intake.words import listed
from isomould.units import LengthUnit

OUTER, INNER, DRILLED = "CUT", "CUT_INNER", "DRILL"
"""Where the outline is drawn unless another layer is named, and the layers of holes that are always read."""

_SILENT = {"engrave", "info", "sheet", "defpoints"}
"""Layers that say nothing of what is cut."""

_CURVES = {"LINE", "ARC", "CIRCLE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "SPLINE"}

_CLOSING = _CURVES - {"LINE"}
"""What may be a hole by itself, or with a second of its kind."""

_WORDS = (
    "TEXT", "MTEXT", "ATTDEF", "ATTRIB", "POINT", "DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION", "LEADER",
    "MULTILEADER", "MLEADER", "TOLERANCE", "VIEWPORT",
)  # fmt: skip
"""What stands beside the curves of a part for people to read."""


@dataclass(frozen=True)
class LayerChoice:
    """What a user says of part drawings.

    Attributes
    ----------
    outer
        The layer of outlines; None is CUT, or the only layer that holds curves.
    inner
        Layers of holes beside CUT_INNER and DRILL.
    ignored
        Layers that may hold closed loops in a part which are not cut.
    units, join
        Of drawings that do not say; how far ends may be apart that join, mm.
    """

    outer: str | None = None
    inner: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()
    units: LengthUnit | None = None
    join: float | None = None


@dataclass(frozen=True, eq=False)
class DrawnLoops:
    """Loops of the outline's layer and of the layers of holes, how near ends join, and what should be known."""

    outer: list[Loop]
    inner: list[Loop]
    stray: list[Loop]
    """Closed loops on layers that are not read."""
    join: float
    notes: tuple[Note, ...]


def read_loops(path: Path, choice: LayerChoice) -> DrawnLoops:
    """Read the closed loops of a drawing.

    Raises
    ------
    Refused
        As every drawing (E-DXF-…, E-DRAWN-…); E-PART-OPEN for a curve that is not closed, E-PART-TWICE for one
        that is drawn twice besides, E-PART-CROSS for a loop that crosses itself, E-PART-NONE without any curve,
        E-PART-LAYER for a layer that is not read, not shown, and may hold holes.
    """
    field = str(path)
    source = open_source(path, choice.units, field)
    layers = {layer.name.casefold(): layer for layer in source.layers() if layer.kinds}
    outer, assumed = _outer_layer(layers.values(), choice.outer, field)
    named = [name.casefold() for name in (INNER, DRILLED, *choice.inner)]
    inner = [layers[name].name for name in dict.fromkeys(named) if name in layers and name != outer.casefold()]
    left = {*_SILENT, *(name.casefold() for name in choice.ignored)}
    known = {outer.casefold(), *(name.casefold() for name in inner), *left}
    unread = [layer for key, layer in layers.items() if key not in known]
    _refuse_hidden(unread, field)
    drawings = {name: source.trace(name, skip=_WORDS) for name in (outer, *inner)}
    strays = {layer.name: _curves_of(source, layer) for layer in unread if not layer.state and _CURVES & {*layer.kinds}}
    sight = _sight([*drawings.values(), *strays.values()], choice.join, field)
    found = {name: _closed_loops(name, drawing, sight) for name, drawing in drawings.items()}
    if not found[outer][0]:
        way_out = "Name the layer of the outline (--layer)."
        _refuse("NONE", field, f"no curve on layer {outer!r}", "at least one closed outline", way_out)
    notes = [note for _, own in found.values() for note in own]
    return DrawnLoops(
        outer=found[outer][0],
        inner=[loop for name in inner for loop in found[name][0]],
        stray=[loop for name, drawing in strays.items() for loop in _stray_loops(name, drawing, sight)],
        join=sight.join,
        notes=(*source.notes, *assumed, *notes, *_unread_note(unread, field)),
    )


def _outer_layer(layers: Iterable[LayerContent], asked: str | None, field: str) -> tuple[str, tuple[Note, ...]]:
    """Give the layer of the outline: the one that is asked for, CUT, or the only one with curves."""
    layers = list(layers)
    drawn = [layer.name for layer in layers if _CURVES & {*layer.kinds} and not layer.state]
    named = {name.casefold(): name for name in drawn}
    if asked is None and len(drawn) > 1 and all(layer.name.casefold() != OUTER.casefold() for layer in layers):
        found = f"nothing on layer {OUTER!r}, but curves on {listed([repr(name) for name in drawn])}"
        way_out = "Give --layer NAME for the outlines, and --inner-layer NAME for each layer of holes."
        raise Refused("E-DXF-LAYER", f"{field}: layer", found, "a layer of outlines that is known", way_out)
    wanted = asked or OUTER
    if asked is not None or wanted.casefold() in named or len(drawn) != 1:
        return named.get(wanted.casefold(), wanted), ()
    text = f"nothing on layer {OUTER!r}: the outline is read from {drawn[0]!r}, the only layer with curves"
    return drawn[0], (Note("W-PART-OUTLINE", field, text),)


def _refuse_hidden(unread: Sequence[LayerContent], field: str) -> None:
    """Refuse layers that are not shown and might hold holes: nobody can see whether they were meant."""
    for layer in unread:
        closing = {kind: count for kind, count in layer.kinds.items() if kind in _CLOSING}
        if layer.state and closing:
            held = ", ".join(f"{count} {kind}" for kind, count in sorted(closing.items()))
            found = f"layer {layer.name!r} is {layer.state} and holds {held}, which may be holes"
            way_out = f'Show the layer in CAD, or give --ignore-layer "{layer.name}" if it is not cut.'
            _refuse("LAYER", field, found, "layers that are shown, or left out by name", way_out)


def _curves_of(source: Source, layer: LayerContent) -> LayerDrawing:
    return source.trace(layer.name, skip=tuple(sorted({*layer.kinds} - _CURVES)))


def _unread_note(layers: Sequence[LayerContent], field: str) -> tuple[Note, ...]:
    names = [f"{layer.name} ({layer.state})" if layer.state else layer.name for layer in layers]
    return (Note("W-PART-LAYER", field, f"layers not read: {', '.join(sorted(names))}"),) if names else ()


class _Sight(NamedTuple):
    """From where all layers are seen, how near ends join, and how messages call the drawing."""

    origin: Floats
    join: float
    field: str


def _sight(drawings: Sequence[LayerDrawing], asked: float | None, field: str) -> _Sight:
    origin = origin_of([traced for drawing in drawings for traced in drawing.traced])
    printed = max((drawing.printed for drawing in drawings), default=0.0)
    return _Sight(origin, join_tolerance(asked, printed), field)


def _closed_loops(layer: str, drawing: LayerDrawing, sight: _Sight) -> tuple[list[Loop], list[Note]]:
    """Give the loops of a layer that is cut: nothing else may be drawn there."""
    if not drawing.traced:
        return [], [*drawing.notes]
    strokes, flattened = laid_flat(seen_from(drawing.traced, sight.origin), None, sight.field, sight.join)
    once, doubles = without_doubles(strokes, sight.join)
    chains, joints = _chains(once, sight)
    loops = [make_loop(chain.pieces, _called(chain), layer) for chain in chains if chain.closed]
    for loop in loops:
        refuse_crossing(loop, sight.field)
    kept, copies = without_copies(loops, sight.join)
    over = [chain for chain in chains if not chain.closed]
    for chain in over:
        if not any(lies_on(chain.pieces, loop, sight.join) for loop in kept):
            _refuse_open(chain, layer, {kept_one for kept_one, _ in doubles}, sight)
    twice = [*(dropped for _, dropped in doubles), *(loop.name for loop in copies), *(_called(chain) for chain in over)]
    return kept, [*drawing.notes, *flattened, *joints, *_twice_note(twice, layer, sight.field)]


def _chains(strokes: list[Stroke[Piece]], sight: _Sight) -> tuple[list[Chain[Piece]], list[Note]]:
    """Join what is open; what is closed stays by itself, even where it touches others."""
    closed = [stroke for stroke in strokes if _ends_meet(stroke, sight.join)]
    others = [stroke for stroke in strokes if not _ends_meet(stroke, sight.join)]
    found = [joined([stroke], sight.join, sight.field) for stroke in closed]
    found += [joined(others, sight.join, sight.field)] if others else []
    return [chain for chains, _ in found for chain in chains], [note for _, notes in found for note in notes]


def _ends_meet(stroke: Stroke[Piece], join: float) -> bool:
    start, end = stroke.pieces[0].point(np.zeros(1))[0], stroke.pieces[-1].point(np.ones(1))[0]
    return float(np.hypot(*(end - start))) <= join


def _called(chain: Chain[Piece]) -> str:
    names = [stroke.name for stroke in chain.strokes]
    return names[0] if len(names) == 1 else f"the loop of {listed(names, 2)}"


def _refuse_open(chain: Chain[Piece], layer: str, doubled: set[str], sight: _Sight) -> None:
    if chain.closed:
        return
    names = [stroke.name for stroke in chain.strokes]
    start, end = chain.pieces[0].point(np.zeros(1))[0], chain.pieces[-1].point(np.ones(1))[0]
    apart, (x, y) = float(np.hypot(*(end - start))), start + sight.origin[:2]
    found = (
        f"{listed(names, 4)} on layer {layer!r}: open, its ends are {apart:.6g} mm apart, one at {x:.3f}, {y:.3f} mm"
    )
    if doubled & {*names}:
        found = f"{found}, and drawn twice"
        _refuse("TWICE", sight.field, found, "a closed outline, drawn once", "Close it in CAD, and delete the copy.")
    limit = f"closed curves, ends within {sight.join:g} mm"
    way_out = "Close it in CAD, allow for the gap (--join), or move what is not cut to another layer."
    _refuse("OPEN", sight.field, found, limit, way_out)


def _twice_note(names: Sequence[str], layer: str, field: str) -> tuple[Note, ...]:
    text = f"{len(names)} on layer {layer!r} drawn twice, taken once: {listed(names, 4)}"
    return (Note("W-PART-TWICE", field, text),) if names else ()


def _stray_loops(layer: str, drawing: LayerDrawing, sight: _Sight) -> list[Loop]:
    """Give the closed loops of a layer that is not read, whatever else is drawn there."""
    seen = [_pressed(one) for one in seen_from(drawing.traced, sight.origin)]
    if not any(_has_extent(shape.anchors) for one in seen for shape in one.shapes):
        return []
    strokes, _ = laid_flat(seen, None, sight.field, sight.join)
    try:
        chains, _ = _chains(without_doubles(strokes, sight.join)[0], sight)
    except Refused:
        # Where curves branch there may be loops all the same.
        return _enclosed(strokes, layer, sight.join)
    return [make_loop(chain.pieces, _called(chain), layer) for chain in chains if chain.closed]


def _pressed(one: Traced) -> Traced:
    """Take the height out of an entity: what is not read may be drawn in space."""
    flat = np.array([1.0, 1.0, 0.0])
    return one._replace(shapes=[shape._replace(anchors=shape.anchors * flat) for shape in one.shapes])


def _has_extent(anchors: Floats) -> bool:
    return bool(np.ptp(anchors, axis=0).any())


def _enclosed(strokes: Sequence[Stroke[Piece]], layer: str, join: float) -> list[Loop]:
    """Give what strokes enclose that meet end to end, branches and all."""
    lines = [shapely.LineString(points) for stroke in strokes if len(points := stroke_points(stroke.pieces)) > 1]
    snapped = shapely.set_precision(np.array(lines, dtype=object), max(join, 1e-6), mode="pointwise")
    faces = shapely.get_parts(shapely.polygonize([line for line in snapped if not line.is_empty]))
    return [loop_of_ring(shapely.get_coordinates(face.exterior)[:-1], f"a loop of {len(strokes)} entities", layer)
            for face in faces]  # fmt: skip


def _refuse(what: str, field: str, found: str, limit: str, way_out: str) -> NoReturn:
    raise Refused(f"E-PART-{what}", field, found, limit, way_out)
