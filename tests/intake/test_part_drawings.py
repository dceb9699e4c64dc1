"""Drawings of parts as people have them: each gives its right part, or is refused by name."""

from itertools import pairwise
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf.layouts.layout import Modelspace

import isomould
from isomould.documents.drawing import Circle, Polyline, signed_area
from isomould.errors import Refused
from isomould.intake.drawn_part import PartDrawing, read_part_drawing
from isomould.intake.part_layers import LayerChoice
from isomould.intake.read import Asked, read_part_list

CASES = Path(__file__).parent / "cases"
STOCK = {"sheets": [{"name": "A", "width": 3000, "height": 1500}], "gap": 5}


def read(file: Path, *, turns: bool = True, **choice) -> PartDrawing:
    return read_part_drawing(file, LayerChoice(**choice), turns=turns)


def case(number: str, **choice) -> PartDrawing:
    (file,) = (CASES / "parts").glob(f"part-{number}-*.dxf")
    return read(file, **choice)


def areas(drawing: PartDrawing) -> list[float]:
    return [shapely.Polygon(part.outline).area for part in drawing.parts]


def codes(drawing: PartDrawing) -> list[str]:
    return [note.code for note in drawing.notes] + [code for part in drawing.parts for code, _ in part.remarks]


def net_area(drawing: PartDrawing) -> float:
    (part,) = drawing.parts
    cut = [np.pi * hole.radius**2 if isinstance(hole, Circle) else -signed_area(hole) for hole in part.holes]
    return shapely.Polygon(part.outline).area - sum(cut)


class TestSharedCases:
    @pytest.mark.parametrize(
        ("number", "net", "noted"),
        [
            ("01", 240_000 - np.pi * 1600, []),
            ("04", 240_000 - 6400, []),
            ("12", 240_000, ["W-DXF-LEFT-OUT"]),
            ("13", 240_000 - np.pi * 400, []),
            ("18", 240_000 - np.pi * 1600, ["W-PART-TWICE"]),
            ("19", 240_000, []),
        ],
    )
    def test_parts_with_holes_texts_and_copies(self, number, net, noted):
        drawing = case(number)
        assert net_area(drawing) == pytest.approx(net, abs=1e-6)
        assert codes(drawing) == noted

    def test_a_gap_of_a_hundredth_is_joined_and_noted(self):
        drawing = case("05")
        assert areas(drawing) == [pytest.approx(240_000, abs=3)]
        assert codes(drawing) == ["W-DRAWN-JOINED"]

    @pytest.mark.parametrize(
        ("number", "area", "noted"),
        [
            ("08", np.pi * 300**2, "W-PART-ARC"),
            ("24", np.pi * 400 * 200, "W-PART-CURVE"),
            ("31", 0.75 * np.pi * 400**2, "W-PART-ARC"),
        ],
    )
    def test_curved_outlines_lie_outside_within_a_twentieth(self, number, area, noted):
        drawing = case(number)
        (found,) = areas(drawing)
        assert area < found < area + 0.05 * shapely.Polygon(drawing.parts[0].outline).length
        assert codes(drawing) == [noted]

    def test_two_parts_in_one_file(self):
        drawing = case("11")
        assert areas(drawing) == [240_000, 40_000]
        assert codes(drawing) == ["W-PART-SEVERAL"]

    def test_without_a_header_the_unit_is_asked_for(self):
        with pytest.raises(Refused, match="E-DXF-UNITS"):
            case("28")
        assert areas(case("28", units="mm")) == [240_000]

    @pytest.mark.parametrize(
        ("number", "words"),
        [
            ("02", r"E-PART-CROSS.*400\.000, 150\.000 mm"),
            ("03", r"E-PART-TWICE.*open.*drawn twice"),
            ("15", r'E-PART-LAYER.*--inner-layer "HOLES".*--ignore-layer "HOLES"'),
            ("17", r"E-PART-HOLE.*100\.000, 100\.000 mm lies in the hole"),
            ("21", r"E-PART-CROSS.*400\.000"),
        ],
    )
    def test_refused(self, number, words):
        with pytest.raises(Refused, match=words):
            case(number)

    def test_a_layer_named_as_holes_is_cut_and_one_named_as_ignored_is_not(self):
        assert net_area(case("15", inner=("holes",))) == pytest.approx(240_000 - np.pi * 1600)
        assert net_area(case("15", ignored=("HOLES",))) == 240_000


