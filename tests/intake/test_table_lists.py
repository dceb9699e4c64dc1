"""Tables as people have them: headings of five languages, encodings, titles and totals, units and signs of numbers.

Formats after what their programs write: CutList Optimizer and CutList Plus (`Part #,Description,Thick,Length,Width,
Copies,Material Name`), OpenCutList (UTF-16, tabs, units in cells), CSV-BOM of Fusion (`Part name,Quantity,Volume cm^3,
Width mm,Length mm,Height mm`; the smallest size is the height), bills of SolidWorks (`ITEM NO.,PART NUMBER,QTY.`) and
Tekla reports with titles and totals. The rows are ours.
"""

from pathlib import Path

import numpy as np
import openpyxl
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from isomould.errors import Refused
from isomould.intake.member_list import lists_members, read_member_list
from isomould.intake.numbers import Signs, find_signs, to_length
from isomould.intake.read import Asked, read_part_list
from isomould.intake.table_words import Reading

CASES = Path(__file__).parent / "cases" / "lists"
STOCK = {"sheets": [{"name": "A", "width": 6000, "height": 3210}], "gap": 5}
BARS = {"bars": [{"section": "HEA200", "length": 12000}]}


def read(path, **asked):
    return read_part_list(path, Asked(STOCK, **asked))


def parts_of(path, **asked):
    return [
        (part.id, part.quantity, *np.ptp(part.outline, axis=0).tolist()) for part in read(path, **asked).instance.parts
    ]


