"""Project files: what is read, and what is refused with which words."""

import pytest

from isomould.errors import Refused
from isomould.project.load import load_project, validate
from isomould.templates import template_names
from museum import SMALL, TEMPLATES, changed


@pytest.mark.parametrize("name", template_names())
def test_templates_are_valid(name):
    project = load_project(TEMPLATES / f"{name}.toml").project
    assert project.schema_ == 1


def test_lengths_take_units(project_file):
    path = project_file(changed(SMALL, panels={"gap": "1/2 in", "spacer": "0.3 cm"}))
    panels = load_project(path).project.panels
    assert (panels.gap, panels.spacer) == (12.7, 3.0)


def test_overrides_come_before_validation(project_file):
    loaded = load_project(project_file(SMALL), ['rail.curve.rise="3 m"', "rail.divide.nodes=5", "project.name=New"])
    assert (loaded.project.rail.curve.rise, loaded.project.rail.divide.nodes) == (3000.0, 5)
    assert loaded.project.project.name == "New"


BROKEN = {
    "unknown key": ({"rail": {"divid": {"nodes": 3}}}, ["rail.divid", "unknown key", "'divide'"]),
    "unknown key in a curve": ({"rail": {"curve": {"kind": "parabola", "span": 8000, "rize": 2}}}, ["rise"]),
    "unknown table": ({"panel": {"gap": 3}}, ["panel", "'panels'"]),
    "wrong unit": ({"panels": {"gap": "12 cubits"}}, ["panels.gap", "12 cubits", "mm, cm, m, in, ft"]),
    "decimal comma": (
        {"panels": {"gap": "12,5 mm"}},
        ["panels.gap: '12,5 mm' has a decimal comma", "Write a decimal point: 12.5 mm"],
    ),
    "a flag for a length": ({"panels": {"gap": True}}, ["panels.gap", "True is not a length"]),
    "a length beyond floats": ({"panels": {"gap": "1e400 m"}}, ["panels.gap", "1e400 m", "at most 1e+09 mm"]),
    "an exponent without end": (
        {"panels": {"gap": "1e99999999 m"}},
        ["panels.gap", "1e99999999 m", "a number and one of mm"],
    ),
    "a text without end": ({"panels": {"gap": "9" * 100_000 + " m"}}, ["panels.gap", "a number and one of mm"]),
    "a length of nothing": ({"nodes": {"bore": 5e-324}}, ["nodes.bore", "5e-324. Limit: at least 0.001 mm"]),
    "a number of nothing": ({"members": {"density": 1e-300}}, ["members.density", "1e-300. Limit: at least 1e-09"]),
    "less than no sheets": (
        {"stock": {"sheets": [{"name": "S", "width": 4000, "height": 2500, "quantity": -1}]}},
        ["stock.sheets.0.quantity: -1 of them. Limit: at least 1"],
    ),
    "a layer of DXF itself": ({"deliver": {"layers": {"CUT": "Defpoints"}}}, ["deliver.layers", "DEFPOINTS"]),
    "two processes on a layer": ({"deliver": {"layers": {"CUT": "engrave"}}}, ["deliver.layers", "ENGRAVE"]),
    "a whole number beyond floats": ({"panels": {"gap": 10**400}}, ["panels.gap", "at most 1e+09 mm"]),
    "a gap that is no gap": ({"panels": {"spacer": 1e15}}, ["panels.spacer", "at most 1e+09 mm"]),
    "a number whose square overflows": (
        {"rail": {"curve": {"kind": "polyline", "points": [[0, 0], [1e300, 9]]}}},
        ["rail.curve.points.1.0", "1e+300. Limit: between -1e+12 and 1e+12"],
    ),
    "a count beyond floats": ({"rail": {"divide": {"nodes": 10**400}}}, ["rail.divide.nodes"]),
    "a list that is too short": ({"generatrix": {"origin": []}}, ["generatrix.origin.0", "missing"]),
    "a number for a date": ({"project": {"date": 0}}, ["project.date", "0 is not a date"]),
    "a pole beyond the equator": (
        {"surface": {"kind": "isogonal", "min_pole_angle_deg": 90}},
        ["min_pole_angle_deg", "less than 90"],
    ),
    "waves without end": (
        {"rail": {"curve": {"kind": "sine", "amplitude": 1, "wavelength": 9, "waves": 1e9}}},
        ["rail.curve.waves", "1000"],
    ),
    "negative": ({"panels": {"thickness": -3}}, ["panels.thickness", "-3"]),
    "two ways to divide": ({"rail": {"divide": {"nodes": 3, "angle_deg": 4}}}, ["nodes and angle_deg exclude"]),
    "float for a count": ({"rail": {"divide": {"nodes": 3.5}}}, ["rail.divide.nodes", "3.5"]),
    "unknown kind": ({"surface": {"kind": "blob"}}, ["surface.kind", "'isogonal'"]),
    "kind without one angle": ({"rail": {"divide": {"stations": 4}}}, ["surface.kind = 'isogonal'", "angle_deg"]),
    "phase without edge offset": ({"generatrix": {"divide": {"phase": "centre"}}}, ["edge-offset"]),
    "line break in the name": ({"project": {"name": "a\nb"}}, ["project.name", "control characters"]),
    "direction override in the name": ({"project": {"name": "a\u202eb"}}, ["project.name"]),
    "kerf over gap": ({"stock": {"gap": 1, "kerf": 3}}, ["gap 1 mm is too narrow", "the kerf of 3 mm"]),
    "classes wider than the gaps": (
        {"panels": {"gap": 2}, "tolerances": {"length": 1.5}},
        ["1.5 mm", "panels.gap = 2 mm"],
    ),
    "classes without limits": ({"tolerances": {"angle_deg": 30}}, ["tolerances.angle_deg", "0.5"]),
    "decimal comma in a number": (
        {"rail": {"divide": {"angle_deg": "12,5"}}},
        ["angle_deg: '12,5'. Limit: a valid number. Write a decimal point: 12.5."],
    ),
    "a text too long": ({"members": {"grade": "x" * 30}}, ["Limit: at most 24 characters"]),
    "a value for a table": ({"members": 5}, ["members: 5. Limit: a table"]),
    "half an arc": (
        {"rail": {"curve": {"kind": "arc", "radius": 3}}},
        ["rail.curve: keys that do not go together", "Limit: an arc takes radius, start_deg and end_deg"],
    ),
    "a curve without a kind": ({"rail": {"curve": {"radius": 3}}}, ["rail.curve", "Limit: a table with its kind"]),
    "a flag for the schema": ({"schema": True}, ["schema: True. Limit: a valid integer"]),
    "future schema": ({"schema": 2}, ["schema", "1"]),
    "layer with a line break": ({"deliver": {"layers": {"CUT": "A\nB"}}}, ["deliver.layers"]),
}


