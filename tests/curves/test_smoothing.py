"""Rails that CAD drew smooth and printed with few digits: smooth again, near the exact ones, and no other way round."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter

from isomould.api import check
from isomould.curves.local_curves import build_local_curve
from isomould.curves.pieces import Ellipse, Line
from isomould.curves.settings import CurveSettings
from isomould.curves.turning import arcs, spans
from isomould.design import make_design
from isomould.project.load import validate
from museum import SMALL, write_project

SETTINGS = TypeAdapter(CurveSettings)

PRINTERS = {
    "%g": lambda value: f"{value:g}",
    "4 decimals": lambda value: f"{value:.4f}",
    "6 decimals": lambda value: f"{value:.6f}",
}


def exact(value):
    return f"{value:.17g}"


def tags(*pairs):
    return "".join(f"{code}\n{value}\n" for code, value in zip(pairs[::2], pairs[1::2], strict=True))


class Pen:
    """Writes entities turned by an angle and moved, every number printed by a function."""

    def __init__(self, printed, turn=0.0, at=(0.0, 0.0)):
        self.printed, self.turn, self.at = printed, turn, at

    def place(self, x, y):
        cos, sin = math.cos(self.turn), math.sin(self.turn)
        return self.printed(x * cos - y * sin + self.at[0]), self.printed(x * sin + y * cos + self.at[1])

    def line(self, a, b):
        (x, y), (u, v) = self.place(*a), self.place(*b)
        return tags(0, "LINE", 8, "RAIL", 10, x, 20, y, 11, u, 21, v)

    def arc(self, centre, radius, start, end):
        x, y = self.place(*centre)
        angles = [self.printed(math.degrees(angle + self.turn)) for angle in (start, end)]
        return tags(0, "ARC", 8, "RAIL", 10, x, 20, y, 40, self.printed(radius), 50, angles[0], 51, angles[1])

    def polyline(self, rows, closed):
        body = []
        for x, y, bulge in rows:
            u, v = self.place(x, y)
            body += [10, u, 20, v, 42, self.printed(bulge)]
        return tags(0, "LWPOLYLINE", 8, "RAIL", 90, len(rows), 70, int(closed), *body)

    def spline(self, points, knots):
        body = [pair for knot in knots for pair in (40, knot)]
        for point in points:
            x, y = self.place(*point)
            body += [10, x, 20, y, 30, 0]
        return tags(0, "SPLINE", 8, "RAIL", 70, 8, 71, 3, 72, len(knots), 73, len(points), 74, 0, *body)


def line_arc_line(pen):
    """A hall's eaves: straight, a bend of 60°, straight."""
    cos, sin = math.cos(math.pi / 3), math.sin(math.pi / 3)
    bend = (3000 * sin, 3000 - 3000 * cos)
    away = (bend[0] + 6000 * cos, bend[1] + 6000 * sin)
    return [
        pen.line((-7000, 0), (0, 0)),
        pen.arc((0, 3000), 3000, -math.pi / 2, -math.pi / 6),
        pen.line(bend, away),
    ]


def rounded_rectangle(pen):
    a, b, r, q = 9000.0, 5000.0, 1200.0, math.pi / 2
    return [
        pen.line((r, 0), (a - r, 0)),
        pen.arc((a - r, r), r, -q, 0),
        pen.line((a, r), (a, b - r)),
        pen.arc((a - r, b - r), r, 0, q),
        pen.line((a - r, b), (r, b)),
        pen.arc((r, b - r), r, q, 2 * q),
        pen.line((0, b - r), (0, r)),
        pen.arc((r, r), r, 2 * q, 3 * q),
    ]


def stadium(pen):
    """Half circles: the tangents at both ends of each are parallel."""
    bulges = [(0, 0, 0), (20000, 0, 1), (20000, 6000, 0), (0, 6000, 1)]
    return [pen.polyline(bulges, closed=True)]


def three_arcs(pen):
    """Arc to arc: to the left, on to the left with another radius, then to the right."""
    wide, middle = math.radians(40), math.radians(70)
    second = (0 + 3000 * math.sin(wide), 8000 - 3000 * math.cos(wide))
    out = (math.sin(middle), -math.cos(middle))
    meeting = (second[0] + 5000 * out[0], second[1] + 5000 * out[1])
    third = (meeting[0] + 4000 * out[0], meeting[1] + 4000 * out[1])
    back = math.atan2(-out[1], -out[0])
    return [
        pen.arc((0, 8000), 8000, -math.pi / 2, wide - math.pi / 2),
        pen.arc(second, 5000, wide - math.pi / 2, middle - math.pi / 2),
        pen.arc(third, 4000, back - math.radians(50), back),
    ]


