"""The schedules as tables: one row per class, one row per instance (deliverables, Folder).

Values come from the parts as they are cut: lengths, areas and masses from rounded outlines and from solids.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from isomould.arrays import Floats, Ints
from isomould.documents.adjacency import Neighbours, find_neighbours
from isomould.documents.numbers import format_number
from isomould.documents.table import Table, make_table
from isomould.form.mesh import Family, NodeKind
from isomould.parts.kit import Kit, KitSettings
from isomould.parts.members import TURNED
from isomould.parts.outline import area, sides
from isomould.parts.settings import MemberSettings, PanelSettings

Columns = Mapping[str, Sequence[object]]

_KG_PER_MM3 = 1e-9
"""Times density in kg/m³."""


class Bulky(Protocol):
    """What schedules need to know of a node's solid."""

    @property
    def volume(self) -> float:
        """Volume in mm³."""
        ...

    @property
    def surface(self) -> float:
        """Area of the surface in mm²."""
        ...


@dataclass(frozen=True)
class Bulk:
    """Volume (mm³) and surface (mm²) of a node that was not made as a checked solid."""

    volume: float
    surface: float


@dataclass(frozen=True)
class Placed:
    """Where a piece was nested: sheet, position of the part's origin (mm), rotation, turned over or not."""

    sheet: str
    x: float
    y: float
    rotation_deg: int
    turned_over: bool


@dataclass(frozen=True)
class OnBar:
    """Where a member was nested: bar, distance of its left end from that of the bar (mm), how it is turned."""

    bar: str
    position: float
    turned: str


def part_tables(
    kit: Kit,
    settings: KitSettings,
    solids: Sequence[Bulky],
    placed: dict[str, Placed],
    bars: dict[str, OnBar],
    *,
    drawn: bool = False,
) -> tuple[Table, ...]:
    """Give the tables of nodes, members and panels, classes and instances.

    Parameters
    ----------
    kit, settings, solids
        The parts, what was asked of them, and a solid per node class.
    placed
        Sheet and place of every panel location.
    bars
        Bar and place of every member location; empty without bars in stock.
    drawn
        Whether there are shop drawings to name.
    """
    around = find_neighbours(kit.mesh, kit.nodes.arm_rows, kit.arms, kit.panels.edges)
    nodes, members, panels = class_tables(kit, settings, solids, drawn=drawn)
    return (
        nodes,
        make_table("node_instances", _node_instances(kit, around)),
        members,
        make_table("member_instances", _member_instances(kit, around, bars)),
        panels,
        make_table("panel_instances", _panel_instances(kit, placed)),
    )


def class_tables(
    kit: Kit, settings: KitSettings, solids: Sequence[Bulky], *, drawn: bool = False
) -> tuple[Table, Table, Table]:
    """Give the tables of the classes of nodes, members and panels."""
    return (
        make_table("nodes", _nodes(kit, settings, solids, drawn=drawn)),
        make_table("members", _members(kit, settings, drawn=drawn)),
        make_table("panels", _panels(kit, settings.panels, drawn=drawn)),
    )


def _nodes(kit: Kit, settings: KitSettings, solids: Sequence[Bulky], *, drawn: bool) -> Columns:
    nodes, joints, asked = kit.nodes, kit.joints, settings.nodes
    count = len(nodes.marks)
    volume = np.array([solid.volume for solid in solids])
    steel = volume + [base.volume if base else 0.0 for base in kit.bases]
    diameter, height = (np.array(values) for values in zip(*((j.diameter, j.height) for j in joints), strict=True))
    bar = asked.diameter_step * np.ceil(np.round((diameter + asked.bar_allowance) / asked.diameter_step, 9))
    blank = np.round(height + asked.facing_allowance, 6)
    deviation = _worst(nodes.deviation, nodes.classes.of, count)
    turned = np.array([joint.turned_volume(solid.volume) for joint, solid in zip(joints, solids, strict=True)])
    return {
        "mark": list(nodes.marks),
        "quantity": nodes.classes.quantity.tolist(),
        "kind": [NodeKind(kind).word for kind in nodes.kind],
        "valence": [len(arms.azimuth) for arms in nodes.arms],
        "handed": list(nodes.handed),
        **_arm_columns(kit, settings.members),
        "drum_diameter_mm": diameter.tolist(),
        "drum_height_mm": height.tolist(),
        "mass_kg": (steel * asked.density * _KG_PER_MM3).tolist(),
        "volume_cm3": (volume / 1e3).tolist(),
        "coated_area_m2": [solid.surface / 1e6 for solid in solids],
        "bar_diameter_mm": bar.tolist(),
        "blank_length_mm": blank.tolist(),
        "bar_mass_kg": (np.pi / 4 * bar**2 * blank * asked.density * _KG_PER_MM3).tolist(),
        "removed_volume_cm3": ((np.pi / 4 * bar**2 * blank - turned) / 1e3).tolist(),
        **{name: [getattr(joint.counts, name) for joint in joints] for name in _COUNTED},
        **_base_columns(kit, asked.density),
        "weld_length_mm": [joint.weld_length for joint in joints],
        "max_deviation_mm": (deviation * diameter / 2).tolist(),
        "max_deviation_deg": np.degrees(deviation).tolist(),
        "solid_file": [f"nodes/{mark}.3mf" for mark in nodes.marks],
        "drawing_file": _node_files(kit, drawn=drawn),
    }


