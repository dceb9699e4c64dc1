"""Drawings and models as sources of curves, whatever their format, and the chains that a layer holds.

This is what `curve` tables, part drawings and `inspect` read files with, so that all of them read alike.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from isomould.arrays import Floats
from isomould.curves.chains import Chain
from isomould.curves.drawing_units import FoundUnit
from isomould.curves.dxf import open_dxf_source
from isomould.curves.entities import TRACERS
from isomould.curves.joining import join_tolerance, joined
from isomould.curves.layers import LayerContent, LayerDrawing
from isomould.curves.origins import origin_of, seen_from
from isomould.curves.pieces import Piece
from isomould.curves.rhino import RHINO_CURVES, open_rhino_source
from isomould.curves.spatial import laid_flat
from isomould.errors import Note, Refused
from isomould.units import LengthUnit

CURVE_KINDS = frozenset(TRACERS) | RHINO_CURVES
"""Types of entities that are read as curves, as `LayerContent.kinds` names them."""


class Source(Protocol):
    """An opened drawing or model."""

    unit: FoundUnit | None
    """None where the file does not say and nobody was asked: layers can be listed, curves not read."""
    notes: tuple[Note, ...]
    """What was assumed when it was opened."""

    def layers(self) -> tuple[LayerContent, ...]: ...  # noqa: D102
    def holds(self, layer: str) -> bool: ...  # noqa: D102
    def trace(self, layer: str, skip: Sequence[str] = ()) -> LayerDrawing: ...  # noqa: D102


@dataclass(frozen=True, eq=False)
class Reading:
    """The curves on a layer, in its plane, mm from an origin."""

    chains: tuple[Chain[Piece], ...]
    origin: Floats
    """(3,) mm in the drawing: zeros unless it is remote."""
    unit: FoundUnit
    join: float
    """The tolerance that ends were joined with, mm."""
    notes: tuple[Note, ...]


def open_source(path: Path, units: LengthUnit | None, field: str) -> Source:
    """Open a drawing (.dxf) or a Rhino model (.3dm).

    Raises
    ------
    Refused
        E-DRAWN-FILE for another format; E-DXF-… or E-RHINO-… as the format's own reader.
    OutputFault
        If the system does not let the file be read.
    """
    match path.suffix.lower():
        case ".dxf":
            return open_dxf_source(path, units, field)
        case ".3dm":
            return open_rhino_source(path, units, field)
        case suffix:
            found = f"{path.name}, a file of type {suffix or 'unknown'}"
            raise Refused("E-DRAWN-FILE", field, found, "a .dxf or .3dm file", "Save the drawing as DXF.")


def read_chains(source: Source, layer: str, join: float | None, field: str) -> Reading:
    """Read all curves on a layer of a flat drawing.

    Raises
    ------
    Refused
        As `Source.trace`, `laid_flat` and `joined`.
    """
    drawing = source.trace(layer)
    if source.unit is None:
        message = "a source without a unit traces nothing"
        raise TypeError(message)
    origin = origin_of(drawing.traced)
    tolerance = join_tolerance(join, drawing.printed)
    strokes, flattened = laid_flat(seen_from(drawing.traced, origin), None, field, tolerance)
    chains, moved = joined(strokes, tolerance, field)
    notes = (*source.notes, *drawing.notes, *flattened, *moved)
    return Reading(chains, origin, source.unit, tolerance, notes)
