"""Members nested alone: layout and saw lists as written, and with one fault at a time; V45g on paper."""

import json
import shutil
from dataclasses import replace

import pytest

import isomould
from isomould.verify.checks import saw_list
from isomould.verify.delivery import Delivery
from isomould.verify.read.pdf import Book, Sheet

ROWS = """id,section,quantity,length,depth,end_angle_start,end_angle_end
A,FL200*12,7,1505.25,200,12,-20
B001,RHS 50x3,9,1200,,,
=Ä日,RHS 50x3,2,2201.234,,,
"""
CHANGES = {
    "bars": [{"section": "FL200*12", "length": 6000}, {"section": "RHS 50x3", "length": 6000, "quantity": 2}],
    "bar_trim": 10,
    "bar_ends": "head-to-tail",
}


def nest(folder, saw="saw.csv"):
    files = isomould.NestFiles(changes=CHANGES, plan=folder / "saw.pdf", saw_list=folder / saw)
    return isomould.nest(folder / "m.csv", folder / "layout.json", files=files)


@pytest.fixture(scope="module")
def sawn(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sawn")
    (folder / "m.csv").write_text(ROWS, encoding="utf-8")
    nest(folder)
    nest(folder, "saw.xlsx")
    return folder


def check(folder, saw="saw.csv"):
    checks = isomould.verify(folder / "layout.json", 1, plan=folder / "saw.pdf", saw_list=folder / saw).checks
    return {one.id: one.status for one in checks}


def test_what_was_written_is_proved(sawn):
    assert json.loads((sawn / "layout.json").read_text(encoding="utf-8"))["status"] == "incomplete"
    for saw in ("saw.csv", "saw.xlsx"):
        assert check(sawn, saw) == {"V34c": "pass", "V34d": "pass", "V45g": "pass"}
    rest = isomould.verify(sawn / "layout.json", 1).checks
    assert [one.status for one in rest] == ["pass", "not_applicable", "not_applicable"]


NAMES = [
    *("A^J", "%%d", " lead", "A  B", "'q", "=1", "-", "日", "B001", "1", "0.5"),
    "Offcut (mm)",
    "-3",
    "2e5",
    "a,b",
    7,
]


def test_names_of_any_kind_pass_their_proof(tmp_path):
    members = [{"id": name, "section": "=S 日 x 2", "length": 700 + k} for k, name in enumerate(NAMES)]
    table = {"name": "na\nmes", "bars": [{"section": "=S 日 x 2", "length": 3210.5}], "members": members}
    (tmp_path / "m.json").write_text(json.dumps(table), encoding="utf-8")
    for saw in ("saw.csv", "saw.xlsx"):
        files = isomould.NestFiles(plan=tmp_path / "saw.pdf", saw_list=tmp_path / saw)
        isomould.nest(tmp_path / "m.json", tmp_path / "layout.json", files=files)
        assert set(check(tmp_path, saw).values()) == {"pass"}


def in_layout(change):
    def seed(folder):
        table = json.loads((folder / "layout.json").read_text(encoding="utf-8"))
        change(table)
        (folder / "layout.json").write_text(json.dumps(table), encoding="utf-8")

    return seed


def in_table(old, new):
    def seed(folder):
        text = (folder / "saw.csv").read_bytes()
        assert old in text
        (folder / "saw.csv").write_bytes(text.replace(old, new, 1))

    return seed


def cut(table, bar=0, number=1):
    return table["bars"][bar]["cuts"][number]


FAULTS = {
    "too near": (in_layout(lambda table: cut(table).update(start=cut(table)["start"] - 0.01)), "V34c"),
    "another way round": (in_layout(lambda table: cut(table).update(turned="none")), "V34c"),
    "another length": (in_layout(lambda table: cut(table, 0, -1).update(length=1505.0)), "V34c"),
    "another rest": (in_layout(lambda table: table["bars"][0].update(rest=1.0)), "V34c"),
    "from another section": (in_layout(lambda table: table["bars"][0].update(section="RHS 50x3")), "V34c"),
    "a piece forgotten": (in_layout(lambda table: table["bars"][0]["cuts"].pop()), "V34c"),
    "none left out": (in_layout(lambda table: table["unplaced"].clear()), "V34c"),
    "into the trim": (in_layout(lambda table: cut(table, 0, 0).update(start=9.9)), "V34c"),
    "a mark": (in_table(b",2,A,", b",2,B001,"), "V34d"),
    "a length": (in_table(b"1505.25", b"1505.26"), "V34d"),
    "an order": (in_table(b",2,A,", b",3,A,"), "V34d"),
    "a row": (in_table(b"\r\nB001", b"\r\nB009"), "V34d"),
    "a heading": (in_table(b"offcut_mm", b"rest_mm"), "V34d"),
    "another layout on paper": (in_layout(lambda table: table["bars"].reverse()), "V34d"),
}


@pytest.mark.parametrize(("seed", "caught"), FAULTS.values(), ids=FAULTS)
def test_faults_are_found(sawn, tmp_path, seed, caught):
    folder = shutil.copytree(sawn, tmp_path / "copy")
    seed(folder)
    assert check(folder)[caught] == "fail"


def test_what_fails_its_proof_is_not_published(sawn, tmp_path, monkeypatch):
    folder = shutil.copytree(sawn, tmp_path / "copy")
    before = {path: path.read_bytes() for path in folder.iterdir()}
    monkeypatch.setattr("isomould.delivery.nested.csv_text", lambda _: "bar\r\nB001\r\n")
    with pytest.raises(isomould.CertificateFailed, match=r"E-NEST-30 .*saw\.csv: V34d"):
        nest(folder)
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


BARS = [
    saw_list.Bar(
        "B001",
        "FL x 6000",
        (saw_list.Cut("M1", "MP-1", 10.0, 500.5, "none"), saw_list.Cut("M2", "MP-2", 513.5, 700.0, "both")),
        4786.5,
    )
]
COVER = ["1 bar, 2 pieces", "B001", "FL x 6000", "2", "1213.5", "4786.5"]
ROW_1, ROW_2 = ["1", "M1", "MP-1", "10", "500.5", "none"], ["2", "M2", "MP-2", "513.5", "700", "both"]
OFFCUT = "Offcut (mm)"


def paper(*pages):
    return Book("saw-list", tuple(Sheet(f"Saw list {k}", tuple(texts)) for k, texts in enumerate(pages, start=1)))


def on_paper(*pages):
    return saw_list.paper_faults(paper(*pages), BARS).worst


def test_a_bar_may_go_on_where_it_is_named_again():
    assert on_paper(COVER, ["B001", "FL x 6000", *ROW_1, *ROW_2, OFFCUT, "4786.5"]) == 0
    assert on_paper(COVER, ["B001", "FL x 6000", *ROW_1, "B001", "FL x 6000", *ROW_2, OFFCUT, "4786.5"]) == 0


@pytest.mark.parametrize(
    "texts",
    [
        [*ROW_2, *ROW_1, OFFCUT, "4786.5"],
        [*ROW_1, OFFCUT, "4786.5"],
        [*ROW_1, *ROW_2, OFFCUT, "4786.499"],
        [*ROW_1, *ROW_2],
        [*ROW_1[:-1], "both", *ROW_2, OFFCUT, "4786.5"],
        [*ROW_1[:4], "500.501", *ROW_1[5:], *ROW_2, OFFCUT, "4786.5"],
        [*ROW_1[:2], "MP-2", *ROW_1[3:], *ROW_2, OFFCUT, "4786.5"],
    ],
)
def test_faults_on_paper_are_found(texts):
    assert on_paper(COVER, ["B001", "FL x 6000", *texts]) == 1
    assert on_paper(["B001", "FL x 6000", "3"], ["B001", "FL x 6000", *ROW_1, *ROW_2, OFFCUT, "4786.5"]) == 1


def test_the_saw_list_of_a_delivery_is_held_to_its_schedules(built_folder):
    delivery = Delivery(built_folder)
    assert saw_list.planned(delivery).worst == 0
    first, *others = delivery.saw_plan.sheets
    texts = list(others[0].texts)
    texts.remove(next(text for text in texts if text.startswith("M") and "-" in text))
    without = (first, replace(others[0], texts=tuple(texts)), *others[1:])
    vars(delivery)["saw_plan"] = replace(delivery.saw_plan, sheets=without)
    assert saw_list.planned(delivery).worst == 1