_COUNTED = ("slots", "facets", "fins", "holes", "threads")
"""What is counted of a node."""


def _base_columns(kit: Kit, density: float) -> Columns:
    """What the supports stand on; blank for all other nodes."""
    sizes = [np.ptp(base.plate, axis=0).tolist() if base else (None, None) for base in kit.bases]
    return {
        "base_length_mm": [length for length, _ in sizes],
        "base_width_mm": [width for _, width in sizes],
        "base_level_mm": [base and base.level for base in kit.bases],
        "base_holes": [base and len(base.holes) for base in kit.bases],
        "base_mass_kg": [base and base.volume * density * _KG_PER_MM3 for base in kit.bases],
    }


def sheet_of(book: str, number: int) -> str:
    """Name the sheet of a class, counted from 0, in the book of its kind.

    >>> sheet_of("nodes", 2)
    'drawings/nodes.pdf#page=3'
    """
    return f"drawings/{book}.pdf#page={number + 1}"


def _node_files(kit: Kit, *, drawn: bool) -> list[str]:
    """Base plates have a part file and NC1, other nodes a plan for a machine where one describes them."""
    rows = zip(kit.nodes.marks, kit.joints, kit.bases, strict=True)
    endings = [("dxf", "nc1") if base else ("dxf",) if joint.planned else () for _, joint, base in rows]
    return _files("nodes", kit.nodes.marks, endings, drawn=drawn)


def _files(kind: str, marks: Sequence[str], endings: Sequence[Sequence[str]], *, drawn: bool) -> list[str]:
    """Name the files of every class: its machine files by their endings, and its sheet where there are drawings."""
    sheets = [[sheet_of(kind, k)] if drawn else [] for k in range(len(marks))]
    made = [[f"{kind}/{mark}.{ending}" for ending in each] for mark, each in zip(marks, endings, strict=True)]
    return [";".join(files + sheet) for files, sheet in zip(made, sheets, strict=True)]


def _arm_columns(kit: Kit, members: MemberSettings) -> Columns:
    columns: dict[str, list[object]] = {}
    for k in range(max(len(arms.azimuth) for arms in kit.nodes.arms)):
        there = [arms if k < len(arms.azimuth) else None for arms in kit.nodes.arms]
        columns[f"azimuth_{k + 1}_deg"] = [arms and float(np.degrees(arms.azimuth[k])) for arms in there]
        columns[f"elevation_{k + 1}_deg"] = [arms and float(np.degrees(arms.elevation[k])) for arms in there]
        columns[f"family_{k + 1}"] = [arms and Family(arms.family[k]).word for arms in there]
        columns[f"section_{k + 1}"] = [arms and members.of(arms.family[k]).name for arms in there]
    return columns


def _worst(values: Floats, of: Ints, count: int) -> Floats:
    """Largest value (k,) of the instances of every class."""
    worst = np.zeros(count)
    np.maximum.at(worst, of, values)
    return worst


