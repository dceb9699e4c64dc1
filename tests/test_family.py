"""Shapes of one project: one kit of nodes, proved; and what cannot share one is refused with its value."""

import csv
import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

import isomould
from isomould.errors import Refused
from isomould.family import kit_table, make_designs
from isomould.project.load import load_project
from isomould.templates import template_folder
from isomould.verify import verify_folder
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.rules import judge
from museum import FAMILY, SMALL, changed, dome, trimmed, write_project


def designs(tmp_path, data):
    return make_designs(load_project(write_project(tmp_path / "family.toml", data)))


def shape(**tables):
    return {"shapes": [{"name": "Other", **tables}]}


@pytest.fixture(scope="module")
def family_folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("family")
    project = write_project(folder / "family.toml", FAMILY)
    return isomould.build(project, folder / "out", run=isomould.Run(effort="quick", jobs=1)).folder


@pytest.fixture
def folder(family_folder, tmp_path):
    return Path(shutil.copytree(family_folder, tmp_path / "delivered"))


def test_all_nodes_of_the_template_are_shared():
    found = make_designs(load_project(template_folder() / "family-of-vaults.toml"))
    table = kit_table(found).frame
    assert list(found) == ["main", "upright", "lying", "leaning"]
    assert table["shared"].all()
    total = sum(len(design.kit.mesh.nodes) for design in found.values())
    assert table["quantity"].sum() == total
    spans = [np.ptp(design.kit.mesh.nodes[:, 2]) for design in found.values()]
    assert len({round(span) for span in spans}) == 4


def test_shared_nodes_are_the_same_to_the_last_bit(tmp_path):
    first, other = designs(tmp_path, FAMILY).values()
    assert first.kit.nodes.marks == other.kit.nodes.marks
    assert first.kit.joints[0].diameter == other.kit.joints[0].diameter
    assert [joint.height for joint in first.kit.joints] == [joint.height for joint in other.kit.joints]
    for a, b in zip(first.kit.nodes.arms, other.kit.nodes.arms, strict=True):
        assert (a.azimuth.tolist(), a.elevation.tolist()) == (b.azimuth.tolist(), b.elevation.tolist())
    assert len(first.kit.members.marks) != len(other.kit.members.marks)


def test_domes_on_one_rail_share_their_regular_nodes(tmp_path):
    """Three generatrices with one phase (paper §4.4), cut by the ground: supports are their own."""
    data = trimmed(dome(9.0))
    flat = dome(12.0)["generatrix"]
    data |= shape(generatrix={key: flat[key] for key in ("curve", "origin")})
    found = designs(tmp_path, data)
    table = kit_table(found).frame.set_index("mark")
    inner = table[table["kind"] == "interior"]
    assert len(inner) == inner["shared"].sum() == 2
    assert not table.loc[table["kind"] == "support", "shared"].all()
    note = next(note for note in found["main"].notes if note.code == "W-SHAPE-OWN")
    assert all(mark in note.text for mark in table.index[~table["shared"].astype(bool)])


