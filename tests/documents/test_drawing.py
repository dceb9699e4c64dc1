from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from isomould.documents.drawing import Circle, CutDrawing, Label, Polyline, Segment3D, chords, signed_area
from isomould.documents.drawing_checks import check_drawing
from isomould.documents.stroke_font import text_strokes, text_width
from isomould.errors import Refused

SQUARE = np.array([[0, 0], [100, 0], [100, 80], [0, 80]], float)


def contour(points=SQUARE, layer="CUT", bulges=None, closed=True):
    return Polyline(layer, np.array(points, float), closed, bulges)


def circle_of(count, radius=10.0):
    """A circle of arcs: vertices on it and the bulge tan(2π / n / 4) of each."""
    angles = 2 * np.pi * np.arange(count) / count
    points = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    return contour(points, bulges=np.full(count, np.tan(np.pi / 2 / count)))


@given(st.integers(2, 40), st.floats(0.1, 1e4))
def test_area_of_arcs_is_the_area_of_the_circle(count, radius):
    assert signed_area(circle_of(count, radius)) == pytest.approx(np.pi * radius**2, rel=1e-12)


@given(st.integers(2, 12))
def test_chords_lie_on_the_arcs(count):
    points = chords(circle_of(count))
    assert np.allclose(np.hypot(*points.T), 10.0, rtol=1e-12)
    area = signed_area(contour(points))
    assert 0.9 * np.pi * 100 < area < np.pi * 100


def test_a_good_drawing_passes():
    hole = contour(SQUARE[::-1] / 10 + 5, "CUT_INNER")
    axis = Segment3D("INFO", (0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    drawing = CutDrawing((contour(), hole, Circle("DRILL", (50.0, 40.0), 6.0), axis))
    assert check_drawing(drawing) is drawing


BAD = {
    "clockwise": contour(SQUARE[::-1]),
    "inner counter-clockwise": contour(layer="CUT_INNER"),
    "open": contour(closed=False),
    "first vertex repeated": contour([*SQUARE, SQUARE[0]]),
    "point twice": contour([SQUARE[0], *SQUARE]),
    "nan": contour(SQUARE * [1, np.nan]),
    "nan bulge": contour(bulges=np.array([0, np.nan, 0, 0])),
    "infinite": Circle("DRILL", (np.inf, 0.0), 1.0),
    "no radius": Circle("DRILL", (0.0, 0.0), 0.0),
    "no area": contour([[0, 0], [1, 0]]),
    "bow tie without area": contour([[0, 0], [1, 1], [1, 0], [0, 1]]),
    "line break": Label("INFO", "a\nb", (0.0, 0.0, 0.0), 5.0),
    "control code": Label("INFO", "%%c", (0.0, 0.0, 0.0), 5.0),
}


@pytest.mark.parametrize("name", BAD)
def test_what_a_machine_cannot_work_is_refused(name):
    with pytest.raises(Refused, match="E-OUT-02"):
        check_drawing(CutDrawing((BAD[name],)))


@pytest.mark.parametrize("twin", [contour(np.roll(SQUARE, 1, axis=0)), contour([[100, 0], [0, 0], [50, -9]], "SCORE")])
def test_a_line_that_is_there_twice_is_refused_whatever_its_direction(twin):
    with pytest.raises(Refused, match="twice"):
        check_drawing(CutDrawing((contour(), twin)))


def test_lines_that_are_not_worked_may_repeat():
    check_drawing(CutDrawing((contour(layer="INFO"), contour(layer="INFO"), contour())))


ALPHABET = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-./"


@pytest.mark.parametrize("character", ALPHABET)
def test_no_glyph_engraves_a_line_twice(character):
    strokes = [Polyline("ENGRAVE", stroke, closed=False) for stroke in text_strokes(character, 6.0)]
    check_drawing(CutDrawing(tuple(strokes)))
    assert strokes


@pytest.mark.parametrize("character", ALPHABET)
def test_no_grid_segment_of_a_glyph_overlaps_another(character):
    units = [unit for stroke in text_strokes(character, 6.0) for a, b in pairwise(stroke) for unit in grid_units(a, b)]
    assert len(set(units)) == len(units)


def grid_units(a, b):
    """Cut a segment at grid points, as unordered pairs."""
    count = int(np.gcd(*np.abs(b - a).astype(int)))
    points = [tuple(a + (b - a) * k / count) for k in range(count + 1)]
    return [tuple(sorted(pair)) for pair in pairwise(points)]


def test_glyphs_differ():
    drawn = {character: [s.tolist() for s in text_strokes(character, 6.0)] for character in ALPHABET}
    assert len({str(strokes) for strokes in drawn.values()}) == len(ALPHABET)


@given(st.text(ALPHABET, min_size=1, max_size=12), st.floats(2, 30))
def test_text_stays_in_its_box(text, height):
    points = np.concatenate(text_strokes(text, height))
    assert points.min() >= 0
    assert points[:, 0].max() <= text_width(text, height) * (1 + 1e-12)
    assert points[:, 1].max() <= height * (1 + 1e-12)


def test_unknown_characters_are_refused():
    with pytest.raises(Refused, match="E-OUT-03"):
        text_strokes("Pø1", 5.0)
