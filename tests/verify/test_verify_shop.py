"""What a shop adds is proved on a delivered folder: bases, plans, marks, solids; seeded faults are found."""

import csv
import json
import re
import shutil
from pathlib import Path

import ezdxf
import numpy as np
import pytest

import isomould
from isomould.documents.shop.title_block import PLAIN_NOTE
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.read.labels import read_label_texts
from isomould.verify.read.pdf import read_pdf
from isomould.verify.rules import judge
from museum import changed, dome, trimmed, write_project

BY_ID = {rule.id: rule for rule in RULES}


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    folder = tmp_path_factory.mktemp("shop")
    data = changed(
        trimmed(dome(5.2, nodes=6)),
        nodes={"base_plate": {"holes": 6}, "slot_end": "round"},
        panels={"coating": "outside", "edge_deduction": {"generatrix": 1}},
        deliver={"solids": ["members", "panels"], "labels": True},
        project={"name": "Купол Łódź", "client": "Μονή 日本", "number": "№ 7"},
    )
    project = write_project(folder / "dome.toml", data)
    return isomould.build(project, folder / "dome", run=isomould.Run(effort="quick", jobs=1)).folder


@pytest.fixture
def folder(built, tmp_path):
    return Path(shutil.copytree(built, tmp_path / "delivered"))


def check(folder, rule):
    return judge(BY_ID[rule], Delivery(folder))


