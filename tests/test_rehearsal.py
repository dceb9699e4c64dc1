"""What `check` says is what `build` does: refusals that need no search come from both, and come together."""

import pytest

import isomould
from isomould.errors import Attempt, Gathering, Refused, RefusedTogether
from museum import FAMILY, SMALL, changed

WELL = changed(SMALL, deliver={"drawings": False, "strips": []})


def refusals(project_file, data, *changes):
    """Codes and fields of everything that `check` refuses."""
    with pytest.raises(Refused) as refused:
        isomould.check(project_file(data), changes)
    return [(one.code, one.field) for one in refused.value.each]


def codes(project_file, data, *changes):
    return [code for code, _ in refusals(project_file, data, *changes)]


PLANTED = changed(
    WELL,
    panels={"spacerr": 3, "seat_width": "20 mm"},
    rail={"curve": {"kind": "dxf", "file": "nowhere.dxf", "layer": "RAIL", "units": "m"}},
    generatrix={"divide": {"angle_deg": 80}},
    nodes={"drum_diameter": "30 mm"},
    stock={"sheets": [{"name": "Small", "width": 900, "height": 700}]},
)
"""Six faults in five stages: a key, the rail, the division of the generatrix, drums, seats, and sheets."""


def test_six_faults_in_five_stages_take_two_runs(project_file):
    first = refusals(project_file, PLANTED)
    assert [code for code, _ in first] == ["E-PROJECT", "E-DXF-FILE", "E-CURVE-ANGLE"]
    assert first[0][1] == "project.toml: panels.spacerr"

    mended = changed(PLANTED, rail=WELL["rail"], generatrix=WELL["generatrix"])
    mended["panels"] = {"seat_width": "20 mm"}
    assert codes(project_file, mended) == ["E-NODE-DRUM", "E-PANEL-BEARING", "E-NEST-01"]


@pytest.mark.parametrize(
    ("tables", "found"),
    [
        ({"stock": {"sheets": [{"name": "S", "width": 900, "height": 700}]}}, "E-NEST-01"),
        ({"stock": {"sheets": [], "max_blank_length": 700}}, "E-NEST-02"),
        ({"stock": {"sheets": [{"name": "S", "width": 4000, "height": 2500, "quantity": 1}]}}, "E-STOCK"),
        ({"stock": {"bars": [{"section": "FL200*12", "length": 900}]}}, "E-NEST-20"),
        ({"stock": {"bars": [{"section": "FL200*12", "length": 6000, "quantity": 2}]}}, "E-STOCK"),
        ({"surface": {"trim": [{"plane": {"z": 500}, "keep": "above"}]}, "deliver": {"compare": True}}, "E-COMPARE"),
        (
            {"surface": {"trim": [{"plane": {"z": 500}, "keep": "above"}]}, "deliver": {"strips": ["parallel"]}},
            "E-STRIP",
        ),
        ({"deliver": {"layers": {"CUT": "0"}}}, "E-PROJECT"),
        ({"project": {"name": "CON"}}, "E-NAME-01"),
    ],
)
def test_check_and_build_refuse_alike(project_file, tmp_path, tables, found):
    data = changed(WELL, **tables)
    assert codes(project_file, data) == [found]
    with pytest.raises(Refused, match=found):
        isomould.build(project_file(data), None, run=isomould.Run(effort="quick", jobs=1))


def test_several_shapes_are_told_apart(project_file):
    shape = {"name": "Tall one", "rail": {"divide": {"angle_deg": 25, "first_deg": 90}}}
    found = refusals(project_file, {**FAMILY, "shapes": [shape, {**shape, "name": "Other"}]})
    assert found[0] == ("E-SHAPE-ANGLE", "shapes (tall-one): rail.divide")
    assert {field for code, field in found if code == "E-SHAPE-ANGLE"} == {
        "shapes (tall-one): rail.divide",
        "shapes (other): rail.divide",
    }


def refuse(code):
    raise Refused(code, "rail", "none", "one", "Draw it.")


def test_work_that_needs_refused_work_ends_quietly():
    gathering = Gathering()
    first = gathering.run(refuse, "E-1")
    gathering.run(lambda: first.value)
    gathering.run(refuse, "E-2")
    assert gathering.run(lambda: 3).value == 3
    with pytest.raises(RefusedTogether) as refused, gathering:
        """Nothing more goes wrong."""
    assert [one.code for one in refused.value.each] == ["E-1", "E-2"]
    assert refused.value.code == "E-1"


def test_one_refusal_stays_itself_and_other_errors_pass():
    with pytest.raises(Refused) as refused, Gathering() as gathering:
        gathering.run(refuse, "E-1")
    assert type(refused.value) is Refused
    with pytest.raises(ZeroDivisionError), gathering:
        gathering.run(lambda: 1 // 0)


def test_messages_are_capped():
    long = Refused("E-1", "rail", "x" * 100_000, "one", "Draw it.")
    assert len(str(long)) < 1000
    assert str(RefusedTogether([long] * 100)).endswith("and 76 more")


def test_an_attempt_gives_its_value_or_its_refusal():
    assert Attempt(4).value == 4
    with pytest.raises(Refused, match="E-1"):
        Attempt[int](None, Refused("E-1", "rail", "none", "one", "Draw it.")).value  # noqa: B018
