"""V36, V40, V41, V43, V44, V50 on small tables, drawings, workbooks and folders."""

import hashlib
import json

import ezdxf
import numpy as np
import openpyxl
import pytest
from openpyxl.worksheet.table import Table as ExcelTable
from verify_museum import changed, holding, ring, spoilt, status, table, vault, with_raw

from isomould.verify.checks import classes, drawings, manifest, totals, workbook
from isomould.verify.delivery import Delivery
from isomould.verify.formula import evaluate
from isomould.verify.read.dxf import Drawing, Outline, read_dxf, with_layers
from isomould.verify.read.mesh import edge_vectors
from isomould.verify.read.workbook import Cell, NamedTable, Workbook, read_workbook
from isomould.verify.rules import Unreadable

OUTLINE = np.array([[0, 0], [1000, 0], [900, 500], [200, 500.0]])


def outline(points, layer="CUT", closed=True):
    points = np.array(points, dtype=float)
    return Outline(layer, points, np.zeros(len(points)), closed)


def part(*outlines, units=4, findings=()):
    return Drawing("P01", units, findings, outlines or (outline(OUTLINE),), ())


# ---------------------------------------------------------------- V40


GOOD_HOLE = outline([[300, 100], [300, 200], [400, 200]], "CUT_INNER")
DRAWINGS = {
    "good": (part(), True),
    "hole": (part(outline(OUTLINE), GOOD_HOLE), True),
    "metres": (part(units=6), False),
    "audit": (part(findings=("x",)), False),
    "clockwise": (part(outline(OUTLINE[::-1])), False),
    "hole counter-clockwise": (part(outline(OUTLINE), outline(GOOD_HOLE.points[::-1], "CUT_INNER")), False),
    "open": (part(outline(OUTLINE, closed=False)), False),
    "layer": (part(outline(OUTLINE, "0")), False),
    "nan": (part(outline(OUTLINE + np.nan)), False),
    "zero length": (part(outline(np.repeat(OUTLINE, 2, axis=0))), False),
    "twice": (part(outline(OUTLINE), outline(np.roll(OUTLINE, 1, axis=0))), False),
    "flat": (part(outline([[0, 0], [1, 0], [2, 0]])), False),
}


@pytest.mark.parametrize("name", DRAWINGS)
def test_drawings_for_machines(name):
    drawing, good = DRAWINGS[name]
    assert (not drawings.drawing_faults(drawing)) == good


def panel_delivery(drawing=None, **columns):
    sides = np.linalg.norm(np.roll(OUTLINE, -1, axis=0) - OUTLINE, axis=1).round(3)
    rows = {f"side_{letter}_mm": [side] for letter, side in zip("abcd", sides, strict=True)}
    rows |= {"diagonal_1_mm": [np.hypot(900, 500).round(3)], "diagonal_2_mm": [np.hypot(800, 500).round(3)]}
    rows |= {
        "mark": ["P01"],
        "area_m2": [0.425],
        "box_width_mm": [1000],
        "box_height_mm": [500],
        "outline": [""],
    }
    plate = np.array([[20, 50], [10, 20], [10, -20], [20, -50], [980, -50], [970, 50.0]])
    members = table("members", mark=["M01"], cut_length_mm=[970], top_length_mm=[950], bottom_length_mm=[960])
    return holding(
        folder=vault().folder,
        design=vault().design,
        panels={"P01": drawing or part()},
        sheets={},
        members={"M01": part(outline(plate))},
        tables={"panels": table("panels", **{**rows, **columns}), "members": members},
    )


@pytest.mark.parametrize("rule", ["V40", "V40b", "V40c", "V40d"])
def test_good_part_files_pass(rule):
    check = status(drawings.RULES, rule, panel_delivery())
    assert check.status == "pass", check


@pytest.mark.parametrize(
    ("rule", "change"),
    [
        ("V40", {"mark": ["P02"]}),
        ("V40b", {"area_m2": [0.425001]}),
        ("V40c", {"side_a_mm": [1000.001]}),
        ("V40c", {"side_b_mm": [538.516], "side_d_mm": [509.902]}),
        ("V40c", {"diagonal_1_mm": [943.398]}),
        ("V40b", {"drawing": part(outline(OUTLINE * 1.0001))}),
        ("V40c", {"drawing": part(outline(changed(OUTLINE, 1, 0.01)))}),
    ],
    ids=map(str, range(7)),
)
def test_part_files_that_differ_from_the_schedule(rule, change):
    assert status(drawings.RULES, rule, panel_delivery(**change)).status == "fail"


