"""Machine files: part files of panels and members, cut sheets, strips, setting out."""

from dataclasses import dataclass
from pathlib import Path

from isomould.arrays import Floats
from isomould.delivery.cut_sheets import SheetLook, sheet_files, write_sheet, write_versions
from isomould.delivery.goods import Delivery
from isomould.delivery.stages import PART_FILES, SHEETS
from isomould.documents.cut_sheets import part_drawing
from isomould.documents.drawing import CutDrawing
from isomould.documents.flat_parts import FlatPart, base_parts, fitting_parts, flat_drawing, flat_nc_part
from isomould.documents.member_files import member_drawing, member_nc_parts
from isomould.documents.setting_out import setting_out_drawing
from isomould.documents.strips import strip_drawing
from isomould.nesting.files import layout_to_json
from isomould.parts.members import MemberShape
from isomould.parts.settings import PanelSettings
from isomould.progress import UNTOLD, Course
from isomould.workers import Spread
from isomould.writers.disk import write_bytes
from isomould.writers.dxf import write_dxf
from isomould.writers.nc1 import NcOrder, write_nc1
from isomould.writers.settings import DeliverSettings


@dataclass(frozen=True, eq=False)
class _PartFile:
    """A part file that is to be written: the outline of a panel, a member or a flat fitting."""

    folder: Path
    name: str
    part: Floats | MemberShape | FlatPart
    asked: DeliverSettings
    orientation: str | None


def write_machine_files(folder: Path, delivery: Delivery, spread: Spread, course: Course = UNTOLD) -> None:
    """Write the part files of panels and members and the cut sheets: many files, side by side."""
    kit, asked = delivery.design.kit, delivery.design.project.deliver
    orientation = _orientation(delivery.design.project.panels)
    parts: dict[str, Floats | MemberShape | FlatPart] = {
        f"panels/{mark}": outline for mark, outline in zip(kit.panels.marks, kit.panels.outlines, strict=True)
    }
    parts |= {f"members/{mark}": shape for mark, shape in zip(kit.members.marks, kit.members.shapes, strict=True)}
    parts |= {part.file: part for part in fitting_parts(delivery.fittings)}
    files = [_PartFile(folder, name, part, asked, orientation) for name, part in parts.items()]
    spread(_write_part, files, course.begin(PART_FILES))
    layout = delivery.cutting.sheets
    look = SheetLook(asked, orientation)
    sheets = sheet_files(folder, "sheets/", layout, delivery.cutting.stock, look)
    spread(write_sheet, sheets, course.begin(SHEETS))
    write_bytes(folder / "sheets" / "nesting.json", layout_to_json(layout).encode())


def _orientation(panels: PanelSettings) -> str | None:
    """What stands beside the arrow to side a: which side is coated; None where nothing is engraved."""
    text = {"none": "", "inside": "COATED INSIDE", "outside": "COATED OUTSIDE"}[panels.coating]
    return text if panels.orientation_mark else None


def _write_part(file: _PartFile) -> None:
    write_versions(file.folder, file.name, _part_drawing(file), file.asked)


def _part_drawing(file: _PartFile) -> CutDrawing:
    mark = file.name.rpartition("/")[2]
    if isinstance(file.part, MemberShape):
        return member_drawing(mark, file.part)
    if isinstance(file.part, FlatPart):
        return flat_drawing(file.part)
    return part_drawing(mark, file.part, orientation=file.orientation)


def write_nc1_files(folder: Path, delivery: Delivery) -> None:
    """Write the NC1 files of members, flat fittings and bases beside their drawings."""
    project, members = delivery.design.project, delivery.design.kit.members
    info, asked = project.project, project.members
    order = NcOrder(info.number, info.drawing, info.phase)
    for part in member_nc_parts(members, asked, project.deliver.mass_unit("bar")):
        write_nc1(folder / "members" / f"{part.mark}.nc1", part, order)
    densities = ((fitting_parts(delivery.fittings), asked.density), (plates_of_bases(delivery), project.nodes.density))
    for part, density in ((part, density) for parts, density in densities for part in parts):
        written = flat_nc_part(part, asked.grade, density, project.deliver.mass_unit("plate"))
        write_nc1(folder / f"{part.file}.nc1", written, order)


def plates_of_bases(delivery: Delivery) -> tuple[FlatPart, ...]:
    """Give plate and stem of every class of supports that stands on a base."""
    nodes = delivery.design.kit.nodes
    rows = zip(nodes.marks, nodes.classes.quantity.tolist(), delivery.design.kit.bases, strict=True)
    return tuple(part for mark, quantity, base in rows if base for part in base_parts(mark, quantity, base))


def write_strips(folder: Path, delivery: Delivery) -> None:
    """Write the unrolled strips that the project asks for."""
    for strip in delivery.strips:
        write_versions(folder, f"strips/{strip.name}", strip_drawing(strip), delivery.design.project.deliver)


def write_setting_out(path: Path, delivery: Delivery) -> None:
    """Write the axes in space."""
    write_dxf(path, setting_out_drawing(delivery.setting_out), delivery.design.project.deliver.layers)