def _node_instances(kit: Kit, around: Neighbours) -> Columns:
    mesh, nodes = kit.mesh, kit.nodes
    members, panels = np.array(kit.members.locations), np.array(kit.panels.locations)
    return {
        "location": list(nodes.locations),
        "mark": _marks(nodes.marks, nodes.classes.of),
        "i": mesh.node_ij[:, 0].tolist(),
        "j": mesh.node_ij[:, 1].tolist(),
        **_vector("{}_mm", mesh.nodes),
        **_vector("axis_{}", mesh.axes),
        **_vector("ref_{}", nodes.reference),
        "mismatch_mm": kit.mismatch.tolist(),
        "torsion_deg": np.degrees(kit.torsion).tolist(),
        "members": _lists(members, around.node_edges),
        "panels": _lists(panels, around.node_faces, kept=around.node_edges >= 0),
        "deviation_mm": (nodes.deviation * kit.joints[0].radius).tolist(),
        "deviation_deg": np.degrees(nodes.deviation).tolist(),
    }


def _vector(name: str, values: Floats) -> Columns:
    return {name.format(axis): values[:, k].tolist() for k, axis in enumerate("xyz")}


def _marks(marks: tuple[str, ...], of: Ints) -> list[object]:
    return [marks[k] for k in of]


def _lists(names: np.ndarray, rows: Ints, kept: np.ndarray | None = None) -> list[object]:
    """Names joined by ";" per row (n, v) of numbers; −1 stands for nothing, and keeps its place where asked to."""
    kept = rows >= 0 if kept is None else kept
    words = np.where(rows >= 0, names[rows], "").tolist()
    return [
        ";".join(w for w, keep in zip(row, keeps, strict=True) if keep)
        for row, keeps in zip(words, kept.tolist(), strict=True)
    ]


def _members(kit: Kit, settings: KitSettings, *, drawn: bool) -> Columns:
    members, asked = kit.members, settings.members
    shapes = members.shapes
    return {
        "mark": list(members.marks),
        "quantity": members.classes.quantity.tolist(),
        "family": [Family(family).word for family in members.family],
        "section": [shape.section.name for shape in shapes],
        "grade": [asked.grade] * len(shapes),
        "system_length_mm": [shape.system_length for shape in shapes],
        "top_length_mm": [shape.top_length for shape in shapes],
        "bottom_length_mm": [shape.bottom_length for shape in shapes],
        "cut_length_mm": [shape.cut_length for shape in shapes],
        "end_angle_start_deg": [float(np.degrees(shape.end_angle[0])) for shape in shapes],
        "end_angle_end_deg": [float(np.degrees(shape.end_angle[1])) for shape in shapes],
        "set_back_start_mm": [shape.set_back[0] for shape in shapes],
        "set_back_end_mm": [shape.set_back[1] for shape in shapes],
        "mass_kg": [shape.volume * asked.density * _KG_PER_MM3 for shape in shapes],
        "coated_area_m2": [shape.paint_area / 1e6 for shape in shapes],
        "holes": [len(shape.holes) for shape in shapes],
        "files": _files("members", members.marks, [("dxf", "nc1")] * len(shapes), drawn=drawn),
    }


def _member_instances(kit: Kit, around: Neighbours, bars: dict[str, OnBar]) -> Columns:
    mesh, members = kit.mesh, kit.members
    nodes, panels = np.array(kit.nodes.locations), np.array(kit.panels.locations)
    left, right = (np.where(side >= 0, panels[side], "").tolist() for side in around.edge_faces.T)
    places = [bars.get(where) for where in members.locations]
    return {
        "location": list(members.locations),
        "mark": _marks(members.marks, members.classes.of),
        "turned": [TURNED[variant] for variant in members.classes.variant],
        "node_start": nodes[mesh.edges[:, 0]].tolist(),
        "node_end": nodes[mesh.edges[:, 1]].tolist(),
        "panel_left": left,
        "panel_right": right,
        "bar": [place.bar if place else "" for place in places],
        "position_mm": [place.position if place else None for place in places],
        "bar_turned": [place.turned if place else "" for place in places],
        "deviation_mm": members.deviation.tolist(),
    }


