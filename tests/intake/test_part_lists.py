"""Part lists of others: CSV, folders of drawings and deliveries become instances, or are refused by name."""

from pathlib import Path

import ezdxf
import numpy as np
import pytest
import shapely

from isomould.documents.drawing import Circle
from isomould.errors import Refused
from isomould.intake.drawn_part import OUTWARD
from isomould.intake.read import Asked, read_part_list
from isomould.intake.stock import read_stock
from isomould.nesting.nest import nest_sheets
from isomould.nesting.search import Search

SHEET = {"sheets": [{"name": "A", "width": "6 m", "height": 3210}], "gap": 5}
ASKED = Asked(SHEET)
GOOD = """id,quantity,a,b,h,ol,orr,points
P1,6,900,820,700,40,40,
X7,3,,,,,,"0,0;500,0;620,300;0,400"
"""


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


def draw(path: Path, points, *, units=4, layer="CUT", closed=True, holes=()):
    document = ezdxf.new("R2010", units=units)
    document.modelspace().add_lwpolyline(points, format="xyb", close=closed, dxfattribs={"layer": layer})
    for x, y, radius in holes:
        document.modelspace().add_circle((x, y), radius, dxfattribs={"layer": "DRILL"})
    document.saveas(path)
    return path


SQUARE = [(0, 0, 0), (400, 0, 0), (400, 300, 0), (0, 300, 0)]


class TestCsv:
    def test_trapezoids_and_polygons(self, tmp_path):
        parts = read_part_list(write(tmp_path / "p.csv", GOOD), ASKED).instance.parts
        assert [(part.id, part.quantity) for part in parts] == [("P1", 6), ("X7", 3)]
        assert parts[0].outline.tolist() == [[0, 0], [900, 0], [860, 700], [40, 700]]
        assert shapely.Polygon(parts[1].outline).area == 199000

    def test_a_byte_order_mark_semicolons_and_decimal_commas(self, tmp_path):
        text = "\ufeffid;quantity;a (cm);b (cm);h (cm);ol (cm);orr (cm)\nP1;2;90,5;82,5;70;4;4\n"
        (part,) = read_part_list(write(tmp_path / "p.csv", text), ASKED).instance.parts
        assert part.outline.tolist() == [[0, 0], [905, 0], [865, 700], [40, 700]]

    @pytest.mark.parametrize(
        ("old", "new", "words"),
        [
            ("P1,6,900,820,700,40,40,", "P1,6,900,5,820,5,700,40,40,", "line 2.*10 cells.*Decimal commas"),
            ("X7", "P1", "P1.*given twice"),
            (",900,", ",nan,", "line 2: a.*'nan'"),
            (",900,", ",inf,", "line 2: a.*'inf'"),
            (",900,", ",1'90,", "line 2: a"),
            ("P1,6,", "P1,-1,", "line 2: quantity.*'-1'"),
            ("P1,6,", "P1,2.5,", "line 2: quantity"),
            ("500,0;620,300;0,400", "500,400;500,0;0,400", "touches or crosses itself"),
            ("500,0;620", "500,0,1;620", "line 3: points"),
            ("700,40", "-700,40", "a and h greater than zero"),
            (",820,", ",800,", "a - ol - orr = 820"),
        ],
    )
    def test_refusals_name_line_and_column(self, tmp_path, old, new, words):
        file = write(tmp_path / "p.csv", GOOD.replace(old, new, 1))
        with pytest.raises(Refused, match=rf"(?s)E-NEST-11.*p\.csv.*{words}"):
            read_part_list(file, ASKED)

    def test_without_a_sheet(self, tmp_path):
        with pytest.raises(Refused, match=r"at least one stock sheet.*--stock"):
            read_part_list(write(tmp_path / "p.csv", GOOD))

    def test_of_a_sheet_without_a_name_just_the_name_is_missing(self, tmp_path):
        with pytest.raises(Refused, match=r"sheets\.0\.name: missing\. .*Give the value"):
            read_part_list(write(tmp_path / "p.csv", GOOD), Asked({"sheets": [{"width": 3000, "height": 2000}]}))


