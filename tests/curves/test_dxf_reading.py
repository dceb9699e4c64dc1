import contextlib

import numpy as np
import pytest
from ezdxf.filemanagement import new
from ezdxf.math import Matrix44
from pydantic import TypeAdapter

from isomould.curves.construction import build_curve
from isomould.curves.curve import join_pieces
from isomould.curves.drawn import DxfSettings, read_drawn
from isomould.curves.lengths import length, parameter_at
from isomould.curves.plane import PlaneSettings, build_plane
from isomould.curves.settings import CurveSettings
from isomould.curves.turning import arcs, spans
from isomould.errors import OutputFault, Refused

SETTINGS = TypeAdapter(CurveSettings)
PLANE = TypeAdapter(PlaneSettings)
BACK = (0, 0, -1)
EIGHTH = np.tan(np.pi / 8)


@pytest.fixture
def draw(tmp_path):
    """Give a function that draws on layer RAIL, writes the file and reads the curve back."""

    def drawn(sketch, *, insunits=4, version="R2010", plane=None, **table):
        document = new(version, units=insunits)
        document.layers.add("RAIL")
        sketch(Pen(document))
        document.saveas(tmp_path / "rail.dxf")
        settings = SETTINGS.validate_python({"kind": "dxf", "file": "rail.dxf", "layer": "RAIL", **table})
        return build_curve(settings, tmp_path, plane, "rail.curve")

    return drawn


class Pen:
    """The model space with every entity on layer RAIL."""

    def __init__(self, document, space=None):
        self.document = document
        self.space = document.modelspace() if space is None else space

    def __getattr__(self, name):
        def add(*args, **kwargs):
            attributes = {"layer": "RAIL", **kwargs.pop("dxfattribs", {})}
            return getattr(self.space, f"add_{name}")(*args, dxfattribs=attributes, **kwargs)

        return add


def ends(curve):
    last = np.array([len(curve.pieces) - 1])
    return curve.point(np.array([0]), np.zeros(1))[0], curve.point(last, np.ones(1))[0]


def middle(curve):
    return curve.point(np.array([0]), np.array([0.5]))[0]


def refused(draw, sketch, **table):
    with pytest.raises(Refused) as refusal:
        draw(sketch, **table)
    assert refusal.value.field.startswith("rail.curve")
    return str(refusal.value)


# --- every kind of entity


def test_line(draw):
    curve, notes = draw(lambda pen: pen.line((0, 0), (9000, 4000)))
    np.testing.assert_array_equal(ends(curve), [(0, 0), (9000, 4000)])
    assert notes == ()


def test_arc(draw):
    curve, _ = draw(lambda pen: pen.arc((1000, 0), 9000, 350, 80))
    assert arcs(spans(curve)).turning == pytest.approx([np.pi / 2])
    end = np.radians(80)
    np.testing.assert_allclose(ends(curve)[1], [1000 + 9000 * np.cos(end), 9000 * np.sin(end)])


def test_circle(draw):
    curve, _ = draw(lambda pen: pen.circle((1000, 0), 9000))
    assert curve.closed
    assert length(curve) == pytest.approx(2 * np.pi * 9000)


def test_ellipse(draw):
    curve, _ = draw(lambda pen: pen.ellipse((0, 0), (0, 9000), 0.5, 0, np.pi / 2))
    np.testing.assert_allclose(ends(curve), [(0, 9000), (-4500, 0)], atol=1e-9)
    closed, _ = draw(lambda pen: pen.ellipse((0, 0), (9000, 0), 0.5))
    assert closed.closed


def test_lwpolyline_with_bulges(draw):
    curve, _ = draw(lambda pen: pen.lwpolyline([(0, 0, 1), (9000, 0, 0)], format="xyb"))
    assert middle(curve) == pytest.approx([4500, -4500])
    closed, _ = draw(lambda pen: pen.lwpolyline([(0, 0, 1), (9000, 0, 1)], format="xyb", close=True))
    assert closed.closed
    assert length(closed) == pytest.approx(9000 * np.pi)


