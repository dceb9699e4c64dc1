"""Writing a delivery: every file of the folder, from finished values (deliverables, Folder)."""

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.cutting import Cutting
from isomould.design import Design, kit_settings
from isomould.documents.cut_sheets import part_drawing, sheet_drawing
from isomould.documents.drawing import Layer
from isomould.documents.overview import build_checks, kit_facts, layout_facts
from isomould.documents.schedules import part_tables
from isomould.documents.setting_out import setting_out_drawing
from isomould.documents.stock_tables import bar_table, sheet_table
from isomould.documents.strips import strip_drawing, strip_table
from isomould.documents.table import Table
from isomould.documents.totals import make_summary
from isomould.form.mesh import Family
from isomould.measure.offsets import DoubleLayer
from isomould.nesting.files import layout_to_json
from isomould.nesting.layout import Placement, Sheet
from isomould.parts.marks import locations
from isomould.parts.members import MemberParts
from isomould.parts.nodes import NodeParts
from isomould.parts.panels import PanelParts
from isomould.parts.plates import extrude
from isomould.parts.poses import member_poses, node_poses, panel_poses
from isomould.parts.solid import Solid
from isomould.parts.strips import Strip, unroll_strips
from isomould.record import describe_design
from isomould.workers import Spread
from isomould.writers.csv import write_csv
from isomould.writers.disk import write_bytes
from isomould.writers.dxf import write_dxf
from isomould.writers.model import Instance, write_glb, write_npz, write_obj
from isomould.writers.solids import write_3mf, write_stl
from isomould.writers.xlsx import write_workbook


@dataclass(frozen=True, eq=False)
class Delivery:
    """Everything that is written: the design, its solids, its layouts."""

    design: Design
    solids: tuple[Solid, ...]
    cutting: Cutting

    @cached_property
    def strips(self) -> tuple[Strip, ...]:
        """The strips that the project asks for, unrolled."""
        mesh, asked = self.design.kit.mesh, self.design.project.deliver.strips
        return tuple(strip for along in asked for strip in unroll_strips(mesh, along))


def make_tables(delivery: Delivery) -> tuple[Table, ...]:
    """Give the tables of the schedules, in the order of the workbook; summary and checks apart."""
    design, cutting = delivery.design, delivery.cutting
    settings = kit_settings(design.project)
    tables = part_tables(design.kit, settings, delivery.solids, cutting.placed, cutting.positions)
    sheets = sheet_table(cutting.sheets, cutting.stock)
    bars = (bar_table(cutting.bars, cutting.stock),) if cutting.bars else ()
    strips = (strip_table(delivery.strips),) if delivery.strips else ()
    return (*tables, sheets, *bars, *strips)


def write_delivery(folder: Path, delivery: Delivery, tables: tuple[Table, ...], spread: Spread) -> None:
    """Write all files but certificate and manifest into an empty folder."""
    _write_model(folder / "model", delivery)
    _write_drawings(folder, delivery, spread)
    _write_nodes(folder / "nodes", delivery)
    _write_tables(folder, delivery, tables)
    drawing = setting_out_drawing(delivery.design.kit, delivery.design.project.members.section.depth)
    for strip in delivery.strips:
        layers = delivery.design.project.deliver.layers
        write_dxf(folder / "strips" / f"{strip.name}.dxf", strip_drawing(strip), layers)
    write_dxf(folder / "setting-out.dxf", drawing, delivery.design.project.deliver.layers)


def _write_model(folder: Path, delivery: Delivery) -> None:
    kit, record = delivery.design.kit, describe_design(delivery.design, delivery.cutting.stock)
    write_npz(folder / "geometry.npz", _geometry(delivery))
    write_bytes(folder / "design.json", (json.dumps(record, indent=1, allow_nan=False) + "\n").encode())
    groups = [f"{mark}_{where}" for mark, where in zip(_marks(kit.panels), kit.panels.locations, strict=True)]
    write_obj(folder / "mesh.obj", kit.mesh.nodes, kit.mesh.faces, kit.mesh.face_offsets, groups)
    write_glb(folder / "model.glb", _shapes(delivery), _instances(delivery))
    if delivery.design.layers is not None:
        _write_layers(folder / "double-layer.obj", delivery.design.layers)


def _write_layers(path: Path, layers: DoubleLayer) -> None:
    """Write both layers, the first one's nodes first, and the members that connect them."""
    first, second = layers.first, layers.second
    count = len(first.nodes)
    nodes = np.concatenate([first.nodes, second.nodes])
    faces = np.concatenate([first.faces, second.faces + count])
    offsets = np.concatenate([first.face_offsets, second.face_offsets[1:] + len(first.faces)])
    groups = [f"{layer}_{where}" for layer in ("L1", "L2") for where in locations("P", first.face_ij)]
    ends = np.arange(count)[:, None] + np.array([0, count])
    lines = {f"L12_{where}": pair for where, pair in zip(locations("N", first.node_ij), ends, strict=True)}
    write_obj(path, nodes, faces, offsets, groups, lines)


def _marks(parts: NodeParts | MemberParts | PanelParts) -> list[str]:
    return [parts.marks[k] for k in parts.classes.of]


