"""Changes on the command line: rivals, units, near keys, names of files."""

import pytest

import isomould
from isomould.errors import Refused
from isomould.project.load import load_project, validate
from museum import SMALL, changed


def test_a_change_replaces_its_rival_in_the_file(project_file):
    path = project_file(SMALL)
    divide = load_project(path, ["generatrix.divide.nodes=30"]).project.generatrix.divide
    assert (divide.nodes, divide.per_arc) == (30, None)
    divide = load_project(path, ["rail.divide.angle_deg=12", "rail.divide.first_deg=90"]).project.rail.divide
    assert (divide.nodes, divide.angle_deg, divide.first_deg) == (None, 12, 90)


def test_two_changes_that_exclude_each_other_are_refused(project_file):
    with pytest.raises(Refused, match="nodes and angle_deg exclude"):
        load_project(project_file(SMALL), ["rail.divide.nodes=5", "rail.divide.angle_deg=12"])


@pytest.mark.parametrize(
    ("change", "noted"),
    [
        ("rail.curve.rise=2500", "2500 mm"),
        ("panels.gap=12.5", "12.5 mm"),
        ("rail.max_edge=3000", "3000 mm"),
        ('rail.curve.rise="2.5 m"', None),
        ("rail.curve.rise=2.5 m", None),
        ("rail.divide.nodes=5", None),
        ("tolerances.angle_deg=0.1", None),
        ("panels.density=2400", None),
    ],
)
def test_bare_numbers_for_lengths_are_noted(project_file, change, noted):
    notes = load_project(project_file(SMALL), [change]).notes
    assert [note.code for note in notes] == (["W-SET-UNIT"] if noted else [])
    assert not noted or noted in notes[0].text


def test_check_tells_the_notes_of_changes(project_file):
    checked = isomould.check(project_file(SMALL), ["panels.gap=16"])
    assert checked.notes[0].code == "W-SET-UNIT"


def test_the_ending_of_a_project_file_may_be_left_out(project_file):
    path = project_file(SMALL)
    assert load_project(path.with_suffix("")).project.project.name == "Small"
    with pytest.raises(Refused, match="no such file"):
        load_project(path.with_name("street"))


@pytest.mark.parametrize(
    ("curve", "word", "other"),
    [
        ({"kind": "parabola", "span": 8000, "rize": 2}, "'rise'", "radius"),
        ({"kind": "circle", "radiuss": 8000}, "'radius'", "span"),
        ({"kind": "circle", "radius": 8000, "span": 3}, "a key of another kind", "knots"),
    ],
)
def test_near_keys_are_of_the_same_kind(curve, word, other):
    with pytest.raises(Refused) as refusal:
        validate(changed(SMALL, rail={"curve": curve}), "project.toml")
    said = next(str(one) for one in refusal.value.each if "key" in one.found)
    assert word in said
    assert other not in said