@pytest.mark.parametrize(("version", "table"), [("R12", {"units": "mm"}), ("R2010", {})])
def test_polyline2d(draw, version, table):
    points = [(0, 0, 0.5), (9000, 0, -0.5), (18000, 0, 0)]
    curve, _ = draw(lambda pen: pen.polyline2d(points, format="xyb"), version=version, **table)
    assert arcs(spans(curve)).sign.tolist() == [1, -1]
    assert middle(curve) == pytest.approx([4500, -2250])


def test_polyline3d(draw):
    curve, _ = draw(lambda pen: pen.polyline3d([(0, 0, 5), (9000, 0, 5), (9000, 9000, 5)], close=True))
    assert curve.closed
    assert len(curve.pieces) == 3


def test_splines(draw):
    points = [(0, 0), (3000, 6000), (9000, 6000), (12000, 0)]
    curve, _ = draw(lambda pen: pen.open_spline(points))
    np.testing.assert_allclose(ends(curve), [points[0], points[-1]], atol=1e-9)
    rational, _ = draw(lambda pen: pen.rational_spline([*points, (15000, 0)], [1, 2, 1, 3, 1]))
    assert rational.pieces[0].weights != (1.0,) * 4
    closed, _ = draw(lambda pen: pen.spline().set_closed([(x, y, 0) for x, y in points]))
    assert closed.closed
    assert arcs(spans(closed)).turning == pytest.approx([-2 * np.pi])


def test_fit_points_only(draw):
    points = [(0, 0), (3000, 6000), (9000, 6000), (12000, 0)]
    curve, notes = draw(lambda pen: pen.spline(points))
    settings = SETTINGS.validate_python({"kind": "spline", "points": points})
    assert curve.pieces == build_curve(settings, None)[0].pieces
    assert [n.code for n in notes] == ["W-DXF-FIT"]
    tangents = {"start_tangent": (0, 2, 0), "end_tangent": (0, -5, 0)}
    bent, _ = draw(lambda pen: pen.spline(points, dxfattribs=tangents))
    assert bent.derivative(np.array([0]), np.zeros(1))[0][0] == pytest.approx(0, abs=1e-9)
    closed, _ = draw(lambda pen: pen.spline(points, dxfattribs={"flags": 1}))
    assert closed.closed
    assert len(closed.pieces) == 4


# --- chains


CORNERS = [(0, 0), (9000, 0), (9000, 5000), (0, 5000)]


def test_lines_join_in_any_order_and_direction(draw):
    def sketch(pen):
        for a, b in ((0, 1), (3, 2), (3, 0), (1, 2)):
            pen.line(CORNERS[a], CORNERS[b])

    curve, _ = draw(sketch)
    assert curve.closed
    assert [piece.start for piece in curve.pieces] == CORNERS


def test_an_open_chain_goes_the_way_of_its_first_entity(draw):
    def sketch(pen):
        pen.line((9000, 0), (0, 0))
        pen.arc((9000, 2000), 2000, 270, 0)
        pen.lwpolyline([(11000, 5000), (11000, 2000)])

    curve, _ = draw(sketch)
    assert not curve.closed
    np.testing.assert_allclose(ends(curve), [(11000, 5000), (0, 0)])
    assert [piece.kind for piece in curve.pieces] == ["line", "ellipse", "line"]
    assert spans(curve).kink_span.size == 0


def test_many_lines(draw):
    places = np.column_stack([np.linspace(0, 90000, 400), 1000 * np.sin(np.linspace(0, 9, 400))])
    order = np.random.default_rng(3).permutation(399)

    def sketch(pen):
        for k in order:
            pen.line(*places[k : k + 2][:: (-1) ** k])

    curve, _ = draw(sketch)
    assert {ends(curve)[0][0], ends(curve)[1][0]} == {0, 90000}
    assert len(curve.pieces) == 399


def test_a_dot_is_left_out_with_a_note(draw):
    def sketch(pen):
        pen.line((0, 0), (9000, 0))
        pen.line((9000, 0), (9000, 0))
        pen.line((9000, 0), (9000, 9000))

    curve, notes = draw(sketch)
    assert len(curve.pieces) == 2
    assert [n.code for n in notes] == ["W-CURVE-REPEATED"]


# --- one shape, many drawings


