"""Every sum that must agree agrees in a delivery, and fails when a cell of either side is another."""

from dataclasses import replace

import pytest

import isomould
from isomould.documents.live import Given
from isomould.documents.reconciliations import reconcile
from museum import SMALL, changed, write_project


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sums")
    project = write_project(folder / "small.toml", changed(SMALL, deliver={"strips": []}))
    return isomould.schedule(project, folder / "out", run=isomould.Run(effort="quick", jobs=1)).tables


def test_all_agree(tables):
    checks = reconcile(tables)
    assert len(checks) == 12
    assert {check.status for check in checks} == {"pass"}


def altered(table, column):
    """Give a table whose first cell of a column is one more."""
    frame = table.frame.copy()
    frame.loc[frame.index[0], column] += 1
    return replace(table, frame=frame)


@pytest.mark.parametrize(
    ("path", "failing"),
    [
        ("nodes.quantity", {"Node quantities = nodes", "Arms of nodes = ends of members"}),
        ("nodes.valence", {"Arms of nodes = ends of members"}),
        ("members.quantity", {"Member quantities = members", "Arms of nodes = ends of members"}),
        ("panels.quantity", {"Panel quantities = panels", "Area × quantity = panel area (m²)"}),
        ("panels.total_area_m2", {"Area on sheets = panel area (m²)", "Area × quantity = panel area (m²)"}),
        ("panels.mass_kg", {"Mass transported = mass of parts (t)"}),
        ("sheets.parts", {"Parts on sheets = panels"}),
        ("sheets.part_area_m2", {"Area on sheets = panel area (m²)"}),
        ("sheets.price", {"Price of sheets = their lines of the cost"}),
        ("bars.pieces", {"Pieces on bars = members"}),
        ("bars.price", {"Price of bars = their lines of the cost"}),
    ],
)
def test_another_number_is_found(tables, path, failing):
    name, _, column = path.partition(".")
    changed_tables = [altered(table, column) if table.name == name else table for table in tables]
    found = {check.what for check in reconcile(changed_tables) if check.status == "fail"}
    assert failing <= found
    assert found - failing <= {"Mass transported = mass of parts (t)"}


def test_a_line_of_no_group_is_found(tables):
    (cost,) = (table for table in tables if table.name == "cost")
    frame = cost.frame.copy()
    frame.loc[0, "group"] = "Elsewhere"
    checks = reconcile([replace(cost, frame=frame)])
    assert [(check.what, check.status) for check in checks] == [("Sub-totals = lines of the cost", "fail")]


def test_differences_count_both_ways(tables):
    check = reconcile(tables)[0]
    assert replace(check, expected=Given(check.found.value + 1)).status == "fail"
    assert replace(check, expected=Given(check.found.value - 1)).status == "fail"