def test_long_and_short_length_swapped():
    delivery = panel_delivery()
    delivery.tables["members"] = table(
        "members", mark=["M01"], cut_length_mm=[970], top_length_mm=[960], bottom_length_mm=[950]
    )
    assert status(drawings.RULES, "V40d", delivery).status == "fail"


def test_trimmed_panels_are_compared_point_by_point():
    written = ";".join(f"{x:g},{y:g}" for x, y in OUTLINE)
    blank = {f"side_{letter}_mm": [""] for letter in "abcd"}
    for text, expected in ((written, "pass"), (written.replace("900", "901"), "fail")):
        delivery = panel_delivery(outline=[text], **blank)
        assert status(drawings.RULES, "V40e", delivery).status == expected
        assert status(drawings.RULES, "V40c", delivery).status == "pass"


# ---------------------------------------------------------------- V36, V43


def documented(delivery, **columns):
    """Tables of a mesh with one class per node, member and panel."""
    mesh = delivery.mesh
    names = {
        part: [f"{part[0].upper()}{k}" for k in range(n)]
        for part, n in (("node", len(mesh.nodes)), ("member", len(mesh.edges)), ("panel", len(mesh.face_ij)))
    }
    mesh_marks = {
        "node_mark": np.array(names["node"]),
        "edge_mark": np.array(names["member"]),
        "face_mark": np.array(names["panel"]),
    }
    delivery = spoilt(delivery, "mesh", **mesh_marks)
    mesh = delivery.mesh
    first = [int(np.flatnonzero((mesh.edges == k).any(axis=1))[0]) for k in range(len(mesh.nodes))]
    ray = np.array([mesh.nodes[mesh.edges[e].sum() - k] - mesh.nodes[k] for k, e in enumerate(first)])
    ray -= (ray * mesh.node_axes).sum(axis=1)[:, None] * mesh.node_axes
    ray /= np.linalg.norm(ray, axis=1)[:, None]
    found = {
        name: []
        for name in (
            "valence",
            *(
                f"{x}_{k}{u}"
                for k in range(1, 5)
                for x, u in (("azimuth", "_deg"), ("elevation", "_deg"), ("family", ""))
            ),
        )
    }
    for k in range(len(mesh.nodes)):
        arms = []
        for e in np.flatnonzero((mesh.edges == k).any(axis=1)):
            v = mesh.nodes[mesh.edges[e].sum() - k] - mesh.nodes[k]
            x, y, z = v @ ray[k], v @ np.cross(mesh.node_axes[k], ray[k]), v @ mesh.node_axes[k]
            arms.append((round(np.degrees(np.arctan2(y, x)), 6) % 360, np.degrees(np.arctan2(z, np.hypot(x, y))), e))
        arms.sort()
        found["valence"].append(len(arms))
        for n in range(4):
            azimuth, elevation, e = arms[n] if n < len(arms) else ("", "", None)
            found[f"azimuth_{n + 1}_deg"].append(azimuth if e is None else round(azimuth, 4))
            found[f"elevation_{n + 1}_deg"].append(elevation if e is None else round(elevation, 4))
            found[f"family_{n + 1}"].append("" if e is None else mesh.edge_family[e])
    elevations = np.degrees(classes.arms_of(mesh, ray).elevation.reshape(2, -1)).round(4)
    tables = {
        "nodes": {
            "mark": names["node"],
            "quantity": [1] * len(mesh.nodes),
            "kind": ["interior"] * len(mesh.nodes),
            **found,
        },
        "node_instances": {
            "location": mesh.node_location,
            "mark": names["node"],
            "i": mesh.node_ij[:, 0],
            "j": mesh.node_ij[:, 1],
            **{f"{c}_mm": [f"{x:.3f}" for x in mesh.nodes[:, n]] for n, c in enumerate("xyz")},
            **{f"axis_{c}": [f"{x:.9f}" for x in mesh.node_axes[:, n]] for n, c in enumerate("xyz")},
            **{f"ref_{c}": [f"{x:.9f}" for x in ray[:, n]] for n, c in enumerate("xyz")},
        },
        "members": {
            "mark": names["member"],
            "quantity": [1] * len(mesh.edges),
            "end_angle_start_deg": -elevations[0],
            "end_angle_end_deg": -elevations[1],
            "system_length_mm": np.linalg.norm(edge_vectors(mesh), axis=1).round(3),
        },
        "member_instances": {
            "location": mesh.edge_location,
            "mark": names["member"],
            "turned": ["none"] * len(mesh.edges),
            "node_start": mesh.node_location[mesh.edges[:, 0]],
            "node_end": mesh.node_location[mesh.edges[:, 1]],
        },
        "panels": {"mark": names["panel"], "quantity": [1] * len(mesh.face_ij)},
        "panel_instances": {
            "location": mesh.face_location,
            "mark": names["panel"],
            "i": mesh.face_ij[:, 0],
            "j": mesh.face_ij[:, 1],
            "first_corner": [1] * len(mesh.face_ij),
            "nodes": [";".join(mesh.node_location[f]) for f in mesh.faces.reshape(-1, 4)],
        },
    }
    for path, change in columns.items():
        name, column = path.split("__")
        tables[name][column] = change(list(tables[name][column]))
    return holding(**{**vars(delivery), "tables": {name: table(name, **c) for name, c in tables.items()}})


