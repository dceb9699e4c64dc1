"""Material, thickness, grade and grain of part lists: parts that differ are never cut from one sheet or bar."""

import json
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import isomould
from isomould.errors import Refused
from isomould.intake.member_list import read_member_list
from isomould.intake.read import Asked, read_part_list
from isomould.intake.stock import bar_of, sheet_of
from isomould.nesting.checker import check_layout
from isomould.nesting.grouped import nest_materials
from isomould.nesting.layout import Part
from isomould.nesting.material import Material
from isomould.nesting.search import Search
from isomould.nesting.settings import SheetStock, StockSettings
from isomould.verify import verify_nest

CASES = Path(__file__).parent / "cases" / "lists"
QUICK = Search("quick", jobs=1)
GLASS = ["6000x3210 material=Clear float", "6000x3210 material=Low-E thickness=10", "3000x2000 thickness=8.76"]


def written(tmp_path, text, name="list.csv"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def rectangle(width, height):
    return np.array([(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)])


def nested(path, tmp_path, *sheets, **more):
    changes = {"sheets": [sheet_of(text) for text in sheets], "gap": 5}
    files = isomould.NestFiles(changes=changes, **more)
    notes = []
    layout = isomould.nest(path, tmp_path / "layout.json", "quick", jobs=1, files=files, remark=notes.append)
    return layout, notes


class TestMaterials:
    def test_three_materials_lie_on_sheets_of_their_own(self, tmp_path):
        layout, _ = nested(
            CASES / "a17_materials.csv", tmp_path, *GLASS, sheets=tmp_path / "cut", plan=tmp_path / "p.pdf"
        )
        on = {sheet.id: sheet.material for sheet in layout.sheets}
        assert sorted(map(str, on.values())) == ["Clear float 6 mm", "Laminated 44.2 8.76 mm", "Low-E 10 mm"]
        found = {(item.id, str(on[item.sheet])) for item in layout.placements}
        assert found == {("G1", "Clear float 6 mm"), ("G2", "Laminated 44.2 8.76 mm"), ("G3", "Low-E 10 mm")}
        table = json.loads((tmp_path / "layout.json").read_text())
        assert {(part["id"], part["material"], part["thickness"]) for part in table["parts"]} == {
            ("G1", "Clear float", 6), ("G2", "Laminated 44.2", 8.76), ("G3", "Low-E", 10)}  # fmt: skip
        assert {sheet["material"] for sheet in table["sheets"]} == {"Clear float", "Laminated 44.2", "Low-E"}
        texts = [text.dxf.text for text in ezdxf.readfile(tmp_path / "cut" / "S001.dxf").modelspace().query("TEXT")]
        assert "Clear float 6 mm" in texts

    def test_a_sheet_that_may_be_for_several_is_refused(self, tmp_path):
        path = CASES / "a17_materials.csv"
        with pytest.raises(
            Refused, match=r"E-NEST-13.*any of 3 in the list: Clear float 6 mm \(4 pieces\), Lam.*--sheet"
        ):
            nested(path, tmp_path, "6000x3210")
        with pytest.raises(Refused, match=r"E-NEST-13.*none for Laminated 44\.2 8\.76 mm \(4 pieces\)"):
            nested(path, tmp_path, *GLASS[:2])
        assert not (tmp_path / "layout.json").exists()

    def test_one_material_fits_a_sheet_that_says_none(self, tmp_path):
        layout, _ = nested(CASES / "label_width_height.csv", tmp_path, "2440x1220")
        assert [str(sheet.material) for sheet in layout.sheets] == ["Birch 18 mm"]
        with pytest.raises(Refused, match=r"E-NEST-13.*none for Birch 18 mm"):
            nested(CASES / "label_width_height.csv", tmp_path, "2440x1220 material=Oak")

    def test_same_words_are_one_material(self, tmp_path):
        path = written(tmp_path, "Mark,Qty,Length,Width,Material\nA,1,900,700,MDF  18\nB,1,900,700,mdf 18\n")
        layout, _ = nested(path, tmp_path, "2440x1220")
        assert len(layout.sheets) == 1

    def test_parts_that_do_not_say_what_others_do(self, tmp_path):
        path = written(tmp_path, "Mark,Qty,Length,Width,Material\nA,1,900,700,MDF\nB,1,900,700,\n")
        with pytest.raises(Refused, match=r"E-NEST-13 material: some parts have no material, others have MDF"):
            nested(path, tmp_path, "2440x1220 material=MDF")

    def test_stock_that_differs_in_what_the_list_does_not_say(self, tmp_path):
        path = written(tmp_path, "Mark,Qty,Length,Width\nA,1,900,700\n")
        with pytest.raises(Refused, match=r"E-NEST-13.*sheets of mdf and oak for parts that do not say their material"):
            nested(path, tmp_path, "2440x1220 material=MDF", "2440x1220 material=Oak")
        assert str(nested(path, tmp_path, "2440x1220 material=MDF")[0].sheets[0].material) == "MDF"

    def test_quantities_of_stock_are_each_material_s_own(self, tmp_path):
        path = written(tmp_path, "Mark,Qty,Length,Width,Material\nA,3,900,900,MDF\nB,3,900,900,Oak\n")
        layout, _ = nested(path, tmp_path, "1000x1000 material=MDF quantity=2", "1000x1000 material=Oak")
        assert (layout.status, [item.id for item in layout.unplaced]) == ("incomplete", ["A"])
        assert len(layout.sheets) == 5

    @settings(max_examples=12, deadline=None)
    @given(
        st.lists(
            st.tuples(st.sampled_from(["MDF", "Oak"]), st.sampled_from([12.0, 18.0]), st.integers(1, 4)),
            min_size=1,
            max_size=6,
        )
    )
    def test_no_sheet_ever_holds_two(self, rows):
        parts = [
            Part(k, rectangle(300 + 10 * k, 200), many, material=Material(material, "", thickness))
            for k, (material, thickness, many) in enumerate(rows)
        ]
        sheets = tuple(
            SheetStock(name=f"{material} {thickness}", width=1000, height=600, material=material, thickness=thickness)
            for material in ("MDF", "Oak")
            for thickness in (12.0, 18.0)
        )
        stock = StockSettings(sheets=sheets, gap=5)
        layout = nest_materials(parts, stock, QUICK).layout
        assert check_layout(parts, stock, layout) == ()
        made_of, on = {part.id: part.material for part in parts}, {sheet.id: sheet for sheet in layout.sheets}
        assert all(on[item.sheet].material == made_of[item.id] for item in layout.placements)
        assert all(sheet.stock == f"{sheet.material.material} {sheet.material.thickness}" for sheet in layout.sheets)
        assert len(layout.placements) == sum(many for _, _, many in rows)
        assert layout.bound <= len(layout.sheets)


class TestGrain:
    def test_grains_lie_along_the_sheet(self, tmp_path):
        """The first size of P1 is 1900 and lies along; the second of P2 is 2900 and lies along, turned."""
        layout, notes = nested(CASES / "a18_grain_trap.csv", tmp_path, "3000x2000")
        assert {(item.id, item.rotation_deg % 180) for item in layout.placements} == {("P1", 0), ("P2", 90)}
        assert any("10 pieces have a grain" in note.text and "3000 of 3000 x 2000" in note.text for note in notes)
        with pytest.raises(Refused, match=r"E-NEST-01 part P2: needs 1200 x 2900 mm.*grain across"):
            nested(CASES / "a18_grain_trap.csv", tmp_path, "2000x3000")

    @pytest.mark.parametrize(
        ("heading", "cell", "grain"),
        [
            ("Length,Width,Grain", "length", "along"),
            ("Length,Width,Grain", "L", "along"),
            ("Length,Width,Grain direction", "W", "across"),
            ("Länge,Breite,Maserung", "quer", "across"),
            ("Länge,Breite,Maserung", "ja", "along"),
            ("Length,Width,Grain", "none", None),
            ("Length,Width,Grain", "", None),
            ("Width,Height,Grain", "height", "across"),
            ("Width,Height,Grain", "width", "along"),
            ("Length,Width,Can rotate", "no", "along"),
            ("Length,Width,Can rotate", "yes", None),
        ],
    )
    def test_words(self, tmp_path, heading, cell, grain):
        path = written(tmp_path, f"Mark,Qty,{heading}\nA,1,900,700,{cell}\n")
        stock = {"sheets": [{"name": "A", "width": 2000, "height": 2000}], "gap": 5}
        (part,) = read_part_list(path, Asked(stock)).instance.parts
        assert part.grain == grain

    def test_what_is_no_direction_is_refused(self, tmp_path):
        path = written(tmp_path, "Mark,Qty,Width,Height,Grain\nA,1,900,700,length\n")
        with pytest.raises(Refused, match=r"line 2: grain: 'length'. Limit: width, height, none"):
            nested(path, tmp_path, "2000x2000")

    @pytest.mark.parametrize("turning", ["none", "half", "quarter"])
    def test_free_parts_turn_beside_held_ones(self, turning):
        held = Part("H", rectangle(900, 200), 4, grain="along")
        across = Part("X", rectangle(200, 900), 4, grain="across")
        free = Part("F", rectangle(150, 850), 6)
        stock = StockSettings(sheets=(SheetStock(name="s", width=1000, height=1000),), gap=5, turning=turning)
        layout = nest_materials([held, across, free], stock, QUICK).layout
        assert check_layout([held, across, free], stock, layout) == ()
        turns = {mark: {p.rotation_deg % 180 for p in layout.placements if p.id == mark} for mark in "HXF"}
        assert (turns["H"], turns["X"]) == ({0}, {90})
        assert turns["F"] <= ({0, 90} if turning == "quarter" else {0})


FAULTS = {
    "a part of another material": ("parts", {"material": "Oak"}, {"V31e"}),
    "a thicker part": ("parts", {"thickness": 19}, {"V31e"}),
    "another grain": ("parts", {"grain": "across"}, {"V31e"}),
    "a sheet of another material": ("sheets", {"material": "Oak"}, {"V31e", "V31c", "V45f"}),
    "a sheet of no material": ("sheets", {"material": ""}, {"V31e", "V31c", "V45f"}),
    "a sheet of another grade": ("sheets", {"grade": "B"}, {"V31c", "V45f"}),
}


class TestProof:
    """What is written is proved apart from what made it: seeded faults are found."""

    @pytest.fixture
    def folder(self, tmp_path):
        text = "Mark,Qty,Length,Width,Material,Thickness,Grain\nA,2,900,700,MDF,18,length\nB,2,900,700,Oak,20,width\n"
        sheets = ("2000x1500 material=MDF", "2000x1500 material=Oak")
        nested(written(tmp_path, text), tmp_path, *sheets, sheets=tmp_path / "cut", plan=tmp_path / "plan.pdf")
        return tmp_path

    @pytest.mark.parametrize("fault", FAULTS)
    def test_faults_are_found(self, folder, fault):
        where, change, checks = FAULTS[fault]
        layout = folder / "layout.json"
        assert verify_nest(layout, folder / "cut", folder / "plan.pdf").passed
        table = json.loads(layout.read_text())
        table[where][0].update(change)
        layout.write_text(json.dumps(table))
        assert {one.id for one in verify_nest(layout, folder / "cut", folder / "plan.pdf").failures} == checks

    def test_our_own_checker_finds_mixed_sheets(self):
        parts = [Part("A", rectangle(300, 200), material=Material("MDF")), Part("B", rectangle(300, 200))]
        stock = StockSettings(sheets=(SheetStock(name="s", width=1000, height=600),), gap=5)
        layout = nest_materials([parts[0]], stock, QUICK).layout
        wrong = Part("A", parts[0].outline, material=Material("Oak"))
        assert {finding.code for finding in check_layout([wrong], stock, layout)} == {"N-MATERIAL-02"}
        other = stock.model_copy(update={"sheets": (stock.sheets[0].model_copy(update={"material": "Oak"}),)})
        assert {finding.code for finding in check_layout([parts[0]], other, layout)} == {"N-MATERIAL-01"}
        lies_along = layout.placements[0].rotation_deg % 180 == 0
        turned = Part("A", parts[0].outline, material=Material("MDF"), grain="across" if lies_along else "along")
        assert {finding.code for finding in check_layout([turned], stock, layout)} == {"N-PLACE-03"}

    def test_a_twin_sheet_is_no_proof_for_parts_of_another_grain(self):
        parts = [Part("A", rectangle(900, 500), grain="along"), Part("B", rectangle(900, 500), grain="along")]
        stock = StockSettings(sheets=(SheetStock(name="s", width=1000, height=600),), gap=5)
        layout = nest_materials(parts, stock, QUICK).layout
        assert len(layout.sheets) == 2
        turned = Part("B", parts[1].outline, grain="across")
        assert {finding.code for finding in check_layout([parts[0], turned], stock, layout)} == {"N-PLACE-03"}


class TestBars:
    TEXT = "Mark;Profile;Material;Pcs;Length(mm)\nA;HEA200;S355;2;2500,5\nB;HEA200;S235;2;2500\nC;L50;S235;1;900\n"

    def members(self, tmp_path, *bars):
        path = written(tmp_path, self.TEXT)
        return read_member_list(path, {"bars": [bar_of(bar) for bar in bars]})[0]

    def test_grades_of_a_section_are_kept_apart(self, tmp_path):
        bars = ("HEA200=6 m grade=S355", "HEA200=6 m grade=S235 price=90", "L50=6 m")
        listed = self.members(tmp_path, *bars)
        sections = {member.id: member.section for member in listed.members}
        assert sections == {"A": "HEA200 S355", "B": "HEA200 S235", "C": "L50"}
        files = isomould.NestFiles(changes={"bars": [bar_of(bar) for bar in bars]}, saw_list=tmp_path / "saw.csv")
        layout = isomould.nest(tmp_path / "list.csv", tmp_path / "bars.json", files=files)
        assert layout.bounds == {"HEA200 S355": 1, "HEA200 S235": 1, "L50": 1}
        assert "HEA200 S355 x 6000" in (tmp_path / "saw.csv").read_text()

    def test_a_bar_that_may_be_of_several_grades_is_refused(self, tmp_path):
        with pytest.raises(Refused, match=r"E-NEST-13 bar: 'HEA200' says no material.*S355 \(2 pieces\), S235 \(2"):
            self.members(tmp_path, "HEA200=6 m", "L50=6 m")
        with pytest.raises(Refused, match=r"E-NEST-13 bar: none of HEA200 for S235.*--bar .SECTION=6 m grade=S235"):
            self.members(tmp_path, "HEA200=6 m grade=S355", "L50=6 m")


@pytest.mark.parametrize(
    "text", ["2500x1250 material=", "2500x1250 price=cheap", "2500 material=MDF", "1x1 grain=perhaps"]
)
def test_options_that_are_none(text):
    with pytest.raises(ValueError, match=r"\w"):
        sheet_of(text)
