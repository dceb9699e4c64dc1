"""Cut sheets for machines: the drawings of a layout's sheets, of a project or of a part list of others."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from isomould.arrays import Floats
from isomould.documents.cut_sheets import PartOnSheet, sheet_drawing
from isomould.documents.drawing import Circle, CutDrawing, Polyline
from isomould.nesting.layout import Layout, Placement, Sheet
from isomould.nesting.scoring import score_lines
from isomould.nesting.settings import StockSettings
from isomould.writers.dxf import write_dxf
from isomould.writers.settings import DeliverSettings

Holes = Callable[[Placement], Sequence[Polyline | Circle]]


def _no_holes(_: Placement) -> Sequence[Polyline | Circle]:
    return ()


@dataclass(frozen=True)
class SheetLook:
    """How sheets are written: versions and layers, the text at the arrow of orientation, the holes of parts."""

    asked: DeliverSettings
    orientation: str | None = None
    holes: Holes = _no_holes


@dataclass(frozen=True, eq=False)
class SheetFile:
    """A cut sheet that is to be written; `scores` (k, 2, 2) mm where it is scored."""

    folder: Path
    name: str
    sheet: Sheet
    parts: tuple[PartOnSheet, ...]
    scores: Floats | None
    asked: DeliverSettings
    orientation: str | None


def sheet_files(folder: Path, prefix: str, layout: Layout, stock: StockSettings, look: SheetLook) -> list[SheetFile]:
    """Give the files of all sheets; `prefix` stands before their names in the folder."""
    scores = score_lines(layout, stock) if stock.scored else {}
    on: dict[str, list[PartOnSheet]] = {sheet.id: [] for sheet in layout.sheets}
    for p in layout.placements:
        on[p.sheet].append(PartOnSheet(str(p.id), p.location or "", p.points, look.holes(p)))
    return [
        SheetFile(folder, f"{prefix}{s.id}", s, tuple(on[s.id]), scores.get(s.id), look.asked, look.orientation)
        for s in layout.sheets
    ]


def write_sheet(file: SheetFile) -> None:
    """Write the drawing of a sheet."""
    sheet, material = file.sheet, str(file.sheet.material)
    drawing = sheet_drawing(sheet.width, sheet.height, file.parts, file.scores, file.orientation, material)
    write_versions(file.folder, file.name, drawing, file.asked)


def write_versions(folder: Path, name: str, drawing: CutDrawing, asked: DeliverSettings) -> None:
    """Write a drawing in every version asked for; the twins of the folder's files lie in `r12/`."""
    for version in asked.dxf:
        place = folder / "r12" if version == "R12" else folder
        write_dxf(place / f"{name}.dxf", drawing, asked.layers, version)