def half_circle_nurbs(pen):
    points = [(9000, 0), (9000, 9000), (0, 9000), (-9000, 9000), (-9000, 0)]
    w = np.sqrt(0.5)
    pen.rational_spline(points, [1, w, 1, w, 1], degree=2, knots=[0, 0, 0, 1, 1, 2, 2, 2])


@pytest.mark.parametrize(
    "sketch",
    [
        lambda pen: pen.ellipse((0, 0), (9000, 0), 1, 0, np.pi),
        lambda pen: pen.lwpolyline([(9000, 0, 1), (-9000, 0, 0)], format="xyb"),
        lambda pen: pen.lwpolyline([(9000, 0, EIGHTH), (0, 9000, EIGHTH), (-9000, 0, 0)], format="xyb"),
        lambda pen: pen.arc((0, 0), 9000, 0, 180, dxfattribs={"extrusion": BACK}),
        half_circle_nurbs,
    ],
    ids=["ellipse", "bulge", "two bulges", "mirrored", "nurbs"],
)  # fmt: skip
def test_the_same_half_circle(draw, sketch):
    arc, _ = draw(lambda pen: pen.arc((0, 0), 9000, 0, 180))
    other, _ = draw(sketch)
    s = np.linspace(0, 9000 * np.pi, 13)
    expected, found = arc.point(*parameter_at(arc, s)), other.point(*parameter_at(other, s))
    found = found if found[0][0] > 0 else found[::-1]
    np.testing.assert_allclose(found, expected, atol=1e-8)


# --- object coordinate systems and blocks


def test_mirrored_extrusion_mirrors_x(draw):
    curve, notes = draw(lambda pen: pen.arc((5000, 0), 2000, 0, 90, dxfattribs={"extrusion": BACK}))
    np.testing.assert_allclose(ends(curve), [(-7000, 0), (-5000, 2000)], atol=1e-9)
    assert [n.code for n in notes] == ["W-DXF-OCS"]
    points = [(1000, 0, 0.5), (4000, 0, 0)]
    bulged, _ = draw(lambda pen: pen.lwpolyline(points, format="xyb", dxfattribs={"extrusion": BACK}))
    np.testing.assert_allclose(ends(bulged), [(-1000, 0), (-4000, 0)], atol=1e-12)
    assert middle(bulged) == pytest.approx([-2500, -750])


def block_of(pen, name="PART", layer="0"):
    block = pen.document.blocks.new(name)
    block.add_line((0, 0), (1000, 0), dxfattribs={"layer": layer})
    block.add_arc((1000, 500), 500, 270, 0, dxfattribs={"layer": layer})
    block.add_lwpolyline([(1500, 500, 0.2), (1500, 900, 0)], format="xyb", dxfattribs={"layer": layer})
    return name


@pytest.mark.parametrize("layer", ["0", "RAIL"])
def test_blocks_are_placed_with_a_note(draw, layer):
    def sketch(pen):
        scale = {"xscale": -2, "yscale": 2, "zscale": 2, "rotation": 90}
        insert_layer = "RAIL" if layer == "0" else "OTHER"
        pen.blockref(block_of(pen, layer=layer), (100, 200), dxfattribs={**scale, "layer": insert_layer})

    curve, notes = draw(sketch)
    np.testing.assert_allclose(ends(curve), [(100, 200), (100 - 1800, 200 - 3000)], atol=1e-9)
    assert curve.point(np.array([1]), np.array([0.5]))[0] == pytest.approx(
        [100 - 1000 * (1 - np.sqrt(0.5)), 200 - 2000 - 1000 * np.sqrt(0.5)]
    )
    assert notes[0].code == "W-DXF-BLOCK"
    assert "(block PART)" in notes[0].text


def test_nested_blocks(draw):
    def sketch(pen):
        outer = pen.document.blocks.new("OUTER")
        outer.add_blockref(block_of(pen), (1000, 0))
        pen.blockref("OUTER", (0, 500))

    curve, _ = draw(sketch)
    np.testing.assert_allclose(ends(curve)[0], (1000, 500), atol=1e-9)


