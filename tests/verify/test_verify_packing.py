"""Packing lists of a delivered folder are proved; seeded faults are found."""

import csv
import shutil
from pathlib import Path

import pytest
from verify_museum import edit_table

from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.rules import judge

BY_ID = {rule.id: rule for rule in RULES}


@pytest.fixture
def folder(built_folder, tmp_path):
    return Path(shutil.copytree(built_folder, tmp_path / "delivered"))


def rows(folder, name):
    with (folder / "tables" / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("rule", ["V47", "V47b", "V47c"])
def test_the_good_folder_passes(built_folder, rule):
    found = judge(BY_ID[rule], Delivery(built_folder))
    assert found.status == "pass", found
    assert found.count > 0


def test_what_a_site_reads(built_folder):
    """A first row's crate has its nodes, the members that start there, the panels above."""
    crates, packing = rows(built_folder, "crates"), rows(built_folder, "packing")
    first = [row for row in crates if row["crate"] == "R-00"]
    assert [row["part"] for row in first] == sorted(
        (row["part"] for row in first), key=("node", "member", "panel").index
    )
    places = [where for row in first for where in row["locations"].split(";")]
    assert all(where.split("-")[1] == "00" for where in places)
    node = next(row for row in packing if row["location"] == "N-01-01")
    assert {name.split()[1] for name in node["members"].split(";")} == {"MG-00-01", "MG-01-01", "MP-01-00", "MP-01-01"}
    assert {name.split()[1] for name in node["panels"].split(";")} == {"P-00-00", "P-00-01", "P-01-00", "P-01-01"}
    quantity = {
        row["mark"]: int(row["quantity"]) for name in ("nodes", "members", "panels") for row in rows(built_folder, name)
    }
    assert sum(int(row["quantity"]) for row in crates) == sum(quantity.values())


def cell(name, change, row=0):
    return lambda lines: lines[row].update({name: change(lines[row][name])})


SEEDS = {
    "another crate": ("V47", edit_table("crates", cell("crate", lambda _: "R-01"))),
    "a line lost": ("V47", edit_table("crates", lambda lines: lines.pop())),
    "a piece twice": ("V47", edit_table("crates", cell("locations", lambda text: text + ";" + text.split(";")[0]))),
    "another mark": ("V47", edit_table("crates", cell("mark", lambda _: "N99"))),
    "one more": ("V47b", edit_table("crates", cell("quantity", lambda text: str(int(text) + 1)))),
    "too light": ("V47b", edit_table("crates", cell("mass_kg", lambda text: f"{float(text) - 0.001:.3f}"))),
    "total": ("V47b", edit_table("crates", cell("total_mass_kg", lambda text: f"{float(text) + 0.001:.3f}"))),
    "arms in another order": (
        "V47c",
        edit_table("packing", cell("members", lambda t: ";".join(t.split(";")[::-1]), 8)),
    ),
    "a panel left out": ("V47c", edit_table("packing", cell("panels", lambda t: t.rpartition(";")[0], 8))),
    "a node of another mark": ("V47c", edit_table("packing", cell("mark", lambda _: "N99"))),
    "a node in another crate": ("V47c", edit_table("packing", cell("crate", lambda _: "R-07"))),
    "a node left out": ("V47c", edit_table("packing", lambda lines: lines.pop())),
}


@pytest.mark.parametrize("name", SEEDS)
def test_every_fault_is_found(folder, name):
    rule, seed = SEEDS[name]
    seed(folder)
    found = judge(BY_ID[rule], Delivery(folder))
    assert found.status == "fail", found
    assert found.reason
