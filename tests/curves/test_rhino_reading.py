"""Rhino models written with rhino3dm and read back: exact curves, units, candidates, refusals."""

import sys
from itertools import pairwise

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from isomould.curves.construction import build_curve
from isomould.curves.lengths import length
from isomould.curves.plane import build_plane
from isomould.curves.settings import CurveSettings
from isomould.curves.spatial_settings import build_spatial_curve
from isomould.errors import Refused

rhino3dm = pytest.importorskip("rhino3dm", reason="the extra isomould[rhino] is not installed")

SETTINGS = TypeAdapter(CurveSettings)
S = np.linspace(0, 1, 9)


def at(*coordinates):
    x, y, z = (*coordinates, 0.0)[:3]
    return rhino3dm.Point3d(x, y, z)


def arc_through(start, middle, end):
    return rhino3dm.ArcCurve.CreateFromArc(rhino3dm.Arc(at(*start), at(*middle), at(*end)))


def polyline(*points):
    return rhino3dm.PolylineCurve(rhino3dm.Point3dList([at(*p) for p in points]))


def line(start, end):
    return rhino3dm.LineCurve(at(*start), at(*end))


def nurbs(points, weights, knots, degree):
    curve = rhino3dm.NurbsCurve(3, True, degree + 1, len(points))
    for k, (point, w) in enumerate(zip(points, weights, strict=True)):
        x, y, z = (*point, 0.0)[:3]
        curve.Points[k] = rhino3dm.Point4d(x * w, y * w, z * w, w)
    for k, knot in enumerate(knots):
        curve.Knots[k] = knot
    return curve


def joined(*curves):
    chain = rhino3dm.PolyCurve()
    for curve in curves:
        chain.AppendSegment(curve)
    return chain


class Sketch:
    """A model in the making."""

    def __init__(self, units="Millimeters"):
        self.model = rhino3dm.File3dm()
        self.model.Settings.ModelUnitSystem = getattr(rhino3dm.UnitSystem, units)
        self.layer("RAIL")

    def layer(self, name, parent=None, visible=True):
        layer = rhino3dm.Layer()
        layer.Name, layer.Visible = name, visible
        if parent is not None:
            layer.ParentLayerId = self.model.Layers[parent].Id
        return self.model.Layers.Add(layer)

    def add(self, curve, layer=0, name="", **attributes):
        given = rhino3dm.ObjectAttributes()
        given.LayerIndex, given.Name = layer, name
        for key, value in attributes.items():
            setattr(given, key, value)
        self.model.Objects.Add(curve, given)
        return self


@pytest.fixture
def read(tmp_path):
    def reading(sketch, plane=None, space=False, **table):
        assert sketch.model.Write(str(tmp_path / "rail.3dm"), 7)
        given = {"layer": "RAIL", **table}
        settings = SETTINGS.validate_python({"kind": "rhino", "file": "rail.3dm", **given})
        if space:
            return build_spatial_curve(settings, tmp_path, "rail.curve").curve
        return build_curve(settings, tmp_path, plane, "rail.curve")[0]

    return reading


def refusal(read, sketch, **table):
    with pytest.raises(Refused) as found:
        read(sketch, **table)
    return str(found.value)


HALF = (2.0, 0.0), (0.0, 2.0), (-2.0, 0.0)
CURVES = {
    "line": (lambda: line((0, 0), (3, 4)), ["line"]),
    "polyline": (lambda: polyline((0, 0), (3, 0), (4, 1), (4, 5)), ["line"] * 3),
    "arc": (lambda: arc_through(*HALF), ["ellipse"]),
    "nurbs": (
        lambda: nurbs([(0, 0), (1, 3), (4, 3), (6, 0), (9, 1)], [1, 0.4, 2, 1, 3], [0, 0, 0, 0.3, 1, 1, 1], 3),
        ["bezier"] * 2,
    ),
    "unclamped nurbs": (
        lambda: nurbs([(0, 0), (1, 3), (4, 3), (6, 0), (9, 1)], [1, 1, 1, 1, 2], [0, 1, 2.5, 3, 4, 6, 7], 3),
        ["bezier"] * 2,
    ),
    "polycurve": (
        lambda: joined(line((5, 0), (2, 0)), joined(arc_through(*HALF), line((-2, 0), (-2, -3)))),
        ["line", "ellipse", "line"],
    ),
}