def _geometry(delivery: Delivery) -> dict[str, np.ndarray]:
    kit = delivery.design.kit
    mesh = kit.mesh
    arrays: dict[str, np.ndarray] = {
        "nodes": mesh.nodes,
        "node_axes": mesh.axes,
        "node_ij": mesh.node_ij.astype(np.int32),
        "edges": mesh.edges.astype(np.int32),
        "edge_family": np.array([family.word for family in Family])[mesh.family],
        "faces": mesh.faces.astype(np.int32),
        "face_offsets": mesh.face_offsets,
        "face_ij": mesh.face_ij.astype(np.int32),
    }
    for name, parts in (("node", kit.nodes), ("edge", kit.members), ("face", kit.panels)):
        arrays |= {f"{name}_mark": np.array(_marks(parts)), f"{name}_location": np.array(parts.locations)}
    return arrays


def _shapes(delivery: Delivery) -> dict[str, tuple[Floats, Ints]]:
    """One solid per mark, in the frame of its class."""
    kit, project = delivery.design.kit, delivery.design.project
    half = project.members.section.thickness / 2
    shapes = {mark: (s.vertices, s.triangles) for mark, s in zip(kit.nodes.marks, delivery.solids, strict=True)}
    shapes |= {
        mark: extrude(shape.outline, -half, half)
        for mark, shape in zip(kit.members.marks, kit.members.shapes, strict=True)
    }
    thickness = project.panels.thickness
    levels = {False: (0.0, thickness), True: (-thickness, 0.0)}[project.panels.flippable]
    return shapes | {
        mark: extrude(outline, *levels) for mark, outline in zip(kit.panels.marks, kit.panels.outlines, strict=True)
    }


def _instances(delivery: Delivery) -> list[Instance]:
    kit = delivery.design.kit
    posed = (
        (kit.nodes, node_poses(kit.mesh, kit.nodes)),
        (kit.members, member_poses(kit.mesh, kit.members)),
        (kit.panels, panel_poses(kit.mesh, kit.panels)),
    )
    return [
        Instance(mark, where, pose)
        for parts, poses in posed
        for mark, where, pose in zip(_marks(parts), parts.locations, poses, strict=True)
    ]


@dataclass(frozen=True, eq=False)
class _PartFile:
    """A part file that is to be written."""

    path: Path
    outline: Floats
    layers: dict[Layer, str]


@dataclass(frozen=True, eq=False)
class _SheetFile:
    """A cut sheet that is to be written."""

    path: Path
    sheet: Sheet
    placements: tuple[Placement, ...]
    layers: dict[Layer, str]


def _write_drawings(folder: Path, delivery: Delivery, spread: Spread) -> None:
    """Write the part files of panels and members and the cut sheets: many files, side by side."""
    kit, layers = delivery.design.kit, delivery.design.project.deliver.layers
    outlines = {
        f"panels/{mark}.dxf": outline for mark, outline in zip(kit.panels.marks, kit.panels.outlines, strict=True)
    }
    outlines |= {
        f"members/{m}.dxf": shape.outline for m, shape in zip(kit.members.marks, kit.members.shapes, strict=True)
    }
    spread(_write_part, [_PartFile(folder / name, outline, layers) for name, outline in outlines.items()])
    layout = delivery.cutting.sheets
    on: dict[str, list[Placement]] = {sheet.id: [] for sheet in layout.sheets}
    for placement in layout.placements:
        on[placement.sheet].append(placement)
    files = [_SheetFile(folder / "sheets" / f"{s.id}.dxf", s, tuple(on[s.id]), layers) for s in layout.sheets]
    spread(_write_sheet, files)
    write_bytes(folder / "sheets" / "nesting.json", layout_to_json(layout).encode())


def _write_part(file: _PartFile) -> None:
    write_dxf(file.path, part_drawing(file.path.stem, file.outline), file.layers)


def _write_sheet(file: _SheetFile) -> None:
    placed = [(str(p.id), str(p.location), p.points) for p in file.placements]
    write_dxf(file.path, sheet_drawing(file.sheet.width, file.sheet.height, placed), file.layers)


def _write_nodes(folder: Path, delivery: Delivery) -> None:
    marks = delivery.design.kit.nodes.marks
    for mark, solid in zip(marks, delivery.solids, strict=True):
        write_3mf(folder / f"{mark}.3mf", solid.vertices, solid.triangles, mark)
        write_stl(folder / f"{mark}.stl", solid.vertices, solid.triangles)
    records = {mark: _solid_record(solid) for mark, solid in zip(marks, delivery.solids, strict=True)}
    write_bytes(folder / "solids.json", (json.dumps(records, indent=1, allow_nan=False) + "\n").encode())


def _solid_record(solid: Solid) -> dict[str, float | int | str]:
    """What the maker measured, for the certificate (V20–V22)."""
    return {
        "status": solid.status,
        "genus": solid.genus,
        "components": solid.components,
        "volume_mm3": solid.volume,
        "analytic_volume_mm3": solid.analytic_volume,
        "inclusion_exclusion": solid.inclusion_exclusion,
        "commutativity": solid.commutativity,
    }


def _write_tables(folder: Path, delivery: Delivery, tables: tuple[Table, ...]) -> None:
    design, cutting = delivery.design, delivery.cutting
    for table in tables:
        write_csv(folder / "tables" / f"{table.name}.csv", table)
    if cutting.bars:
        write_csv(folder / "bars" / "bars.csv", next(table for table in tables if table.name == "bars"))
    facts = (*kit_facts(design.kit), *layout_facts(cutting.sheets, cutting.bars))
    summary = make_summary(facts, tables)
    checks = build_checks(design.kit, delivery.solids, cutting.sheets)
    write_workbook(folder / "schedules.xlsx", (summary, *tables, checks), design.project.project, design.notes)
