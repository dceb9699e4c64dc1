"""A trimmed project, built and proved; faults seeded in what trimming adds are found."""

import csv
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

import isomould
from isomould.verify import verify_folder
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.rules import judge
from museum import dome, trimmed, write_project

BY_ID = {rule.id: rule for rule in RULES}


GROUND = {"plane": {"z": 0}, "keep": "above"}
GABLE = {"plane": {"origin": [2000, 0, 0], "normal": [1, 0, 0.1]}, "keep": [-1, 0, 0]}


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A dome on the ground that a gable cuts: the two planes meet on two panels."""
    folder = tmp_path_factory.mktemp("trimmed")
    project = write_project(folder / "dome.toml", trimmed(dome(5.2, nodes=6), GROUND, GABLE))
    return isomould.build(project, folder / "dome", run=isomould.Run(effort="quick", jobs=1)).folder


@pytest.fixture
def folder(built, tmp_path):
    return Path(shutil.copytree(built, tmp_path / "delivered"))


def rows(folder, name):
    with (folder / "tables" / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_the_certificate_holds_and_looks_at_the_trim(built):
    certificate = verify_folder(built)
    assert certificate.passed, certificate.failures
    looked = {check.id for check in certificate.checks if check.status == "pass"}
    assert {"V17", "V17b", "V17c", "V40e"} <= looked


def test_schedules_of_trimmed_panels_and_sills(built):
    cut = [row for row in rows(built, "panels") if row["outline"]]
    assert cut
    assert all(row["side_a_mm"] == row["diagonal_1_mm"] == row["height_mm"] == "" for row in cut)
    points = np.array([[float(x) for x in pair.split(",")] for pair in cut[0]["outline"].split(";")])
    x, y = points.T
    area = (x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2
    assert float(cut[0]["area_m2"]) == pytest.approx(area / 1e6, rel=1e-9)
    sills = [row for row in rows(built, "members") if row["family"] == "sill"]
    assert all(float(row["end_angle_start_deg"]) == float(row["end_angle_end_deg"]) == 0 for row in sills)
    lengths = [
        float(r["system_length_mm"]) - float(r["set_back_start_mm"]) - float(r["set_back_end_mm"]) for r in sills
    ]
    assert lengths == pytest.approx([float(row["cut_length_mm"]) for row in sills], abs=2e-3)
    supports = [row for row in rows(built, "nodes") if row["kind"] == "support"]
    assert {(row["valence"], row["slots"]) for row in supports} <= {
        ("3", "1"),
        ("4", "2"),
        ("5", "3"),
        ("4", "3"),
        ("2", "0"),
    }
    assert ("2", "0") in {(row["valence"], row["slots"]) for row in supports}
    locations = {row["location"] for row in rows(built, "member_instances")}
    assert {"MS-000", "MS-001"} < locations
    assert any(row["location"].endswith("-A") for row in rows(built, "panel_instances"))
    at_cut = [row for row in rows(built, "panel_instances") if row["location"].endswith("-A")]
    assert all(row["packers_mm"].split(";").count("") >= 1 for row in at_cut)


def test_sills_do_not_touch_their_nodes(built):
    """The square end of a sill stays outside the drum, measured in space on the delivered tables."""
    with np.load(built / "model" / "geometry.npz") as file:
        mesh = dict(file)
    drum = {row["mark"]: float(row["drum_height_mm"]) for row in rows(built, "nodes")}
    radius = float(rows(built, "nodes")[0]["drum_diameter_mm"]) / 2
    members = {row["mark"]: row for row in rows(built, "members")}
    turned = {row["location"]: row["turned"] for row in rows(built, "member_instances")}
    for k in np.flatnonzero(mesh["edge_family"] == "sill"):
        row = members[str(mesh["edge_mark"][k])]
        backs = [float(row["set_back_start_mm"]), float(row["set_back_end_mm"])]
        if turned[str(mesh["edge_location"][k])] in ("end_for_end", "both"):
            backs = backs[::-1]
        start, end = mesh["edges"][k]
        along = mesh["nodes"][end] - mesh["nodes"][start]
        along /= np.linalg.norm(along)
        for node, way, back in ((start, along, backs[0]), (end, -along, backs[1])):
            sine = abs(mesh["node_axes"][node] @ way)
            assert back > radius * np.sqrt(1 - sine**2) + drum[str(mesh["node_mark"][node])] / 2 * sine


def edit_mesh(folder, change):
    path = folder / "model" / "geometry.npz"
    with np.load(path) as file:
        arrays = dict(file)
    change(arrays)
    np.savez(path, **arrays)


def support(arrays):
    return next(k for k, name in enumerate(arrays["node_location"]) if name.endswith("-A"))


def corner(arrays):
    """The node where two sills meet and nothing else."""
    arms = np.zeros((len(arrays["nodes"]), 2), dtype=int)
    np.add.at(arms, (arrays["edges"], (arrays["edge_family"] == "sill").astype(int)[:, None]), 1)
    return int(np.flatnonzero((arms == [0, 2]).all(axis=1))[0])


def slide_corner(arrays):
    """Along a rim: it stays in its panel and on one plane."""
    node = corner(arrays)
    edge = np.flatnonzero((arrays["edges"] == node).any(axis=1))[0]
    other = arrays["edges"][edge].sum() - node
    along = arrays["nodes"][other] - arrays["nodes"][node]
    arrays["nodes"][node] += 0.01 * along / np.linalg.norm(along)


def lift(arrays):
    arrays["nodes"][support(arrays)] += [0.0, 0.0, 0.01]


def slide(arrays):
    arrays["nodes"][support(arrays)] += [0.01, 0.01, 0.0]


def forget_sill(arrays):
    arrays["edge_family"][arrays["edge_family"] == "sill"] = "parallel"


def twist(arrays):
    node = support(arrays)
    arrays["node_axes"][node] += [0.0, 0.001, 0.001]
    arrays["node_axes"][node] /= np.linalg.norm(arrays["node_axes"][node])


def swap_cut_faces(arrays):
    cut = [k for k, name in enumerate(arrays["face_location"]) if name.endswith("-A")]
    marks = arrays["face_mark"]
    other = next(k for k in cut if marks[k] != marks[cut[0]])
    marks[[cut[0], other]] = marks[[other, cut[0]]]


def drop_face(arrays):
    """A whole one."""
    lost = next(k for k, name in enumerate(arrays["face_location"]) if not name.endswith("-A"))
    sizes = np.diff(arrays["face_offsets"])
    arrays["faces"] = arrays["faces"][np.repeat(np.arange(len(sizes)), sizes) != lost]
    arrays["face_offsets"] = np.concatenate([[0], np.cumsum(np.delete(sizes, lost))])
    for name in ("face_ij", "face_mark", "face_location"):
        arrays[name] = np.delete(arrays[name], lost, axis=0)


MESH_FAULTS = {
    "support off the plane": ("V17", lift),
    "corner off one of its planes": ("V17", slide_corner),
    "support off its member": ("V17", slide),
    "sill forgotten": ("V17c", forget_sill),
    "axis out of the member's plane": ("V6", twist),
    "cut panels swapped": ("V43", swap_cut_faces),
    "panel lost": ("V17b", drop_face),
}


@pytest.mark.parametrize("name", MESH_FAULTS)
def test_faults_of_the_mesh_are_found(folder, name):
    rule, change = MESH_FAULTS[name]
    edit_mesh(folder, change)
    assert judge(BY_ID[rule], Delivery(folder)).status == "fail"


def test_another_plane_is_found(folder):
    path = folder / "model" / "design.json"
    record = json.loads(path.read_text("utf-8"))
    record["trim"][0]["origin"][2] = 1500.0
    path.write_text(json.dumps(record), "utf-8")
    found = {rule: judge(BY_ID[rule], Delivery(folder)).status for rule in ("V17", "V17b", "V17c")}
    assert found == {"V17": "fail", "V17b": "fail", "V17c": "fail"}


def test_a_changed_outline_is_found(folder):
    path = folder / "tables" / "panels.csv"
    text = path.read_bytes().decode()
    outline = next(row["outline"] for row in rows(folder, "panels") if row["outline"])
    path.write_bytes(text.replace(outline, outline.replace("0,0;", "0,0.01;", 1)).encode())
    assert judge(BY_ID["V40e"], Delivery(folder)).status == "fail"


def test_trimming_without_sills(tmp_path):
    project = write_project(tmp_path / "dome.toml", trimmed(dome(9.3, nodes=5), sill=False))
    built = isomould.build(project, tmp_path / "dome", run=isomould.Run(effort="quick", jobs=1))
    assert built.certificate.passed
    assert "1" in {row["valence"] for row in rows(built.folder, "nodes")}
