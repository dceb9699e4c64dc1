"""Lists of members become members of the nesting room, or are refused by name."""

import json
from pathlib import Path

import pytest

from isomould.errors import OutputFault, Refused
from isomould.intake.member_list import lists_members, read_member_list
from isomould.intake.table_words import Reading

STOCK = {"bars": [{"section": "FL200*12", "length": "6 m"}]}
GOOD = """mark,section,qty,length,depth,end_angle_start_deg,end_angle_end_deg
A,FL200*12,5,1505,200,45,-45
B,RHS,2,900,,,
"""


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


def read(path, stock=STOCK, units=None):
    return read_member_list(path, stock, Reading(units))[0].members


class TestCsv:
    def test_ends_lean_over_the_depth(self, tmp_path):
        """Positive where the top is longer: here the bottom starts 200 mm late and the top ends 200 mm early."""
        first, second = read(write(tmp_path / "m.csv", GOOD))
        assert (first.id, first.section, first.quantity, first.length) == ("A", "FL200*12", 5, 1505)
        assert first.outline == ((200, 0), (1505, 0), (1305, 200), (0, 200))
        assert (second.outline, second.quantity) == ((), 2)

    def test_units_decimal_commas_and_other_names(self, tmp_path):
        text = "\ufeffPart;Profile;Pieces;Cut length (cm);colour\nA;RHS;3;90,5;red\n"
        given, notes = read_member_list(write(tmp_path / "m.csv", text), STOCK)
        assert [(m.id, m.section, m.quantity, m.length) for m in given.members] == [("A", "RHS", 3, 905)]
        assert [note.text for note in notes] == ["not read: colour"]
        (member,) = read(write(tmp_path / "n.csv", "id,section,quantity,length\nA,RHS,1,2.5\n"), units="m")
        assert member.length == 2500

    @pytest.mark.parametrize(
        ("old", "new", "words"),
        [
            ("B,RHS", "A,RHS", "line 3.id.*given twice"),
            ("RHS", " ", "line 3.section"),
            (",900,", ",-900,", "line 3.length.*greater than zero"),
            (",900,", ",1'90,", "line 3: length"),
            (",2,", ",-2,", "line 3: quantity"),
            (",45,", ",81,", "line 2.end_angle_start.*80° from square"),
            (",1505,200,45,-45", ",190,200,45,-45", "line 2.length.*more than 200.000 mm"),
            (",200,", ",0,", "line 2.depth"),
        ],
    )
    def test_what_is_wrong_is_named(self, tmp_path, old, new, words):
        assert old in GOOD
        with pytest.raises(Refused, match=rf"E-NEST-11.*{words}"):
            read(write(tmp_path / "m.csv", GOOD.replace(old, new)))

    def test_bars_are_needed_and_widths_where_ends_lie_head_to_tail(self, tmp_path):
        path = write(tmp_path / "m.csv", GOOD)
        with pytest.raises(Refused, match=r"bar: missing.*--bar"):
            read(path, {})
        head = {**STOCK, "bar_ends": "head-to-tail"}
        assert len(read(path, head)) == 2
        with pytest.raises(Refused, match=r"line 2.depth: missing beside an end"):
            read(write(path, GOOD.replace(",200,", ",,")), head)
        with pytest.raises(Refused, match=r"line 4.depth: 150 mm.*200 mm as before"):
            read(write(path, GOOD + "C,FL200*12,1,900,150,,\n"), head)


def test_json(tmp_path):
    row = {"section": "FL200*12", "id": 7, "quantity": 2, "length": 800, "depth": 200, "end_angle_start": -45}
    table = {"name": "Hall", **STOCK, "bar_kerf": 4, "members": [row]}
    path = write(tmp_path / "m.json", json.dumps(table))
    given, _ = read_member_list(path, {"bar_kerf": 2})
    assert (given.name, given.stock.bar_kerf, given.stock.bars[0].length) == ("Hall", 2, 6000)
    assert given.members[0].outline == ((0, 0), (800, 0), (800, 200), (200, 200))
    wrong = [
        ("lenght", 1, "Did you mean length"),
        ("length", "1 m", "a number in mm"),
        ("id", "", "id"),
        ("depth", "x", "depth"),
    ]
    for key, value, words in wrong:
        path.write_text(json.dumps({**table, "members": [{**row, key: value}]}))
        with pytest.raises(Refused, match=rf"members\[0\].*{words}"):
            read_member_list(path, {})
    path.write_text(json.dumps({**table, "members": []}))
    with pytest.raises(Refused, match="at least one member"):
        read_member_list(path, {})


def test_columns_and_keys_say_what_is_listed(tmp_path):
    assert lists_members(write(tmp_path / "m.csv", GOOD))
    assert not lists_members(write(tmp_path / "p.csv", "id,quantity,section,length,points\n"))
    assert not lists_members(write(tmp_path / "q.csv", "id,quantity,a,b,h,ol,orr\n"))
    with pytest.raises(Refused, match="the first line has nothing"):
        lists_members(write(tmp_path / "q.csv", ";;\n"))
    assert lists_members(write(tmp_path / "m.json", '{"members": []}'))
    assert not lists_members(write(tmp_path / "p.json", '{"parts": []}'))
    assert not lists_members(tmp_path)
    with pytest.raises(OutputFault):
        lists_members(tmp_path / "nowhere.csv")


def test_the_schedule_of_a_delivery_is_such_a_list(built_folder):
    path = built_folder / "tables" / "members.csv"
    assert lists_members(path)
    given, notes = read_member_list(path, STOCK)
    assert (sum(member.quantity for member in given.members), notes) == (82, ())


def test_sections_are_compared_without_case_and_blanks(tmp_path):
    """Two spellings in a list are cut from one stock, named as the stock has it."""
    text = "Mark;Profile;Qty;Length\nA;HEA 200;4;5980\nB;hea200;2;3000\nC;FL200x12;1;900\n"
    bars = [{"section": "HEA200", "length": "12 m", "quantity": 5}, {"section": "FL 200*12", "length": "6 m"}]
    given, _ = read_member_list(write(tmp_path / "m.csv", text), {"bars": bars})
    assert [member.section for member in given.members] == ["HEA200", "HEA200", "FL 200*12"]
    assert [(bar.section, bar.quantity) for bar in given.stock.bars] == [("HEA200", 5), ("FL 200*12", None)]


def test_american_lists_call_the_section_size_or_shape(tmp_path):
    text = "Part Mark,Qty,Size,Length,Grade\nA,4,W12X26,12'-3 1/2\",A992\n"
    path = write(tmp_path / "m.csv", text)
    stock = {"bars": [{"section": "W12X26", "length": "40 ft"}]}
    assert lists_members(path, None, stock)
    (member,) = read_member_list(path, stock)[0].members
    assert (member.section, member.length, member.quantity) == ("W12X26", 3746.5, 4)
