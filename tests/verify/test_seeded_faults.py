"""One fault in a delivered folder at a time: found by a check that reads the content, not by its hash alone."""

import json
import re
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from verify_museum import edit_table

from isomould.verify import verify_folder
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.rules import judge

Seed = Callable[[Path], None]
WELDED_PLATES = ("V37c", "V37d", "V38b", "V38d", "V38e", "V39", "V39b", "V39c", "V42f", "V42g")
"""Checks of facets, forks, fittings and hardware, which welded plates have none of."""
BY_ID = {rule.id: rule for rule in RULES}


@pytest.fixture
def folder(built_folder, tmp_path):
    return Path(shutil.copytree(built_folder, tmp_path / "delivered"))


def test_no_false_alarm(built_folder):
    certificate = verify_folder(built_folder)
    assert certificate.passed, certificate.failures
    silent = {check.id: check.reason for check in certificate.checks if check.status == "not_applicable"}
    scored = {"V33c", "V33d", "V33e"}
    trims = {"V17", "V17b", "V17c", "V28", "V28b", "V28c"}
    asked = {"V7", "V10", "V23d", "V27c", "V40e", "V41d", "V43i", "V45e", "V48", "V60", "V61", "V62", "V63"}
    assert silent.keys() <= trims | scored | asked | set(WELDED_PLATES), silent


def edit_mesh(change):
    def seed(folder):
        path = folder / "model" / "geometry.npz"
        with np.load(path) as file:
            arrays = dict(file)
        change(arrays)
        np.savez(path, **arrays)

    return seed


def edit_drawing(pattern, change):
    def seed(folder):
        path = sorted(folder.glob(pattern))[0]
        document = ezdxf.readfile(path)
        change(document)
        document.saveas(path)

    return seed


def edit_layout(change):
    def seed(folder):
        path = folder / "sheets" / "nesting.json"
        layout = json.loads(path.read_text("utf-8"))
        change(layout)
        path.write_text(json.dumps(layout), "utf-8")

    return seed


def both(*seeds):
    def seed(folder):
        for one in seeds:
            one(folder)

    return seed


def cuts(document):
    return [e for e in document.modelspace() if e.dxftype() == "LWPOLYLINE" and e.dxf.layer == "CUT"]


def set_points(polyline, points):
    polyline.set_points([tuple(point) for point in points], format="xy")


def points_of(polyline):
    return np.array(polyline.get_points("xy"))