@pytest.mark.parametrize("case", CURVES)
@pytest.mark.parametrize(("units", "factor"), [("Millimeters", 1.0), ("Meters", 1000.0), ("Feet", 304.8)])
def test_curves_are_taken_over_exactly(read, case, units, factor):
    """Every point of ours lies where Rhino has it, span by span: the parameters are Rhino's own."""
    make, kinds = CURVES[case]
    curve = make()
    curve.Scale(1000 / factor)
    found = read(Sketch(units).add(curve))
    assert [piece.kind for piece in found.pieces] == kinds
    expected = np.array([[p.X, p.Y] for p in (curve.PointAt(t) for t in parameters(curve))]) * factor
    index, t = np.repeat(np.arange(len(kinds)), S.size), np.tile(S, len(kinds))
    np.testing.assert_allclose(found.point(index, t), expected, atol=1e-9)


def parameters(curve):
    """Rhino's parameters at our places (piece, t)."""
    if isinstance(curve, rhino3dm.NurbsCurve):
        breaks = [k for k in sorted(set(curve.Knots)) if curve.Domain.T0 <= k <= curve.Domain.T1]
    elif isinstance(curve, rhino3dm.PolylineCurve):
        breaks = np.linspace(curve.Domain.T0, curve.Domain.T1, curve.PointCount)
    elif isinstance(curve, rhino3dm.PolyCurve):
        chain = curve.Duplicate()
        chain.RemoveNesting()
        breaks = [chain.SegmentDomain(0).T0, *(chain.SegmentDomain(k).T1 for k in range(chain.SegmentCount))]
    else:
        breaks = [curve.Domain.T0, curve.Domain.T1]
    return np.concatenate([low + S * (high - low) for low, high in pairwise(breaks)])


def test_circles_and_ellipses_are_closed(read):
    circle = rhino3dm.ArcCurve.CreateFromCircle(rhino3dm.Circle(at(0, 0), 5000))
    assert length(read(Sketch().add(circle))) == pytest.approx(10000 * np.pi)
    spline = rhino3dm.NurbsCurve.CreateFromCircle(rhino3dm.Circle(at(0, 0), 5000))
    found = read(Sketch().add(spline))
    assert found.closed
    assert length(found) == pytest.approx(10000 * np.pi)


def test_objects_on_one_layer_chain_in_any_direction(read):
    sketch = Sketch().add(line((0, 0), (5000, 0))).add(line((9000, 3000), (5000, 0)))
    assert length(read(sketch)) == pytest.approx(10000)


def test_a_name_chooses_between_curves(read):
    sketch = Sketch().add(line((0, 0), (5000, 0)), name="rail").add(line((0, 9000), (7000, 9000)), name="arch")
    assert length(read(sketch, name="arch")) == pytest.approx(7000)
    assert length(read(sketch, layer=None, name="rail")) == pytest.approx(5000)


def test_layers_by_path(read):
    sketch = Sketch()
    inner = sketch.layer("RAIL", parent=sketch.layer("SITE"))
    sketch.add(line((0, 0), (5000, 0))).add(line((0, 0), (0, 8000)), layer=inner)
    assert length(read(sketch, layer="site::rail")) == pytest.approx(8000)
    assert "'RAIL' names 'RAIL', 'SITE::RAIL'" in refusal(read, sketch)


def test_curves_off_their_plane_are_refused(read):
    sketch = Sketch("Meters").add(arc_through((5, 7, 0), (0, 7, 5), (-5, 7, 0)))
    assert "leaves the plane by 7000 mm" in refusal(read, sketch, plane=build_plane("xz"), drawn="world")
    assert "leaves the height of the drawing" in refusal(read, sketch)


def test_curves_on_their_plane(read):
    sketch = Sketch("Meters").add(arc_through((5, 0, 0), (0, 0, 5), (-5, 0, 0)))
    curve = read(sketch, plane=build_plane("xz"), drawn="world")
    assert curve.point(np.array([0]), np.array([0.5]))[0] == pytest.approx([0, 5000])


def test_rails_in_space(read):
    points = [(0, 0, 0), (3, 0, 1), (6, 2, 3), (9, 5, 3)]
    spline = nurbs(points, [1, 2, 1, 1], [0, 0, 0, 1, 1, 1], 3)
    sketch = Sketch("Meters").add(joined(spline, line((9, 5, 3), (12, 9, 4))))
    curve = read(sketch, space=True, drawn="world")
    expected = [[p.X * 1000, p.Y * 1000, p.Z * 1000] for p in (spline.PointAt(t) for t in S)]
    np.testing.assert_allclose(curve.point(np.zeros(9, int), S), expected, atol=1e-9)