def rows(folder, name):
    with (folder / "tables" / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize(
    "rule",
    [
        "V24",
        "V25",
        "V26",
        "V26b",
        "V27",
        "V27b",
        "V27c",
        "V28",
        "V28b",
        "V28c",
        "V40",
        "V42f",
        "V42g",
        "V43f",
        "V45",
        "V45b",
        "V45c",
        "V45d",
        "V45e",
        "V48",
    ],
)
def test_the_good_folder_passes(built, rule):
    found = check(built, rule)
    assert found.status == "pass", found
    assert found.count > 0


def test_names_in_other_scripts_stand_in_drawings_and_labels(built):
    for sheet in read_pdf(built / "drawings" / "nodes.pdf").sheets:
        assert {"Купол Łódź", "Μονή □□", PLAIN_NOTE} <= set(sheet.texts)
    assert "№ 7 Купол Łódź" in read_label_texts(built / "labels.pdf")[0]


def test_files_and_schedule_of_a_support(built):
    row = next(row for row in rows(built, "nodes") if row["kind"] == "support")
    mark, names = row["mark"], {path.name for path in (built / "nodes").iterdir()}
    assert {f"{mark}.dxf", f"{mark}-stem.dxf", f"{mark}-drum.dxf", f"{mark}.3mf"} <= names
    assert row["base_holes"] == "6"
    assert row["drawing_file"].split(";")[0] == f"nodes/{mark}.dxf"
    drum = float(row["volume_cm3"]) * 7.85e-3
    assert float(row["mass_kg"]) == pytest.approx(drum + float(row["base_mass_kg"]), abs=1.1e-3)
    inner = next(row for row in rows(built, "nodes") if row["kind"] != "support")
    assert inner["base_mass_kg"] == inner["base_holes"] == ""
    assert not (built / "nodes" / f"{inner['mark']}-drum.dxf").exists()


def test_the_coated_side_is_engraved(built):
    """The arrow of a coated panel has its text beside it: more strokes than shaft, head and mark."""
    panel = ezdxf.readfile(sorted(built.glob("panels/*.dxf"))[0]).modelspace()
    assert len(panel.query("LWPOLYLINE[layer=='ENGRAVE']")) > 20


def edit(pattern, change):
    def seed(folder):
        path = sorted(folder.glob(pattern))[0]
        document = ezdxf.readfile(path)
        change(document.modelspace())
        document.saveas(path)

    return seed


def support(folder):
    return next(row["mark"] for row in rows(folder, "nodes") if row["kind"] == "support")


def at_base(change, name="{}.dxf"):
    return lambda folder: edit(f"nodes/{name.format(support(folder))}", change)(folder)


def delete_hole(space):
    space.delete_entity(space.query("CIRCLE")[0])


def widen_hole(space):
    space.query("CIRCLE")[0].dxf.radius += 0.5


def move_hole(space):
    hole = space.query("CIRCLE")[0]
    hole.dxf.center = hole.dxf.center * 1.1


def stretch(space):
    outline = space.query("LWPOLYLINE[layer=='CUT']")[0]
    outline.set_points([(x * 1.01, y, b) for x, y, b in outline.get_points("xyb")], format="xyb")


def turn(space):
    outline = space.query("LWPOLYLINE[layer=='CUT']")[0]
    c, s = np.cos(1e-3), np.sin(1e-3)
    outline.set_points([(c * x - s * y, s * x + c * y, b) for x, y, b in outline.get_points("xyb")], format="xyb")


def no_bore(space):
    space.delete_entity(space.query("LWPOLYLINE[layer=='CUT_INNER']")[0])


def move_marks(space):
    for stroke in space.query("LWPOLYLINE[layer=='ENGRAVE']"):
        stroke.set_points([(x + 1.0, y) for x, y in stroke.get_points("xy")], format="xy")


def mirror_marks(space):
    for stroke in space.query("LWPOLYLINE[layer=='ENGRAVE']"):
        stroke.set_points([(x, 200 - y) for x, y in stroke.get_points("xy")], format="xy")


def lower_plates(folder):
    path = folder / "tables" / "nodes.csv"
    text = path.read_bytes().decode()
    level = next(row["base_level_mm"] for row in rows(folder, "nodes") if row["base_level_mm"])
    path.write_bytes(text.replace(f",{level},", f",{float(level) + 1:g},").encode())


def ask_for_more(folder):
    path = folder / "model" / "design.json"
    record = json.loads(path.read_text("utf-8"))
    record["node"]["base_plate"]["edge_distance_mm"] += 1
    path.write_text(json.dumps(record), "utf-8")


def swap_solids(folder):
    one, other = sorted(folder.glob("members/*.3mf"))[:2]
    content = one.read_bytes()
    one.write_bytes(other.read_bytes())
    other.write_bytes(content)


def lose_solid(folder):
    sorted(folder.glob("panels/*.3mf"))[0].unlink()


def edit_nc1(name, pattern, change):
    """Change the first match of a pattern in an NC1 file of the first support."""

    def seed(folder):
        path = folder / "nodes" / name.format(support(folder))
        text = path.read_bytes().decode("ascii")
        spoilt = re.sub(pattern, change, text, count=1)
        assert spoilt != text
        path.write_bytes(spoilt.encode("ascii"))

    return seed


def lose_nc1(folder):
    (folder / "nodes" / f"{support(folder)}-stem.nc1").unlink()


def move_corner(space):
    outline = space.query("LWPOLYLINE[layer=='CUT']")[0]
    points = outline.get_points("xyb")
    outline.set_points([(points[0][0] - 0.05, *points[0][1:]), *points[1:]], format="xyb")


def at_trimmed(change):
    """Change the part file of a panel whose corners are listed."""
    return lambda folder: edit(f"panels/{next(r['mark'] for r in rows(folder, 'panels') if r['outline'])}.dxf", change)(
        folder
    )


SEEDS = {
    "hole of a base plate told elsewhere": ("V42f", edit_nc1("{}.nc1", r"30\.00u", "30.02u")),
    "corner of a stem told elsewhere": ("V42f", edit_nc1("{}-stem.nc1", r"0\.00u      0\.00", "0.02u      0.00")),
    "stem without NC1": ("V42f", lose_nc1),
    "thickness of a base plate": ("V42g", edit_nc1("{}.nc1", r"     15\.00", "     12.00")),
    "corner moved": ("V45e", at_trimmed(move_corner)),
    "hole lost": ("V28b", at_base(delete_hole)),
    "hole too wide": ("V28b", at_base(widen_hole)),
    "hole at the edge": ("V28b", at_base(move_hole)),
    "less edge than asked for": ("V28b", ask_for_more),
    "hole lost: mass": ("V25", at_base(delete_hole)),
    "stem stretched: mass": ("V25", at_base(stretch, "{}-stem.dxf")),
    "plate stretched": ("V28c", at_base(stretch)),
    "plate lost": ("V28b", lambda folder: (folder / "nodes" / f"{support(folder)}.dxf").unlink()),
    "level changed": ("V28", lower_plates),
    "plan turned": ("V27b", edit("nodes/N01*.dxf", turn)),
    "plan stretched": ("V27b", edit("nodes/N01*.dxf", stretch)),
    "bore forgotten": ("V27b", edit("nodes/N01*.dxf", no_bore)),
    "arrow off the middle": ("V27", edit("panels/*.dxf", move_marks)),
    "arrow to the other side": ("V27", edit("panels/*.dxf", mirror_marks)),
    "solids swapped": ("V27c", swap_solids),
    "solid lost": ("V27c", lose_solid),
}


@pytest.mark.parametrize("name", SEEDS)
def test_every_fault_is_found(folder, name):
    rule, seed = SEEDS[name]
    seed(folder)
    found = check(folder, rule)
    assert found.status == "fail", found
    assert found.reason
