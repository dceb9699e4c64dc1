"""What `nest` writes: the layout, cut sheets for machines, and the cutting plan, proved before they are published."""

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from isomould.delivery.cut_sheets import SheetLook, sheet_files, write_sheet
from isomould.documents.drawing import Circle
from isomould.documents.info import ProjectInfo
from isomould.documents.shop.cutting_plan import cutting_plan
from isomould.documents.shop.title_block import Stationery, read_title_block
from isomould.errors import CertificateFailed, Refused
from isomould.intake.part_list import Hole, PartList
from isomould.nesting.files import layout_to_json
from isomould.nesting.layout import Layout, Part
from isomould.templates import template_folder
from isomould.verify import Certificate, verify_nest
from isomould.workers import Spread
from isomould.writers.disk import replacing, write_bytes
from isomould.writers.pdf import pdf_bytes
from isomould.writers.settings import DeliverSettings
from isomould.writers.sheet_folder import refuse_taken, sheet_folder


@dataclass(frozen=True)
class Targets:
    """Where a nest is written: its layout, sheets (which may replace earlier ones) and cutting plan."""

    layout: Path
    sheets: Path | None = None
    plan: Path | None = None
    overwrite: bool = False


def check_targets(targets: Targets) -> None:
    """Refuse targets that cannot be written, before anything is nested.

    Raises
    ------
    Refused
        E-OUT-10 for a folder that holds anything else, E-OUT-11 for a plan that is no PDF.
    """
    if targets.plan is not None and targets.plan.suffix.lower() != ".pdf":
        raise Refused("E-OUT-11", "--plan", str(targets.plan), "a file that ends in .pdf", "Write --plan plan.pdf.")
    if targets.sheets is not None:
        refuse_taken(targets.sheets, targets.overwrite)


def publish_nest(targets: Targets, layout: Layout, given: PartList, spread: Spread) -> None:
    """Write layout, sheets and cutting plan beside their places, prove them there, and only then publish them.

    Raises
    ------
    CertificateFailed
        E-NEST-30, naming the file: what was written does not show the layout. Nothing is published.
    """
    with ExitStack() as places:
        file = places.enter_context(replacing(targets.layout))
        plan = places.enter_context(replacing(targets.plan)) if targets.plan else None
        folder = (
            places.enter_context(sheet_folder(targets.sheets, replace=targets.overwrite)) if targets.sheets else None
        )
        write_bytes(file, nest_json(layout, given).encode())
        if folder is not None:
            look = SheetLook(DeliverSettings(), holes=given.holes_of)
            spread(write_sheet, sheet_files(folder, "", layout, given.instance.stock, look))
        if plan is not None:
            write_bytes(plan, _plan_bytes(layout, given))
        _prove(targets, verify_nest(file, folder, plan, spread))


def _prove(targets: Targets, certificate: Certificate) -> None:
    for check in certificate.failures:
        place = targets.plan if check.id == "V45f" else targets.sheets or targets.layout
        found = check.reason or f"{check.worst} {check.unit} at {check.where}"
        message = (
            f"E-NEST-30 {place}: {check.id} {check.what}: {found}. Nothing was written; please report the part list."
        )
        raise CertificateFailed(message)


def nest_json(layout: Layout, given: PartList) -> str:
    """Give the layout file: the layout, and what was asked for, so that the file can be proved by itself."""
    stock = given.instance.stock
    nesting = {
        "gap_mm": stock.gap,
        "kerf_mm": stock.kerf,
        "trim_mm": stock.trim,
        "turn_over": stock.turn_over,
        "guillotine": stock.guillotine,
    }
    parts = [_part(part, given.holes.get(part.id, ())) for part in given.instance.parts]
    return layout_to_json(layout, {"nesting": nesting, "parts": parts})


def _part(part: Part, holes: Sequence[Hole]) -> dict[str, Any]:
    table = {"id": part.id, "quantity": part.quantity, "points": part.outline.tolist()}
    return {**table, "holes": [_hole(hole) for hole in holes]} if holes else table


def _hole(hole: Hole) -> dict[str, Any]:
    if isinstance(hole, Circle):
        return {"centre": list(hole.centre), "radius": hole.radius}
    bulges = np.zeros(len(hole.points)) if hole.bulges is None else hole.bulges
    return {"points": hole.points.tolist(), "bulges": bulges.tolist()}


def _plan_bytes(layout: Layout, given: PartList) -> bytes:
    block = read_title_block((template_folder() / "sheets" / "title-block.toml").read_text(encoding="utf-8"))
    name = given.instance.name.strip()[:120] or "Part list"
    stationery = Stationery(block, ProjectInfo(name=name))
    return pdf_bytes(cutting_plan(stationery, layout, given.instance.stock), name)
