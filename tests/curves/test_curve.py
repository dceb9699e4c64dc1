import numpy as np
import pytest

from isomould.curves.bezier import Bezier
from isomould.curves.curve import PlanarCurve, join_pieces
from isomould.curves.pieces import Catenary, Ellipse, Line, Sine
from isomould.curves.turning import spans
from isomould.errors import Refused

LINE = Line((0.0, 0.0), (1000.0, 0.0))
QUARTER = Ellipse((1000.0, 500.0), (500.0, 0.0), (0.0, 500.0), -np.pi / 2, 0.0)
CUBIC = Bezier(((1500.0, 500.0), (1500.0, 900.0), (1200.0, 1500.0), (0.0, 1500.0)), (1.0, 1.0, 1.0, 1.0))
CHAIN = (LINE, QUARTER, CUBIC)


def test_places_of_mixed_pieces_are_evaluated_by_their_own_piece():
    curve, notes = join_pieces(CHAIN, closed=False)
    index, t = np.array([2, 0, 1, 0, 2]), np.array([0.1, 0.2, 0.3, 1.0, 0.0])
    for whole, part in ((curve.point, "point"), (curve.derivative, "derivative"), (curve.second, "second")):
        expected = [getattr(CHAIN[i], part)(np.array([u]))[0] for i, u in zip(index, t, strict=True)]
        np.testing.assert_allclose(whole(index, t), expected, atol=1e-12)
    assert notes == ()


def test_reversed_and_mapped_curves():
    curve, _ = join_pieces(CHAIN, closed=False)
    index, t = np.array([0, 1, 2]), np.array([0.25, 0.5, 0.75])
    np.testing.assert_allclose(curve.reversed().point(2 - index, 1 - t), curve.point(index, t), atol=1e-12)
    turned = curve.mapped(np.array([[0.0, -1.0], [1.0, 0.0]]), np.array([7.0, 0.0]))
    np.testing.assert_allclose(turned.point(index, t), curve.point(index, t)[:, ::-1] * [-1, 1] + [7, 0], atol=1e-12)


def test_descriptors_come_in_order():
    assert [d["kind"] for d in PlanarCurve(CHAIN, closed=False).describe()] == ["line", "ellipse", "bezier"]


def test_repeated_points_are_left_out_with_a_note():
    end = LINE.end
    dots = (Line(end, end), Bezier((end, end, end), (1.0, 1.0, 1.0)))
    curve, notes = join_pieces((LINE, *dots, QUARTER), closed=False, field="rail.curve")
    assert curve.pieces == (LINE, QUARTER)
    assert [str(n) for n in notes] == ["W-CURVE-REPEATED rail.curve: 2 exactly repeated point(s) left out"]


def test_a_kink_is_not_a_gap():
    curve, _ = join_pieces((LINE, Line((1000.0, 0.0), (1000.0, 900.0))), closed=False)
    assert spans(curve).kink_angle == pytest.approx([np.pi / 2])


@pytest.mark.parametrize(
    ("pieces", "closed", "code", "says"),
    [
        ((LINE, Line((1000.0, 2e-6), (0.0, 900.0))), False, "E-CURVE-GAP", "2e-06 mm after piece 0"),
        ((LINE, Line((1000.0, 0.0), (0.0, 900.0))), True, "E-CURVE-GAP", "900 mm after piece 1 at (0, 900)"),
        ((LINE, LINE.reversed()), False, "E-CURVE-CLOSED", "ends meet"),
        ((), False, "E-CURVE-EMPTY", "no piece"),
        ((Line((0.0, 0.0), (0.0, 0.0)),), False, "E-CURVE-EMPTY", "no piece"),
        ((Line((0.0, 0.0), (np.nan, 0.0)),), False, "E-CURVE-NUMBER", "nan in piece 0 (line)"),
        ((Line((0.0, 0.0), (np.inf, 0.0)),), False, "E-CURVE-NUMBER", "inf"),
        ((Line((2e10, 0.0), (2e10, 1000.0)),), False, "E-CURVE-NUMBER", "2e+10"),
        ((LINE, Line((1000.0, 0.0), (1000.0, 1e-7))), False, "E-CURVE-SHORT", "piece 1 is 1e-07 mm"),
        ((Line((0.0, 0.0), (0.1, 0.0)),), False, "E-CURVE-SIZE", "0.1 mm across"),
        ((Line((0.0, 0.0), (3e9, 0.0)),), False, "E-CURVE-SIZE", "3e+09 mm across"),
        ((Ellipse((0.0, 0.0), (900.0, 0.0), (900.0, 0.0), 0.0, 3.0),), False, "E-CURVE-CUSP", "(ellipse)"),
        ((Sine((0.0, 0.0), (900.0, 0.0), (0.0, 0.0), 0.0, 3.0),), False, "E-CURVE-CUSP", "(sine)"),
        ((Catenary((0.0, 0.0), (900.0, 0.0), (0.0, 0.0), 0.0, 3.0),), False, "E-CURVE-CUSP", "(catenary)"),
    ],
)  # fmt: skip
def test_refusals(pieces, closed, code, says):
    with pytest.raises(Refused) as refusal:
        join_pieces(pieces, closed, "rail.curve")
    assert refusal.value.code == code
    assert refusal.value.field == "rail.curve"
    assert says in refusal.value.found


@pytest.mark.parametrize(
    "points",
    [
        ((0.0, 0.0), (1000.0, 1000.0), (0.0, 1000.0), (1000.0, 0.0)),  # the classic cubic cusp
        ((0.0, 0.0), (0.0, 0.0), (1000.0, 0.0), (1000.0, 500.0)),  # a doubled first control point
        ((0.0, 0.0), (1000.0, 0.0), (500.0, 0.0)),  # forth and back on a line
        ((0.0, 0.0), (1000.0, 1000.0), (0.0, 0.5)),  # goes forth and back on nearly one line: sharp, no cusp
    ],
)
def test_cusps_are_refused_and_sharp_bends_are_not(points):
    piece = Bezier(points, (1.0,) * len(points))
    if points[-1] == (0.0, 0.5):
        assert join_pieces((piece,), closed=False)[0].pieces == (piece,)
        return
    with pytest.raises(Refused, match="E-CURVE-CUSP"):
        join_pieces((piece,), closed=False)


def test_an_unusual_size_is_noted():
    _, notes = join_pieces((Line((0.0, 0.0), (24.0, 0.0)),), closed=False)
    assert notes[0].code == "W-CURVE-SIZE"
    assert "24 mm across" in notes[0].text