def move_vertex(arrays):
    arrays["nodes"][len(arrays["nodes"]) // 2] += [0.01, 0.0, 0.0]


def put_nan(arrays):
    arrays["nodes"][3, 1] = np.nan


def other_marks(names):
    """The first two places with different marks."""
    return 0, next(k for k, name in enumerate(names) if name != names[0])


def swap_in_table(rows):
    a, b = other_marks([row["mark"] for row in rows])
    rows[a]["mark"], rows[b]["mark"] = rows[b]["mark"], rows[a]["mark"]


def swap_in_mesh(arrays):
    a, b = other_marks(arrays["node_mark"])
    arrays["node_mark"][[a, b]] = arrays["node_mark"][[b, a]]


def swap_faces(arrays):
    a, b = other_marks(arrays["face_mark"])
    arrays["face_mark"][[a, b]] = arrays["face_mark"][[b, a]]


def one_more(rows):
    rows[0]["quantity"] = str(int(rows[0]["quantity"]) + 1)


def swap_lengths(rows):
    row = next(row for row in rows if abs(float(row["top_length_mm"]) - float(row["bottom_length_mm"])) > 1)
    row["top_length_mm"], row["bottom_length_mm"] = row["bottom_length_mm"], row["top_length_mm"]


def delete_cut(document):
    document.modelspace().delete_entity(cuts(document)[0])


def mirror_cut(document):
    points = points_of(cuts(document)[0])
    set_points(cuts(document)[0], ([points[:, 0].max(), 0] + points * [-1, 1])[::-1])


def shift_cut(document):
    """Push the part nearest to a neighbour 0.1 mm on to it."""
    set_points(cuts(document)[0], points_of(cuts(document)[0]) + 0.1)


def double_cut(document):
    space = document.modelspace()
    space.add_entity(cuts(document)[0].copy())


def set_metres(document):
    document.header["$INSUNITS"] = 6


def shear_cut(document):
    points = points_of(cuts(document)[0])
    points[2, 0] += 0.01
    set_points(cuts(document)[0], points)


def first_sheet(layout):
    name = sorted(sheet["id"] for sheet in layout["sheets"])[0]
    return [placed for placed in layout["placements"] if placed["sheet"] == name]


def turn_over(layout):
    first_sheet(layout)[0]["turned_over"] = True


def double_placement(layout):
    layout["placements"].append(first_sheet(layout)[0])


def is_lopsided(points):
    sides = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    return min(abs(sides[0] - sides[2]), abs(sides[1] - sides[3])) > 1


def mirror_placement(layout):
    placed = next(placed for placed in layout["placements"] if is_lopsided(np.array(placed["points"])))
    points = np.array(placed["points"])
    placed["points"] = ([points[:, 0].max() + points[:, 0].min(), 0] + points * [-1, 1])[::-1].tolist()


def close_up(folder):
    """Shift one part of a sheet 0.1 mm towards its nearest neighbour, in the layout and in the drawing alike."""
    path = folder / "sheets" / "nesting.json"
    layout = json.loads(path.read_text("utf-8"))
    placed = first_sheet(layout)
    points = np.array(placed[0]["points"])
    far = min((np.array(other["points"]) for other in placed[1:]), key=lambda p: abs(p.mean(0) - points.mean(0)).sum())
    way = far.mean(axis=0) - points.mean(axis=0)
    by = 0.1 * np.sign(way) * (abs(way) > 1)
    placed[0]["points"] = (points + by).tolist()
    path.write_text(json.dumps(layout), "utf-8")

    def change(document):
        mine = min(cuts(document), key=lambda cut: abs(points_of(cut).mean(0) - points.mean(0)).sum())
        set_points(mine, points_of(mine) + by)

    edit_drawing(f"sheets/{placed[0]['sheet']}.dxf", change)(folder)


def one_digit(folder):
    """Change the last digit of one number in the workbook's XML."""
    path = folder / "schedules.xlsx"
    with zipfile.ZipFile(path) as book:
        parts = {name: book.read(name) for name in book.namelist()}
    names = sorted(name for name in parts if name.startswith("xl/worksheets/sheet"))
    name = next(name for name in names if b"tableParts" in parts[name] and name.endswith("sheet3.xml"))
    found = re.search(rb"<v>-?\d+\.\d+</v>", parts[name])
    digit = found.end() - len(b"</v>") - 1
    other = b"1" if parts[name][digit : digit + 1] != b"1" else b"2"
    parts[name] = parts[name][:digit] + other + parts[name][digit + 1 :]
    with zipfile.ZipFile(path, "w") as book:
        for part, content in parts.items():
            book.writestr(part, content)


def truncate(pattern):
    def seed(folder):
        path = sorted(folder.glob(pattern))[0]
        path.write_bytes(path.read_bytes()[: int(0.8 * path.stat().st_size)])

    return seed


def remove(pattern):
    def seed(folder):
        sorted(folder.glob(pattern))[0].unlink()

    return seed


def move_solid(folder):
    path = sorted(folder.glob("nodes/*.3mf"))[0]
    with zipfile.ZipFile(path) as package:
        parts = {name: package.read(name) for name in package.namelist()}
    model = parts["3D/3dmodel.model"].decode()
    x = re.search(r'vertex x="([^"]+)"', model)
    parts["3D/3dmodel.model"] = (model[: x.start(1)] + repr(float(x[1]) * 1.001) + model[x.end(1) :]).encode()
    with zipfile.ZipFile(path, "w") as package:
        for part, content in parts.items():
            package.writestr(part, content)


def edit_page(old, new):
    def seed(folder):
        path = folder / "report.html"
        text = path.read_text("utf-8")
        assert old in text
        path.write_text(text.replace(old, new, 1), "utf-8")

    return seed


def last_digit_of_a_figure(folder):
    """Add one to the last digit of the first key figure in mm."""
    path = folder / "report.html"
    text = path.read_text("utf-8")
    found = re.search(r'(<td class="number">\d+\.)(\d)(</td><td>mm</td>)', text)
    digit = (int(found[2]) + 1) % 10
    path.write_text(f"{text[: found.start()]}{found[1]}{digit}{found[3]}{text[found.end() :]}", "utf-8")


def change_certificate(folder):
    path = folder / "certificate.json"
    certificate = json.loads(path.read_text("utf-8"))
    certificate["checks"][0]["status"] = "fail"
    path.write_text(json.dumps(certificate), "utf-8")


SEEDS: dict[str, tuple[str, Seed]] = {
    "vertex moved 0.01 mm": ("V15", edit_mesh(move_vertex)),
    "vertex moved: planes": ("V1", edit_mesh(move_vertex)),
    "NaN": ("V1", edit_mesh(put_nan)),
    "marks swapped in a table": ("V43", edit_table("panel_instances", swap_in_table)),
    "panel marks swapped for the nest": ("V31", edit_table("panel_instances", swap_in_table)),
    "node marks swapped everywhere": (
        "V36", both(edit_mesh(swap_in_mesh), edit_table("node_instances", swap_in_table))
    ),
    "face marks swapped everywhere": (
        "V36d", both(edit_mesh(swap_faces), edit_table("panel_instances", swap_in_table))
    ),
    "quantity": ("V31", edit_table("panels", one_more)),
    "quantity of nodes": ("V43", edit_table("nodes", one_more)),
    "quantity in one document": ("V41", edit_table("members", one_more)),
    "entity deleted": ("V31b", edit_drawing("sheets/*.dxf", delete_cut)),
    "entity of a part deleted": ("V40b", edit_drawing("panels/*.dxf", delete_cut)),
    "part file mirrored": ("V40c", edit_drawing("panels/*.dxf", mirror_cut)),
    "placed part mirrored": ("V32", edit_layout(mirror_placement)),
    "coated panel turned over": ("V32", edit_layout(turn_over)),
    "part sheared 0.01 mm": ("V40c", edit_drawing("panels/*.dxf", shear_cut)),
    "metres": ("V40", edit_drawing("sheets/*.dxf", set_metres)),
    "metres in a member": ("V40", edit_drawing("members/*.dxf", set_metres)),
    "gap short by 0.1 mm": ("V33", close_up),
    "part shifted 0.1 mm on the sheet only": ("V31b", edit_drawing("sheets/*.dxf", shift_cut)),
    "one digit": ("V41", one_digit),
    "part doubled on a sheet": ("V31b", edit_drawing("sheets/*.dxf", double_cut)),
    "part doubled: lines cut twice": ("V40", edit_drawing("sheets/*.dxf", double_cut)),
    "part doubled in the layout": ("V31", edit_layout(double_placement)),
    "lengths swapped": ("V40d", edit_table("members", swap_lengths)),
    "lengths swapped: end cuts": ("V43e", edit_table("members", swap_lengths)),
    "part file truncated": ("V40", truncate("panels/*.dxf")),
    "mesh truncated": ("V11", truncate("model/geometry.npz")),
    "workbook truncated": ("V41", truncate("schedules.xlsx")),
    "solid truncated": ("V23", truncate("nodes/*.3mf")),
    "table truncated": ("V43", truncate("tables/*.csv")),
    "layout truncated": ("V32", truncate("sheets/nesting.json")),
    "table lost": ("V41", remove("tables/members.csv")),
    "sheet lost": ("V31", remove("sheets/*.dxf")),
    "part file lost": ("V40", remove("panels/*.dxf")),
    "solid lost": ("V20", remove("nodes/*.3mf")),
    "solid changed": ("V23b", move_solid),
    "page: another key figure": ("V49", edit_page('<td class="number">', '<td class="number">1')),
    "page: a key figure wrong in its last digit": ("V49", last_digit_of_a_figure),
    "page: failed check shown as passed": ("V49", change_certificate),
    "page: another hash": ("V49", edit_page('<td class="hash">', '<td class="hash">0')),
    "page: a file left out": ("V49", edit_page('<td><a href', '<th><a href')),
    "page: loads from elsewhere": ("V49", edit_page("</head>", '<script src="https://a.b/c.js"></script></head>')),
    "page lost": ("V49", remove("report.html")),
    "page truncated": ("V49", truncate("report.html")),
}  # fmt: skip


@pytest.mark.parametrize("name", SEEDS)
def test_every_fault_is_found(folder, name):
    rule, seed = SEEDS[name]
    seed(folder)
    check = judge(BY_ID[rule], Delivery(folder))
    assert check.status == "fail", check
    assert check.reason
    assert judge(BY_ID["V50"], Delivery(folder)).status == "fail"
