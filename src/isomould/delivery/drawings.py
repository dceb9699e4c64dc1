"""The folder `drawings/`: a sheet for every class and the general arrangement, as PDF and as DXF."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from isomould.delivery.goods import Delivery
from isomould.delivery.stages import DRAWING_FILES, DRAWINGS
from isomould.documents.shop.arrangement import arrangement_pages
from isomould.documents.shop.cutting_plan import cutting_plan
from isomould.documents.shop.font import drawable
from isomould.documents.shop.member_sheet import MemberDrawing, member_sheet
from isomould.documents.shop.node_sheet import NodeDrawing, node_sheet
from isomould.documents.shop.page import Book
from isomould.documents.shop.panel_sheet import panel_sheet
from isomould.documents.shop.panel_view import PanelDrawing
from isomould.documents.shop.rows import length_text, schedule_rows
from isomould.documents.shop.saw_list import saw_list
from isomould.documents.shop.title_block import Stationery, read_title_block
from isomould.documents.table import Table
from isomould.documents.title_block import heading
from isomould.parts.bodies import section_outline
from isomould.parts.details.bolting import Bolting
from isomould.parts.details.caps import Cap
from isomould.parts.details.faceted import FacetedJoint
from isomould.parts.details.finned import FinnedJoint
from isomould.parts.details.fittings import name_fins
from isomould.parts.details.joint import Fin, Joint
from isomould.parts.details.slotted import SlottedJoint
from isomould.parts.kit import Kit
from isomould.parts.sections import view_solid
from isomould.parts.settings import PanelSettings
from isomould.progress import UNTOLD, Course, Told, count_for_nobody, counted
from isomould.project.schema import Project
from isomould.templates import template_folder
from isomould.workers import Spread
from isomould.writers.dxf_pages import write_pages
from isomould.writers.pdf import write_pdf

Tables = Mapping[str, Table]


@dataclass(frozen=True)
class _BookFiles:
    """A book that is to be written, and where."""

    folder: Path
    book: Book
    subject: str


def write_drawings(folder: Path, delivery: Delivery, spread: Spread, course: Course = UNTOLD) -> None:
    """Draw the books that the project asks for, and write them side by side."""
    project = delivery.design.project
    if project.deliver.drawings:
        books = make_books(delivery, course.begin(DRAWINGS))
        files = [_BookFiles(folder, book, heading(project.project)) for book in books]
        spread(_write_book, files, course.begin(DRAWING_FILES))


def write_cutting_plan(path: Path, delivery: Delivery) -> None:
    """Write the cutting plan of the sheets beside them, where drawings are asked for."""
    project, cutting = delivery.design.project, delivery.cutting
    if project.deliver.drawings:
        plan = cutting_plan(_stationery(project), cutting.sheets, cutting.stock)
        write_pdf(path, plan, heading(project.project))


def write_saw_list(path: Path, delivery: Delivery) -> None:
    """Write the saw list of the bars beside their table, where drawings are asked for."""
    project, cutting = delivery.design.project, delivery.cutting
    if project.deliver.drawings and cutting.bars:
        write_pdf(path, saw_list(_stationery(project), cutting.bars, cutting.stock), heading(project.project))


def _stationery(project: Project) -> Stationery:
    block = read_title_block((template_folder() / "sheets" / "title-block.toml").read_text(encoding="utf-8"))
    return Stationery(block, project.project, None if project.deliver.paper == "auto" else project.deliver.paper)


def _write_book(files: _BookFiles) -> None:
    write_pdf(files.folder / f"{files.book.name}.pdf", files.book, files.subject)
    write_pages(files.folder / f"{files.book.name}.dxf", files.book)


def make_books(delivery: Delivery, told: Told = count_for_nobody) -> tuple[Book, ...]:
    """Draw all books of a delivery from its parts and its schedules, counted."""
    project, named = delivery.design.project, {table.name: table for table in delivery.schedules}
    return tuple(make(delivery, named, _stationery(project)) for make in counted(_BOOKS, told))


def _nodes(delivery: Delivery, tables: Tables, stationery: Stationery) -> Book:
    table, kit = tables["nodes"], delivery.design.kit
    rows = schedule_rows(table)
    parts = zip(rows, delivery.solids, _set_backs(kit), map(detail_notes, kit.joints), kit.bases, strict=True)
    fins = [_fins_of_arms(delivery, k) for k in range(len(rows))]
    drawn = [
        NodeDrawing(row, view_solid(solid), backs, notes, base, *fin)
        for (row, solid, backs, notes, base), fin in zip(parts, fins, strict=True)
    ]
    pages = [node_sheet(stationery, table, node, k, len(rows)) for k, node in enumerate(drawn, start=1)]
    return Book("nodes", "Nodes", tuple(pages))


def _fins_of_arms(delivery: Delivery, node: int) -> tuple[tuple[str, ...], Fin | None]:
    """Give the mark of the fins on every arm of a node class, empty for sills, and the fin of arm 1."""
    arms, joint = delivery.design.kit.nodes.arms[node], delivery.design.kit.joints[node]
    named = name_fins(joint, arms, delivery.fittings)
    first = joint.fins[0] if joint.fins and 1 in named else None
    return tuple(named.get(k, "") for k in range(1, len(arms.azimuth) + 1)), first


def _set_backs(kit: Kit) -> list[tuple[str, ...]]:
    """Give the set-backs of the arms of every node class as the members' schedule prints them."""
    rows = kit.nodes.arm_rows[kit.nodes.classes.representative].tolist()
    return [tuple(length_text(_set_back(kit, row)) for row in arms if row >= 0) for arms in rows]


