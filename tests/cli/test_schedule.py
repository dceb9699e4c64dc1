"""Schedules alone: the same tables as a build gives, proved as far as they go."""

import csv
import json
import shutil

import pytest

import isomould
from museum import DELIVERED, SMALL, changed, write_project


@pytest.fixture(scope="module")
def schedules(tmp_path_factory):
    folder = tmp_path_factory.mktemp("schedules")
    project = write_project(folder / "small.toml", DELIVERED)
    return isomould.schedule(project, folder / "out", run=isomould.Run(effort="quick", jobs=1)).folder


FILES = {"file", "files", "solid_file", "drawing_file"}


def read_tables(folder):
    """Give the rows of every table: the names of files, and all other cells."""
    found = {}
    for path in (folder / "tables").iterdir():
        rows = list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))
        named = [text for row in rows for column, text in row.items() if column in FILES]
        found[path.name] = named, [{c: text for c, text in row.items() if c not in FILES} for row in rows]
    return found


def test_tables_are_those_of_a_build(schedules, built_folder):
    ours, theirs = read_tables(schedules), read_tables(built_folder)
    assert {name: rows for name, (_, rows) in ours.items()} == {name: rows for name, (_, rows) in theirs.items()}


def test_no_files_are_named_that_are_not_there(schedules, built_folder):
    assert not any(text for named, _ in read_tables(schedules).values() for text in named)
    assert any(text for named, _ in read_tables(built_folder).values() for text in named)


def test_nothing_but_schedules_is_written(schedules):
    assert {path.name for path in schedules.iterdir()} == {
        "certificate.json",
        "manifest.json",
        "model",
        "schedules.xlsx",
        "tables",
    }


def test_they_are_proved_and_prove_again(schedules):
    certificate = isomould.verify(schedules, jobs=1)
    assert certificate.passed
    assert {"V1", "V41", "V41b", "V43", "V44", "V46", "V46b", "V47", "V47b", "V47c", "V50"} <= {
        c.id for c in certificate.checks if c.status == "pass"
    }


def test_a_delivery_does_not_pass_for_schedules(built_folder, tmp_path):
    """Who claims less to be proved less is found by the files that he cannot explain."""

    copied = tmp_path / "claimed"
    shutil.copytree(built_folder, copied)
    manifest = json.loads((copied / "manifest.json").read_text())
    (copied / "manifest.json").write_text(json.dumps(manifest | {"scope": "schedules"}))
    failures = {check.id: check.reason for check in isomould.verify(copied, jobs=1).failures}
    assert "is no schedule" in failures["V50"]


def test_sheets_that_are_nearly_all_waste_are_noted(tmp_path):
    """A sheet in the wrong unit: 40 m wide."""
    sheets = [{**SMALL["stock"]["sheets"][0], "width": "40 m", "height": "25 m"}]
    project = write_project(tmp_path / "wide.toml", changed(SMALL, stock={"sheets": sheets}))
    built = isomould.schedule(project, tmp_path / "out", run=isomould.Run(effort="quick", jobs=1))
    (note,) = [note for note in built.design.notes if note.code == "W-NEST-WASTE"]
    assert "% of the sheets is waste" in note.text
