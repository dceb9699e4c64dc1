import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from isomould.documents.cut_sheets import PartOnSheet, part_drawing, sheet_drawing
from isomould.documents.drawing import Polyline, signed_area
from isomould.documents.drawing_checks import check_drawing
from isomould.documents.stroke_font import text_strokes

TRAPEZOID = np.array([[0, 0], [1200, 0], [1100, 900], [150, 900]], float)


def on(drawing, layer):
    return [entity for entity in drawing.entities if entity.layer == layer]


def test_part_has_contour_mark_and_information():
    drawing = check_drawing(part_drawing("P07", TRAPEZOID, note="4 pieces"))
    assert len(on(drawing, "CUT")) == 1
    assert on(drawing, "CUT")[0].points.tolist() == TRAPEZOID.tolist()
    assert [label.text for label in on(drawing, "INFO")] == ["P07 4 pieces"]
    assert on(drawing, "INFO")[0].position[1] < 0


@given(st.floats(15, 3000), st.floats(15, 3000), st.floats(-400, 400))
def test_engraving_lies_inside_the_outline(width, height, shift):
    outline = np.array([[0, 0], [width, 0], [width + shift, height], [shift, height]])
    strokes = on(part_drawing("P07", outline), "ENGRAVE")
    inside = shapely.Polygon(outline)
    assert all(inside.contains(shapely.LineString(stroke.points)) for stroke in strokes)


def test_tall_parts_get_the_tallest_mark_and_slivers_none():
    tall = np.concatenate([stroke.points for stroke in on(part_drawing("P07", TRAPEZOID), "ENGRAVE")])
    assert np.ptp(tall[:, 1]) == 20.0
    sliver = np.array([[0, 0], [500, 0], [500, 3.5], [0, 3.5]], float)
    assert not on(part_drawing("P07", sliver), "ENGRAVE")
    strip = np.array([[0, 0], [9, 0], [9, 500], [0, 500]], float)
    assert on(part_drawing("P07", strip), "ENGRAVE")


def test_engraving_keeps_clear_of_holes():
    hole = Polyline("CUT_INNER", np.array([[500, 300], [700, 300], [700, 600], [500, 600]], float), True)
    drawing = check_drawing(part_drawing("P07", TRAPEZOID, inner=[hole]))
    assert signed_area(on(drawing, "CUT_INNER")[0]) < 0
    free = shapely.Polygon(TRAPEZOID, [hole.points])
    strokes = on(drawing, "ENGRAVE")
    assert strokes
    assert all(free.contains(shapely.LineString(stroke.points)) for stroke in strokes)


def test_arcs_are_kept_and_holes_with_arcs_turned():
    bulges = np.array([0.0, 1.0, 0.0, 1.0])
    slot = Polyline("CUT_INNER", np.array([[400, 100], [800, 100], [800, 140], [400, 140]], float), True, bulges)
    drawing = check_drawing(part_drawing("P07", TRAPEZOID, inner=[slot]))
    assert signed_area(on(drawing, "CUT_INNER")[0]) == pytest.approx(-signed_area(slot), rel=1e-14)


def test_sheet_shows_stock_contours_and_locations():
    placed = TRAPEZOID + np.array([20, 30])
    turned_over = TRAPEZOID * [-1, 1] + np.array([2600, 30])
    parts = [PartOnSheet("P07", "P-00-01", placed), PartOnSheet("P07", "P-00-02", turned_over)]
    drawing = sheet_drawing(3210, 2250, parts)
    check_drawing(drawing)
    assert on(drawing, "SHEET")[0].points.max(axis=0).tolist() == [3210, 2250]
    assert [signed_area(contour) > 0 for contour in on(drawing, "CUT")] == [True, True]
    assert on(drawing, "CUT")[0].points.tolist() == placed.tolist()
    assert [label.text for label in on(drawing, "INFO")] == ["P07 P-00-01", "P07 P-00-02"]
    marks = ("P07 P-00-01", "P07 P-00-02")
    assert len(on(drawing, "ENGRAVE")) == sum(len(text_strokes(mark, 20.0)) for mark in marks)


def test_scored_glass_is_not_cut():
    scores = np.array([[[0, 900], [3210, 900]], [[1200, 0], [1100, 900]]], float)
    drawing = check_drawing(sheet_drawing(3210, 2250, [PartOnSheet("P07", "P-00-01", TRAPEZOID)], scores))
    assert not on(drawing, "CUT")
    assert len(on(drawing, "SCORE")) == 2
    assert any(isinstance(entity, Polyline) for entity in on(drawing, "INFO"))
