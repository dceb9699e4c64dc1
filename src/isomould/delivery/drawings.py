"""The folder `drawings/`: shop drawings of every class and the general arrangement, as PDF and as DXF."""

from collections.abc import Mapping

from isomould.delivery.goods import Delivery
from isomould.documents.shop.member_sheet import MemberDrawing, member_sheet, plate_section
from isomould.documents.shop.node_sheet import NodeDrawing, node_sheet
from isomould.documents.shop.page import Book
from isomould.documents.shop.panel_sheet import PanelDrawing, panel_sheet
from isomould.documents.shop.rows import length_text, schedule_rows
from isomould.documents.shop.title_block import Stationery
from isomould.documents.table import Table
from isomould.parts.kit import Kit
from isomould.parts.settings import PanelSettings
from isomould.parts.sections import view_solid


def make_book(name: str, delivery: Delivery, tables: Mapping[str, Table], stationery: Stationery) -> Book:
    return _BOOKS[name](delivery, tables, stationery)


def _nodes(delivery: Delivery, tables: Mapping[str, Table], stationery: Stationery) -> Book:
    rows = schedule_rows(tables["nodes"])
    kit = delivery.design.kit
    notes = detail_notes(kit)
    drawings = [
        NodeDrawing(row, view_solid(solid), backs, notes)
        for row, solid, backs in zip(rows, delivery.solids, _set_backs(kit), strict=True)
    ]
    pages = [
        node_sheet(stationery, tables["nodes"], node, k, len(rows)) for k, node in enumerate(drawings, start=1)
    ]
    return Book("nodes", "Nodes", tuple(pages))


def _set_backs(kit: Kit) -> list[tuple[str, ...]]:
    """Give the set-backs of the arms of every node class as the members' schedule prints them."""
    rows = kit.nodes.arm_rows[kit.nodes.classes.representative]
    members = kit.members
    return [
        tuple(length_text(members.shapes[members.classes.of[kit.arms.edge[row]]].set_back[_end(kit, row)]) for row in arms if row >= 0)
        for arms in rows.tolist()
    ]


def _end(kit: Kit, row: int) -> int:
    """Which end of its member's class an arm is: members that lie end for end show their other one."""
    edge = kit.arms.edge[row]
    return int(kit.arms.end[row]) ^ int(kit.members.classes.variant[edge] % 2)


def detail_notes(kit: Kit) -> tuple[str, ...]:
    """Say what the views of a slotted node do not dimension."""
    drum = kit.drum
    return (
        f"Slots {length_text(drum.slot_width)} wide, parallel to the axis",
        f"Slot floors {length_text(drum.slot_floor)} from the axis",
        *([f"Bore Ø{length_text(drum.bore)}"] if drum.bore else []),
    )


def _members(delivery: Delivery, tables: Mapping[str, Table], stationery: Stationery) -> Book:
    table, shapes = tables["members"], delivery.design.kit.members.shapes
    section = delivery.design.project.members.section
    rows, outline = schedule_rows(table), plate_section(section.depth, section.thickness)
    drawings = [MemberDrawing(row, shape, outline) for row, shape in zip(rows, shapes, strict=True)]
    pages = [member_sheet(stationery, table, member, k, len(rows)) for k, member in enumerate(drawings, start=1)]
    return Book("members", "Members", tuple(pages))


def _panels(delivery: Delivery, tables: Mapping[str, Table], stationery: Stationery) -> Book:
    table, outlines = tables["panels"], delivery.design.kit.panels.outlines
    rows, notes = schedule_rows(table), panel_notes(delivery.design.project.panels)
    drawings = [PanelDrawing(row, outline, notes) for row, outline in zip(rows, outlines, strict=True)]
    pages = [panel_sheet(stationery, table, panel, k, len(rows)) for k, panel in enumerate(drawings, start=1)]
    return Book("panels", "Panels", tuple(pages))


def panel_notes(panels: PanelSettings) -> tuple[str, ...]:
    """Say what panels are made of and which side is drawn."""
    sides = "either side may be outside" if panels.flippable else "seen from outside: the reader looks at the outside"
    return f"{panels.makeup}, {length_text(panels.thickness)} thick", f"Drawn {sides}"


_BOOKS = {"nodes": _nodes, "members": _members, "panels": _panels}
