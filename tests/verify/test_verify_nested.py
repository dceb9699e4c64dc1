"""What `nest` wrote, proved from its files: as written, and with one fault at a time."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import ezdxf
import pytest

import isomould
from isomould.delivery import nested as delivery
from isomould.delivery.cut_sheets import write_sheet
from isomould.verify import verify_nest

STOCK = """[stock]
gap = {gap}
trim = 15
turn_over = true
sheets = [{{name = "Plate", width = "1.6 m", height = "1.2 m"}}]
"""
ROWS = 'id,quantity,points,file\nA,3,,A.dxf\nÄ^%%% 1日,2,"0,0;500,0;620,300;0,400",\n'


def write_parts(folder: Path, gap: float = 5) -> Path:
    """Three drawn parts with a hole and a slot of arcs, two polygons whose name no font has."""
    document = ezdxf.new("R2010", units=4)
    space = document.modelspace()
    outline = [(0, 0), (700, 0), (640, 300), (50, 300)]
    space.add_lwpolyline(outline, close=True, dxfattribs={"layer": "CUT"})
    space.add_lwpolyline([(400, 100, 1), (400, 140, 0), (300, 140, 1), (300, 100, 0)], "xyb", close=True,
                         dxfattribs={"layer": "CUT_INNER"})  # fmt: skip
    space.add_circle((100, 80), 11, dxfattribs={"layer": "DRILL"})
    document.saveas(folder / "A.dxf")
    (folder / "stock.toml").write_text(STOCK.format(gap=gap))
    (folder / "parts.csv").write_text(ROWS, encoding="utf-8")
    return folder / "parts.csv"


def nest(folder: Path, **more: bool):
    files = isomould.NestFiles(folder / "stock.toml", sheets=folder / "cut", plan=folder / "plan.pdf", **more)
    return isomould.nest(folder / "parts.csv", folder / "layout.json", "quick", files=files, jobs=1)


@pytest.fixture(scope="module", params=[5, 0], ids=["cut", "scored"])
def nested(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("nested")
    write_parts(folder, request.param)
    nest(folder)
    return folder


NAMES = [
    *("A^J", "^", "A\\P b", "\\U+00C4x", " lead", "trail ", "%%d", "%%%", "A  B", "{x}"),
    "'q",
    '"q"',
    "=1",
    "-",
    "日",
    1,
]


@pytest.mark.parametrize("gap", [5, 0])
def test_names_of_any_kind_pass_their_proof(tmp_path, gap):
    sides = {"a": 300, "b": 250, "h": 120, "ol": 25, "orr": 25}
    parts = [{"id": name, "quantity": 2, **sides, "row": k % 3} for k, name in enumerate(NAMES)]
    table = {"name": "na\nmes", "sheet": [1600, 1200], "gap": gap, "trim": 10, "turning": "half", "parts": parts}
    (tmp_path / "parts.json").write_text(json.dumps(table), encoding="utf-8")
    files = isomould.NestFiles(sheets=tmp_path / "cut", plan=tmp_path / "plan.pdf")
    layout = isomould.nest(tmp_path / "parts.json", tmp_path / "layout.json", "quick", files=files, jobs=1)
    assert {placement.id for placement in layout.placements} == set(NAMES)
    assert failures(tmp_path) == set()


def failures(folder: Path) -> set[str]:
    certificate = isomould.verify(folder / "layout.json", 1, folder / "cut", folder / "plan.pdf")
    return {check.id for check in certificate.failures}


def test_what_was_written_is_proved(nested):
    checks = verify_nest(nested / "layout.json", nested / "cut", nested / "plan.pdf").checks
    assert {check.status for check in checks if not check.id.startswith("V33")} == {"pass"}
    assert "fail" not in {check.status for check in checks}
    alone = {check.id: check.status for check in verify_nest(nested / "layout.json").checks}
    assert (alone["V32"], alone["V35b"], alone["V31b"], alone["V45f"]) == ("pass", "pass", *["not_applicable"] * 2)


def on_sheet(change):
    """A fault in the drawing of the first sheet."""

    def seed(folder: Path):
        document = ezdxf.readfile(folder / "cut" / "S001.dxf")
        change(document.modelspace())
        document.saveas(folder / "cut" / "S001.dxf")

    return seed


def in_layout(change):
    def seed(folder: Path):
        table = json.loads((folder / "layout.json").read_text(encoding="utf-8"))
        change(table)
        (folder / "layout.json").write_text(json.dumps(table), encoding="utf-8")

    return seed


def first(space, query: str):
    return next(iter(space.query(query)))


def swap_texts(space):
    one, other = (next(t for t in space.query("TEXT") if t.dxf.text.startswith(mark)) for mark in ("A", "Ä"))
    one.dxf.text, other.dxf.text = other.dxf.text, one.dxf.text


def move_part(space):
    contour = next(line for line in space.query("LWPOLYLINE[layer=='CUT' | layer=='INFO']") if line.closed)
    contour.translate(0.01, 0, 0)


FAULTS = {
    "a contour moved": (on_sheet(move_part), "V31b"),
    "a mark in another part": (on_sheet(swap_texts), "V31c"),
    "a mark missing": (on_sheet(lambda space: first(space, "TEXT").destroy()), "V31c"),
    "a mark twice": (on_sheet(lambda space: first(space, "TEXT").copy_to_layout(space)), "V31c"),
    "engraved outside": (
        on_sheet(lambda space: space.add_lwpolyline([(1, 1), (9, 1)], dxfattribs={"layer": "ENGRAVE"})),
        "V31c",
    ),
    "a hole moved": (on_sheet(lambda space: first(space, "CIRCLE").translate(0.01, 0, 0)), "V32b"),
    "a hole missing": (on_sheet(lambda space: first(space, "CIRCLE").destroy()), "V32b"),
    "another radius": (on_sheet(lambda space: first(space, "CIRCLE").dxf.set("radius", 10.9)), "V32b"),
    "a slot moved": (
        on_sheet(lambda space: first(space, "LWPOLYLINE[layer=='CUT_INNER']").translate(0, 0.01, 0)),
        "V32b",
    ),
    "a sheet missing": (lambda folder: (folder / "cut" / "S001.dxf").unlink(), "V31"),
    "a sheet too many": (lambda folder: shutil.copy(folder / "cut" / "S001.dxf", folder / "cut" / "S009.dxf"), "V31"),
    "another quantity": (in_layout(lambda table: table["parts"][0].update(quantity=4)), "V31"),
    "another status": (in_layout(lambda table: table.update(status="incomplete")), "V31"),
    "another yield": (in_layout(lambda table: table.update(yield_percent=99.0)), "V34b"),
    "another shape": (in_layout(lambda table: table["parts"][0]["points"][2].__setitem__(0, 641)), "V32"),
    "another order": (in_layout(lambda table: table["placements"].reverse()), "V45f"),
    "another layer": (
        on_sheet(lambda space: first(space, "LWPOLYLINE[layer=='SHEET']").dxf.set("layer", "KEEP")),
        "V40",
    ),
}


@pytest.mark.parametrize(("seed", "caught"), FAULTS.values(), ids=FAULTS)
def test_faults_are_found(nested, tmp_path, seed, caught):
    folder = shutil.copytree(nested, tmp_path / "copy")
    seed(folder)
    assert caught in failures(folder)


def test_what_fails_its_proof_is_not_published(nested, tmp_path, monkeypatch):
    """A part left out of its sheet: a refusal that names the sheet, and what was there before stays."""
    folder = shutil.copytree(nested, tmp_path / "copy")
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}

    def forgetful(file):
        write_sheet(replace(file, parts=file.parts[:-1]))

    monkeypatch.setattr(delivery, "write_sheet", forgetful)
    with pytest.raises(isomould.CertificateFailed, match=r"E-NEST-30 .*cut: V31b .*S001"):
        nest(folder, overwrite=True)
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before


def test_a_folder_is_no_layout(nested):
    with pytest.raises(isomould.Refused, match="E-VERIFY"):
        isomould.verify(nested, 1, nested / "cut")