@pytest.mark.parametrize("case", BROKEN)
def test_broken_projects_are_refused_by_name(case):
    change, words = BROKEN[case]
    data = {**SMALL, **{k: {**SMALL.get(k, {}), **v} if isinstance(v, dict) else v for k, v in change.items()}}
    with pytest.raises(Refused) as refusal:
        validate(data, "project.toml")
    for word in words:
        assert word in str(refusal.value)


def test_missing_tables_are_named():
    with pytest.raises(Refused, match="rail"):
        validate({key: value for key, value in SMALL.items() if key != "rail"}, "project.toml")


def test_all_findings_are_told_at_once():
    with pytest.raises(Refused) as refusal:
        validate(changed(SMALL, panels={"gap": -1, "spacerr": 2}), "project.toml")
    found = {one.field: one.limit for one in refusal.value.each}
    assert found.keys() == {"project.toml: panels.gap", "project.toml: panels.spacerr"}
    assert found["project.toml: panels.gap"] == "greater than zero"


def test_all_conflicts_are_told_at_once():
    """Tables that do not go together, in one table of the file and between several."""
    stock = {"gap": 1, "kerf": 3, "trim": 2000}
    with pytest.raises(Refused) as refusal:
        validate(changed(SMALL, stock=stock), "project.toml")
    assert [one.found for one in refusal.value.each] == [
        "gap 1 mm is too narrow",
        "trim 2000 mm leaves nothing of sheet 'Sheet'",
    ]
    with pytest.raises(Refused) as refusal:
        validate(changed(SMALL, panels={"gap": 0.5}, generatrix={"divide": {"phase": "node"}}), "project.toml")
    assert len(refusal.value.each) == 2


def test_several_changes_that_cannot_be_set_are_told_at_once(project_file):
    with pytest.raises(Refused) as refusal:
        load_project(project_file(SMALL), ["gap", "schema.x=1", "panels.gap=14"])
    assert [one.field for one in refusal.value.each] == ["--set gap", "--set schema.x"]


@pytest.mark.parametrize(
    ("content", "word"),
    [
        (b"\xff\xfe", "not UTF-8"),
        (b"schema = ", "TOML"),
        (b"a = 1\na = 2", "TOML"),
        (b"x = nan", "unknown key"),
        (b"x = " + b"9" * 5000, "TOML"),
        (b"x = " + b"[" * 100_000, "TOML"),
        (b"", "missing"),
    ],
)
def test_broken_files(tmp_path, content, word):
    path = tmp_path / "broken.toml"
    path.write_bytes(content)
    with pytest.raises(Refused, match=word):
        load_project(path)


def test_missing_file(tmp_path):
    with pytest.raises(Refused, match="no such file"):
        load_project(tmp_path / "nothing.toml")


@pytest.mark.parametrize("change", ["gap", "=3", "panels..gap=3", "schema.x=1"])
def test_broken_overrides(project_file, change):
    with pytest.raises(Refused, match="--set"):
        load_project(project_file(SMALL), [change])


@pytest.mark.parametrize("case", BROKEN)
def test_every_limit_is_said(case):
    """No message sends its reader away for the limit."""
    change, _ = BROKEN[case]
    data = {**SMALL, **{k: {**SMALL.get(k, {}), **v} if isinstance(v, dict) else v for k, v in change.items()}}
    with pytest.raises(Refused) as refusal:
        validate(data, "project.toml")
    assert "docs/" not in refusal.value.limit
    assert refusal.value.limit not in {"", refusal.value.found}
