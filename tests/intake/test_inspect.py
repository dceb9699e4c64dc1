"""What `inspect` says of drawings, models and part lists: lengths and boxes known by construction."""

import contextlib
import io
import json
from math import pi, sqrt
from xml.etree import ElementTree

import ezdxf
import pytest
import rhino3dm

import isomould
from isomould.cli import main
from isomould.errors import Refused


def drawing(path, draw, units=4):
    document = ezdxf.new("R2010", units=units)
    draw(document.modelspace(), document)
    document.saveas(path)
    return path


def mixed(space, document):
    """A closed plate, two open curves, a text, a doubled line, a hidden layer and a block that nobody inserts."""
    space.add_lwpolyline([(0, 0), (400, 0), (400, 300), (0, 300)], close=True, dxfattribs={"layer": "CUT"})
    space.add_line((1000, 0), (1300, 400), dxfattribs={"layer": "RAIL"})
    space.add_arc((1300, 0), 400, 0, 90, dxfattribs={"layer": "RAIL"})
    space.add_line((0, 900), (500, 900), dxfattribs={"layer": "RAIL"})
    space.add_text("hello", dxfattribs={"layer": "WORDS"})
    for ends in (((0, 2000), (700, 2000)), ((700, 2000), (0, 2000))):
        space.add_line(*ends, dxfattribs={"layer": "TWICE"})
    document.layers.add("HIDDEN").off()
    space.add_line((0, 0), (9, 9), dxfattribs={"layer": "HIDDEN"})
    document.blocks.new("B").add_line((0, 0), (5, 5), dxfattribs={"layer": "RAIL"})