def test_several_curves_are_refused_by_name(read):
    sketch = Sketch().add(line((0, 0), (5000, 0)), name="low").add(line((0, 9000), (7000, 9000)), name="high")
    text = refusal(read, sketch)
    assert "E-DRAWN-CURVES rail.curve: 2 curves (LineCurve 'low' " in text
    assert "LineCurve 'high' " in text


def hidden_child():
    sketch = Sketch()
    sketch.add(line((0, 0), (9000, 0)), layer=sketch.layer("INNER", parent=sketch.layer("OUTER", visible=False)))
    return sketch


def test_units_of_the_project_win_with_a_note_that_names_both(tmp_path):
    assert Sketch("Meters").add(line((0, 0), (9000, 0))).model.Write(str(tmp_path / "rail.3dm"), 7)
    table = {"kind": "rhino", "file": "rail.3dm", "layer": "RAIL", "units": "mm"}
    curve, notes = build_curve(SETTINGS.validate_python(table), tmp_path, None, "rail.curve")
    assert length(curve) == 9000
    assert [note.code for note in notes] == ["W-DRAWN-UNITS"]
    assert "read in mm as asked, although the file says m" in notes[0].text


REFUSALS = {
    "no layer": (lambda: Sketch().add(line((0, 0), (9, 0))), {"layer": "ARCH"}, ["E-RHINO-LAYER", "'ARCH'", "RAIL"]),
    "nothing on it": (Sketch, {}, ["E-RHINO-LAYER", "nothing on layer 'RAIL'"]),
    "no name": (
        lambda: Sketch().add(line((0, 0), (9, 0)), name="rail"),
        {"name": "arch"},
        ["E-RHINO-NAME rail.curve.name: nothing is called 'arch'", "one of 'rail'"],
    ),
    "hidden layer": (hidden_child, {"layer": "INNER"}, ["E-RHINO-LAYER", "layer 'OUTER' is off"]),
    "hidden object": (lambda: Sketch().add(line((0, 0), (9, 0)), Visible=False), {}, ["E-RHINO-OBJECT", "is hidden"]),
    "no curve": (lambda: Sketch().add(rhino3dm.Point(at(1, 2))), {}, ["E-RHINO-OBJECT rail.curve, Point ", "ArcCurve"]),
    "no units": (lambda: Sketch("None").add(line((0, 0), (9, 0))), {}, ["E-RHINO-UNITS rail.curve.units", "Set units"]),
    "strange units": (lambda: Sketch("Parsecs").add(line((0, 0), (9, 0))), {}, ["model units Parsecs", "Set units"]),
    "world without plane": (lambda: Sketch().add(line((0, 0), (9, 0))), {"drawn": "world"}, ["E-DRAWN-PLANE"]),
    "remote": (lambda: Sketch("Kilometers").add(line((0, 0), (9e9, 0))), {}, ["E-CURVE-NUMBER", "finite"]),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSALS)
def test_refusals(read, case):
    make, table, words = REFUSALS[case]
    text = refusal(read, make(), **table)
    for word in words:
        assert word in text


def test_units_of_a_model_without_any(read):
    assert length(read(Sketch("None").add(line((0, 0), (9, 0))), units="m")) == pytest.approx(9000)


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.999])
def test_files_cut_off_are_refused(read, tmp_path, share):
    read(Sketch().add(line((0, 0), (9000, 0))))
    path = tmp_path / "rail.3dm"
    path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])
    settings = SETTINGS.validate_python({"kind": "rhino", "file": "rail.3dm", "layer": "RAIL"})
    with pytest.raises(Refused, match="E-RHINO-FILE"):
        build_curve(settings, tmp_path)


def test_missing_files_are_refused(tmp_path):
    settings = SETTINGS.validate_python({"kind": "rhino", "file": "none.3dm", "layer": "RAIL"})
    with pytest.raises(Refused, match="is no file"):
        build_curve(settings, tmp_path)


def test_without_the_extra_the_message_says_how_to_get_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "rhino3dm", None)
    settings = SETTINGS.validate_python({"kind": "rhino", "file": "rail.3dm", "layer": "RAIL"})
    with pytest.raises(Refused, match=r'E-RHINO-MISSING rail\.curve\.kind: .*pip install "isomould\[rhino\]"'):
        build_curve(settings, tmp_path, None, "rail.curve")


def test_a_curve_without_layer_and_name_is_refused():
    with pytest.raises(ValidationError, match="layer or name"):
        SETTINGS.validate_python({"kind": "rhino", "file": "rail.3dm"})