class TestFolder:
    def folder(self, tmp_path, table="file,mark,quantity\nA.dxf,A,4\n"):
        write(tmp_path / "parts.csv", table)
        return tmp_path

    def test_units_of_the_drawing_and_holes_that_move_along(self, tmp_path):
        draw(tmp_path / "A.dxf", [(x / 25.4, y / 25.4, b) for x, y, b in SQUARE], units=1, holes=[(2, 2, 0.25)])
        given = read_part_list(self.folder(tmp_path), ASKED)
        (part,) = given.instance.parts
        assert (part.id, part.quantity) == ("A", 4)
        assert part.outline.max(axis=0).tolist() == [400, 300]
        layout = nest_sheets(given.instance.parts, given.instance.stock, Search("quick"))
        for placement in layout.placements:
            (hole,) = given.holes_of(placement)
            assert isinstance(hole, Circle)
            assert hole.radius == pytest.approx(6.35)
            corner = placement.points[0]
            assert np.hypot(*(hole.centre - corner)) == pytest.approx(50.8 * 2**0.5, abs=1e-3)
            assert shapely.Polygon(placement.points).contains(shapely.Point(hole.centre).buffer(6))

    @pytest.mark.parametrize("bulge", [0.3, -0.3, 1.0, -0.9])
    def test_arcs_become_polygons_outside_never_inside(self, tmp_path, bulge):
        draw(tmp_path / "A.dxf", [(0, 0, 0), (400, 0, bulge), (400, 300, 0), (0, 300, 0)])
        given = read_part_list(self.folder(tmp_path), ASKED)
        outline = shapely.Polygon(given.instance.parts[0].outline)
        chord, sagitta = 300.0, abs(bulge) * 150
        radius = (chord**2 / 4 + sagitta**2) / (2 * sagitta)
        side = np.sign(bulge)
        centre = 400 + side * (sagitta - radius)
        disc = shapely.Point(centre, 150).buffer(radius, quad_segs=20000)
        segment = disc.intersection(shapely.box(400, 0, 900, 300) if side > 0 else shapely.box(-500, 0, 400, 300))
        true = shapely.box(0, 0, 400, 300).union(segment) if side > 0 else shapely.box(0, 0, 400, 300) - segment
        assert true.difference(outline).area < 1e-3
        assert outline.difference(true.buffer(OUTWARD + 1e-3)).area < 1e-3
        assert [note.code for note in given.notes] == ["W-PART-ARC"]

    def test_open_outlines_missing_and_surplus_drawings_are_refused(self, tmp_path):
        draw(tmp_path / "A.dxf", SQUARE, closed=False)
        with pytest.raises(Refused, match=r"E-PART-OPEN.*A\.dxf"):
            read_part_list(self.folder(tmp_path), ASKED)
        draw(tmp_path / "A.dxf", SQUARE)
        draw(tmp_path / "B.dxf", SQUARE)
        with pytest.raises(Refused, match=r"no row for B\.dxf"):
            read_part_list(self.folder(tmp_path), ASKED)
        with pytest.raises(Refused, match=r"C.dxf is no file"):
            read_part_list(self.folder(tmp_path, "file,mark,quantity\nC.dxf,C,4\n"), ASKED)

    def test_a_drawing_without_units_wants_them(self, tmp_path):
        draw(tmp_path / "A.dxf", SQUARE, units=0)
        with pytest.raises(Refused, match="E-DXF-UNITS"):
            read_part_list(self.folder(tmp_path), ASKED)
        (part,) = read_part_list(tmp_path, Asked(SHEET, "cm")).instance.parts
        assert part.outline.max(axis=0).tolist() == [4000, 3000]


def test_a_delivery_is_nested_as_it_was_scheduled(built_folder):
    for where in (built_folder, built_folder / "panels"):
        given = read_part_list(where, ASKED)
        assert not given.notes
        rows = (built_folder / "tables" / "panels.csv").read_text(encoding="utf-8").splitlines()[1:]
        wanted = {row.split(",")[0]: int(row.split(",")[1]) for row in rows}
        assert {part.id: part.quantity for part in given.instance.parts} == wanted


def test_stock_comes_from_any_toml_with_a_stock_table(tmp_path):
    file = write(tmp_path / "s.toml", "[stock]\ngap = 5\nsheets = [{name = 'A', width = '6 m', height = 3210}]\n")
    stock = read_part_list(write(tmp_path / "p.csv", GOOD), Asked(read_stock(file))).instance.stock
    assert (stock.sheets[0].width, stock.gap) == (6000, 5)
    with pytest.raises(Refused, match="stock: missing"):
        read_stock(write(tmp_path / "t.toml", "[sheets]\n"))
    with pytest.raises(Refused, match=r"E-NEST-11.*gap"):
        read_part_list(tmp_path / "p.csv", Asked({**SHEET, "gap": 1, "kerf": 3}))
