"""Sheets of panels of awkward shapes: everything is written, nothing meets a text, whatever is small or thin."""

import re

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from isomould.documents.info import ProjectInfo
from isomould.documents.shop.checks import clashes, text_box
from isomould.documents.shop.page import Text
from isomould.documents.shop.panel_sheet import panel_sheet
from isomould.documents.shop.panel_view import PanelDrawing
from isomould.documents.shop.title_block import Stationery, read_title_block
from isomould.documents.table import make_table
from isomould.templates import template_folder

BLOCK = read_title_block((template_folder() / "sheets" / "title-block.toml").read_text(encoding="utf-8"))
STATIONERY = Stationery(BLOCK, ProjectInfo(name="Dome", number="2026-014", revision="A"))
SIDES, DIAGONALS, ANGLES = (
    [f"side_{letter}_mm" for letter in "abcd"],
    ["diagonal_1_mm", "diagonal_2_mm"],
    [f"angle_{k}_deg" for k in range(1, 5)],
)
SIZES = ["area_m2", "mass_kg", "charged_area_m2", "box_width_mm", "box_height_mm", "height_mm"]
OTHERS = ["mark", "quantity", "outline", "handed", "files"]
TABLE = make_table("panels", {name: [] for name in (*OTHERS, *SIZES, *SIDES, *DIAGONALS, *ANGLES)})
NOTES = ("2 x 6 mm heat-strengthened, laminated, 13.5 thick", "Outside: the side that is seen here")


def sheet_of(outline, *, own=True, paper=None, notes=NOTES):
    """Draw a panel with an outline of its own, or as the schedule lists quadrilaterals."""
    points = np.round(np.array(outline, dtype=float), 3)
    row = dict.fromkeys((column.name for column in TABLE.columns), "")
    row |= {"mark": "P07", "quantity": "3", "area_m2": "1.234567890123", "mass_kg": "12.3"}
    if own:
        row["outline"] = ";".join(f"{x:g},{y:g}" for x, y in points)
    else:
        sides = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
        diagonals = np.linalg.norm(points[2:] - points[:2], axis=1)
        row |= {name: f"{value:.3f}" for name, value in zip(SIDES + DIAGONALS, [*sides, *diagonals], strict=True)}
        row |= {name: f"{80 + k}.1234" for k, name in enumerate(ANGLES)} | {"height_mm": f"{points[2, 1]:.3f}"}
    stationery = Stationery(BLOCK, STATIONERY.info, paper)
    return panel_sheet(stationery, TABLE, PanelDrawing(row, points, notes), 1, 99), row


def shown(page):
    return [item.text for item in page.items if isinstance(item, Text)]


def proved(page):
    """Nothing meets, nothing leaves the frame."""
    assert clashes(page) == ()
    boxes = np.concatenate([text_box(item) for item in page.items if isinstance(item, Text)])
    assert (boxes > [20, 10]).all()
    assert (boxes < np.array(page.size) - 10).all()
    texts = shown(page)
    assert texts.count("P07") >= 2


def drawn_angles(page):
    return [text for text in shown(page) if re.fullmatch(r"[\d.]+°", text)]


def lengths(points):
    return [
        f"{side:.3f}".rstrip("0").rstrip(".") for side in np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    ]


def regular(sides, radius, flat=1.0):
    turn = np.linspace(0, 2 * np.pi, sides, endpoint=False) + 0.1
    return radius * np.stack([np.cos(turn), flat * np.sin(turn)], axis=1)


