"""Revisions: marks of unchanged parts stay, others are new for ever."""

import copy
import csv
import shutil

import pytest

import isomould
from isomould.errors import Refused
from museum import SMALL, write_project

PARTS = ("nodes", "members", "panels")


def build(folder, name, data, previous=None):
    project = write_project(folder / f"{name}.toml", data)
    return isomould.build(project, folder / name, run=isomould.Run(effort="quick", jobs=1, previous=previous)).folder


def read(folder, name):
    with (folder / "tables" / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def places(folder, part):
    return {row["location"]: row["mark"] for row in read(folder, f"{part}_instances")}


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Three revisions: A; B longer in the middle, with the same angles; C as A was."""
    folder = tmp_path_factory.mktemp("revisions")
    first = copy.deepcopy(SMALL)
    first["rail"]["divide"] = {"angle_deg": 18}
    first["stock"].pop("bars")
    first["deliver"] = {"drawings": False}
    second = copy.deepcopy(first)
    second["rail"]["curve"] = {"kind": "parabola", "span": "8.4 m", "rise": "2.52 m"}
    a = build(folder, "a", first)
    b = build(folder, "b", second, a)
    return a, b, build(folder, "c", first, b), build(folder, "again", first, a)


def test_the_same_design_keeps_every_mark(folders):
    a, *_, again = folders
    assert all(places(a, part) == places(again, part) for part in ("node", "member", "panel"))
    assert {row["status"] for row in read(again, "revision")} == {"unchanged"}


def test_nodes_of_another_rail_with_the_same_angle_keep_their_marks(folders):
    a, b, *_ = folders
    status = {row["mark"]: row["status"] for row in read(b, "revision")}
    assert {status[row["mark"]] for row in read(b, "nodes")} == {"unchanged"}
    assert places(a, "node") == places(b, "node")


def test_marks_of_dropped_parts_never_come_back(folders):
    a, b, c, _ = folders
    dropped = {row["mark"] for row in read(b, "revision") if row["status"] == "dropped"}
    assert dropped
    assert dropped <= {row["mark"] for row in read(a, "members") + read(a, "panels")}
    assert dropped == {row["mark"] for row in read(c, "revision") if row["status"] == "retired"}
    assert not dropped & {row["mark"] for part in PARTS for row in read(c, part)}


def test_changed_parts_say_what_they_replace(folders):
    a, b, *_ = folders
    before, now = places(a, "panel"), places(b, "panel")
    for row in read(b, "revision"):
        if row["part"] == "panel" and row["status"] == "changed":
            there = {before[where] for where, mark in now.items() if mark == row["mark"]}
            assert set(row["replaces"].split(";")) == there


def test_files_carry_the_kept_marks(folders):
    _, b, *_ = folders
    assert {path.stem for path in (b / "panels").glob("*.dxf")} == {row["mark"] for row in read(b, "panels")}


def test_a_changed_folder_is_no_former_delivery(folders, tmp_path):
    copied = tmp_path / "former"
    copied.mkdir()
    with pytest.raises(Refused, match=r"E-PREVIOUS --previous .*manifest.json is missing"):
        build(tmp_path, "new", SMALL, copied)


def test_the_certificate_finds_a_revision_that_lies(folders, tmp_path):
    copied = tmp_path / "b"
    shutil.copytree(folders[1], copied)
    table = copied / "tables" / "revision.csv"
    table.write_bytes(
        table.read_bytes()
        .replace(b",dropped,", b",unchanged,", 1)
        .replace(b"N01,node,unchanged,", b"N01,node,dropped,")
    )
    failed = {check.id for check in isomould.verify(copied, jobs=1).failures}
    assert "V43i" in failed