AFFINE = {  # of an INSERT: attributes, and the matrix (rows are the images of x and y) and offset that they stand for
    "stretched": ({"xscale": 3, "yscale": 0.5}, [[3, 0], [0, 0.5]], (0, 0)),
    "mirrored, stretched": ({"xscale": -1, "yscale": 2}, [[-1, 0], [0, 2]], (0, 0)),
    "turned, stretched": ({"xscale": 2, "yscale": 5, "rotation": 90}, [[0, 2], [-5, 0]], (0, 0)),
    "seen from below": ({"xscale": 2, "extrusion": BACK}, [[-2, 0], [0, 1]], (0, 0)),
    "moved": ({"xscale": 2, "yscale": 3, "zscale": 7}, [[2, 0], [0, 3]], (500, -70)),
}


def whole_sketch(pen):
    """Every kind of entity once, end to end."""
    pen.line((0, 0), (1000, 0))
    pen.arc((1000, 500), 500, 270, 0)
    pen.lwpolyline([(1500, 500, 0.4), (1500, 900, 0)], format="xyb")
    pen.ellipse((1500, 1100), (400, 0), 0.5, -np.pi / 2, 0)
    pen.rational_spline([(1900, 1100), (2500, 1100), (2500, 1900)], [1, 0.7, 1], degree=2)


@pytest.mark.parametrize("case", AFFINE)
def test_stretched_blocks_are_the_affine_image_exactly(draw, case):
    attributes, matrix, offset = AFFINE[case]

    def inserted(pen):
        block = pen.document.blocks.new("PART", base_point=(10, 20))
        whole_sketch(Pen(pen.document, block))
        pen.blockref("PART", offset, dxfattribs=attributes)

    plain, _ = draw(whole_sketch)
    curve, notes = draw(inserted)
    index, t = np.repeat(np.arange(5), 7), np.tile(np.linspace(0, 1, 7), 5)
    expected = (plain.point(index, t) - [10, 20]) @ np.array(matrix, float) + offset
    np.testing.assert_allclose(curve.point(index, t), expected, atol=1e-9)
    assert notes[0].code == "W-DXF-BLOCK"


def test_nested_stretched_blocks_multiply(draw):
    def sketch(pen):
        outer = pen.document.blocks.new("OUTER")
        outer.add_blockref(block_of(pen), (100, 0), dxfattribs={"rotation": 90})
        pen.blockref("OUTER", (0, 0), dxfattribs={"xscale": 2, "layer": "RAIL"})

    curve, _ = draw(sketch)
    np.testing.assert_allclose(ends(curve), [(200, 0), (200 - 1800, 1500)], atol=1e-9)


def test_rows_of_a_block_are_each_in_their_place(draw):
    def sketch(pen):
        block = pen.document.blocks.new("STEP")
        block.add_line((0, 0), (1000, 0))
        pen.blockref("STEP", (0, 0), dxfattribs={"column_count": 3, "column_spacing": 1000})

    curve, _ = draw(sketch)
    np.testing.assert_allclose(ends(curve), [(0, 0), (3000, 0)])


def test_blocks_that_cannot_be_placed_are_refused(draw):
    def collapsed(pen):
        insert = pen.blockref(block_of(pen), (0, 0))
        insert.dxf.discard("xscale")
        insert.dxf.__dict__["xscale"] = 0.0

    assert "scales 0, 1, 1" in refused(draw, collapsed)

    text = refused(draw, lambda pen: pen.blockref("NONE", (0, 0)))
    assert "refers to another drawing, or to no block" in text


def test_a_block_of_other_units_is_read_as_its_insert_scales_it(draw):
    def in_metres(pen):
        block_of(pen)
        pen.document.blocks.get("PART").units = 6
        pen.blockref("PART", (0, 0), dxfattribs={"xscale": 2, "yscale": 2, "zscale": 2})

    curve, notes = draw(in_metres)
    np.testing.assert_allclose(ends(curve), [(0, 0), (3000, 1800)], atol=1e-9)
    assert notes[0].code == "W-DXF-BLOCK"


# --- in space


