"""The worked example: the page says what the arithmetic gives, and the program's schedules say the same."""

import re
import tomllib
from pathlib import Path

import pytest
import worked_by_hand as hand
import worked_rows as rows
from worked_details import detail_steps
from worked_nc1 import NUMBER as ORDER
from worked_nc1 import nc1_file
from worked_steps import steps
from worked_templates import other_templates

from isomould.design import kit_settings, make_design
from isomould.documents.member_files import member_nc_parts
from isomould.documents.schedules import part_tables
from isomould.documents.table import cells
from isomould.parts.solid import make_solids
from isomould.project.load import load_project
from isomould.writers.nc1 import NcOrder, nc1_text
from museum import TEMPLATES

TEMPLATE = TEMPLATES / "barrel-vault.toml"
PAGE = (Path(__file__).parents[2] / "docs" / "worked-example.md").read_text(encoding="utf-8")
NODE, MEMBER, PANEL = (5, 7), (5, 7, 1, 0), (5, 7)
SYMBOL = re.compile(r"^\| `([^`]+)` \|.*\| ([^|]+) \|$", re.MULTILINE)
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
NESTED = {"bar", "position_mm", "sheet", "x_mm", "y_mm", "rotation_deg", "turned_over"}
"""Columns of the instances that the nesting fills."""


@pytest.fixture(scope="module")
def design():
    """The program's design of the template."""
    loaded = load_project(TEMPLATE)
    return make_design(loaded.project, loaded.folder)


@pytest.fixture(scope="module")
def schedules(design) -> dict[str, list[dict]]:
    """Rows of the program's tables by name."""
    return schedule_rows(design)


def schedule_rows(design) -> dict[str, list[dict]]:
    solids = make_solids(design.kit.nodes, design.kit.joints)
    tables = part_tables(design.kit, kit_settings(design.project), solids, {}, {}, drawn=True)
    return {table.name: _rows(table) for table in tables}


def _rows(table) -> list[dict]:
    names = [column.name for column in table.columns]
    lines = zip(*(cells(table, column) for column in table.columns), strict=True)
    return [dict(zip(names, line, strict=True)) for line in lines]


def test_constants_are_those_of_the_template():
    data = tomllib.loads(TEMPLATE.read_text(encoding="utf-8"))
    wave, panels = data["generatrix"], data["panels"]
    assert data["rail"]["curve"] == {"kind": "parabola", "span": "24 m", "rise": "9 m"}
    assert (24000, 9000, data["rail"]["divide"]["nodes"]) == (hand.SPAN, hand.RISE, hand.INNER)
    assert wave["curve"] == {"kind": "sine", "amplitude": "1 m", "wavelength": "14 m", "waves": hand.WAVES}
    assert (1000, 14000, wave["divide"]["per_arc"]) == (hand.AMPLITUDE, hand.WAVELENGTH, hand.PER_ARC)
    assert data["members"]["section"] == {"kind": "plate", "depth": hand.DEPTH, "thickness": hand.THICK}
    assert (data["members"]["grade"], data["nodes"]["bore"]) == (hand.GRADE, hand.BORE)
    given = (hand.GLASS, hand.GAP, hand.SPACER, hand.SEAT_WIDTH, hand.SEAT_HEIGHT)
    assert given == tuple(panels[key] for key in ("thickness", "gap", "spacer", "seat_width", "seat_height"))
    assert {key: data["tolerances"][key] for key in ("length", "angle_deg")} == {"length": 0.5, "angle_deg": 0.05}


def test_every_step_of_the_page_is_what_the_arithmetic_gives():
    page, expected = dict(SYMBOL.findall(PAGE)), steps() | detail_steps() | other_templates()
    assert page.keys() == expected.keys()
    wrong = {symbol: text for symbol, text in page.items() if not _says(text, expected[symbol])}
    assert not wrong


def _says(text: str, values) -> bool:
    """Whether printed numbers are the values, rounded to as many decimals as are printed."""
    found = NUMBER.findall(text)
    return len(found) == len(values) and all(
        abs(float(number) - value) <= 0.5 * 10.0 ** -len(number.partition(".")[2]) + 1e-9
        for number, value in zip(found, values, strict=True)
    )


