"""What the program reads from a file: the curves of a drawing or model, layer by layer, or the parts of a list."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from isomould.arrays import Floats, read_only
from isomould.documents.numbers import format_number
from isomould.errors import Note

DRAWINGS = {".dxf", ".3dm"}
"""Ends of the names of drawings and models; everything else lists parts."""

_DECIMALS = 6
"""Of lengths as data, mm."""

_SHOWN = 8
"""Names of entities in a line for people; data has them all."""


def is_drawing(path: Path) -> bool:
    """Tell a drawing or model from a part list."""
    return path.suffix.lower() in DRAWINGS


@dataclass(frozen=True, eq=False)
class ReadCurve:
    """A curve as it was read.

    Attributes
    ----------
    layer : str
    closed : bool
    length : float, mm
    pieces : int
        Lines, arcs and spans of splines.
    box : (4,) float, mm
        Least x and y, largest x and y, in the drawing's coordinates.
    entities : tuple of str
        What it was drawn with, in the order of the curve.
    points : (n, 2) float, mm
        Along the curve, for pictures.
    """

    layer: str
    closed: bool
    length: float
    pieces: int
    box: tuple[float, float, float, float]
    entities: tuple[str, ...]
    points: Floats

    def __post_init__(self) -> None:
        read_only(self.points)

    @property
    def data(self) -> dict[str, Any]:
        """The curve as plain data."""
        return {
            "layer": self.layer,
            "closed": self.closed,
            "length_mm": _rounded(self.length),
            "pieces": self.pieces,
            "box_mm": [_rounded(value) for value in self.box],
            "entities": list(self.entities),
        }

    @property
    def line(self) -> str:
        """The curve in a line for people."""
        kind = "closed" if self.closed else "open"
        low_x, low_y, high_x, high_y = (format_number(value, 3) for value in self.box)
        more = f" and {len(self.entities) - _SHOWN} more" if len(self.entities) > _SHOWN else ""
        drawn = ", ".join(self.entities[:_SHOWN]) + more
        length, pieces = format_number(self.length, 3), f"{self.pieces} piece{'s'[: self.pieces != 1]}"
        return f"{kind}, {length} mm, {pieces}, from ({low_x}, {low_y}) to ({high_x}, {high_y}): {drawn}"


@dataclass(frozen=True)
class ReadDrawing:
    """The curves of a drawing or model, the unit that it is in and who said so, and what should be known of it."""

    file: str
    curves: tuple[ReadCurve, ...]
    units: str
    units_said_by: str
    notes: tuple[Note, ...]

    @property
    def data(self) -> dict[str, Any]:
        """What was read as plain data."""
        return {
            "curves": [curve.data for curve in self.curves],
            "units": self.units,
            "units_said_by": self.units_said_by,
            "notes": _noted(self.notes),
        }

    @property
    def lines(self) -> tuple[str, ...]:
        """What was read in lines for people."""
        said = {"file": "as the file says", "asked": "as asked"}[self.units_said_by]
        count = f"{len(self.curves)} curve{'s'[: len(self.curves) != 1]}"
        rows = [f"  {json.dumps(curve.layer, ensure_ascii=False)}: {curve.line}" for curve in self.curves]
        return (f"{self.file}: {count}, read in {self.units} {said}", *rows)


@dataclass(frozen=True)
class ReadList:
    """The parts or members of a list as plain data, and what should be known of it."""

    file: str
    parts: tuple[Mapping[str, Any], ...]
    notes: tuple[Note, ...]

    @property
    def data(self) -> dict[str, Any]:
        """What was read as plain data."""
        return {"parts": [dict(part) for part in self.parts], "notes": _noted(self.notes)}

    @property
    def lines(self) -> tuple[str, ...]:
        """What was read in lines for people."""
        pieces = sum(part["quantity"] for part in self.parts)
        rows = [f"  {_described(part)}" for part in self.parts]
        return (f"{self.file}: {len(self.parts)} kinds, {pieces} pieces", *rows)


Inspection = ReadDrawing | ReadList


def json_text(inspection: Inspection) -> str:
    """Give what was read as JSON."""
    return json.dumps(inspection.data, indent=1)


def _described(part: Mapping[str, Any]) -> str:
    size = f"{format_number(part['length_mm'], 3)} mm of {part['section']}" if "section" in part else _flat_size(part)
    return f"{part['id']}: {part['quantity']} × {size}"


def _flat_size(part: Mapping[str, Any]) -> str:
    holes = f", {part['holes']} holes" if part["holes"] else ""
    box = f"{format_number(part['width_mm'], 3)} × {format_number(part['height_mm'], 3)} mm"
    return f"{box}, {part['corners']} corners{holes}"


def _noted(notes: tuple[Note, ...]) -> list[dict[str, str]]:
    return [{"code": note.code, "text": note.text} for note in notes]


def _rounded(value: float) -> float:
    return round(value, _DECIMALS) + 0.0