REFUSED = {
    "another angle": (shape(rail={"divide": {"angle_deg": 22.5, "first_deg": 90}}), "E-SHAPE-ANGLE", "22.5000°"),
    "another phase": (
        shape(generatrix={"divide": {"angle_deg": 7, "first_deg": 91}})
        | {"generatrix": FAMILY["generatrix"] | {"divide": {"angle_deg": 7, "first_deg": 90}}},
        "E-SHAPE-PHASE",
        "runs at",
    ),
    "a shape that cannot be": (shape(rail={"divide": {"angle_deg": 100}}), "E-", r"shapes \(other\): rail"),
    "a shape with a wrong key": (shape(rail={"curv": {}}), "E-PROJECT", r"Other: rail.curv"),
    "two shapes of one name": ({"shapes": [{"name": "A b"}, {"name": "a-B"}]}, "E-PROJECT", "names must differ"),
    "a shape named main": ({"shapes": [{"name": "Main"}]}, "E-PROJECT", "names must differ"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_share_nodes_is_refused(case, tmp_path):
    tables, code, words = REFUSED[case]
    with pytest.raises(Refused, match=f"(?s)^{code}.*{words}"):
        designs(tmp_path, {**FAMILY, **tables})


def test_shapes_without_a_common_node_are_refused(tmp_path):
    """The same turning and slopes, but one generatrix swells where the other is hollow."""
    hill = {"kind": "sine", "amplitude": 400, "wavelength": 9000, "waves": 0.5}
    generatrix = {"curve": hill, "axes": "zd", "divide": {"nodes": 3}}
    data = {**FAMILY, "generatrix": generatrix}
    hollow = {"curve": {**hill, "phase_deg": 180}}
    with pytest.raises(Refused, match="E-SHAPE-KIT shapes: none of 4 classes"):
        designs(tmp_path, data | shape(generatrix=hollow))


def test_every_shape_is_a_folder_of_its_own_and_proved(family_folder):
    certificate = verify_folder(family_folder)
    assert certificate.passed, certificate.failures
    status = {check.id: check.status for check in certificate.checks}
    assert {status[name] for name in ("V60", "V61", "V62", "V63")} == {"pass"}
    rows = list(csv.DictReader((family_folder / "tables" / "kit.csv").read_text().splitlines()))
    assert list(rows[0]) == ["mark", "kind", "quantity", "quantity_main", "quantity_tall_one", "shared"]
    inner = json.loads((family_folder / "shapes" / "tall-one" / "manifest.json").read_text())
    assert any(entry["path"] == "nodes/N01.3mf" for entry in inner["files"])


def edit(path, pattern, text):
    before = path.read_bytes().decode()
    after = re.sub(pattern, text, before, count=1, flags=re.MULTILINE)
    assert after != before
    path.write_bytes(after.encode())


def bend(folder):
    path = folder / "shapes" / "tall-one" / "model" / "geometry.npz"
    with np.load(path) as file:
        arrays = dict(file)
    arrays["nodes"][len(arrays["nodes"]) // 2] += [20.0, 0.0, 0.0]
    np.savez(path, **arrays)


def failing(folder, *numbers):
    """Those of some checks that fail."""
    delivery = Delivery(folder)
    return {rule.id for rule in RULES if rule.id in numbers and judge(rule, delivery).status == "fail"}


FAULTS = {
    "V60": lambda folder: (folder / "shapes" / "tall-one" / "panels" / "P01.dxf").unlink(),
    "V61": bend,
    "V62": lambda folder: shutil.copy(folder / "nodes" / "N02.3mf", folder / "shapes/tall-one/nodes/N01.3mf"),
    "V63": lambda folder: edit(folder / "tables" / "kit.csv", r"^(N01,\w+,)(\d+)", r"\g<1>99"),
}


@pytest.mark.parametrize("number", FAULTS)
def test_faults_between_shapes_are_found(number, folder):
    FAULTS[number](folder)
    assert failing(folder, number) == {number}


def test_a_shape_that_was_lost_is_found(folder):
    shutil.rmtree(folder / "shapes" / "tall-one")
    assert failing(folder, "V60", "V61", "V62", "V63") == {"V60", "V61", "V62", "V63"}


def test_schedule_of_one_shape_changed_is_another_part(folder):
    nodes = folder / "shapes" / "tall-one" / "tables" / "nodes.csv"
    edit(nodes, r"^(N02,.*?)(\d+\.\d{4})", r"\g<1>77.7777")
    assert failing(folder, "V62") == {"V62"}


def test_check_prints_the_proof_and_draw_takes_a_shape(project_file, tmp_path):
    path = project_file(FAMILY)
    kit = isomould.check(path).kit
    assert kit is not None
    assert kit.frame["shared"].all()
    pictures = [tmp_path / f"{name}.svg" for name in ("main", "tall-one")]
    for picture in pictures:
        isomould.draw(path, picture, shape=picture.stem)
    assert pictures[0].read_text() != pictures[1].read_text()
    with pytest.raises(Refused, match=r"E-DRAW-SHAPE.*one of main, tall-one"):
        isomould.draw(path, tmp_path / "x.svg", shape="flat")


def test_a_project_of_one_shape_has_no_kit(project_file):
    assert isomould.check(project_file(changed(SMALL))).kit is None


def kept_cells(folder):
    """All cells of all tables but the names of files, which schedules alone leave blank."""
    files = {"file", "files", "solid_file", "drawing_file"}
    tables = {
        path.name: csv.DictReader(path.read_text(encoding="utf-8").splitlines())
        for path in (folder / "tables").iterdir()
    }
    return {name: [{k: v for k, v in row.items() if k not in files} for row in rows] for name, rows in tables.items()}


def test_schedules_of_a_family_are_those_of_its_first_shape(project_file, tmp_path, family_folder):
    run = isomould.Run(effort="quick", jobs=1)
    built = isomould.schedule(project_file(FAMILY), tmp_path / "out", run=run)
    assert built.certificate.passed
    assert "shapes" not in {path.name for path in built.folder.iterdir()}
    assert kept_cells(built.folder) == kept_cells(family_folder)


def test_marks_of_a_former_delivery_belong_to_all_shapes(project_file, tmp_path, family_folder):
    run = isomould.Run(effort="quick", jobs=1, previous=family_folder)
    with pytest.raises(Refused, match="E-SHAPE-PREVIOUS --previous"):
        isomould.build(project_file(FAMILY), tmp_path / "out", run=run)