def line_spline_line(pen):
    """A spline between lines in the direction of its end handles."""
    points = [(0, 0), (2000, 0), (5000, 500), (7000, 2500), (8000, 5000), (8500, 7000)]
    end = (points[-1][0] + 500 * 4, points[-1][1] + 2000 * 4)
    knots = [0, 0, 0, 0, 1, 2, 3, 3, 3, 3]
    return [pen.line((-30000, 0), (0, 0)), pen.spline(points, knots), pen.line(points[-1], end)]


def closed_spline(pen):
    """A spline that ends where it starts, its end handles in one line."""
    points = [(0, 0), (3000, 0), (9000, 1000), (9000, 8000), (1000, 9000), (-4000, 5000), (-4000, 0), (0, 0)]
    return [pen.spline(points, [0, 0, 0, 0, 1, 2, 3, 4, 5, 5, 5, 5])]


RAILS = [line_arc_line, rounded_rectangle, stadium, three_arcs, line_spline_line, closed_spline]


def drawing(entities):
    header = tags(0, "SECTION", 2, "HEADER", 9, "$INSUNITS", 70, 4, 0, "ENDSEC")
    return header + tags(0, "SECTION", 2, "ENTITIES") + "".join(entities) + tags(0, "ENDSEC", 0, "EOF")


@pytest.fixture(scope="module")
def read(tmp_path_factory):
    folder = tmp_path_factory.mktemp("smoothing")

    def reading(entities, **table):
        (folder / "rail.dxf").write_text(drawing(entities))
        given_ = SETTINGS.validate_python({"kind": "dxf", "file": "rail.dxf", "layer": "RAIL", **table})
        return build_local_curve(given_, folder, None, "rail.curve")

    return reading


def outline(curve, count):
    """A polygon through points of a curve, (n, 2), mm."""
    index = np.repeat(np.arange(len(curve.pieces)), count)
    return curve.point(index, np.tile(np.linspace(0, 1, count), len(curve.pieces)))


def codes(local):
    return [note.code for note in local.notes]


@pytest.mark.parametrize("rail", RAILS)
@pytest.mark.parametrize("printer", PRINTERS)
@given(turn=st.integers(-300, 300).map(lambda hundredths: hundredths / 100))
@settings(max_examples=3, deadline=None)
def test_a_printed_rail_is_smooth_and_near_the_exact_one(read, rail, printer, turn):
    true, printed = read(rail(Pen(exact, turn))), read(rail(Pen(PRINTERS[printer], turn)))
    wanted, found = spans(true.curve), spans(printed.curve)
    assert found.kink_angle.size == 0
    assert printed.curve.closed == true.curve.closed
    np.testing.assert_array_equal(arcs(found).sign, arcs(wanted).sign)
    np.testing.assert_allclose(arcs(found).turning, arcs(wanted).turning, atol=2e-5)
    # six digits of 20,000 mm are a tenth; chords of 1/800 of a piece leave an arc of it by less than 0.004 mm
    limit = 0.1 if printer == "%g" else 0.01
    away = shapely.distance(shapely.LineString(outline(true.curve, 801)), shapely.points(outline(printed.curve, 9)))
    assert away.max() < limit + 0.004


def test_the_note_tells_number_angle_place_and_movement(read):
    """An arc of 90° whose end is printed 0.004 mm off leaves a kink that follows from its radius."""
    entities = ["line", (0, 0), (9000, 0)], ["arc", (9000.004, 3000), 3000, -math.pi / 2, 0]
    local = read([getattr(Pen(exact), name)(*numbers) for name, *numbers in entities])
    assert codes(local) == ["W-DRAWN-JOINED"]
    turned = Pen(exact).arc((9000, 3000), 3000, 1e-6 - math.pi / 2, 0)
    local = read([Pen(exact).line((0, 0), (9000, 0)), turned])
    (note,) = [note for note in local.notes if note.code == "W-DRAWN-SMOOTHED"]
    assert "1 joint with a kink of 5.7e-05° at (9000, 0) made smooth, nothing moved by more than 0.00" in note.text


@pytest.mark.parametrize("kink", [1.1e-3, 0.01, 0.3])
def test_a_kink_that_was_meant_stays(read, kink):
    pen = Pen(exact)
    local = read(
        [
            pen.line((0, 0), (9000, 0)),
            pen.arc((9000 - 3000 * math.sin(kink), 3000 * math.cos(kink)), 3000, kink - math.pi / 2, 1),
        ]
    )
    assert codes(local) == []
    np.testing.assert_allclose(spans(local.curve).kink_angle, kink, rtol=1e-6)


