"""What `nest` writes beside the layout: cut sheets for machines, and the cutting plan."""

from pathlib import Path

from isomould.delivery.cut_sheets import SheetLook, sheet_files, write_sheet
from isomould.documents.info import ProjectInfo
from isomould.documents.shop.cutting_plan import cutting_plan
from isomould.documents.shop.title_block import Stationery, read_title_block
from isomould.errors import Refused
from isomould.intake.part_list import PartList
from isomould.nesting.layout import Layout
from isomould.templates import template_folder
from isomould.writers.disk import replace_file
from isomould.writers.pdf import pdf_bytes
from isomould.writers.settings import DeliverSettings
from isomould.writers.sheet_folder import refuse_taken, sheet_folder


def check_targets(sheets: Path | None, plan: Path | None, *, overwrite: bool) -> None:
    """Refuse targets that cannot be written, before anything is nested.

    Raises
    ------
    Refused
        E-OUT-10 for a folder that holds anything else, E-OUT-11 for a plan that is no PDF.
    """
    if plan is not None and plan.suffix.lower() != ".pdf":
        raise Refused("E-OUT-11", "--plan", str(plan), "a file that ends in .pdf", "Write --plan plan.pdf.")
    if sheets is not None:
        refuse_taken(sheets, overwrite)


def write_sheets(target: Path, layout: Layout, given: PartList, *, overwrite: bool) -> None:
    """Write the sheets of a layout as DXF into a folder of their own, whole or not at all."""
    look = SheetLook(DeliverSettings(), holes=given.holes_of)
    with sheet_folder(target, replace=overwrite) as folder:
        for file in sheet_files(folder, "", layout, given.instance.stock, look):
            write_sheet(file)


def write_plan(target: Path, layout: Layout, given: PartList) -> None:
    """Write the cutting plan of a layout as PDF."""
    block = read_title_block((template_folder() / "sheets" / "title-block.toml").read_text(encoding="utf-8"))
    name = given.instance.name.strip()[:120] or "Part list"
    stationery = Stationery(block, ProjectInfo(name=name))
    replace_file(target, pdf_bytes(cutting_plan(stationery, layout, given.instance.stock), name))