def _set_back(kit: Kit, row: int) -> float:
    """Set-back of an arm: members that lie end for end show the other end of their class."""
    members, edge = kit.members, kit.arms.edge[row]
    end = int(kit.arms.end[row]) ^ int(members.classes.variant[edge] % 2)
    return members.shapes[members.classes.of[edge]].set_back[end]


def detail_notes(joint: Joint) -> tuple[str, ...]:
    """Say what the views of a node do not dimension."""
    bore = [f"Bore Ø{length_text(joint.bore)}"] if joint.bore else []
    if isinstance(joint, SlottedJoint):
        widths = " and ".join(map(length_text, sorted(set(joint.slot_widths.tolist()))))
        slots = [
            f"Slots {widths} wide, parallel to the axis",
            f"Slot floors {length_text(joint.slot_floor)} from the axis",
        ]
        return (*(slots if widths else []), *_grooves(joint.cap), *bore)
    if isinstance(joint, FacetedJoint):
        return (f"Facets {length_text(joint.distance)} from the work point", *_threads(joint), *bore)
    if isinstance(joint, FinnedJoint):
        return (*_forks(joint), *bore)
    return tuple(bore)


def _forks(joint: FinnedJoint) -> list[str]:
    """Say what fins are and where their holes are, along the members from the work point."""
    if not joint.forks:
        return []
    gaps = " and ".join(map(length_text, sorted({fork.gap for fork in joint.forks})))
    places = " and ".join(length_text(joint.distance + x) for x in joint.pattern.columns)
    return [
        f"Two fins per arm, {length_text(joint.forks[0].fin)} thick, {gaps} apart",
        f"Holes Ø{length_text(joint.pattern.hole)} at {places} from the work point",
        "Seams: along the foot of every fin, from outside",
    ]


def _grooves(cap: Cap | None) -> list[str]:
    """Say where the grooves for the lips of caps are."""
    if cap is None:
        return []
    inner, outer = (2 * radius for radius in (cap.lip_inner - cap.clearance, cap.lip_outer + cap.clearance))
    return [f"Grooves Ø{length_text(inner)} to Ø{length_text(outer)}, {length_text(cap.groove_depth)} deep"]


def _threads(joint: FacetedJoint) -> list[str]:
    """Say what is tapped into the facets."""
    each = dict.fromkeys(joint.bolting)
    return [line for bolting in each for line in _thread(bolting)]


def _thread(bolting: Bolting) -> tuple[str, str]:
    size, depth = bolting.bolt.size, length_text(bolting.hole_depth)
    levels = " and ".join(map(length_text, bolting.levels))
    return f"{size} in facets of {bolting.section.name}, {depth} deep,", f"at {levels} from the member's axis"


def _members(delivery: Delivery, tables: Tables, stationery: Stationery) -> Book:
    table, shapes = tables["members"], delivery.design.kit.members.shapes
    rows = schedule_rows(table)
    drawn = [MemberDrawing(row, shape, section_outline(shape.section)) for row, shape in zip(rows, shapes, strict=True)]
    pages = [member_sheet(stationery, table, member, k, len(rows)) for k, member in enumerate(drawn, start=1)]
    return Book("members", "Members", tuple(pages))


def _panels(delivery: Delivery, tables: Tables, stationery: Stationery) -> Book:
    table, outlines = tables["panels"], delivery.design.kit.panels.outlines
    rows, notes = schedule_rows(table), panel_notes(delivery.design.project.panels)
    drawn = [PanelDrawing(row, outline, notes) for row, outline in zip(rows, outlines, strict=True)]
    pages = [panel_sheet(stationery, table, panel, k, len(rows)) for k, panel in enumerate(drawn, start=1)]
    return Book("panels", "Panels", tuple(pages))


def panel_notes(panels: PanelSettings) -> tuple[str, ...]:
    """Say what panels are made of and which side is drawn."""
    side = "Either side may lie outside" if panels.flippable else "Outside: the side that is seen here"
    return f"{drawable(panels.makeup)}, {length_text(panels.thickness)} thick", side


def _arrangement(delivery: Delivery, tables: Tables, stationery: Stationery) -> Book:
    kit, rows = delivery.design.kit, schedule_rows(tables["node_instances"])
    marks = {
        where: parts.marks[k]
        for parts in (kit.members, kit.panels)
        for k, where in zip(parts.classes.of.tolist(), parts.locations, strict=True)
    }
    return Book("general-arrangement", "General arrangement", arrangement_pages(stationery, kit, rows, marks))


_BOOKS: tuple[Callable[[Delivery, Tables, Stationery], Book], ...] = (_nodes, _members, _panels, _arrangement)