def run(*arguments):
    """Give exit code, stdout and stderr of a verb."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), pytest.raises(SystemExit) as end:
        main([*map(str, arguments)])
    return end.value.code, out.getvalue(), err.getvalue()


class TestDrawings:
    def test_every_layer_is_listed_with_an_entry_per_chain(self, tmp_path):
        code, out, err = run("inspect", drawing(tmp_path / "mixed.dxf", mixed), "--json")
        data = json.loads(out)
        assert (code, err) == (0, "")
        assert data["units"] == "mm"
        assert [(curve["layer"], curve["closed"], curve["pieces"]) for curve in data["curves"]] == [
            ("CUT", True, 4),
            ("RAIL", False, 2),
            ("RAIL", False, 1),
            ("TWICE", False, 1),
        ]
        lengths = [curve["length_mm"] for curve in data["curves"]]
        assert lengths == pytest.approx([1400, 500 + 200 * pi, 500, 700], abs=1e-6)
        assert data["curves"][1]["box_mm"] == pytest.approx([1000, 0, 1700, 400], abs=1e-6)
        assert [name.split()[0] for name in data["curves"][1]["entities"]] == ["LINE", "ARC"]
        codes = [note["code"] for note in data["notes"]]
        assert codes == ["W-DRAWN-HIDDEN", "W-DRAWN-ELSEWHERE", "W-DRAWN-DOUBLED"]

    def test_a_layer_is_read_as_a_project_reads_it(self, tmp_path):
        path = drawing(tmp_path / "mixed.dxf", mixed)
        code, out, _ = run("inspect", path, "--layer", "cut", "--json")
        assert code == 0
        assert [curve["length_mm"] for curve in json.loads(out)["curves"]] == [1400]
        for layer, word in (("RAIL", "2 curves"), ("TWICE", "lie on each other"), ("NONE", "NONE"), ("WORDS", "TEXT")):
            code, out, err = run("inspect", path, "--layer", layer, "--json")
            assert (code, out) == (2, ""), layer
            assert word in err

    def test_for_people_there_is_a_line_per_curve_and_notes_beside(self, tmp_path):
        code, out, err = run("inspect", drawing(tmp_path / "mixed.dxf", mixed))
        first, *rows = out.splitlines()
        assert code == 0
        assert first.endswith("mixed.dxf: 4 curves, read in mm as the file says")
        assert rows[0].startswith('  "CUT": closed, 1400 mm, 4 pieces, from (0, 0) to (400, 300): LWPOLYLINE')
        assert err.count("note: W-DRAWN-") == 3

    def test_units_are_asked_for_and_win(self, tmp_path):
        path = drawing(tmp_path / "none.dxf", lambda space, _: space.add_line((0, 0), (3, 4)), units=0)
        code, out, err = run("inspect", path)
        assert (code, out) == (2, "")
        assert "--units" in err
        found = isomould.inspect(path, units="in")
        assert found.curves[0].length == pytest.approx(5 * 25.4)
        assert (found.units, found.units_said_by) == ("in", "asked")
        path = drawing(tmp_path / "metres.dxf", lambda space, _: space.add_line((0, 0), (3, 4)), units=6)
        assert isomould.inspect(path).curves[0].length == pytest.approx(5000)
        other = isomould.inspect(path, units="mm")
        assert other.curves[0].length == pytest.approx(5)
        assert [note.code for note in other.notes] == ["W-DRAWN-UNITS"]

    def test_join_decides_what_is_one_curve(self, tmp_path):
        def draw(space, _):
            space.add_line((0, 0), (100, 0))
            space.add_line((100, 0.3), (100, 50))

        path = drawing(tmp_path / "gap.dxf", draw)
        assert len(isomould.inspect(path).curves) == 2
        assert len(isomould.inspect(path, join=0.5).curves) == 1
        code, out, _ = run("inspect", path, "--join", "1/50 in", "--json")
        assert (code, len(json.loads(out)["curves"])) == (0, 1)
        assert run("inspect", path, "--join", "0")[0] == 2

    def test_what_cannot_be_joined_is_told_and_the_rest_is_read(self, tmp_path):
        def draw(space, _):
            for end in ((100, 0), (0, 100), (-100, 0)):
                space.add_line((0, 0), end, dxfattribs={"layer": "STAR"})
            space.add_circle((0, 0), 10, dxfattribs={"layer": "ROUND"})

        data = isomould.inspect(drawing(tmp_path / "star.dxf", draw)).data
        assert [curve["layer"] for curve in data["curves"]] == ["ROUND"]
        assert data["curves"][0]["length_mm"] == pytest.approx(20 * pi)
        assert [(note["code"], "3 ends meet" in note["text"]) for note in data["notes"]] == [("E-DRAWN-CURVES", True)]

    def test_nothing_drawn_is_refused(self, tmp_path):
        path = drawing(tmp_path / "words.dxf", lambda space, _: space.add_text("hello"))
        with pytest.raises(Refused, match=r"no curve in the model among 1 TEXT"):
            isomould.inspect(path)

    def test_a_curve_in_space_is_read_with_a_note(self, tmp_path):
        ends = [(0, 0, 0), (300, 400, 1200), (600, 0, 0)]
        path = drawing(tmp_path / "space.dxf", lambda space, _: space.add_polyline3d(ends))
        found = isomould.inspect(path)
        assert found.curves[0].length == pytest.approx(2600)
        assert found.curves[0].box == pytest.approx((0, 0, 600, 400))
        assert [note.code for note in found.notes] == ["W-DRAWN-SPACE"]

    def test_boxes_hold_what_bulges_between_ends(self, tmp_path):
        def draw(space, _):
            space.add_arc((0, 0), 1000, 30, 150)
            space.add_ellipse((5000, 0), (600, 800), 0.5)
            space.add_open_spline([(0, 5000), (1000, 8000), (2000, 5000)], degree=2)

        arc, ellipse, spline = (curve.box for curve in isomould.inspect(drawing(tmp_path / "box.dxf", draw)).curves)
        assert arc == pytest.approx((-500 * sqrt(3), 500, 500 * sqrt(3), 1000), abs=1e-9)
        wide, high = sqrt(600**2 + 400**2), sqrt(800**2 + 300**2)
        assert ellipse == pytest.approx((5000 - wide, -high, 5000 + wide, high), abs=1e-9)
        assert spline == pytest.approx((0, 5000, 2000, 6500), abs=1e-9)

    def test_a_model_is_read_alike(self, tmp_path):
        model = rhino3dm.File3dm()
        model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
        layer = rhino3dm.Layer()
        layer.Name = "RAIL"
        model.Layers.Add(layer)
        model.Objects.AddCircle(rhino3dm.Circle(2.0))
        model.Write(str(tmp_path / "model.3dm"), 8)
        found = isomould.inspect(tmp_path / "model.3dm")
        assert (found.units, len(found.curves), found.curves[0].closed) == ("m", 1, True)
        assert found.curves[0].length == pytest.approx(4000 * pi)

    def test_the_picture_shows_every_curve_its_start_and_its_end(self, tmp_path):
        path, picture = drawing(tmp_path / "mixed.dxf", mixed), tmp_path / "picture.svg"
        assert run("inspect", path, "--out", picture)[0] == 0
        again = tmp_path / "again.svg"
        isomould.inspect(path, out=again)
        assert again.read_bytes() == picture.read_bytes()
        root = ElementTree.fromstring(picture.read_text("utf-8"))
        names = [element.tag.rpartition("}")[2] for element in root]
        assert (names.count("circle"), names.count("text")) == (4 + 3, 4)
        assert names.count("path") == 2 * 4
        assert run("inspect", path, "--out", tmp_path / "picture.png")[0] == 2

    def test_a_straight_line_has_a_picture_too(self, tmp_path):
        path = drawing(tmp_path / "line.dxf", lambda space, _: space.add_line((5, 0), (5, 900)))
        isomould.inspect(path, out=tmp_path / "line.svg")
        assert "900.000 mm" in (tmp_path / "line.svg").read_text("utf-8")


class TestLists:
    def test_parts_of_a_table(self, tmp_path):
        (tmp_path / "parts.csv").write_text("mark,width,height,quantity\nA,900,700,9\nB,640,410.5,7\n", "utf-8")
        code, out, err = run("inspect", tmp_path / "parts.csv", "--json", "--units", "mm")
        parts = json.loads(out)["parts"]
        assert code == 0, err
        assert [(part["id"], part["quantity"]) for part in parts] == [("A", 9), ("B", 7)]
        assert [(part["width_mm"], part["height_mm"]) for part in parts] == [(900, 700), (640, 410.5)]
        assert [part["area_mm2"] for part in parts] == [630000, 262720]
        code, out, _ = run("inspect", tmp_path / "parts.csv", "--units", "mm")
        assert out.splitlines()[1:] == ["  A: 9 × 900 × 700 mm, 4 corners", "  B: 7 × 640 × 410.5 mm, 4 corners"]

    def test_members(self, tmp_path):
        members = [{"id": "M1", "section": "FL80*8", "length": 1234.5, "quantity": 3}]
        (tmp_path / "bars.json").write_text(json.dumps({"name": "bars", "members": members}), "utf-8")
        found = isomould.inspect(tmp_path / "bars.json")
        assert found.data["parts"] == [{"id": "M1", "quantity": 3, "section": "FL80*8", "length_mm": 1234.5}]
        assert found.lines[1] == "  M1: 3 × 1234.5 mm of FL80*8"

    def test_a_folder_of_drawings(self, tmp_path):
        (tmp_path / "parts").mkdir()
        drawing(tmp_path / "parts" / "P_x4.dxf", mixed)
        found = isomould.inspect(tmp_path / "parts")
        assert [(part["id"], part["quantity"], part["area_mm2"]) for part in found.data["parts"]] == [("P", 4, 120000)]

    def test_what_is_no_list_is_refused(self, tmp_path):
        (tmp_path / "odd.csv").write_text("colour,taste\nred,sweet\n", "utf-8")
        code, out, err = run("inspect", tmp_path / "odd.csv", "--json")
        assert (code, out) == (2, "")
        assert "isomould: E-" in err
        with pytest.raises(Refused, match="E-INSPECT-PICTURE"):
            isomould.inspect(tmp_path / "odd.csv", out=tmp_path / "odd.svg")
