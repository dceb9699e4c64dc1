"""Delivered folders of capped, faceted and finned nodes, whole and spoilt: every check of details finds its fault."""

import json
import re
import shutil
import zipfile
from pathlib import Path

import ezdxf
import pytest
from verify_museum import edit_table

import isomould
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.rules import judge
from museum import BARE, SMALL, changed, write_project

BY_ID = {rule.id: rule for rule in RULES}
TINY = changed(
    {key: table for key, table in SMALL.items() if key not in {"stock", "deliver"}},
    rail={"curve": {"kind": "parabola", "span": "5 m", "rise": "1 m"}, "divide": {"nodes": 2}},
    generatrix={"curve": {"kind": "arc", "span": "5 m", "rise": "0.6 m"}, "divide": {"nodes": 2}},
)
DESIGNS = {
    "capped": changed(TINY, nodes={"retention": "lipped-cap"}, members={"parallel": "FL200*15"}),
    "faceted": changed(TINY, nodes={"detail": "faceted"}, members={"section": "RHS 100x50x4"}),
    "finned": changed(
        TINY, nodes={"detail": "finned"}, members={"parallel": "FL200*15"}, deliver={**BARE, "solids": ["members"]}
    ),
}


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The folders, by name."""
    folder = tmp_path_factory.mktemp("details")
    run = isomould.Run(effort="quick", jobs=1)
    projects = {name: write_project(folder / f"{name}.toml", data) for name, data in DESIGNS.items()}
    return {name: isomould.build(path, folder / name, run=run).folder for name, path in projects.items()}


SILENT = {
    "capped": {"V37c", "V37d", "V38b", "V38d", "V38e"},
    "faceted": {"V37b", "V38", "V38d", "V38e", "V39b"},
    "finned": {"V37b", "V37c", "V38", "V38b", "V39b"},
}


@pytest.mark.parametrize(("name", "silent"), SILENT.items())
def test_details_are_proved_with_something_to_prove(built, name, silent):
    checks = {rule: judge(BY_ID[rule], Delivery(built[name])) for rule in BY_ID if re.match("V3[7-9]", rule)}
    assert {rule for rule, check in checks.items() if check.status == "not_applicable"} == silent
    assert all(check.status == "pass" and check.count > 0 for rule, check in checks.items() if rule not in silent)


def test_solids_of_drilled_members_are_their_outlines(built):
    found = judge(BY_ID["V27c"], Delivery(built["finned"]))
    assert (found.status, found.count > 0) == ("pass", True), found


def edit_row(name, change):
    return edit_table(name, lambda rows: change(rows[0]))


def put(column, text):
    return lambda row: row.update({column: text})


def edit_solid(pattern, change):
    """Change all x coordinates of a solid."""

    def seed(folder):
        path = sorted(folder.glob(pattern))[0]
        with zipfile.ZipFile(path) as package:
            parts = {name: package.read(name) for name in package.namelist()}
        model = parts["3D/3dmodel.model"].decode()
        moved = re.sub(r'vertex x="([^"]+)"', lambda found: f'vertex x="{change(float(found[1]))!r}"', model)
        with zipfile.ZipFile(path, "w") as package:
            for name, content in (parts | {"3D/3dmodel.model": moved.encode()}).items():
                package.writestr(name, content)

    return seed


def edit_drawing(pattern, layer, change):
    def seed(folder):
        path = sorted(folder.glob(pattern))[0]
        document = ezdxf.readfile(path)
        change(next(entity for entity in document.modelspace() if entity.dxf.layer == layer))
        document.saveas(path)

    return seed


def move_points(chosen, by):
    """Shift the points of a polyline that are chosen by their (x, y)."""

    def change(polyline):
        points = [tuple(p) for p in polyline.get_points("xyb")]
        moved = [(x + by[0], y + by[1], b) if chosen(x, y) else (x, y, b) for x, y, b in points]
        polyline.set_points(moved, format="xyb")

    return change


def edit_design(table, key, value):
    def seed(folder):
        path = folder / "model" / "design.json"
        design = json.loads(path.read_text("utf-8"))
        design[table][key] = value
        path.write_text(json.dumps(design), "utf-8")

    return seed


def other_plate(row):
    row["section_1"] = {"FL200*12": "FL200*15", "FL200*15": "FL200*12"}[row["section_1"]]


def edit_nc1(pattern, change):
    """Change the first match of a pattern in the first NC1 file of the fittings."""

    def seed(folder):
        path = sorted(folder.glob("fittings/*.nc1"))[0]
        text = path.read_bytes().decode("ascii")
        spoilt = re.sub(pattern, change, text, count=1)
        assert spoilt != text
        path.write_bytes(spoilt.encode("ascii"))

    return seed


def copy_nc1(folder):
    shutil.copy(sorted(folder.glob("fittings/*.nc1"))[0], folder / "fittings" / "F99.nc1")


def anywhere(_x, _y):
    return True


def at_free_end(x, _y):
    return x > 60


def at_notch_floor(x, y):
    return x < 100 and 90 < y < 99 and x > 30


def move_hole(x, y=0.0):
    def change(circle):
        circle.dxf.center = (circle.dxf.center.x + x, circle.dxf.center.y + y)

    return change


def grow(circle):
    circle.dxf.radius += 0.1


SEEDS = {
    "margin": ("capped", "V37", edit_row("node_limits", put("margin_mm", "99"))),
    "limit broken": ("faceted", "V37", edit_row("node_limits", put("required_mm", "999"))),
    "web asked for": ("capped", "V37b", edit_design("node", "min_web_mm", 60.0)),
    "web between holes asked for": ("faceted", "V37c", edit_design("node", "min_web_mm", 60.0)),
    "drum turned out of round": ("capped", "V38", edit_solid("nodes/*.3mf", lambda x: 1.001 * x)),
    "facets moved": ("faceted", "V38b", edit_solid("nodes/*.3mf", lambda x: 1.001 * x)),
    "notch filled": ("capped", "V38c", edit_drawing("members/*.dxf", "CUT", move_points(at_notch_floor, (0, 4)))),
    "member shifted": ("faceted", "V38c", edit_drawing("members/*.dxf", "CUT", move_points(anywhere, (0.05, 0)))),
    "access hole moved": (
        "faceted", "V38c", edit_drawing("members/*.dxf", "CUT_INNER", move_points(anywhere, (0, 0.1)))
    ),
    "hole in the tube": (
        "faceted", "V25", edit_drawing("members/*.dxf", "CUT_INNER", move_points(lambda x, y: y > -25, (0, 3)))
    ),
    "plates as thick as others": ("capped", "V38", edit_row("nodes", other_plate)),
    "mass of caps": ("capped", "V39", edit_row("fittings", put("mass_kg", "0.5"))),
    "bolt hole of an end plate": ("faceted", "V39", edit_drawing("fittings/*.dxf", "DRILL", grow)),
    "cap squashed flat": ("capped", "V39b", edit_solid("fittings/*.3mf", lambda x: 0.0)),
    "one bolt less": ("faceted", "V39c", edit_row("hardware", put("pieces", "1"))),
    "hole of a member moved": ("finned", "V38c", edit_drawing("members/*.dxf", "DRILL", move_hole(0.02))),
    "bolt that meets no fin": ("finned", "V38d", edit_drawing("members/*.dxf", "DRILL", move_hole(0.0, 0.02))),
    "hole at the edge of a member": ("finned", "V37d", edit_drawing("members/*.dxf", "DRILL", move_hole(0.0, -40.0))),
    "hole at the edge of a fin": ("finned", "V37d", edit_drawing("fittings/*.dxf", "DRILL", move_hole(2.0))),
    "hole of a fin moved": ("finned", "V38e", edit_drawing("fittings/*.dxf", "DRILL", move_hole(0.02))),
    "fin too long": ("finned", "V38e", edit_drawing("fittings/*.dxf", "CUT", move_points(at_free_end, (0.02, 0)))),
    "fins out of place": ("finned", "V38e", edit_solid("nodes/*.3mf", lambda x: 1.001 * x)),
    "fins of another arm": ("finned", "V38e", edit_row("node_fittings", put("fitting", "F02"))),
    "fins of a node less": ("finned", "V39c", edit_row("node_fittings", put("total_pieces", "2"))),
    "mass of fins": ("finned", "V39", edit_row("fittings", put("mass_kg", "0.5"))),
    "one nut less": ("finned", "V39c", edit_table("hardware", lambda rows: rows[1].update(pieces="3"))),
    "a hole that is not there": ("finned", "V20", edit_row("nodes", put("holes", "10"))),
    "arc of an end plate": ("faceted", "V42f", edit_nc1(r"(u +\d+\.\d\d) {6}4\.00", r"\1      4.10")),
    "hole of an end plate": ("faceted", "V42f", edit_nc1(r"BO\r\n  v( +)2", r"BO\r\n  v\g<1>3")),
    "hole of a fin told elsewhere": ("finned", "V42f", edit_nc1(r"BO\r\n  v( +)\d", r"BO\r\n  v\g<1>7")),
    "too many fins told": ("finned", "V42g", edit_nc1(r"S355\r\n  (\d+)", r"S355\r\n  9\1")),
    "fins of another grade": ("finned", "V42g", edit_nc1(r"S355", "S235")),
    "thicker fins told": ("finned", "V42g", edit_nc1(r"      8\.00", "     10.00")),
    "NC1 of no fitting": ("finned", "V42g", copy_nc1),
    "caps of another mass in all": ("capped", "V44", edit_row("fittings", put("total_mass_kg", "1"))),
    "caps of one node less": ("capped", "V39c", edit_row("fittings", put("quantity", "2"))),
}  # fmt: skip


@pytest.mark.parametrize("name", SEEDS)
def test_every_fault_is_found(built, tmp_path, name):
    which, rule, seed = SEEDS[name]
    folder = Path(shutil.copytree(built[which], tmp_path / "delivered"))
    seed(folder)
    check = judge(BY_ID[rule], Delivery(folder))
    assert check.status == "fail", check
    assert "could not run" not in check.reason