IDENTITY = (*classes.RULES, *totals.RULES)


@pytest.mark.parametrize("name", ["vault", "ring"])
@pytest.mark.parametrize("rule", ["V36", "V36b", "V36c", "V36d", "V43", "V43b", "V43c", "V43d"])
def test_good_documents_pass(name, rule):
    check = status(IDENTITY, rule, documented({"vault": vault, "ring": ring}[name]()))
    assert check.status == "pass", check


def swap(a, b):
    def change(values):
        values[a], values[b] = values[b], values[a]
        return values

    return change


def put(k, value):
    return lambda values: [*values[:k], value, *values[k + 1 :]]


def negated(values):
    return ["" if value == "" else -float(value) for value in values]


FAULTS = [
    ("V36", "nodes__elevation_1_deg", negated),
    ("V36", "nodes__azimuth_2_deg", negated),
    ("V36", "nodes__family_2", put(40, "sill")),
    ("V36", "nodes__valence", put(40, 3)),
    ("V36b", "members__system_length_mm", swap(3, 150)),
    ("V36b", "members__system_length_mm", put(3, 1.0)),
    ("V36c", "members__end_angle_start_deg", negated),
    ("V36c", "member_instances__turned", put(30, "upside_down")),
    ("V43", "node_instances__mark", swap(1, 2)),
    ("V43", "panel_instances__mark", swap(1, 20)),
    ("V43", "members__quantity", put(2, 2)),
    ("V43", "panel_instances__location", put(2, "P-99-99")),
    ("V43b", "member_instances__node_end", swap(1, 2)),
    ("V43b", "panel_instances__nodes", swap(1, 2)),
    ("V43b", "node_instances__j", put(5, 0)),
    ("V43c", "node_instances__y_mm", swap(1, 2)),
    ("V43d", "node_instances__axis_z", swap(1, 60)),
]


@pytest.mark.parametrize(("rule", "column", "change"), FAULTS, ids=map(str, range(len(FAULTS))))
def test_wrong_documents_are_found(rule, column, change):
    assert status(IDENTITY, rule, documented(vault(), **{column: change})).status == "fail"


def test_panels_of_one_mark_must_cover_congruent_faces():
    delivery = documented(vault())
    marks = np.array(["P1"] * len(delivery.mesh.face_mark))
    assert status(IDENTITY, "V36d", spoilt(delivery, "mesh", face_mark=marks)).status == "fail"
    ring_ = documented(ring())
    of_rows = np.array([f"P{i}" for i in ring_.mesh.face_ij[:, 0]])
    loose = with_raw(spoilt(ring_, "mesh", face_mark=of_rows), tolerances={"length_mm": 3000.0})
    assert status(IDENTITY, "V36d", loose).status == "pass"


def member_table(**columns):
    depth, start, end = 200.0, np.radians(3.0), np.radians(-1.0)
    rows = {
        "mark": ["M01"],
        "end_angle_start_deg": [3.0],
        "end_angle_end_deg": [-1.0],
        "top_length_mm": [1000.0],
        "bottom_length_mm": [round(1000 - depth * (np.tan(start) + np.tan(end)), 3)],
    }
    return holding(design=vault().design, tables={"members": table("members", **{**rows, **columns})})


def test_end_cuts_explain_top_and_bottom():
    assert status(IDENTITY, "V43e", member_table()).status == "pass"
    swapped = {"top_length_mm": [993.01], "bottom_length_mm": [1000.0]}
    assert status(IDENTITY, "V43e", member_table(**swapped)).status == "fail"


# ---------------------------------------------------------------- V41, V44