def test_a_kink_that_takes_more_than_join_stays_and_is_noted(read):
    """A bend by 1e-4 between parts of some metres is tenths of a millimetre."""
    pen = Pen(exact)
    centre = (9000 - 3000 * math.sin(1e-4), 3000 * math.cos(1e-4))
    points = [pen.line((0, 0), (9000, 0)), pen.arc(centre, 3000, 1e-4 - math.pi / 2, 0)]
    local = read(points)
    assert codes(local) == ["W-DRAWN-KINK"]
    assert "would move the curve by more than 0.01 mm (join)" in local.notes[0].text
    np.testing.assert_allclose(spans(local.curve).kink_angle, 1e-4, rtol=1e-3)
    assert spans(read(points, join=0.2).curve).kink_angle.size == 0


def test_vertices_of_polylines_are_meant(read):
    circle = [(9000 * math.cos(a), 9000 * math.sin(a), 0) for a in np.linspace(0, 1, 1201)]
    local = read([Pen(exact).polyline(circle, closed=False)])
    assert codes(local) == []
    assert spans(local.curve).kink_angle.size == 1199


def test_a_polyline_is_not_bent_into_a_curve_for_an_arc_beside_it(read):
    chords = [(-9000 * math.sin(a), 9000 - 9000 * math.cos(a), 0) for a in np.linspace(1, 0, 1201)]
    local = read([Pen(exact).polyline(chords, closed=False), Pen(exact).arc((0, 9000), 9000, -math.pi / 2, 0)])
    assert codes(local) == ["W-DRAWN-KINK"]
    assert spans(local.curve).kink_angle.size >= 1199


def test_lines_stay_lines_and_arcs_of_circles_stay_so(read):
    local = read(rounded_rectangle(Pen(PRINTERS["%g"], 0.7)))
    assert [type(piece) for piece in local.curve.pieces] == [Line, Ellipse] * 4
    for arc in local.curve.pieces[1::2]:
        assert np.hypot(*arc.major) == pytest.approx(1200, abs=0.02)
        assert np.hypot(*arc.minor) == pytest.approx(np.hypot(*arc.major), rel=1e-12)


BARE_SMALL = {name: table for name, table in SMALL.items() if name not in ("stock", "deliver")}


def project(file, closed):
    # the straight sides have a direction of the lattice
    turned = {"first_deg": math.degrees(0.4)} if closed else {}
    rail = {"curve": {"kind": "dxf", "file": file, "layer": "RAIL"}, "divide": {"nodes": 16 if closed else 5} | turned}
    way = {"outside": "outer", "plane": "xy"} if closed else {"outside": [0, -1], "plane": "xy"}
    return {**BARE_SMALL, "rail": {**rail, **way}}


def counts(design):
    """Give the numbers of node, member and panel classes."""
    kit = design.kit
    return len(kit.nodes.marks), len(kit.members.marks), len(kit.panels.marks)


@pytest.mark.parametrize(("rail", "closed"), [(line_arc_line, False), (rounded_rectangle, True)])
@pytest.mark.parametrize("at", [(0.0, 0.0), (691608123.25, 5334765400.5)], ids=["near", "UTM"])
def test_a_printed_rail_gives_the_surface_of_the_exact_one(tmp_path, rail, closed, at):
    (tmp_path / "exact.dxf").write_text(drawing(rail(Pen(exact, 0.4))))
    (tmp_path / "printed.dxf").write_text(drawing(rail(Pen(PRINTERS["4 decimals"], 0.4, at))))
    true, printed = (
        make_design(validate(project(f"{name}.dxf", closed), "x"), tmp_path) for name in ("exact", "printed")
    )
    found = printed.mesh.nodes - (np.array([at[0] % 1000, at[1] % 1000, 0]) if at[0] else 0)
    move = np.round((found - true.mesh.nodes).mean(axis=0), -3)
    np.testing.assert_allclose(found - move, true.mesh.nodes, atol=0.05)
    assert counts(printed) == counts(true)


def test_check_takes_a_printed_rail(tmp_path):
    (tmp_path / "rail.dxf").write_text(drawing(line_arc_line(Pen(PRINTERS["%g"], 0.4))))
    checked = check(write_project(tmp_path / "hall.toml", project("rail.dxf", closed=False)), ["rail.max_edge=3000"])
    assert "W-DRAWN-SMOOTHED" in {note.code for note in checked.notes}