@pytest.mark.parametrize(
    ("title", "expected"),
    [
        ("The node", (rows.node_row(*NODE), rows.node_instance_row(*NODE))),
        ("The member", (rows.member_row(*MEMBER), rows.member_instance_row(*MEMBER))),
        ("The panel", (rows.panel_row(*PANEL), rows.panel_instance_row(*PANEL))),
    ],
)
def test_the_rows_of_the_page_are_what_the_arithmetic_gives(title, expected):
    printed = {name: _text(name, value) for row in expected for name, value in row.items()}
    assert _page_row(title) == printed


def _page_row(title: str) -> dict[str, str]:
    """Cells of the table below a heading: two columns and their values a line."""
    table = PAGE.partition(f"### {title}:")[2].partition("\n#")[0]
    lines = [line for line in table.splitlines() if line.startswith("|")][2:]
    found = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines]
    return {name: value for line in found for name, value in (line[:2], line[2:]) if name}


def _text(name: str, value) -> str:
    return rows.text(value, rows.decimals(name)) if isinstance(value, float) else str(value)


def _node(row: dict) -> tuple[int, ...]:
    return tuple(int(number) for number in row["location"].split("-")[1:])


def _member(row: dict) -> tuple[int, ...]:
    return *_node(row), *((1, 0) if row["location"].startswith("MG") else (0, 1))


INSTANCES = {
    "node_instances": (_node, rows.node_instance_row, NODE),
    "member_instances": (_member, rows.member_instance_row, MEMBER),
    "panel_instances": (_node, rows.panel_instance_row, PANEL),
}
CLASSES = {
    "nodes": (rows.node_classes, rows.node_row, NODE),
    "members": (rows.member_classes, rows.member_row, MEMBER),
    "panels": (rows.panel_classes, rows.panel_row, PANEL),
}


@pytest.mark.parametrize("table", [*CLASSES, *INSTANCES])
def test_the_program_schedules_the_parts_of_the_page(schedules, table):
    by_hand = (CLASSES | INSTANCES)[table]
    name = "mark" if table in CLASSES else "location"
    expected = by_hand[1](*by_hand[2])
    assert _differences(next(row for row in schedules[table] if row[name] == expected[name]), expected) == {}


def test_the_nc1_file_of_the_page_is_what_the_arithmetic_and_the_program_give(design):
    printed = PAGE.partition("```text\nST\n")[2].partition("```")[0].splitlines()
    assert ["ST", *printed] == nc1_file(*MEMBER)
    order = NcOrder(design.project.project.number)
    parts = {part.mark: part for part in member_nc_parts(design.kit.members, design.project.members, "kg/m")}
    assert order.order == ORDER
    assert nc1_text(parts["M008"], order).splitlines() == nc1_file(*MEMBER)


@pytest.mark.parametrize("table", INSTANCES)
def test_every_instance_of_the_design_agrees(schedules, table):
    place, by_hand, _ = INSTANCES[table]
    wrong = {row["location"]: _differences(row, by_hand(*place(row))) for row in schedules[table]}
    assert not {where: found for where, found in wrong.items() if found}


@pytest.mark.parametrize("table", CLASSES)
def test_every_class_of_the_design_agrees(schedules, table):
    classes, by_hand, _ = CLASSES[table]
    founders = {}
    for place, (number, _) in classes().items():
        founders.setdefault(number, place)
    assert len(schedules[table]) == len(founders)
    pairs = zip(schedules[table], founders.values(), strict=True)
    wrong = {row["mark"]: _differences(row, by_hand(*place)) for row, place in pairs}
    assert not {mark: found for mark, found in wrong.items() if found}


def _differences(row: dict, expected: dict) -> dict:
    """Columns of the program's row that are not the arithmetic's, or that it does not know."""
    said = {name: value for name, value in row.items() if value not in (None, "") and name not in NESTED}
    unknown = {name: value for name, value in said.items() if name not in expected}
    return unknown | {k: (row[k], v) for k, v in expected.items() if not _same(k, row[k], v)}


def _same(name: str, got, value) -> bool:
    """The same word, the same whole number, or the same number to the last printed digit."""
    if value == "L or R":  # the specification does not say which panel of a pair is called L
        return got in ("L", "R")
    if not isinstance(value, float):
        return got == value
    return abs(got - rows.printed(value, rows.decimals(name))) <= 1e-3 * 10.0 ** -rows.decimals(name)
