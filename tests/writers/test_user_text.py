"""Whatever a user types stays text: in cells of the workbook, in formulas that name it, in CSV files."""

import csv

import openpyxl
import pytest

import isomould
from isomould.errors import Refused
from isomould.project.load import validate
from museum import SMALL, changed, write_project

EVIL = {
    "name": "=1+1",
    "number": "+1",
    "client": "@x",
    "revision": "-1",
    "author": '=HYPERLINK("http://a.b","c")',
    "grade": "=2+2",
    "sheet": '@"sheet*',
    "currency": "=3+3",
    "section": '=4+4"*',
    "drawing": "@drawing",
    "phase": "+5",
    "makeup": "=6+6",
    "shape": "=7+7",
}


@pytest.fixture(scope="module")
def evil(tmp_path_factory):
    folder = tmp_path_factory.mktemp("evil")
    own = {key: EVIL[key] for key in ("name", "number", "client", "revision", "author", "drawing", "phase")}
    data = changed(SMALL, project=own, members={"grade": EVIL["grade"]}, costs={"currency": EVIL["currency"]})
    stock = SMALL["stock"]
    sheets = [{**stock["sheets"][0], "name": EVIL["sheet"]}]
    bars = [*stock["bars"], {**stock["bars"][0], "section": EVIL["section"]}]
    data = changed(data, stock={"sheets": sheets, "bars": bars}, panels={"makeup": EVIL["makeup"]})
    data["shapes"] = [{"name": EVIL["shape"], "rail": SMALL["rail"]}]
    data = changed(data, deliver={"compare": True})
    project = write_project(folder / "evil.toml", data)
    return isomould.schedule(project, folder / "out", run=isomould.Run(effort="quick", jobs=1)).folder


def test_the_folder_is_proved(evil):
    assert isomould.verify(evil, jobs=1).passed


def test_user_text_is_text_in_the_workbook(evil):
    book = openpyxl.load_workbook(evil / "schedules.xlsx")
    found = [cell for sheet in book for row in sheet for cell in row if cell.value in EVIL.values()]
    unseen = {EVIL[key] for key in ("section", "drawing", "phase", "makeup", "shape")}
    assert {cell.value for cell in found} == set(EVIL.values()) - unseen
    assert {cell.data_type for cell in found} == {"s"}
    assert not [name for name in book.sheetnames if name[0] in "=+-@"]
    formulas = {c.value for sheet in book for row in sheet for c in row if c.data_type == "f"}
    assert not [text for text in formulas if text.startswith(("=1", "=2", "=3", "=HYPER", "=+", "=-", "=@"))]
    assert '=SUMPRODUCT(--EXACT(tblSheets[Stock],"@""sheet*"))' in formulas
    assert '=SUMPRODUCT(--EXACT(tblBars[Stock],"=4+4""* x 6000"))' in formulas
    assert not [text for text in formulas if text.startswith(("=4", "=5", "=6", "=7"))]
    assert "Quantity 7 7" in {cell.value for cell in book["Kit"][1]}


def test_user_text_is_neutralised_in_csv(evil):
    seen = set()
    for path in (evil / "tables").iterdir():
        with path.open(encoding="utf-8", newline="") as file:
            for row in csv.reader(file):
                assert not [cell for cell in row if cell.startswith(("=", "+", "@", "\t", "\r"))], path
                assert not [cell for cell in row if cell.startswith("-") and not is_number(cell)], path
                seen |= set(row)
    assert {f"'{EVIL[key]}" for key in ("grade", "sheet", "currency")} <= seen


def is_number(cell):
    try:
        float(cell)
    except ValueError:
        return False
    return True


@pytest.mark.parametrize("text", ["a\nb", "a\rb", "a\tb", "a\x07b", "a\u202eb"])
@pytest.mark.parametrize(
    ("field", "tables"),
    [
        ("stock.sheets", lambda text: {"stock": {"sheets": [{**SMALL["stock"]["sheets"][0], "name": text}]}}),
        ("stock.bars", lambda text: {"stock": {"bars": [{**SMALL["stock"]["bars"][0], "section": text}]}}),
        ("members.grade", lambda text: {"members": {"grade": text}}),
        ("panels.makeup", lambda text: {"panels": {"makeup": text}}),
        ("project.phase", lambda text: {"project": {"phase": text}}),
    ],
)
def test_text_of_more_than_a_line_is_refused(field, tables, text):
    with pytest.raises(Refused, match=r"control characters, line breaks") as caught:
        validate(changed(SMALL, **tables(text)), "small.toml")
    assert field in str(caught.value)
