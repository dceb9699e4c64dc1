"""Reading a drawing or model to say what is in it: all its layers, or the one curve of a layer."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from isomould.arrays import Floats
from isomould.curves.chains import Chain, Stroke
from isomould.curves.curve import PlanarCurve
from isomould.curves.doubles import without_doubles
from isomould.curves.drawn import the_one_chain
from isomould.curves.joining import join_tolerance, joined
from isomould.curves.layers import LayerContent, LayerDrawing
from isomould.curves.lengths import length
from isomould.curves.origins import origin_of, seen_from
from isomould.curves.sources import CURVE_KINDS, Source, open_source
from isomould.curves.space_curve import SpatialCurve, SpatialPiece, piece_in_space
from isomould.curves.spatial import Traced, laid_flat
from isomould.errors import Note, Refused
from isomould.intake.inspection import ReadCurve, ReadDrawing
from isomould.units import LengthUnit

_SAMPLES = 33
"""Points along a piece: for pictures, and between which a coordinate turns back once at most."""


class _Found(NamedTuple):
    """The chains of a layer, their origin (3,) mm in the drawing, and notes."""

    layer: str
    chains: Sequence[Chain[Any]]
    origin: Floats
    notes: tuple[Note, ...]


def inspect_drawing(path: Path, layer: str | None, units: LengthUnit | None, join: float | None) -> ReadDrawing:
    """Say what is read of a drawing or model.

    Parameters
    ----------
    path
        A .dxf or .3dm file.
    layer
        The layer whose one curve is read as a `curve` table reads it; None lists the curves of all layers.
    units
        Of coordinates; None takes them from the file.
    join
        Ends this near are joined, mm; None for what drawings are exact to.

    Raises
    ------
    Refused
        As `open_source` and `Source.trace`. With a layer whatever keeps it from being one curve; without, only if no
        layer can be read, else what is wrong with a layer becomes a note.
    OutputFault
        If the system does not let the file be read.
    """
    field = str(path)
    source = open_source(path, units, field)
    found = [_one(source, layer, join, field)] if layer is not None else _all(source, join, field)
    unit = source.unit
    if unit is None:
        message = "a source without a unit traces nothing"
        raise TypeError(message)
    curves = tuple(_read(one.layer, chain, one.origin) for one in found for chain in one.chains)
    notes = (*source.notes, *(note for one in found for note in one.notes))
    return ReadDrawing(field, curves, unit.name, unit.said_by, notes)


# --- one layer, as a project reads it


def _one(source: Source, layer: str, join: float | None, field: str) -> _Found:
    drawing = source.trace(layer)
    origin = origin_of(drawing.traced)
    tolerance = join_tolerance(join, drawing.printed)
    strokes, flattened = laid_flat(seen_from(drawing.traced, origin), None, field, tolerance)
    chain, moved = the_one_chain(strokes, tolerance, field)
    return _Found(layer, [chain], origin, (*drawing.notes, *flattened, *moved))


# --- all layers


def _all(source: Source, join: float | None, field: str) -> list[_Found]:
    """Read every layer that shows curves; raise the first refusal if none can be read."""
    found, refused = list[_Found](), list[Refused]()
    for content in source.layers():
        try:
            found.append(_listed(source, content, join, field))
        except Refused as refusal:
            refused.append(refusal)
            found.append(_Found(content.name, (), np.zeros(3), (_as_note(refusal),)))
    read = any(one.chains for one in found)
    if refused and not read:
        raise refused[0]
    if not read:
        _refuse_empty(source, [note.text for one in found for note in one.notes], field)
    return found


def _listed(source: Source, content: LayerContent, join: float | None, field: str) -> _Found:
    """Read all curves on a layer, in space where they leave the plane of the drawing."""
    notes = list(_elsewhere(content, field))
    drawn = CURVE_KINDS & content.kinds.keys()
    if content.state or not drawn:
        return _Found(content.name, (), np.zeros(3), tuple(notes))
    drawing = source.trace(content.name, skip=sorted(content.kinds.keys() - drawn))
    origin = origin_of(drawing.traced)
    tolerance = join_tolerance(join, drawing.printed)
    strokes, flattened = _strokes(drawing, origin, tolerance, field)
    single, doubled = without_doubles(strokes, tolerance)
    chains, moved = joined(single, tolerance, field)
    notes += [*drawing.notes, *flattened, *_doubled(doubled, field), *moved]
    if len(chains) == 1 and not doubled:
        notes += _wrong_with(strokes, tolerance, field)
    return _Found(content.name, chains, origin, tuple(notes))


def _strokes(
    drawing: LayerDrawing, origin: Floats, tolerance: float, field: str
) -> tuple[list[Stroke[Any]], tuple[Note, ...]]:
    traced = seen_from(drawing.traced, origin)
    try:
        return laid_flat(traced, None, field, tolerance)
    except Refused as refusal:
        if refusal.code != "E-DRAWN-PLANE":
            raise
        text = f'{refusal.found}: read in space, as with drawn = "world"'
        return _in_space(traced), (Note("W-DRAWN-SPACE", field, text),)


def _in_space(traced: list[Traced]) -> list[Stroke[SpatialPiece]]:
    shapes = [(one.name, [shape for shape in one.shapes if np.ptp(shape.anchors, axis=0).any()]) for one in traced]
    return [Stroke(name, tuple(piece_in_space(shape) for shape in kept)) for name, kept in shapes if kept]


def _wrong_with(strokes: list[Stroke[Any]], tolerance: float, field: str) -> Iterator[Note]:
    """Say why a project would not take a layer's only curve."""
    try:
        the_one_chain(strokes, tolerance, field)
    except Refused as refusal:
        yield _as_note(refusal)