def _panels(kit: Kit, settings: PanelSettings, *, drawn: bool) -> Columns:
    panels = kit.panels
    first = panels.classes.representative
    whole = ((kit.mesh.face_piece == 0) & (kit.mesh.sizes == 4))[first].tolist()
    size = np.array([np.ptp(outline, axis=0) for outline in panels.outlines])
    areas = np.array([area(outline) for outline in panels.outlines]) / 1e6
    measures = [_measures(blank) if plain else {} for plain, blank in zip(whole, panels.blanks, strict=True)]
    sound = [plain and len(o) == len(b) for plain, o, b in zip(whole, panels.outlines, panels.blanks, strict=True)]
    return {
        "mark": list(panels.marks),
        "quantity": panels.classes.quantity.tolist(),
        **{name: [row.get(name) for row in measures] for name in _MEASURES},
        "outline": ["" if plain else _points(o) for plain, o in zip(sound, panels.outlines, strict=True)],
        "area_m2": areas.tolist(),
        "charged_area_m2": charged_areas(size, settings).tolist(),
        "box_width_mm": size[:, 0].tolist(),
        "box_height_mm": size[:, 1].tolist(),
        "mass_kg": (areas * settings.thickness / 1e3 * settings.density).tolist(),
        "handed": list(panels.handed),
        "files": _files("panels", panels.marks, [("dxf",)] * len(panels.marks), drawn=drawn),
    }


_MEASURES = (
    *(f"side_{letter}_mm" for letter in "abcd"),
    *("diagonal_1_mm", "diagonal_2_mm", "height_mm"),
    *(f"angle_{number}_deg" for number in range(1, 5)),
)
"""What is scheduled of whole quadrilaterals; trimmed panels and lids have their outline instead."""


def _measures(outline: Floats) -> dict[str, float]:
    """Give the measures of a quadrilateral by their columns."""
    diagonals = np.linalg.norm(outline[[2, 3]] - outline[[0, 1]], axis=1)
    values = [*sides(outline), *diagonals, outline[2, 1], *np.degrees(_angles(outline))]
    return {name: float(value) for name, value in zip(_MEASURES, values, strict=True)}


def _points(outline: Floats) -> str:
    return ";".join(f"{format_number(x, 3)},{format_number(y, 3)}" for x, y in outline)


def _packer(thickness: float) -> str:
    return "" if np.isnan(thickness) else format_number(thickness, 3)


def _angles(outline: Floats) -> Floats:
    """Inner angles (n,) rad of an outline, at its vertices in order."""
    ahead, behind = np.roll(outline, -1, axis=0) - outline, np.roll(outline, 1, axis=0) - outline
    cross = ahead[:, 0] * behind[:, 1] - ahead[:, 1] * behind[:, 0]
    return np.arctan2(cross, (ahead * behind).sum(axis=1))


def charged_areas(size: Floats, settings: PanelSettings) -> Floats:
    """Charged area (k,) m²: each side of the box rounded up to `glass_round`, at least `glass_min_area`."""
    step = settings.glass_round
    boxes = step * np.ceil(np.round(size / step, 9))
    return np.maximum(boxes.prod(axis=1) / 1e6, settings.glass_min_area)


def _panel_instances(kit: Kit, placed: dict[str, Placed]) -> Columns:
    mesh, panels = kit.mesh, kit.panels
    nodes, members = np.array(kit.nodes.locations), np.array(kit.members.locations)
    places = [placed.get(where) for where in panels.locations]
    corners = mesh.table(mesh.faces)
    return {
        "location": list(panels.locations),
        "mark": _marks(panels.marks, panels.classes.of),
        "i": mesh.face_ij[:, 0].tolist(),
        "j": mesh.face_ij[:, 1].tolist(),
        "first_corner": (panels.first_corner + 1).tolist(),
        "nodes": _lists(nodes, corners),
        "members": _lists(members, mesh.table(panels.edges), kept=corners >= 0),
        "packers_mm": [";".join(map(_packer, row)) for row in np.split(panels.packers, mesh.face_offsets[1:-1])],
        "slope_deg": np.degrees(panels.slope).tolist(),
        "flatness_mm": panels.flatness.tolist(),
        "sheet": [place.sheet if place else "" for place in places],
        "x_mm": [place.x if place else None for place in places],
        "y_mm": [place.y if place else None for place in places],
        "rotation_deg": [float(place.rotation_deg) if place else None for place in places],
        "turned_over": [bool(place and place.turned_over) for place in places],
        "deviation_mm": panels.deviation.tolist(),
    }