def written(tmp_path, text, name="list.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


def codes(given_):
    return [note.code for note in given_.notes]


class TestCases:
    """What the README of the cases asks for."""

    def test_cut_list_optimizer(self, tmp_path):
        path = CASES / "a01_cutlistoptimizer.csv"
        assert parts_of(path) == [("Left rail;Right rail", 48, 16, 1), ("Shelf", 6, 24.5, 11.25)]
        assert parts_of(path, units="in")[0][2:] == pytest.approx((406.4, 25.4))
        assert any("read in mm" in note.text for note in read(path).notes)
        off = written(tmp_path, path.read_text().replace("11.25,6,Plastic,Shelf,true", "11.25,6,Plastic,Shelf,false"))
        given_ = read(off)
        assert [part.id for part in given_.instance.parts] == ["Left rail;Right rail"]
        assert any("switched off: Shelf (line 3)" in note.text for note in given_.notes)

    def test_open_cut_list(self):
        assert parts_of(CASES / "a09_opencutlist.csv") == [("A", 1, 1200, 600), ("B", 2, 700, 600)]
        assert "W-PART-UNITS" not in codes(read(CASES / "a09_opencutlist.csv"))

    @pytest.mark.parametrize(
        ("file", "parts"),
        [
            ("a10_unit_cells.csv", [("P1", 2, 650, 400)]),
            ("a11_sep.csv", [("P1", 6, 900.5, 700)]),
            ("a14_float.csv", [("P1", 4, 900, 700)]),
            ("a24_width_height.csv", [("P1", 4, 900, 700)]),
            ("label_width_height.csv", [("Frame 1", 2, 1400, 100), ("Frame 2", 2, 540, 82), ("Frame 3", 2, 206, 66)]),
        ],
    )
    def test_sizes(self, file, parts):
        assert parts_of(CASES / file) == parts

    def test_quantity_nought(self):
        given_ = read(CASES / "a15_zero.csv")
        assert [part.id for part in given_.instance.parts] == ["P1"]
        assert [note.text for note in given_.notes] == ["left out, quantity 0: P2 (line 3)"]

    def test_tekla(self):
        path = CASES / "a21_tekla.csv"
        assert lists_members(path)
        given_, notes = read_member_list(path, BARS)
        members = [(m.id, m.section, m.quantity, m.length) for m in given_.members]
        assert members == [("B/1", "HEA200", 4, 5980), ("B/2", "HEA200", 12, 1840.5)]
        told = " ".join(note.text for note in notes)
        assert "line 1 'CUTTING LIST'" in told
        assert "totals: line 7" in told
        assert "W-PART-TOTAL" not in {note.code for note in notes}
        with pytest.raises(Refused, match=r"bar: missing.*--bar"):
            read_member_list(path, {})

    def test_thousands(self):
        with pytest.raises(Refused, match=r"E-NEST-11.*'1\.900' may be 1900 or 1\.9"):
            read(CASES / "a23_thousands_silent.csv")


class TestHeadings:
    @pytest.mark.parametrize(
        "heading",
        [
            "Mark;Quantity;Length;Width",
            "Pos.;Anzahl;Länge [mm];Breite [mm]",
            "Bezeichnung;Stück;LAENGE;BREITE",
            "Repère;Qté;Longueur (mm);Largeur (mm)",
            "Referencia;Cantidad;Largo;Ancho",
            "Codice;Quantità;Lunghezza;Larghezza",
            "Label;Nos.;Width in mm;Height in mm",
            "ITEM NO.;QTY.;LENGTH, mm;WIDTH, mm",
            "Name;Pcs;Cut length_mm;Cut width_mm",
            "Nr.;Menge;Breite/mm;Höhe/mm",
        ],
    )
    def test_five_languages(self, tmp_path, heading):
        path = written(tmp_path, f"{heading}\nP1;3;900;700\n")
        assert parts_of(path) == [("P1", 3, 900, 700)]

    def test_marks_come_before_names_and_cut_sizes_before_others(self, tmp_path):
        text = "No.,Name,Qty,Length,Width,Cutting length,Cutting width\n1,Door,2,800,500,810,510\n"
        given_ = read(written(tmp_path, text))
        assert parts_of(written(tmp_path, text)) == [("1", 2, 810, 510)]
        assert "not read: Name, Length, Width" in [note.text for note in given_.notes]

    def test_as_an_option_says(self, tmp_path):
        path = written(tmp_path, "Ding,Wieviel,Maß 1,Maß 2,Extra\nA,2,900,700,x\n")
        with pytest.raises(Refused, match="no heading that is known; the first line has Ding, Wieviel, Maß 1, Maß 2"):
            read(path)
        columns = {"id": "Ding", "quantity": "Wieviel", "length": "Maß 1", "width": "maß 2"}
        assert parts_of(path, columns=columns) == [("A", 2, 900, 700)]
        with pytest.raises(Refused, match=r"--column width=Maß 3.*no columns 'Maß 3' among Ding"):
            read(path, columns={**columns, "width": "Maß 3"})

    def test_what_is_missing_is_said(self, tmp_path):
        with pytest.raises(
            Refused, match=r"length alone, in columns Label, Qty, Length\. Limit: two of.*--column width="
        ):
            read(written(tmp_path, "Label,Qty,Length\nA,2,900\n"))
        with pytest.raises(Refused, match=r"Länge, Laenge: two columns for length.*--column length="):
            read(written(tmp_path, "Label,Länge,Laenge,Breite\nA,2,900,1\n"))

    def test_no_is_a_number_of_pieces_beside_a_mark_alone(self, tmp_path):
        assert parts_of(written(tmp_path, "Mark,No.,Length,Width\nA,7,900,700\n")) == [("A", 7, 900, 700)]
        numbered = written(tmp_path, "No.,Length,Width\n1,900,700\n2,800,600\n")
        assert parts_of(numbered) == [("1", 1, 900, 700), ("2", 1, 800, 600)]
        assert "W-PART-QUANTITY" in codes(read(numbered))
        with pytest.raises(Refused, match=r"'No\.' runs from 1 to 2.*--column quantity="):
            read(written(tmp_path, "Mark,No.,Length,Width\nA,1,900,700\nB,2,800,600\n"))

    @pytest.mark.parametrize(
        "heading",
        ["No. of pcs", "Qty required", "Anzahl gesamt", "Nb pièces", "N° pièces", "Nº piezas", "N° pezzi", "Q.tà"],
    )
    def test_pieces_in_other_words(self, tmp_path, heading):
        assert parts_of(written(tmp_path, f"Mark;{heading};Length;Width\nA;4;900;700\n")) == [("A", 4, 900, 700)]

    def test_a_heading_that_may_count_pieces_is_never_one_a_row(self, tmp_path):
        path = written(tmp_path, "Mark,Qty per flat,Length,Width\nA,4,900,700\n")
        with pytest.raises(Refused, match=r"'Qty per flat', which may count pieces.*--column quantity='Qty per flat'"):
            read(path)
        assert parts_of(path, columns={"quantity": "Qty per flat"}) == [("A", 4, 900, 700)]

    def test_a_size_that_is_not_positive_is_named_as_listed(self, tmp_path):
        with pytest.raises(Refused, match=r"line 2: length: -900 mm\. Limit: greater than zero"):
            read(written(tmp_path, "Mark,Qty,Length,Width\nA,1,-900,700\n"))
        with pytest.raises(Refused, match=r"no size, in columns Mark, Qty, Diameter"):
            read(written(tmp_path, "Mark,Qty,Diameter\nA,1,700\n"))

    def test_glass_is_a_mark_beside_a_make_up(self, tmp_path):
        (one,) = read(written(tmp_path, "Vetro;Pz;L;H;Composizione\nV1;2;1250;2100;44.2\n")).instance.parts
        assert (one.id, one.material.material) == ("V1", "44.2")
        (one,) = read(written(tmp_path, "Pos;Stk;B;H;Glas\n7;2;1250;2100;ESG 8\n")).instance.parts
        assert (one.id, one.material.material) == ("7", "ESG 8")

    @pytest.mark.parametrize("heading", ["Species", "Holzart", "Essence", "Essenza", "Dekor", "Scheibenaufbau"])
    def test_woods_decors_and_panes_are_materials(self, tmp_path, heading):
        given_ = read(written(tmp_path, f"Mark;Qty;Length;Width;{heading}\nA;2;900;400;Oak\nB;1;900;400;Ash\n"))
        assert [part.material.material for part in given_.instance.parts] == ["Oak", "Ash"]

    def test_rough_sizes_are_what_is_cut(self, tmp_path):
        text = "Nom;Longueur brute;Largeur brute;Longueur finie;Largeur finie;Qté\nA;905;405;900;400;2\n"
        assert parts_of(written(tmp_path, text)) == [("A", 2, 905, 405)]
        assert "not read: Longueur finie, Largeur finie" in [note.text for note in read(tmp_path / "list.csv").notes]

    def test_names_that_repeat_get_numbers_and_marks_are_refused(self, tmp_path):
        given_ = read(written(tmp_path, "Name,Qty,Length,Width\nSide,1,900,700\nSide,2,800,600\n,1,70,60\n"))
        assert [part.id for part in given_.instance.parts] == ["Side", "Side (2)", "3"]
        assert "W-PART-MARKS" in codes(given_)
        with pytest.raises(Refused, match=r"line 3\.id: 'A' is given twice"):
            read(written(tmp_path, "Mark,Qty,Length,Width\nA,1,900,700\nA,2,800,600\n"))

    def test_three_sizes_of_a_box(self, tmp_path):
        text = "Part name,Quantity,Volume cm^3,Width mm,Length mm,Height mm\nTop,1,1,600,1200,18\nLeg,4,1,18,80,700\n"
        given_ = read(written(tmp_path, text))
        assert parts_of(written(tmp_path, text)) == [("Top", 1, 1200, 600), ("Leg", 4, 80, 700)]
        assert "W-PART-BOX" in codes(given_)


class TestFiles:
    TEXT = "Stück;Bezeichnung;Länge;Breite\n2;Tür;900,5;700\n"

    @pytest.mark.parametrize(
        "encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "cp1252", "cp850"]
    )
    def test_encodings(self, tmp_path, encoding):
        path = written(tmp_path, self.TEXT, encoding=encoding)
        assert parts_of(path) == [("Tür", 2, 900.5, 700)]
        assert ("W-PART-ENCODING" in codes(read(path))) == (encoding in ("cp1252", "cp850"))

    @pytest.mark.parametrize(("name", "sign"), [("l.tsv", "\t"), ("l.txt", "|"), ("l.txt", "    "), ("l.CSV", ";")])
    def test_separators(self, tmp_path, name, sign):
        assert parts_of(written(tmp_path, self.TEXT.replace(";", sign), name)) == [("Tür", 2, 900.5, 700)]

    def test_excel(self, tmp_path):
        book = openpyxl.Workbook()
        book.active.title = "Notes"
        sheet = book.create_sheet("Cut list")
        for row in (["Order 17"], [], ["Part", "Qty", "Length (mm)", "Width (mm)"], ["A", 2, 900.125, 700], [None, 2]):
            sheet.append(row)
        sheet["A5"] = "Total"
        book.save(tmp_path / "list.xlsx")
        given_ = read(tmp_path / "list.xlsx")
        assert parts_of(tmp_path / "list.xlsx") == [("A", 2, 900.125, 700)]
        assert codes(given_) == ["W-PART-ROWS", "W-PART-ROWS"]
        (tmp_path / "no.xlsx").write_text("no workbook")
        with pytest.raises(Refused, match="no workbook"):
            read(tmp_path / "no.xlsx")

    def test_titles_units_totals_rules_and_headings_again(self, tmp_path):
        text = """Cut list;;;
Job 12;;;
=======;;;
Mark;No. of pieces;Length;Width
;pcs;cm;mm
Kitchen;;;
A;2;90;700
-------;;;
Mark;No. of pieces;Length;Width
B;1;80,5;600
Subtotal;3;;
Printed by hand;;;
"""
        path = written(tmp_path, text)
        assert parts_of(path) == [("A", 2, 900, 700), ("B", 1, 805, 600)]
        told = [note.text for note in read(path).notes]
        assert told == [
            "left out, before the heading: line 1 'Cut list', line 2 'Job 12'",
            "left out, no parts: line 6 'Kitchen', line 12 'Printed by hand'",
            "left out, totals: line 11 'Subtotal 3'",
        ]
        assert "W-PART-TOTAL" in codes(read(written(tmp_path, text.replace("Subtotal;3", "Subtotal;4"))))

    def test_a_report_in_columns(self, tmp_path):
        text = """
  TEKLA STRUCTURES                 MATERIAL LIST
  ------------------------------------------------
  Mark    Profile    No.   Length(mm)   Weight(kg)
  ------------------------------------------------
  B1      HEA200     4     5980         252.9
  B2      HEA200     12    1840         77.8
  ------------------------------------------------
  Total              16
"""
        path = written(tmp_path, text, "report.txt")
        members = read_member_list(path, BARS)[0].members
        assert [(m.id, m.quantity, m.length) for m in members] == [("B1", 4, 5980), ("B2", 12, 1840)]


class TestNumbers:
    @pytest.mark.parametrize(
        ("cell", "length"),
        [
            ('27 7/8"', 708.025),
            ("650 mm", 650),
            ("12'-3 1/2\"", 3746.5),
            ("12' 3\"", 3733.8),
            ("5½ in", 139.7),
            ("~ 600 mm", 600),
            ("1.2 m", 1200),
            ("65 cm", 650),
            ("2 ft", 609.6),
            ("1'240 mm", 1240),
            ("1 840.5 mm", 1840.5),
        ],
    )
    def test_units_in_cells(self, tmp_path, cell, length):
        quoted = cell.replace('"', '""')
        path = written(tmp_path, f'Mark,Qty,Length,Width\nA,1,"{quoted}",50 mm\n')
        assert parts_of(path)[0][2] == pytest.approx(length)

    @pytest.mark.parametrize(
        ("cells", "separator", "sign"),
        [
            (["1.900", "12,5"], ";", ","),
            (["1,900", "12.5"], ";", "."),
            (["1.900.000"], ";", ","),
            (["1.234,5"], ";", ","),
            (["1,234.5"], ",", "."),
            (["1.900", "0.04"], ";", "."),
            (["1200.000"], ";", "."),
            (["0,125", "0,250"], ";", ","),
            (["1.900"], ",", "."),
            (["900"], ";", "."),
        ],
    )
    def test_the_list_says_how_its_numbers_are_written(self, cells, separator, sign):
        assert find_signs(cells, [], separator, "mm", "list").decimal == sign

    @pytest.mark.parametrize(("cells", "separator"), [(["1.900", "700"], ";"), (["1,900"], ","), (["1.900"], "\t")])
    def test_what_every_number_leaves_open_is_refused(self, cells, separator):
        with pytest.raises(Refused, match=r"may be 1900 or 1\.9"):
            find_signs(cells, [], separator, "mm", "list")
        assert find_signs(cells, ["77,8"], separator, "mm", "list").decimal == ","
        assert find_signs(cells, [], separator, "m", "list").decimal in cells[0]

    def test_two_decimal_signs(self):
        with pytest.raises(Refused, match="one decimal sign"):
            find_signs(["12,5", "12.5"], [], ";", "mm", "list")

    @settings(max_examples=60)
    @given(st.integers(1, 999_999_999), st.sampled_from([".", ","]), st.booleans())
    def test_numbers_come_back_as_they_were_written(self, thousandths, decimal, grouped):
        whole, rest = divmod(thousandths, 1000)
        digits = f"{whole:,}" if grouped else str(whole)
        text = digits.replace(",", "." if decimal == "," else ",") + f"{decimal}{rest:03}0"
        signs = find_signs([text], [], ";", "mm", "list")
        assert to_length(text, signs, "mm", "cell") == pytest.approx(thousandths / 1000, abs=1e-9)

    def test_fractions_want_a_unit(self, tmp_path):
        path = written(tmp_path, "Mark,Qty,Length,Width\nA,1,27 7/8,10\n")
        with pytest.raises(Refused, match=r"a fraction without a unit.*--units in"):
            read(path)
        assert parts_of(path, units="in")[0][2:] == pytest.approx((708.025, 254))

    def test_cells_without_a_unit_are_read_as_the_others(self, tmp_path):
        path = written(tmp_path, 'Mark,Qty,Length,Width\nA,1,"10""",5\n')
        assert parts_of(path)[0][2:] == pytest.approx((254, 127))
        mixed = written(tmp_path, 'Mark,Qty,Length,Width\nA,1,"10""",5\nB,1,5 cm,5 cm\n')
        with pytest.raises(Refused, match="without a unit, beside cells in cm and in"):
            read(mixed)
        assert parts_of(mixed, units="mm")[0][2:] == pytest.approx((254, 5))

    @pytest.mark.parametrize(("cell", "count"), [("4", 4), ("4.0", 4), ("4 pcs", 4), ("x4", 4), ("4 Stk.", 4)])
    def test_pieces(self, tmp_path, cell, count):
        assert parts_of(written(tmp_path, f"Mark,Qty,Length,Width\nA,{cell},900,700\n"))[0][1] == count

    @pytest.mark.parametrize("cell", ["", "-4", "4.5", "four", "4e3", "99999999999"])
    def test_no_pieces(self, tmp_path, cell):
        with pytest.raises(Refused, match=r"line 2: quantity.*a whole number of pieces"):
            read(written(tmp_path, f"Mark,Qty,Length,Width\nA,{cell},900,700\n"))

    def test_groups_that_are_none_are_refused(self):
        assert Signs(",").plain("1.234,5") == "1234.5"
        with pytest.raises(Refused):
            to_length("12.34", Signs(","), "mm", "cell")


def test_members_by_an_option(tmp_path):
    path = written(tmp_path, "Stab;Anzahl;Profil;Länge\nT1;3;L50;600\n")
    reading = Reading(columns={"id": "Stab"})
    assert lists_members(path, reading)
    (member,) = read_member_list(path, BARS, reading)[0].members
    assert (member.id, member.quantity, member.section, member.length) == ("T1", 3, "L50", 600)


def test_a_profile_with_a_width_is_cut_from_bars_where_the_stock_has_bars_alone(tmp_path):
    path = written(tmp_path, "Mark,Qty,Profile,Length,Width\nT1,3,L50,600,50\n")
    assert lists_members(path, None, BARS)
    assert not lists_members(path, None, {**BARS, **STOCK})
    assert not lists_members(path)


class TestPlates:
    """Steel lists name plates as sections: plates of two thicknesses never share a sheet."""

    def test_the_thickness_is_in_the_section(self, tmp_path):
        text = "Mark;Profile;Material;No.;Length;Width\nP1;{};S355;4;1200;200\nP2;PL 12*150;S355;2;800;150\n"
        for section, thickness in (("PL10*200", 10), ("FL 200x12,5", 12.5), ("Bl. 8", 8), ("PL1/2x12", 12.7)):
            given_ = read(written(tmp_path, text.format(section)))
            assert [part.material.thickness for part in given_.instance.parts] == [thickness, 12]
            assert "W-PART-SECTION" in codes(given_)
        with pytest.raises(Refused, match=r"line 2: section: 'HEA200'.*plates such as PL10\*200"):
            read(written(tmp_path, text.format("HEA200")))

    def test_a_column_of_thicknesses_comes_first_and_other_words_are_not_read(self, tmp_path):
        (one,) = read(written(tmp_path, "Mark,Profile,Thk,Qty,Length,Width\nA,PL10,12,1,900,700\n")).instance.parts
        assert one.material.thickness == 12
        given_ = read(written(tmp_path, "Mark,Size,Qty,Length,Width\nA,900 x 700,1,900,700\n"))
        assert given_.instance.parts[0].material.thickness is None
        assert "not read: the section of parts, such as '900 x 700'" in [note.text for note in given_.notes]


def test_lists_on_two_sheets_of_a_workbook_are_refused(tmp_path):
    book = openpyxl.Workbook()
    book.active.append(["Project", "4711"])
    rows = [["Mark", "Qty", "Length", "Width"], ["A", 2, 900, 400]]
    for name in ("Doors", "Walls"):
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(tmp_path / "two.xlsx")
    with pytest.raises(Refused, match=r"lists on the sheets 'Doors', 'Walls'.*one list in a workbook"):
        read(tmp_path / "two.xlsx")
    del book["Walls"]
    book.save(tmp_path / "one.xlsx")
    assert parts_of(tmp_path / "one.xlsx") == [("A", 2, 900, 400)]


class TestUnitsBesideNumbers:
    def test_a_column_of_units(self, tmp_path):
        text = "Part;Copies;Length;Width;Unit\nA;2;90,5;40;cm\nB;1;35;16;in\nC;1;9 mm;8;\n"
        with pytest.raises(Refused, match=r"line 4: width: '8' without a unit"):
            read(written(tmp_path, text))
        assert parts_of(written(tmp_path, text), units="mm") == [
            ("A", 2, 905, 400),
            ("B", 1, 889, 406.4),
            ("C", 1, 9, 8),
        ]
        headed = "Part;Qty;Length mm;Width;Unit\nA;2;900;40;cm\n"
        assert parts_of(written(tmp_path, headed)) == [("A", 2, 900, 400)]

    def test_a_unit_of_pieces_is_none_of_lengths(self, tmp_path):
        assert parts_of(written(tmp_path, "Part;Qty;Unit;Length;Width\nA;2;pcs;900;400\n")) == [("A", 2, 900, 400)]

    @pytest.mark.parametrize(
        ("title", "factor"),
        [("Units: inches", 25.4), ("Cut list (all dimensions in cm)", 10), ("Alle Maße in cm", 10), ("Maße [cm]", 10),
         ("Cotes en cm", 10), ("Project M, sizes in stock", 1), ("Size M", 1), ("Units: cm; dimensions in mm", 1)],
    )  # fmt: skip
    def test_a_unit_in_a_title(self, tmp_path, title, factor):
        path = written(tmp_path, f"{title}\nMark;Qty;Length;Width\nA;2;90;40\n")
        assert parts_of(path)[0][2:] == pytest.approx((90 * factor, 40 * factor))
        assert parts_of(path, units="mm")[0][2:] == (90, 40)
        said = any("as a title before the heading says" in note.text for note in read(path).notes)
        assert said == (factor != 1)


def test_a_second_width_is_no_rectangle(tmp_path):
    path = written(tmp_path, "Mark;Stk;Länge;Breite;Breite 2\nA;2;1200;700;500\n")
    with pytest.raises(Refused, match=r"'Breite 2' beside a width.*a, b, h, ol and orr"):
        read(path)
