"""Parquet files beside the CSV files: the same tables, proved equal."""

import shutil

import pandas as pd
import pytest

import isomould
from isomould.errors import Refused
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.rules import judge
from isomould.writers import parquet
from museum import SMALL, changed, write_project

DATA = {**changed(SMALL, deliver={"parquet": True, "strips": []}), "stock": {}}
V41D = next(rule for rule in RULES if rule.id == "V41d")


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    folder = tmp_path_factory.mktemp("parquet")
    project = write_project(folder / "small.toml", DATA)
    return isomould.schedule(project, folder / "out", run=isomould.Run(effort="quick", jobs=1))


def test_pandas_reads_the_frames_of_the_api(built):
    for name, frame in isomould.frames(built).items():
        found = pd.read_parquet(built.folder / "tables" / f"{name}.parquet")
        pd.testing.assert_frame_equal(found, frame, check_dtype=False, check_exact=True)
        assert found.dtypes.astype(str).drop(_texts(frame)).equals(frame.dtypes.astype(str).drop(_texts(frame))), name


def _texts(frame):
    return [name for name in frame if frame[name].dtype == object]


def test_the_certificate_compares_them(built):
    (check,) = [check for check in built.certificate.checks if check.id == "V41d"]
    assert (check.status, check.worst) == ("pass", 0)
    assert check.count > 500


def test_the_same_project_gives_the_same_bytes(built, tmp_path):
    table = next(table for table in built.tables if table.name == "panels")
    parquet.write_parquet(tmp_path / "panels.parquet", table)
    assert (tmp_path / "panels.parquet").read_bytes() == (built.folder / "tables" / "panels.parquet").read_bytes()


def test_another_number_or_a_lost_file_is_found(built, tmp_path):
    folder = shutil.copytree(built.folder, tmp_path / "copy")
    path = folder / "tables" / "members.parquet"
    frame = pd.read_parquet(path)
    frame.assign(quantity=frame["quantity"] + 1).to_parquet(path, index=False)
    (folder / "tables" / "nodes.parquet").unlink()
    reason = judge(V41D, Delivery(folder)).reason
    assert "tables/nodes.parquet has no twin" in reason


def test_other_columns_are_found(built, tmp_path):
    folder = shutil.copytree(built.folder, tmp_path / "copy")
    path = folder / "tables" / "members.parquet"
    frame = pd.read_parquet(path)
    frame.assign(quantity=frame["quantity"] + 1).to_parquet(path, index=False)
    assert "tables/members.parquet quantity row 2" in judge(V41D, Delivery(folder)).reason
    frame.drop(columns="grade").to_parquet(path, index=False)
    assert "tables/members.parquet has other columns" in judge(V41D, Delivery(folder)).reason


def test_without_pyarrow_it_is_refused_before_anything_is_computed(built, monkeypatch, tmp_path):
    monkeypatch.setattr(parquet, "find_spec", lambda name: None)
    project = write_project(tmp_path / "small.toml", DATA)
    with pytest.raises(Refused, match=r"E-PARQUET deliver\.parquet: .*pip install 'isomould\[parquet\]'"):
        isomould.schedule(project, tmp_path / "out")