def test_world_drawings_are_projected_on_the_plane(draw):
    place = {"origin": [100, 200, 300], "x_axis": [0, 1, 0], "y_axis": [0, 0, 1]}
    plane = build_plane(PLANE.validate_python(place))
    curve, _ = draw(lambda pen: pen.line((100, 200, 300), (100, 9200, 1300)), plane=plane, drawn="world")
    np.testing.assert_allclose(ends(curve), [(0, 0), (9000, 1000)])
    spline, _ = draw(lambda pen: pen.open_spline([(100, 0, 0), (100, 1000, 0), (100, 0, 9000), (100, 1, 0)]),
                     plane=plane, drawn="world")  # fmt: skip
    np.testing.assert_allclose(ends(spline), [(-200, -300), (-199, -300)], atol=1e-9)


def test_an_upright_arc_in_the_world(draw):
    """Extrusion −y: the drawing's own x is the world's x, its y the world's z."""
    plane = build_plane("xz")

    def sketch(pen):
        pen.arc((0, 0, 0), 9000, 0, 90, dxfattribs={"extrusion": (0, -1, 0)})

    curve, _ = draw(sketch, plane=plane, drawn="world")
    np.testing.assert_allclose(ends(curve), [(9000, 0), (0, 9000)], atol=1e-9)
    assert "leaves the height of the drawing" in refused(draw, sketch)
    assert 'set drawn = "world"' in refused(draw, sketch)


def test_what_leaves_the_plane_is_refused(draw):
    plane = build_plane("xz")
    text = refused(draw, lambda pen: pen.line((0, 0.02, 0), (9000, 0, 0)), plane=plane, drawn="world")
    assert "E-DRAWN-PLANE" in text
    assert "by 0.02 mm" in text
    text = refused(draw, lambda pen: pen.line((0, 0, 0), (9000, 0, 1)))
    assert "leaves the height of the drawing by 1 mm" in text


def test_a_rigid_motion_in_the_world_changes_nothing(draw):
    motion = Matrix44.chain(Matrix44.xyz_rotate(0.3, -0.7, 1.1), Matrix44.translate(1e4, -2e4, 3e4))
    x, y = ([*motion.transform_direction(v)] for v in ((1, 0, 0), (0, 1, 0)))
    table = {"origin": [*motion.transform((0, 0, 0))], "x_axis": x, "y_axis": y}
    plane = build_plane(PLANE.validate_python(table))

    def sketch(pen, moved=False):
        chain = [
            pen.lwpolyline([(0, 0, 0.3), (4000, 0, 0)], format="xyb"),
            pen.arc((4000, 1000), 1000, 270, 0),
            pen.ellipse((4000, 1000), (0, 3000), 1 / 3, -np.pi / 2, 0),
        ]
        for entity in chain:
            if moved:
                entity.transform(motion)

    flat, _ = draw(sketch)
    moved, _ = draw(lambda pen: sketch(pen, moved=True), plane=plane, drawn="world")
    index, t = np.repeat(np.arange(3), 5), np.tile(np.linspace(0, 1, 5), 3)
    np.testing.assert_allclose(moved.point(index, t), flat.point(index, t), atol=1e-8)


# --- units


@pytest.mark.parametrize(
    ("code", "factor"), [(1, 25.4), (2, 304.8), (4, 1), (5, 10), (6, 1000), (10, 914.4), (14, 100)]
)
def test_drawing_units(draw, code, factor):
    curve, _ = draw(lambda pen: pen.arc((0, 0), 9, 0, 90), insunits=code)
    assert length(curve) == pytest.approx(4.5 * np.pi * factor)


def nine(pen):
    pen.line((0, 0), (9, 0))


def test_units_of_the_project_file(draw):
    assert length(draw(nine, insunits=0, units="m")[0]) == 9000
    assert length(draw(nine, insunits=6, units="m")[0]) == 9000


def test_units_of_the_project_file_win_with_a_note_that_names_both(draw):
    curve, notes = draw(nine, insunits=4, units="m")
    assert length(curve) == 9000
    assert [n.code for n in notes] == ["W-DRAWN-UNITS"]
    assert "read in m as asked, although the file says mm" in notes[0].text
    assert length(draw(nine, insunits=18, units="m")[0]) == 9000


