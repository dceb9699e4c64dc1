"""What `nest` writes: the layout, cut sheets for machines, and the cutting plan, proved before they are published."""

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from isomould.delivery.cut_sheets import SheetLook, sheet_files, write_sheet
from isomould.documents.drawing import Circle
from isomould.documents.info import ProjectInfo
from isomould.documents.shop.cutting_plan import cutting_plan
from isomould.documents.shop.saw_list import saw_list
from isomould.documents.shop.title_block import Stationery, read_title_block
from isomould.documents.stock_tables import bar_table, saw_table
from isomould.errors import CertificateFailed, Refused
from isomould.intake.member_rows import MemberList
from isomould.intake.part_list import Hole, PartList
from isomould.nesting.files import bars_to_json, layout_to_json, said
from isomould.nesting.layout import BarLayout, Layout, Part
from isomould.templates import template_folder
from isomould.verify import Certificate, verify_nest
from isomould.workers import Spread
from isomould.writers.csv import csv_text
from isomould.writers.disk import replacing, write_bytes
from isomould.writers.pdf import pdf_bytes
from isomould.writers.settings import DeliverSettings
from isomould.writers.sheet_folder import refuse_taken, sheet_folder
from isomould.writers.xlsx import Words, workbook_bytes


@dataclass(frozen=True)
class Targets:
    """Where a nest is written: its layout, sheets (which may replace earlier ones) or saw list, and cutting plan."""

    layout: Path
    sheets: Path | None = None
    plan: Path | None = None
    saw_list: Path | None = None
    overwrite: bool = False


def check_targets(targets: Targets, listed: Literal["parts", "members"]) -> None:
    """Refuse targets that cannot be written, before anything is nested.

    Raises
    ------
    Refused
        E-OUT-12 for what the list cannot give, E-OUT-10 for a folder that holds anything else, E-OUT-11 for a plan or
        saw list in another format.
    """
    if listed == "members" and targets.sheets is not None:
        way_out = "Members lie on bars: give --saw-list saw.csv, or --plan saw.pdf."
        raise Refused("E-OUT-12", "--sheets", "a list of members", "a list of flat parts", way_out)
    if listed == "parts" and targets.saw_list is not None:
        way_out = "Parts lie on sheets: give --sheets DIR, or --plan plan.pdf."
        raise Refused("E-OUT-12", "--saw-list", "a list of flat parts", "a list of members", way_out)
    if targets.plan is not None and targets.plan.suffix.lower() != ".pdf":
        raise Refused("E-OUT-11", "--plan", str(targets.plan), "a file that ends in .pdf", "Write --plan plan.pdf.")
    if targets.saw_list is not None and targets.saw_list.suffix.lower() not in {".csv", ".xlsx"}:
        limit, way_out = "a file that ends in .csv or .xlsx", "Write --saw-list saw.csv; a PDF is --plan."
        raise Refused("E-OUT-11", "--saw-list", str(targets.saw_list), limit, way_out)
    if targets.sheets is not None:
        refuse_taken(targets.sheets, targets.overwrite)


def refuse_overwriting(targets: Targets, read: Sequence[Path]) -> None:
    """Refuse targets in the place of what is read, or of each other.

    Raises
    ------
    Refused
        E-OUT-13, naming the option and the file.
    """
    taken = {path.resolve() for path in read}
    named = {
        "--out": targets.layout,
        "--plan": targets.plan,
        "--saw-list": targets.saw_list,
        "--sheets": targets.sheets,
    }
    for option, path in named.items():
        if path is None:
            continue
        if path.resolve() in taken:
            raise Refused(
                "E-OUT-13", option, str(path), "a place that is not read or written besides", "Choose another."
            )
        taken.add(path.resolve())


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
        _prove(targets, verify_nest(file, folder, plan, spread=spread))


def publish_bars(targets: Targets, layout: BarLayout, given: MemberList) -> None:
    """Write layout, saw list and its PDF beside their places, prove them there, and only then publish them.

    Raises
    ------
    CertificateFailed
        E-NEST-30, naming the file. Nothing is published.
    """
    with ExitStack() as places:
        file = places.enter_context(replacing(targets.layout))
        plan = places.enter_context(replacing(targets.plan)) if targets.plan else None
        saw = places.enter_context(replacing(targets.saw_list)) if targets.saw_list else None
        write_bytes(file, bars_json(layout, given).encode())
        if saw is not None:
            write_bytes(saw, _saw_bytes(targets, layout, given))
        if plan is not None:
            write_bytes(plan, pdf_bytes(saw_list(_stationery(given.name), layout, given.stock), _heading(given.name)))
        _prove(targets, verify_nest(file, plan=plan, saw_list=saw))


def bars_json(layout: BarLayout, given: MemberList) -> str:
    """Give the layout file of bars, and what was asked for."""
    stock = given.stock
    nesting = {"bar_kerf_mm": stock.bar_kerf, "bar_trim_mm": stock.bar_trim, "bar_ends": stock.bar_ends}
    members = [
        {"id": m.id, "section": m.section, "quantity": m.quantity, "length": m.length, "points": [*m.outline]}
        for m in given.members
    ]
    return bars_to_json(layout, {"nesting": nesting, "members": members})


def _saw_bytes(targets: Targets, layout: BarLayout, given: MemberList) -> bytes:
    """Write the saw list as its name asks: one table as CSV, or a workbook with that of the bars."""
    table = saw_table(layout)
    if targets.saw_list and targets.saw_list.suffix.lower() == ".csv":
        return csv_text(table).encode()
    return workbook_bytes((table, bar_table(layout, given.stock)), Words(ProjectInfo(name=_heading(given.name))))


_PLACES = {"V45f": "plan", "V45g": "plan", "V34d": "saw_list"}
"""What other checks than those of sheets or layout find fault with."""


def _prove(targets: Targets, certificate: Certificate) -> None:
    for check in certificate.failures:
        place = getattr(targets, _PLACES.get(check.id, "sheets")) or targets.layout
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
    grain = {"grain": part.grain} if part.grain else {}
    outline = {"id": part.id, "quantity": part.quantity, "points": part.outline.tolist()}
    table = {**outline, **said(part.material), **grain}
    return {**table, "holes": [_hole(hole) for hole in holes]} if holes else table


def _hole(hole: Hole) -> dict[str, Any]:
    if isinstance(hole, Circle):
        return {"centre": list(hole.centre), "radius": hole.radius}
    bulges = np.zeros(len(hole.points)) if hole.bulges is None else hole.bulges
    return {"points": hole.points.tolist(), "bulges": bulges.tolist()}


def _plan_bytes(layout: Layout, given: PartList) -> bytes:
    name = given.instance.name
    return pdf_bytes(cutting_plan(_stationery(name), layout, given.instance.stock), _heading(name))


def _stationery(name: str) -> Stationery:
    block = read_title_block((template_folder() / "sheets" / "title-block.toml").read_text(encoding="utf-8"))
    return Stationery(block, ProjectInfo(name=_heading(name)))


def _heading(name: str) -> str:
    """Give the name of a list as a title block holds it."""
    return "".join(c if c.isprintable() else " " for c in name).strip()[:120] or "Part list"