def _elsewhere(content: LayerContent, field: str) -> Iterator[Note]:
    name = f"layer '{content.name}'"
    if content.state:
        yield Note("W-DRAWN-HIDDEN", field, f"{name} is {content.state}: not read")
    if content.elsewhere:
        yield Note("W-DRAWN-ELSEWHERE", field, f"{name} also holds, not read: {'; '.join(content.elsewhere)}")


def _doubled(pairs: list[tuple[str, str]], field: str) -> Iterator[Note]:
    if pairs:
        kept, copy = pairs[0]
        more = f", and {len(pairs) - 1} more" if len(pairs) > 1 else ""
        yield Note("W-DRAWN-DOUBLED", field, f"{kept} and {copy} lie on each other{more}: a project refuses that")


def _as_note(refusal: Refused) -> Note:
    return Note(refusal.code, refusal.field, f"{refusal.found}. Limit: {refusal.limit}. {refusal.way_out}")


def _refuse_empty(source: Source, said: Sequence[str], field: str) -> None:
    kinds = {kind: count for content in source.layers() for kind, count in content.kinds.items()}
    there = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
    found = "; ".join([f"no curve in the model{f' among {there}' if there else ''}", *said])
    raise Refused("E-DRAWN-CURVES", field, found, "one curve", "Draw a curve, or thaw its layer.")


# --- a curve, measured


def _read(layer: str, chain: Chain[Any], origin: Floats) -> ReadCurve:
    pieces = chain.pieces
    kind = SpatialCurve if isinstance(pieces[0], SpatialPiece) else PlanarCurve
    curve = kind(pieces, chain.closed)
    offset = origin[:2]
    places = np.linspace(0.0, 1.0, _SAMPLES)
    points = np.concatenate([piece.point(places)[:, :2] for piece in pieces]) + offset
    reach = np.concatenate([points, *(_turning_points(piece) + offset for piece in pieces)])
    low, high = reach.min(axis=0), reach.max(axis=0)
    box = (float(low[0]), float(low[1]), float(high[0]), float(high[1]))
    return ReadCurve(layer, chain.closed, length(curve), len(pieces), box, chain.names, points)


def _turning_points(piece: Any) -> Floats:
    """Give the points (k, 2) of a piece in the plane, or over it, at which x or y turns back."""
    places = np.linspace(0.0, 1.0, _SAMPLES)
    found = [turn for axis in (0, 1) for turn in _zeros(piece, axis, places)]
    return piece.point(np.array(found))[:, :2] if found else np.empty((0, 2))


def _zeros(piece: Any, axis: int, places: Floats) -> Iterator[float]:
    """Give the parameters at which a coordinate's derivative changes its sign."""

    def slope(t: float) -> float:
        return float(piece.derivative(np.array([t]))[0, axis])

    signs = np.sign(piece.derivative(places)[:, axis])
    for (low, high), (before, after) in zip(pairwise(places.tolist()), pairwise(signs.tolist()), strict=True):
        if before * after < 0:
            yield float(brentq(slope, low, high))