@pytest.mark.parametrize(
    ("code", "table", "says"),
    [
        (0, {}, "rail.curve.units: a drawing without units"),
        (18, {}, "drawing units $INSUNITS 18"),
    ],
)
def test_unknown_units_are_refused(draw, code, table, says):
    text = refused(draw, nine, insunits=code, **table)
    assert "E-DXF-UNITS" in text
    assert says in text


# --- layers and entities


def two_lines(gap):
    def sketch(pen):
        pen.line((0, 0), (9000, 0))
        pen.line((9000 + gap, 0), (9000, 9000))

    return sketch


def branching(pen):
    two_lines(0)(pen)
    pen.arc((9000, 1000), 1000, 270, 0)


def doubled(pen):
    pen.line((0, 0), (9000, 0))
    pen.line((9000, 0), (0, 0))


def mesh(pen):
    pen.polyline2d([(0, 0), (9000, 0)]).dxf.flags = 64


def false_closure(pen):
    pen.open_spline([(0, 0), (3000, 6000), (9000, 6000), (12000, 0)]).dxf.flags |= 1


def bad_weights(pen):
    pen.rational_spline([(0, 0), (3000, 6000), (9000, 6000), (12000, 0)], [1, -1, 1, 1])


def bad_knots(pen):
    pen.open_spline([(0, 0), (3000, 6000), (9000, 6000), (12000, 0)]).knots = [0, 0, 0, 0, 1, 1, 1]


@pytest.mark.parametrize(
    ("sketch", "code", "says"),
    [
        (two_lines(0.02), "CURVES", "their nearest ends are 0.02 mm apart"),
        (branching, "CURVES", "3 ends meet at (9000, 0): LINE"),
        (doubled, "CURVES", "lie on each other"),
        (lambda pen: pen.line((5, 5), (5, 5)), "CURVES", "only points"),
        (lambda pen: pen.text("RAIL"), "ENTITY", "TEXT"),
        (lambda pen: pen.point((0, 0)), "ENTITY", "visible ARC, CIRCLE, ELLIPSE, LINE"),
        (lambda pen: pen.line((0, 0), (9, 9), dxfattribs={"invisible": 1}), "ENTITY", "LINE"),
        (lambda pen: pen.line((0, 0), (float("nan"), 9)), "NUMBER", "a number nan"),
        (lambda pen: pen.line((0, 0), (float("inf"), 9)), "NUMBER", "a number"),
        (lambda pen: pen.line((0, 0), (1e300, 9)), "NUMBER", "1e+300"),
        (lambda pen: pen.lwpolyline([(float("inf"), 0), (9, 9)]), "NUMBER", "LWPOLYLINE 30: a number"),
        (lambda pen: pen.circle((0, 0), 0), "ENTITY", "radius 0"),
        (lambda pen: pen.circle((0, 0), -5), "ENTITY", "radius -5"),
        (mesh, "ENTITY", "a mesh"),
        (lambda pen: pen.spline([(0, 0), (0, 0)]), "ENTITY", "1 different fit points"),
        (false_closure, "CURVES", "says that it is closed, but its ends are 12000 mm apart"),
        (bad_weights, "", "E-SPLINE-WEIGHTS rail.curve, SPLINE"),
        (bad_knots, "", "7 knots"),
        (lambda pen: pen.line((0, 0), (9, 9), dxfattribs={"layer": "OTHER"}), "LAYER", "one of 'OTHER' (1 LINE)"),
        (lambda pen: None, "LAYER", "nothing on layer 'RAIL'"),
    ],
)
def test_refusals_of_what_is_drawn(draw, sketch, code, says):
    text = refused(draw, sketch)
    assert code in text
    assert says in text


@pytest.mark.parametrize("state", ["freeze", "off"])
def test_hidden_layers_are_refused(draw, state):
    def sketch(pen):
        pen.line((0, 0), (9000, 0))
        getattr(pen.document.layers.get("RAIL"), state)()

    assert f"layer 'RAIL' is {state.replace('eeze', 'ozen')}" in refused(draw, sketch)


