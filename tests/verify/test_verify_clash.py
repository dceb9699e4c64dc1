"""Clashes and gaps are measured on the delivered model; faults seeded there are found."""

import json
import shutil
from pathlib import Path

import ezdxf
import numpy as np
import pytest

from isomould.verify.checks.gaps import ROUNDING
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.joints import different_joints
from isomould.verify.rules import judge

BY_ID = {rule.id: rule for rule in RULES}


@pytest.fixture
def folder(built_folder, tmp_path):
    return Path(shutil.copytree(built_folder, tmp_path / "delivered"))


def check(folder, rule):
    return judge(BY_ID[rule], Delivery(folder))


def edit_model(folder, change):
    """Change the tree of the model; its data stay as they are."""
    path = folder / "model" / "model.glb"
    content = path.read_bytes()
    size = int.from_bytes(content[12:16], "little")
    tree = json.loads(content[20 : 20 + size])
    change(tree)
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    body = len(text).to_bytes(4, "little") + b"JSON" + text + content[20 + size :]
    path.write_bytes(b"glTF" + (2).to_bytes(4, "little") + (12 + len(body)).to_bytes(4, "little") + body)


def part(tree, location):
    return next(node for node in tree["nodes"] if node["name"].split()[-1] == location)


def move(location, along, by):
    """Move a part by mm along one of its own axes."""

    def change(tree):
        matrix = np.array(part(tree, location)["matrix"]).reshape(4, 4)
        matrix[3, :3] += by * matrix[along, :3]
        part(tree, location)["matrix"] = matrix.ravel().tolist()

    return change


def test_the_good_model_passes(built_folder):
    found = {rule: check(built_folder, rule) for rule in ("V24", "V26", "V26b")}
    assert {rule: c.status for rule, c in found.items()} == dict.fromkeys(found, "pass")
    assert found["V24"].worst == 0
    assert 0 < abs(found["V26"].worst) < ROUNDING


def test_every_class_of_node_is_looked_at_once(built_folder):
    delivery = Delivery(built_folder)
    joints = different_joints(delivery.mesh, delivery.model)
    marks = [joint.parts[0].mark for joint in joints]
    assert set(marks) == set(delivery.mesh.node_mark)
    assert len(joints) < len(delivery.mesh.nodes)


@pytest.mark.parametrize(
    ("location", "along", "by", "depth"),
    [
        ("MG-02-02", 0, 2.25, 0.24),  # into the slot's floor, past the end gap of 2 mm
        ("MG-02-02", 2, 0.3, 0.05),  # into the slot's side, past half the clearance of 0.5 mm
        ("P-02-02", 2, -30.0, 1.0),  # through spacer and seat down onto the members
    ],
)
def test_a_part_that_is_moved_clashes(folder, location, along, by, depth):
    edit_model(folder, move(location, along, by))
    found = check(folder, "V24")
    assert found.status == "fail"
    assert location in found.where
    assert found.worst >= depth - 1e-3


def test_a_panel_that_is_moved_comes_too_near(folder):
    edit_model(folder, move("P-02-02", 1, 0.5))
    found = check(folder, "V26")
    assert found.status == "fail"
    assert found.worst == pytest.approx(0.5, abs=ROUNDING)
    assert "P-02-02" in found.where


def test_a_wider_gap_is_not_there(folder):
    path = folder / "model" / "design.json"
    record = json.loads(path.read_text("utf-8"))
    record["panel"]["gap_mm"] += 0.01
    path.write_text(json.dumps(record), "utf-8")
    assert check(folder, "V26").status == "fail"


def rename(location, name):
    return lambda tree: part(tree, location).update(name=name)


@pytest.mark.parametrize("name", ["P01 P-99-99", "M01 P-02-02", "P-02-02"])
def test_a_model_with_other_names_proves_nothing(folder, name):
    edit_model(folder, rename("P-02-02", name))
    assert check(folder, "V24").status == "fail"


@pytest.mark.parametrize("group", ["panels", "members"])
def test_another_part_file_is_found(folder, group):
    path = sorted(folder.glob(f"{group}/*.dxf"))[0]
    document = ezdxf.readfile(path)
    outline = document.modelspace().query("LWPOLYLINE[layer=='CUT']")[0]
    points = outline.get_points("xy")
    outline.set_points([(points[0][0] + 0.01, points[0][1]), *points[1:]], format="xy")
    document.saveas(path)
    assert check(folder, "V26b").status == "fail"


def test_a_truncated_model_is_found(folder):
    path = folder / "model" / "model.glb"
    path.write_bytes(path.read_bytes()[:-100])
    assert check(folder, "V24").status == check(folder, "V26").status == "fail"
