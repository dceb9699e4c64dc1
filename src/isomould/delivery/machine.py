"""Machine files: part files of panels and members, cut sheets, strips, setting out."""

from dataclasses import dataclass
from pathlib import Path

from isomould.arrays import Floats
from isomould.delivery.goods import Delivery
from isomould.documents.cut_sheets import hole_contours, part_drawing, sheet_drawing
from isomould.documents.drawing import Layer
from isomould.documents.setting_out import setting_out_drawing
from isomould.documents.strips import strip_drawing
from isomould.nesting.files import layout_to_json
from isomould.nesting.layout import Placement, Sheet
from isomould.parts.features import Hole
from isomould.parts.settings import PanelSettings
from isomould.workers import Spread
from isomould.writers.disk import write_bytes
from isomould.writers.dxf import write_dxf


@dataclass(frozen=True, eq=False)
class _PartFile:
    """A part file that is to be written."""

    path: Path
    outline: Floats
    layers: dict[Layer, str]
    orientation: str | None = None
    holes: tuple[Hole, ...] = ()
    bulges: Floats | None = None


@dataclass(frozen=True, eq=False)
class _SheetFile:
    """A cut sheet that is to be written."""

    path: Path
    sheet: Sheet
    placements: tuple[Placement, ...]
    layers: dict[Layer, str]
    orientation: str | None


def write_machine_files(folder: Path, delivery: Delivery, spread: Spread) -> None:
    """Write the part files of panels and members and the cut sheets: many files, side by side."""
    kit, layers = delivery.design.kit, delivery.design.project.deliver.layers
    orientation = _orientation(delivery.design.project.panels)
    panels = zip(kit.panels.marks, kit.panels.outlines, strict=True)
    members = zip(kit.members.marks, kit.members.shapes, strict=True)
    files = [_PartFile(folder / "panels" / f"{mark}.dxf", outline, layers, orientation) for mark, outline in panels]
    files += [
        _PartFile(folder / "members" / f"{mark}.dxf", shape.outline, layers, None, shape.holes)
        for mark, shape in members
    ]
    files += [
        _PartFile(folder / "fittings" / f"{f.mark}.dxf", f.outline[0], layers, None, f.holes, f.outline[1])
        for f in delivery.fittings
        if f.outline
    ]
    spread(_write_part, files)
    layout = delivery.cutting.sheets
    on: dict[str, list[Placement]] = {sheet.id: [] for sheet in layout.sheets}
    for placement in layout.placements:
        on[placement.sheet].append(placement)
    sheets = [
        _SheetFile(folder / "sheets" / f"{s.id}.dxf", s, tuple(on[s.id]), layers, orientation) for s in layout.sheets
    ]
    spread(_write_sheet, sheets)
    write_bytes(folder / "sheets" / "nesting.json", layout_to_json(layout).encode())


def _orientation(panels: PanelSettings) -> str | None:
    """What stands beside the arrow to side a: which side is coated; None where nothing is engraved."""
    text = {"none": "", "inside": "COATED INSIDE", "outside": "COATED OUTSIDE"}[panels.coating]
    return text if panels.orientation_mark else None


def _write_part(file: _PartFile) -> None:
    inner, text = hole_contours(file.holes), file.orientation
    write_dxf(file.path, part_drawing(file.path.stem, file.outline, file.bulges, inner, orientation=text), file.layers)


def _write_sheet(file: _SheetFile) -> None:
    placed = [(str(p.id), str(p.location), p.points) for p in file.placements]
    drawing = sheet_drawing(file.sheet.width, file.sheet.height, placed, orientation=file.orientation)
    write_dxf(file.path, drawing, file.layers)


def write_strips(folder: Path, delivery: Delivery) -> None:
    """Write the unrolled strips that the project asks for."""
    for strip in delivery.strips:
        write_dxf(folder / f"{strip.name}.dxf", strip_drawing(strip), delivery.design.project.deliver.layers)


def write_setting_out(path: Path, delivery: Delivery) -> None:
    """Write the axes in space."""
    project = delivery.design.project
    drawing = setting_out_drawing(delivery.design.kit, project.members.section.depth)
    write_dxf(path, drawing, project.deliver.layers)