class TestSharedFolders:
    def test_a_hole_on_the_outline_s_layer(self):
        (hole,) = read_part_list(CASES / "lists" / "d02_hole_same_layer", Asked(STOCK)).holes["P"]
        assert isinstance(hole, Polyline)
        assert hole.layer == "CUT_INNER"

    def test_holes_on_an_inventor_s_layer_are_never_dropped(self):
        folder = CASES / "lists" / "d03_inventor"
        with pytest.raises(Refused, match=r"E-PART-LAYER.*IV_INTERIOR_PROFILES"):
            read_part_list(folder, Asked(STOCK, layer="IV_OUTER_PROFILE"))
        named = Asked(STOCK, layer="IV_OUTER_PROFILE", inner_layers=("IV_INTERIOR_PROFILES",))
        given = read_part_list(folder, named)
        assert len(given.holes["P"]) == 1
        assert [note.text for note in given.notes] == ["layers not read: IV_BEND"]

    def test_no_bound_says_two_where_frames_hold_the_rest(self, tmp_path):
        files = isomould.NestFiles(changes={"sheets": [{"name": "s", "width": 2100, "height": 1050}], "gap": 5})
        layout = isomould.nest(CASES / "lists" / "d05_frame", tmp_path / "out.json", "quick", files=files, jobs=1)
        assert layout.bound == 1
        assert len(layout.placements) == 10

    def test_doubled_lines_are_dropped_with_a_note(self):
        given = read_part_list(CASES / "lists" / "d08_double", Asked(STOCK))
        assert [note.code for note in given.notes] == ["W-PART-TWICE"]
        assert given.instance.parts[0].polygon.area == 400_000

    def test_an_odd_angle_is_turned_unless_the_material_has_a_direction(self):
        folder = CASES / "lists" / "d14_rot30"
        given = read_part_list(folder, Asked(STOCK))
        assert np.ptp(given.instance.parts[0].outline, axis=0).tolist() == [1000, 400]
        assert [str(note) for note in given.notes] == ["W-PART-TURNED R: turned by -30.000° to the least box"]
        for direction in ({"turning": "half"}, {"sheets": [{**STOCK["sheets"][0], "grain": True}]}):
            kept = read_part_list(folder, Asked({**STOCK, **direction}))
            assert not kept.notes
            assert np.ptp(kept.instance.parts[0].outline, axis=0)[0] > 1000


# --- drawings of our own

SQUARE = [(0, 0), (800, 0), (800, 500), (0, 500)]


class Sheet:
    """A drawing in the making."""

    def __init__(self, path: Path) -> None:
        self.document, self.path = ezdxf.new("R2010", units=4), path

    @property
    def model(self) -> Modelspace:
        return self.document.modelspace()

    def loop(self, points, layer="CUT", **more):
        self.model.add_lwpolyline(points, close=True, dxfattribs={"layer": layer}, **more)
        return self

    def lines(self, points, layer="CUT"):
        for start, end in pairwise(points):
            self.model.add_line(start, end, dxfattribs={"layer": layer})
        return self

    def circle(self, x, y, radius, layer="CUT"):
        self.model.add_circle((x, y), radius, dxfattribs={"layer": layer})
        return self

    def read(self, *, turns: bool = True, **choice) -> PartDrawing:
        self.document.saveas(self.path)
        return read(self.path, turns=turns, **choice)


@pytest.fixture
def sheet(tmp_path):
    return Sheet(tmp_path / "P.dxf")