AWKWARD = {
    "sliver": [(0, 0), (2400, 0), (2390, 18), (12, 16)],
    "needle": [(0, 0), (3000, 4), (5, 60)],
    "triangle": [(0, 0), (900, 0), (450, 12)],
    "upright sliver": [(0, 0), (30, 0), (40, 2400), (2, 2390)],
    "tiny": [(0, 0), (12, 0), (13, 9), (1, 8)],
    "speck": [(0, 0), (1.5, 0), (1.4, 1.2), (0.1, 1.0)],
    "chamfered": [(0, 0), (1200, 0), (1215, 14), (1210, 790), (1190, 800), (10, 800), (-8, 780), (-2, 6)],
    "twelve sides": regular(12, 800.0),
    "many sides, flat": regular(16, 1500.0, 0.1),
    "huge": [(0, 0), (18000, 0), (17500, 2500), (300, 2400)],
    "one short side": [(0, 0), (1000, 0), (1000, 700), (999.2, 700.6), (0, 700)],
    "two corners at one": [(0, 0), (1000, 0), (1000.5, 0.5), (1000, 700), (0, 700)],
}


@pytest.mark.parametrize("name", AWKWARD)
@pytest.mark.parametrize("paper", [None, "A4", "A3"])
def test_awkward_outlines_are_drawn_whole(name, paper):
    outline = np.array(AWKWARD[name], dtype=float)
    page, row = sheet_of(outline, paper=paper)
    proved(page)
    assert len(drawn_angles(page)) == len(outline)
    texts = shown(page)
    assert all({x, y} <= set(texts) for x, y in (pair.split(",") for pair in row["outline"].split(";")))
    sides = lengths(np.round(outline, 3))
    assert all(texts.count(side) >= 2 * sides.count(side) for side in sides)
    assert all(f"Corner {k}" in texts or texts.count(str(k)) >= 2 for k in range(1, len(outline) + 1))


@pytest.mark.parametrize("name", ["sliver", "upright sliver", "tiny", "speck", "huge"])
def test_scheduled_lengths_stand_in_list_and_view(name):
    page, row = sheet_of(AWKWARD[name], own=False)
    proved(page)
    assert len(drawn_angles(page)) == 4
    texts = shown(page)
    values = [row[name] for name in (*SIDES, *DIAGONALS, "height_mm")]
    assert all(texts.count(value) >= 2 * values.count(value) for value in values)


steps = st.integers(0, 125)


@settings(max_examples=10, deadline=None)
@given(st.lists(steps, min_size=3, max_size=9, unique=True), st.floats(60.0, 4000.0), st.floats(0.02, 1.0))
@example([0, 1, 60, 61, 62], 1000.0, 0.05)
def test_any_convex_outline_is_legible_and_listed(found, radius, flat):
    turn = 0.05 * np.sort(found)
    outline = radius * np.stack([np.cos(turn), flat * np.sin(turn)], axis=1)
    page, _ = sheet_of(outline - outline[0])
    proved(page)
    numbers = np.array([float(text) for text in shown(page) if re.fullmatch(r"[\d.]+", text)])
    sides = np.linalg.norm(np.roll(outline, -1, axis=0) - outline, axis=1)
    assert all(min(abs(numbers - side)) < 2e-3 for side in sides)


@settings(max_examples=10, deadline=None)
@given(st.floats(5.0, 6000.0), st.floats(0.01, 2.0), st.floats(5.0, 6000.0), st.floats(-0.4, 0.4))
@example(900.0, 0.02, 10.0, 0.0)
def test_any_trapezoid_is_drawn_whole(width, ratio, height, lean):
    middle, top = width / 2 + lean * height, max(ratio * width, 5.0) / 2
    outline = [(0, 0), (width, 0), (middle + top, height), (middle - top, height)]
    page, row = sheet_of(outline, own=False)
    proved(page)
    values, texts = [row[name] for name in (*SIDES, *DIAGONALS, "height_mm")], shown(page)
    assert all(texts.count(value) >= 2 * values.count(value) for value in values)
    assert len(drawn_angles(page)) == 4


def test_long_notes_keep_clear_of_the_title_block():
    page, _ = sheet_of(AWKWARD["chamfered"], notes=("laminated glass of many sheets " * 9, NOTES[1]))
    proved(page)