PIECES = {"mark": ["M01", "M02"], "quantity": [3, 4], "mass_kg": [1.5, 2.25], "total_mass_kg": [4.5, 9]}


def book_delivery(**cells):
    """A workbook of a Members sheet with a total row, and a Summary with live sums; `cells` replaces some."""
    sheet = {(1, k): Cell(name) for k, name in enumerate(["Mark", "Quantity", "Mass (kg)", "Total mass (kg)"], 1)}
    for k, column in enumerate(PIECES.values(), 1):
        sheet |= {(row, k): Cell(value) for row, value in enumerate(column, 2)}
    each = "=tblMembers[[#This Row],[Quantity]]*tblMembers[[#This Row],[Mass (kg)]]"
    sheet |= {(2, 4): Cell(4.5, each), (3, 4): Cell(9, each)}
    sheet[4, 4] = Cell(13.5, "=SUBTOTAL(109,tblMembers[Total mass (kg)])")
    lines = {
        "Members: quantity": (7, "=SUM(tblMembers[Quantity])"),
        "Members: total mass": (13.5, "=SUM(tblMembers[Total mass (kg)])"),
    }
    summary = {(1, 1): Cell("Item"), (1, 2): Cell("Value")}
    for row, (label, (value, formula)) in enumerate(lines.items(), 2):
        summary |= {(row, 1): Cell(label), (row, 2): Cell(value, formula)}
    sheets = {"Members": sheet, "Summary": summary}
    for place, cell in cells.items():
        name, row, column = place.split("_")
        sheets[name][int(row), int(column)] = cell
    named = NamedTable("Members", ("Mark", "Quantity", "Mass (kg)", "Total mass (kg)"), 1, 2, 3)
    nothing = {"mark": [], "quantity": []}
    tables = {
        "members": table("members", **PIECES),
        "nodes": table("nodes", **nothing),
        "panels": table("panels", **nothing),
    }
    return holding(workbook=Workbook(sheets, {"tblMembers": named}, {}), tables={"members": tables["members"]})


@pytest.mark.parametrize("rule", ["V41", "V41b", "V41c"])
def test_a_good_workbook_passes(rule):
    check = status(workbook.RULES, rule, book_delivery())
    assert check.status == "pass", check


@pytest.mark.parametrize(
    ("rule", "cells"),
    [
        ("V41", {"Members_2_3": Cell(1.51)}),
        ("V41", {"Members_2_3": Cell("1.5")}),
        ("V41", {"Members_3_1": Cell("M01")}),
        ("V41", {"Members_2_2": Cell(True)}),
        ("V41", {"Members_2_2": Cell(3, "=1+2")}),
        ("V41", {"Members_9_9": Cell(1)}),
        ("V41", {"Members_3_2": Cell(None)}),
        ("V41b", {"Members_4_4": Cell(13.6, "=SUBTOTAL(109,tblMembers[Total mass (kg)])")}),
        ("V41b", {"Summary_3_2": Cell(0, "=SUM(tblMembers[Total mass (kg)])")}),
        ("V41b", {"Summary_3_2": Cell(0, "=HYPERLINK(1)")}),
        ("V41c", {"Members_2_1": Cell("M01", '="M01"')}),
    ],
    ids=map(str, range(11)),
)
def test_wrong_cells_are_found(rule, cells):
    assert status(workbook.RULES, rule, book_delivery(**cells)).status == "fail"


def test_totals_are_recomputed(monkeypatch):
    monkeypatch.setattr(totals, "PARTS", ("member",))
    for rule in ("V44", "V44b"):
        assert status(totals.RULES, rule, book_delivery()).status == "pass"
    assert status(totals.RULES, "V44b", book_delivery(Summary_3_2=Cell(13.4))).status == "fail"
    assert status(totals.RULES, "V44b", book_delivery(Summary_3_1=Cell("something"))).status == "fail"
    wrong = book_delivery()
    wrong.tables["members"] = table("members", **{**PIECES, "total_mass_kg": [4.5, 9.001]})
    assert status(totals.RULES, "V44", wrong).status == "fail"