class TestLoops:
    def test_holes_and_outlines_in_any_order_and_parts_from_left_to_right(self, sheet):
        sheet.circle(1450, 100, 20).circle(100, 100, 30).loop([(1000, 0), (1600, 0), (1600, 300)]).loop(SQUARE)
        drawing = sheet.read()
        assert areas(drawing) == [400_000, 90_000]
        assert [len(part.holes) for part in drawing.parts] == [1, 1]

    def test_outlines_may_share_an_edge_and_a_hole_touches_a_corner_of_another_entity(self, sheet):
        drawing = sheet.loop(SQUARE).loop([(800, 0), (1000, 0), (1000, 500), (800, 500)]).read()
        assert areas(drawing) == [400_000, 100_000]

    @pytest.mark.parametrize(
        ("holes", "words"),
        [
            ([(100, 100, 50), (180, 100, 50)], "meets the hole"),
            ([(100, 100, 50), (200, 100, 50)], "meets the hole"),
            ([(100, 100, 50), (100, 100, 20)], "lies in the hole"),
            ([(50, 100, 50)], "touches the outline"),
            ([(40, 100, 50)], "reaches out of the outline"),
            ([(-30, 100, 50)], "lies in no outline"),
        ],
    )
    def test_impossible_holes_are_refused(self, sheet, holes, words):
        sheet.loop(SQUARE)
        for x, y, radius in holes:
            sheet.circle(x, y, radius, "DRILL")
        with pytest.raises(Refused, match=f"E-PART-HOLE.*{words}"):
            sheet.read()

    def test_a_hole_over_the_edge_on_the_outline_s_layer_is_no_part(self, sheet):
        with pytest.raises(Refused, match=r"E-PART-CROSS.*cross each other"):
            sheet.loop(SQUARE).circle(-1, 100, 3).read()

    def test_a_part_in_a_frame_that_is_drawn_around_it_is_refused(self, sheet):
        with pytest.raises(Refused, match=r"E-PART-HOLE.*lies in the hole"):
            sheet.loop(SQUARE).loop([(20, 20), (700, 20), (700, 400), (20, 400)]).circle(100, 100, 30).read()

    def test_a_hole_on_two_layers_is_one(self, sheet):
        (part,) = sheet.loop(SQUARE).circle(100, 100, 30).circle(100, 100, 30, "DRILL").read().parts
        assert len(part.holes) == 1

    def test_a_line_over_part_of_a_closed_side_is_taken_once(self, sheet):
        drawing = sheet.loop(SQUARE).lines([(100, 0), (300, 0)]).read()
        assert areas(drawing) == [400_000]
        assert codes(drawing) == ["W-PART-TWICE"]

    @pytest.mark.parametrize("end", [(300, 200), (900, -50)])
    def test_an_open_curve_on_a_layer_that_is_cut_is_refused(self, sheet, end):
        with pytest.raises(Refused, match=r"E-PART-OPEN.*LINE.*100\.000, 100\.000 mm"):
            sheet.loop(SQUARE).lines([(100, 100), end]).read()

    def test_many_holes(self, sheet):
        sheet.loop([(0, 0), (2000, 0), (2000, 1000), (0, 1000)])
        for k in range(600):
            sheet.circle(30 + 60 * (k % 30), 30 + 45 * (k // 30), 12, "DRILL")
        (part,) = sheet.read().parts
        assert len(part.holes) == 600


class TestLayers:
    def test_the_only_layer_with_curves_is_taken_and_noted(self, sheet):
        drawing = sheet.loop(SQUARE, "0").read()
        assert areas(drawing) == [400_000]
        assert codes(drawing) == ["W-PART-OUTLINE"]
        with pytest.raises(Refused, match="E-DXF-LAYER"):
            sheet.read(outer="CUT")
        with pytest.raises(Refused, match=r"E-DXF-LAYER.*curves on '0', '1'.*--layer NAME"):
            sheet.loop(SQUARE, "1").read()

    @pytest.mark.parametrize("layer", ["BEND", "bend lines"])
    def test_an_open_line_on_another_layer_is_named_only(self, sheet, layer):
        drawing = sheet.loop(SQUARE).lines([(0, 250), (800, 250)], layer).read()
        assert [note.text for note in drawing.notes] == [f"layers not read: {layer}"]

    def test_lines_that_close_on_another_layer_are_refused(self, sheet):
        corners = [(100, 100), (200, 100), (200, 200), (100, 100)]
        with pytest.raises(Refused, match=r'E-PART-LAYER.*--inner-layer "SLOT"'):
            sheet.loop(SQUARE).lines(corners, "SLOT").read()

    def test_so_are_those_that_close_where_lines_branch(self, sheet):
        corners = [(100, 100), (200, 100), (200, 200), (100, 100)]
        with pytest.raises(Refused, match="E-PART-LAYER"):
            sheet.loop(SQUARE).lines([*corners, (50, 50)], "SLOT").read()

    def test_frames_copies_and_what_lies_elsewhere_cut_nothing(self, sheet):
        frame = [(-100, -100), (1000, -100), (1000, 700), (-100, 700)]
        sheet.loop(SQUARE).circle(100, 100, 30).loop(frame, "FRAME").loop(SQUARE, "COPY").circle(100, 100, 30, "COPY")
        drawing = sheet.circle(5000, 0, 30, "LOGO").circle(100, 100, 10, "IN THE HOLE").read()
        assert [note.text for note in drawing.notes] == ["layers not read: COPY, FRAME, IN THE HOLE, LOGO"]
        assert net_area(drawing) == pytest.approx(400_000 - 900 * np.pi)

    def test_a_layer_that_is_not_shown_may_hold_holes(self, sheet):
        sheet.document.layers.add("H").freeze()
        sheet.loop(SQUARE).circle(100, 100, 30, "H").lines([(0, 0), (10, 10)], "H")
        with pytest.raises(Refused, match=r"E-PART-LAYER.*'H' is frozen and holds 1 CIRCLE"):
            sheet.read()
        assert areas(sheet.read(ignored=("H",))) == [400_000]

    def test_layers_that_are_not_read_may_be_drawn_in_space(self, sheet):
        sheet.loop(SQUARE).lines([(50, 50, 0), (50, 50, 100)], "AXES").lines([(0, 0, 5), (0, 0, 9)], "MORE")
        assert areas(sheet.read()) == [400_000]
        with pytest.raises(Refused, match="E-PART-LAYER"):
            sheet.lines([(100, 100, 0), (200, 100, 5), (200, 200, 9), (100, 100, 0)], "AXES").read()

    def test_a_layer_of_texts_alone_is_no_part(self, sheet):
        sheet.model.add_text("P", dxfattribs={"layer": "CUT"})
        with pytest.raises(Refused, match=r"E-PART-NONE.*--layer"):
            sheet.read(outer="CUT")

    def test_what_our_own_drawings_engrave_is_no_hole(self, sheet):
        assert not codes(sheet.loop(SQUARE).circle(100, 100, 30, "ENGRAVE").loop(SQUARE, "SHEET").read())

    def test_texts_and_points_are_left_out_everywhere(self, sheet):
        for layer in ("CUT", "CUT_INNER", "NOTES"):
            sheet.model.add_text("P", height=20, dxfattribs={"layer": layer}).set_placement((10, 10))
            sheet.model.add_mtext("P", dxfattribs={"layer": layer, "insert": (50, 50)})
            sheet.model.add_point((20, 20), dxfattribs={"layer": layer})
        drawing = sheet.loop(SQUARE).read()
        assert areas(drawing) == [400_000]
        assert set(codes(drawing)) == {"W-DXF-LEFT-OUT", "W-PART-LAYER"}


class TestCurves:
    def test_a_closed_spline_around_and_one_within(self, sheet):
        outer = [(0, 0, 0), (600, 0, 0), (800, 300, 0), (400, 600, 0), (0, 400, 0)]
        sheet.model.add_spline(dxfattribs={"layer": "CUT"}).set_closed(outer, 3)
        hole = sheet.model.add_ellipse((350, 250), (80, 0), 0.5, dxfattribs={"layer": "CUT_INNER"})
        drawing = sheet.read(turns=False)
        (part,) = drawing.parts
        true = shapely.Polygon([(v.x, v.y) for v in hole.flattening(1e-4)])
        cut = shapely.Polygon(part.holes[0].points)
        assert true.buffer(1e-3).contains(cut)
        assert 0 < true.area - cut.area < 0.05 * true.length
        assert "W-PART-CURVE" in codes(drawing)

    def test_a_slot_on_drill_and_arcs_of_holes_stay_arcs(self, sheet):
        slot = [(100, 100, 0), (200, 100, 1), (200, 140, 0), (100, 140, 1)]
        (part,) = sheet.loop(SQUARE).loop(slot, "DRILL", format="xyb").read().parts
        (hole,) = part.holes
        assert isinstance(hole, Polyline)
        assert (hole.layer, sorted(np.abs(hole.bulges).round(9).tolist())) == ("CUT_INNER", [0, 0, 1, 1])
        assert signed_area(hole) == pytest.approx(-(4000 + np.pi * 400))

    def test_a_part_turned_by_any_angle_comes_back_level_with_its_holes(self, sheet):
        turn = np.radians(17.3)
        matrix = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        x, y = matrix @ (200, 100)
        drawing = sheet.loop((SQUARE @ matrix.T).tolist()).circle(x, y, 30, "DRILL").read()
        (part,) = drawing.parts
        assert np.ptp(part.outline, axis=0).tolist() == [800, 500]
        away = np.hypot(*(part.outline - part.holes[0].centre).T)
        assert np.sort(away) == pytest.approx(np.sort(np.hypot(*(np.array(SQUARE) - (200, 100)).T)), abs=2e-3)
        assert not codes(sheet.read(turns=False))


def test_several_parts_of_a_file_get_letters_and_the_quantity_of_the_file(sheet, tmp_path):
    sheet.loop(SQUARE).loop([(1000, 0), (1300, 0), (1300, 200), (1000, 200)]).circle(1100, 100, 20).read()
    (tmp_path / "P.dxf").rename(tmp_path / "P_x3.dxf")
    given = read_part_list(tmp_path, Asked(STOCK))
    assert [(part.id, part.quantity, len(part.holes)) for part in given.instance.parts] == [
        ("P-a", 3, 0),
        ("P-b", 3, 1),
    ]
    (tmp_path / "P_x3.dxf").rename(tmp_path / "P.dxf")
    (tmp_path / "parts.csv").write_text("mark,quantity\nP,2\n")
    given = read_part_list(tmp_path, Asked(STOCK))
    assert [(part.id, part.quantity) for part in given.instance.parts] == [("P-a", 2), ("P-b", 2)]


def test_the_options_of_the_command(sheet, tmp_path):
    corners = [(0, 0), (800, 0), (800, 500), (0, 500), (0, 0.3)]
    sheet.lines(corners, "outline").circle(100, 100, 30, "holes").circle(300, 100, 30, "marks").document.saveas(
        sheet.path
    )
    (tmp_path / "parts.csv").write_text("mark,quantity\nP,2\n")
    out, cut = tmp_path / "out.json", tmp_path / "cut"
    layers = {"layer": "outline", "inner_layers": ("holes",), "ignored_layers": ("marks",)}
    files = isomould.NestFiles(changes=STOCK, sheets=cut, join=0.5, **layers)
    notes = []
    layout = isomould.nest(tmp_path, out, "quick", files=files, jobs=1, remark=notes.append)
    assert [note.code for note in notes] == ["W-DRAWN-JOINED"]
    assert isomould.verify(out, jobs=1, sheets=cut).passed
    drawn = ezdxf.readfile(cut / f"{layout.sheets[0].id}.dxf").modelspace().query('LWPOLYLINE[layer=="CUT_INNER"]')
    assert len(drawn) == 2
