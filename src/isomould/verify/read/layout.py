"""`sheets/nesting.json`: which part lies where on which sheet."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from isomould.verify.read.text import Json, read_json, refusing
from isomould.verify.rules import Floats, Unreadable


@dataclass(frozen=True, eq=False)
class Placement:
    """A placed part: `points` (n, 2) mm on its sheet, rotation in degrees."""

    mark: str
    location: str
    sheet: str
    points: Floats
    rotation_deg: float
    turned_over: bool


@dataclass(frozen=True, eq=False)
class Layout:
    """The layout: (width, height) by sheet, placements in order of the file, and the whole file."""

    sheets: dict[str, tuple[float, float]]
    placements: tuple[Placement, ...]
    raw: Json

    def on(self, sheet: str) -> list[Placement]:
        """Give the placements on one sheet."""
        return [placed for placed in self.placements if placed.sheet == sheet]


@refusing
def read_layout(path: Path) -> Layout:
    """Read the layout; repeated sheets or unknown ones make it unreadable."""
    raw = read_json(path)
    sheets = {str(sheet["id"]): (float(sheet["width"]), float(sheet["height"])) for sheet in raw["sheets"]}
    placements = tuple(_placement(placed) for placed in raw["placements"])
    if len(sheets) < len(raw["sheets"]) or any(placed.sheet not in sheets for placed in placements):
        message = "a sheet is listed twice, or a part lies on a sheet that is not listed"
        raise Unreadable(message)
    return Layout(sheets, placements, raw)


def _placement(raw: Json) -> Placement:
    points = np.array(raw["points"], dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or not np.isfinite(points).all():
        message = f"points of {raw['location']} are not finite pairs"
        raise Unreadable(message)
    mark, location, sheet = (str("" if raw[key] is None else raw[key]) for key in ("id", "location", "sheet"))
    return Placement(mark, location, sheet, points, float(raw["rotation_deg"]), bool(raw["turned_over"]))