FORMULAS = [
    ("=1+2*3", 7),
    ("=-2^2+1", 5),
    ("=(1+2)*3", 9),
    ('=IF(1<2,"a","b")', "a"),
    ('="a"&"b"', "ab"),
    ("=SUM(A1:B2)", 10),
    ("=SUM(Other!$A$1,'Two words'!A1)", 15),
    ("=ROUND(2.345,2)", 2.35),
    ("=ROUND(-0.5,0)", -1),
    ("=MAX(A1:B2)-MIN(A1:B2)", 3),
    ("=ABS(-A2)", 3),
    ("=rate*2", 14),
    ("=COUNTA(A1:B3)", 4),
    ("=AND(A1=1,B1=2)", True),
    ("=SUMPRODUCT(A1:A2,B1:B2)", 14),
    ("=SUMPRODUCT(A2:A3,B1:B2)", 6),
    ("=A9+1", 1),
    ('=IF(ABS(SUM(A1:A2)-4)<=1e-06,"pass","fail")', "pass"),
]


def little_book():
    sheet = {(1, 1): Cell(1), (1, 2): Cell(2), (2, 1): Cell(3), (2, 2): Cell(4)}
    sheets = {"S": sheet, "Other": {(1, 1): Cell(7)}, "Two words": {(1, 1): Cell(8)}}
    return Workbook(sheets, {}, {"rate": "Other!$A$1"})


@pytest.mark.parametrize(("formula", "value"), FORMULAS)
def test_formulas_are_computed(formula, value):
    assert evaluate(little_book(), "S", 1, formula) == value


@pytest.mark.parametrize("formula", ["=1+", "=NOW()", "=nobody", "=(1", "=1 2", "={1}", "=tblX[Y"])
def test_what_cannot_be_computed_is_refused(formula):
    with pytest.raises(Unreadable):
        evaluate(little_book(), "S", 1, formula)


def test_workbooks_are_read_with_formulas_and_tables(tmp_path):
    book = openpyxl.Workbook()
    sheet = book.active
    for row in (["Mark", "Mass (kg)"], ["M01", 1.5], ["M02", 2.5], [None, "=SUM(tblX[Mass (kg)])"]):
        sheet.append(row)
    excel_table = ExcelTable(displayName="tblX", name="tblX", ref="A1:B4", totalsRowCount=1)
    sheet.add_table(excel_table)
    book.save(tmp_path / "b.xlsx")
    found = read_workbook(tmp_path / "b.xlsx")
    assert found.tables["tblX"] == NamedTable("Sheet", ("Mark", "Mass (kg)"), 1, 2, 3)
    assert found.sheets["Sheet"][4, 2] == Cell(None, "=SUM(tblX[Mass (kg)])")
    assert evaluate(found, "Sheet", 4, found.sheets["Sheet"][4, 2].formula) == 4.0


# ---------------------------------------------------------------- V50


def folder(tmp_path, *, certificate=True):
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "a.csv").write_text("a")
    if certificate:
        (tmp_path / "certificate.json").write_text("{}")
    paths = [path for path in sorted(tmp_path.rglob("*")) if path.is_file()]
    files = [
        {
            "path": path.relative_to(tmp_path).as_posix(),
            "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
            "size": path.stat().st_size,
        }
        for path in paths
    ]
    (tmp_path / "manifest.json").write_text(json.dumps({"schema": 1, "files": files}))
    return tmp_path


def checked(path, *, final=True):
    return status(manifest.RULES, "V50", Delivery(path, final)).status


def test_manifest_of_a_candidate_and_of_a_delivery(tmp_path):
    folder(tmp_path, certificate=False)
    assert checked(tmp_path, final=False) == "pass"
    assert checked(tmp_path) == "fail"


@pytest.mark.parametrize("fault", ["none", "foreign", "lost", "changed", "linked"])
def test_manifest_faults(tmp_path, fault):
    csv = folder(tmp_path) / "tables" / "a.csv"
    if fault == "foreign":
        (tmp_path / "tables" / "b.csv").write_text("b")
    elif fault == "lost":
        csv.unlink()
    elif fault == "changed":
        csv.write_text("b")
    elif fault == "linked":
        csv.unlink()
        csv.symlink_to(tmp_path / "certificate.json")
    assert checked(tmp_path) == ("pass" if fault == "none" else "fail")


def test_the_units_of_a_drawing_are_read(tmp_path):
    for units in (4, 6):
        ezdxf.new("R2010", units=units).saveas(tmp_path / "P.dxf")
        assert read_dxf(tmp_path / "P.dxf").units == units


def test_layers_of_the_shop_are_known_by_their_names():
    drawing = part(outline(OUTLINE, "LASER"))
    assert drawings.drawing_faults(drawing) == ["LWPOLYLINE on layer LASER"]
    assert not drawings.drawing_faults(with_layers(drawing, {"LASER": "CUT"}))