def test_layer_names_ignore_case_and_paper_space_is_no_drawing(draw):
    def sketch(pen):
        pen.line((0, 0), (9000, 0))
        pen.document.paperspace().add_line((0, 0), (5, 5), dxfattribs={"layer": "RAIL"})
        pen.text("another layer", dxfattribs={"layer": "NOTES"})

    assert length(draw(sketch, layer="rail")[0]) == 9000


# --- broken files


def read(path):
    settings = DxfSettings(kind="dxf", file=path.name, layer="RAIL", units="mm")
    return read_drawn(settings, path.parent, None, "rail.curve")


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "has 0 bytes"),
        (b"hello\n", "does not end like a DXF file"),
        (bytes(range(256)) * 40, "does not end like a DXF file"),
        (b"AutoCAD Binary DXF\r\n\x1a\x00rest", "binary DXF"),
        (b"nonsense\n  0\nEOF\n", "is damaged"),
        (b"  0\nSECTION\n  2\nENTITIES\n  0\nLINE\n 10\n  0\nENDSEC\n  0\nEOF\n", "is damaged"),
        (b"  0\nSECTION\n  2\nENTITIES\n  0\nLINE\n  0\nEOF\n", "section ENTITIES has no end"),
    ],
    ids=["empty", "text", "garbage", "binary", "headless", "a line lost", "no end"],
)
def test_files_that_are_no_dxf_are_refused(tmp_path, content, says):
    path = tmp_path / "rail.dxf"
    path.write_bytes(content)
    with pytest.raises(Refused, match="E-DXF-FILE") as refusal:
        read(path)
    assert says in refusal.value.found


def test_missing_files_and_folders_are_refused(tmp_path):
    for path in (tmp_path / "none.dxf", tmp_path):
        with pytest.raises(Refused, match="is no file"):
            read(path)


def test_files_cut_off_anywhere_are_refused(draw, tmp_path):
    draw(branching_free)
    whole = (tmp_path / "rail.dxf").read_bytes()
    path = tmp_path / "cut.dxf"
    for share in np.linspace(0.01, 0.999, 40):
        path.write_bytes(whole[: int(share * len(whole))])
        with pytest.raises(Refused, match="E-DXF-FILE"):
            read(path)


def branching_free(pen):
    pen.line((0, 0), (9000, 0))


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """The bytes of a drawing with a block, a line, an arc and a polyline."""
    document = new("R2000", units=4)
    pen = Pen(document)
    pen.blockref(block_of(pen), (0, 0))
    pen.line((1500, 900), (0, 1500))
    path = tmp_path_factory.mktemp("sound") / "rail.dxf"
    document.saveas(path)
    return path.read_bytes()


@pytest.mark.parametrize("seed", range(40))
def test_corrupted_files_end_in_a_curve_or_in_a_refusal(tmp_path, sound, seed):
    """Whatever bytes are overwritten or lost, nothing but a refusal comes out beside a checked curve."""
    rng = np.random.default_rng(seed)
    content = bytearray(sound)
    for _ in range(3):
        place, lost = int(rng.integers(len(content) // 2, len(content))), int(rng.integers(1, 40))
        spoilt = rng.choice(list(b"0123456789-.e\n ABZ\xff"), lost // 2)
        content[place : place + lost] = bytes(spoilt.tolist())
    path = tmp_path / "damaged.dxf"
    path.write_bytes(content)
    with contextlib.suppress(Refused):
        draft = read(path)
        assert join_pieces(draft.pieces, draft.closed)[0].pieces


def test_too_large_files_are_refused_unread(tmp_path):
    path = tmp_path / "rail.dxf"
    with path.open("wb") as file:
        file.truncate(101 * 2**20)
    with pytest.raises(Refused, match="has 105906176 bytes"):
        read(path)


def test_a_file_that_may_not_be_read_is_a_fault_of_the_system(draw, tmp_path, monkeypatch):
    draw(branching_free)

    def closed(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("pathlib.Path.open", closed)
    with pytest.raises(OutputFault, match=r"rail\.dxf: Permission denied"):
        read(tmp_path / "rail.dxf")


def test_reading_prints_nothing(draw, capfd):
    draw(branching_free, version="R12", units="mm")
    assert capfd.readouterr() == ("", "")
