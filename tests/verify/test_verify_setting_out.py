"""The setting out is proved in the datum of the site, near and far; seeded faults are found."""

import csv
import json
import shutil
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from verify_museum import edit_table

from isomould.documents.info import DatumSettings
from isomould.documents.setting_out import place
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.rules import judge

BY_ID = {rule.id: rule for rule in RULES}
CHECKS = ["V46", "V46b", "V46c"]


@pytest.fixture
def folder(built_folder, tmp_path):
    return Path(shutil.copytree(built_folder, tmp_path / "delivered"))


@pytest.mark.parametrize("rule", CHECKS)
def test_the_good_folder_passes(built_folder, rule):
    found = judge(BY_ID[rule], Delivery(built_folder))
    assert found.status == "pass", found
    assert found.count > 0


def test_a_micrometre_is_kept_at_utm_coordinates(built_folder):
    """Distances between the printed work points are those of the model to the rounding of 0.001 mm."""
    with (built_folder / "tables" / "setting_out.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    found = np.array([[float(row[f"{axis}_mm"]) for axis in "xyz"] for row in rows])
    with np.load(built_folder / "model" / "geometry.npz") as file:
        nodes = file["nodes"]
    assert abs(found - [691608123, 5334765456.7, 519250]).max() < 20e3
    apart, meant = (np.linalg.norm(points[1:] - points[:-1], axis=1) for points in (found, nodes))
    assert abs(apart - meant).max() < 0.0018


def test_a_quarter_turn_and_a_shift():
    datum = DatumSettings.model_validate({"origin": [1000, 0, "2 m"], "rotation_deg": 90})
    moved = place(np.array([[1.0, 0.0, 0.0], [0.0, 2.0, 3.0]]), datum)
    assert moved == pytest.approx(np.array([[1000.0, 1.0, 2000.0], [998.0, 0.0, 2003.0]]), abs=1e-9)


def edit_drawing(change):
    def seed(folder):
        document = ezdxf.readfile(folder / "setting-out.dxf")
        change(document.modelspace())
        document.saveas(folder / "setting-out.dxf")

    return seed


def turn_datum(folder):
    path = folder / "model" / "design.json"
    record = json.loads(path.read_text("utf-8"))
    record["datum"]["rotation_deg"] += 1e-4
    path.write_text(json.dumps(record), "utf-8")


def move(rows):
    rows[5]["top_z_mm"] = f"{float(rows[5]['top_z_mm']) + 0.002:.3f}"


def swap(rows):
    rows[0]["mark"], rows[7]["mark"] = rows[7]["mark"], rows[0]["mark"]


def move_line(space):
    line = space.query("LINE")[3]
    line.dxf.end = line.dxf.end + ezdxf.math.Vec3(0, 0, 0.001)


def move_label(space):
    space.query("TEXT")[0].dxf.insert += (0.01, 0, 0)


SEEDS = {
    "datum turned": ("V46", turn_datum),
    "drawing in another datum": ("V46c", turn_datum),
    "top moved 0.002 mm": ("V46", edit_table("setting_out", move)),
    "marks swapped": ("V46b", edit_table("setting_out", swap)),
    "row doubled": ("V46b", edit_table("setting_out", lambda rows: rows.append(rows[0]))),
    "row lost": ("V46b", edit_table("setting_out", lambda rows: rows.pop())),
    "line moved": ("V46c", edit_drawing(move_line)),
    "line lost": ("V46c", edit_drawing(lambda space: space.delete_entity(space.query("LINE")[0]))),
    "label moved": ("V46c", edit_drawing(move_label)),
    "another label": ("V46c", edit_drawing(lambda space: setattr(space.query("TEXT")[0].dxf, "text", "N01 X"))),
}


@pytest.mark.parametrize("name", SEEDS)
def test_every_fault_is_found(folder, name):
    rule, seed = SEEDS[name]
    seed(folder)
    found = judge(BY_ID[rule], Delivery(folder))
    assert found.status == "fail", found
    assert found.reason
