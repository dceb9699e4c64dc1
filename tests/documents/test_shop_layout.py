"""Texts on paper never meet: fonts, dimension rows, running dimensions, title blocks, places for names."""

import numpy as np
import pytest
from fontTools.ttLib import TTFont as GlyphFont
from hypothesis import example, given, settings
from hypothesis import strategies as st
from reportlab.pdfbase.pdfmetrics import stringWidth
from reportlab.pdfbase.ttfonts import TTFont

from isomould.documents.info import ProjectInfo
from isomould.documents.shop.checks import clashes
from isomould.documents.shop.dimensions import Side, Span, below, running, stack
from isomould.documents.shop.font import FONT_FILE, depth_below, drawable, font_size, text_width
from isomould.documents.shop.grid import grid, grid_size
from isomould.documents.shop.page import Arc, Line, Page, Text, reading
from isomould.documents.shop.placing import collide, free_text, place_all, segments, within
from isomould.documents.shop.title_block import PLAIN_NOTE, Stationery, Subject, finish, read_title_block
from isomould.documents.shop.view import choose_paper, fit_scale
from isomould.errors import Refused
from isomould.templates import template_folder

BLOCK = read_title_block((template_folder() / "sheets" / "title-block.toml").read_text(encoding="utf-8"))
CHARACTERS = "".join(bytes([k]).decode("cp1252", "ignore") for k in range(32, 256) if k not in {127, 160, 173})
SUBJECT = Subject("General arrangement", "P0123", "1:10 (1:5)", 128, 640)
CLEAR = Text("clear", (100.0, 150.0))


def page(*items, size=(420.0, 297.0)):
    return Page("test", size, tuple(items))


@pytest.mark.parametrize("bold", [False, True])
def test_widths_are_those_of_the_font_that_is_written(bold):
    font = "Helvetica-Bold" if bold else "Helvetica"
    for character in CHARACTERS:
        own = text_width(character, 2.5, bold=bold)
        assert own == pytest.approx(stringWidth(character, font, font_size(2.5)), abs=1e-9), character


def test_widths_of_the_embedded_font_are_those_of_its_file():
    """All of them, by another reader of the file; no letter hangs deeper than is reckoned with."""
    font = TTFont("embedded", str(FONT_FILE))
    codes = [code for code in font.face.charToGlyph if code not in {0xA0, 0xAD, 0xFFFF}]
    assert len(codes) > 2000
    assert {chr(code) for code in codes} >= set(CHARACTERS)
    foreign = [chr(code) for code in codes if chr(code) not in CHARACTERS]
    for text in (*foreign, "Στέγαστρο", "Łódź 7"):
        own = font.stringWidth(text, font_size(2.5, "embedded"))
        assert text_width(text, 2.5) == pytest.approx(own, abs=1e-9), text
    glyphs = GlyphFont(FONT_FILE)["glyf"]
    lowest = min(getattr(glyphs[name], "yMin", 0) for name in glyphs)
    assert 0 < -lowest / 2048 / 0.729 < depth_below("Щ", 1.0)


def test_characters_without_a_width_are_refused():
    with pytest.raises(Refused, match=r"E-DRAW-FONT.*日 本.*Cyrillic.*deliver.drawings"):
        text_width("日本", 2.5)
    assert drawable("日本 Łódź ﬁ 𝐱‐") == "□□ Łódź fi x‐"


@pytest.mark.parametrize(
    "text", ["Łódź Đakovo İstanbul Nguyễn", "Μουσείο Ακρόπολης", "Купол «Сфера» № 2", "Երեւան", "თბილისი"]
)
def test_texts_of_many_scripts_stay_as_they_are(text):
    assert drawable(text) == text
    assert not drawable("".join(CHARACTERS)).strip(CHARACTERS)


def test_the_title_block_says_what_is_not_written_as_given():
    for name, shown, note in (("Купол 日", "Купол □", [PLAIN_NOTE]), ("Süd Łódź", "Süd Łódź", [])):
        page = finish(Stationery(BLOCK, ProjectInfo(name=name, number="Ł1")), SUBJECT, (210.0, 297.0), [])
        texts = [item.text for item in page.items if isinstance(item, Text)]
        assert shown in texts
        assert [text for text in texts if text == PLAIN_NOTE] == note
        assert clashes(page) == ()


CLASHES = {
    "text on text": (Text("200", (101.0, 151.0)),),
    "line through text": (Line("thin", np.array([[90.0, 150.5], [120.0, 151.5]])),),
    "closing line through text": (
        Line("thin", np.array([[90.0, 150.5], [90.0, 200], [200, 200], [200.0, 152.0]]), True),
    ),
    "circle through text": (Arc("outline", (102.0, 151.0), 1.0),),
    "off the sheet": (Text("200", (419.0, 20.0)),),
    "turned text on text": (Text("200", (103.0, 148.0), turn=np.pi / 2),),
    "descender": (Text("g", (100.0, 152.9)),),
}


@pytest.mark.parametrize("name", CLASHES)
def test_clashes_are_found(name):
    assert clashes(page(CLEAR, *CLASHES[name]))
    assert not clashes(page(CLEAR))


def test_neighbours_are_no_clash():
    above = Text("200", (100.0, 153.5))
    assert not clashes(page(CLEAR, above, Line("thin", np.array([[90.0, 149.5], [200.0, 149.5]]))))


lengths = st.floats(0.05, 150.0)
spans = st.lists(st.tuples(st.floats(0.0, 120.0), lengths), min_size=1, max_size=9)


@settings(max_examples=50, deadline=None)
@given(spans, st.sampled_from([0.0, 0.4, np.pi / 2, 2.5, -1.2]))
@example([(0.0, 0.1), (0.1, 0.1), (0.0, 150.0), (0.2, 0.1)], 0.0)
def test_stacked_dimensions_never_meet_texts(found, turn):
    along = np.array([np.cos(turn), np.sin(turn)])
    side = Side(np.array([1000.0, 1000.0]), along, np.array([along[1], -along[0]]))
    drawn = stack(side, [Span(start, start + length, f"{length:.3f}") for start, length in found])
    assert clashes(page(*drawn, size=(2000.0, 2000.0))) == ()
    assert sum(isinstance(item, Text) for item in drawn) == len(found)


@settings(max_examples=40, deadline=None)
@given(st.lists(st.floats(0.0, 120.0), min_size=1, max_size=25))
def test_running_dimensions_never_meet(places):
    drawn = running(below(np.array([500.0, 500.0])), [(u, f"{u:.3f}") for u in sorted(places)])
    assert clashes(page(*drawn, size=(1000.0, 1000.0))) == ()


def test_arrows_point_at_what_is_measured():
    drawn = stack(below(np.array([10.0, 100.0])), [Span(0.0, 60.0, "600")])
    tips = [item.points[0].tolist() for item in drawn if isinstance(item, Line) and item.filled]
    assert tips == [[10.0, 91.0], [70.0, 91.0]]


@pytest.mark.parametrize("angle", np.linspace(-np.pi, np.pi, 17))
def test_texts_are_read_from_below_or_the_right(angle):
    found = reading(angle)
    assert np.radians(-75.1) <= found <= np.radians(105.1)
    assert abs(np.sin(found - angle)) < 1e-12


names = st.text(CHARACTERS + "ŁøЖщΣάքაẼ日", max_size=120)


@settings(max_examples=25, deadline=None)
@given(names, names, names)
@example("W" * 120, "W" * 120, "W" * 120)
@example("Wide " * 24, "", "")
@example("", "", " ")
def test_title_blocks_hold_any_text(name, client, author):
    info = ProjectInfo(name=f"A{name[1:]}", client=client, author=author, number="2026-014", revision="AB")
    sheet = finish(Stationery(BLOCK, info), SUBJECT, (210.0, 297.0), [])
    shown = "".join(item.text for item in sheet.items if isinstance(item, Text))
    assert "".join(drawable(client).split()) in "".join(shown.split())
    assert clashes(sheet) == ()


def test_tables_are_as_large_as_they_say_and_cross_no_text():
    rows = [("Hole", "Diameter (mm)"), ("1", "18"), ("front", "123456.789"), ("-", "")]
    drawn = grid(rows, (20.0, 200.0))
    points = np.concatenate([item.points for item in drawn if isinstance(item, Line)])
    assert np.ptp(points, axis=0) == pytest.approx(grid_size(rows))
    assert clashes(page(*drawn)) == ()


def test_free_places_are_found_in_order():
    taken = segments([CLEAR, Line("thin", np.array([[0.0, 200.0], [400.0, 200.0]]))])
    ways = [Text("a", (102.0, 150.0)), Text("b", (50.0, 199.0)), Text("c", (50.0, 100.0)), Text("d", (60.0, 100.0))]
    assert free_text(ways, taken) == ways[2]
    assert free_text(ways[:2], taken) is None
    assert place_all([[ways[2]], [ways[2], ways[3]], [ways[0]]], [CLEAR]) == [ways[2], ways[3]]
    assert collide([CLEAR], [ways[0]])
    assert not collide([CLEAR], [ways[2]])


def test_texts_inside_outlines():
    square = np.array([[0, 0], [20, 0], [20, 10], [0, 10]], float)
    assert within(Text("abc", (5.0, 4.0)), square)
    assert not within(Text("abc", (18.0, 4.0)), square)


def test_standard_scales_and_papers():
    assert fit_scale((2000.0, 100.0), (210.0, 100.0)) == 10.0
    assert [choose_paper(None, 20.0), choose_paper(None, 50.0), choose_paper("A4", 50.0)] == ["A4", "A3", "A4"]


def test_running_dimensions_of_two_sides_keep_clear_of_each_other_at_their_corner():
    marks = [(0.4 * k, f"{k}.125") for k in range(9)]
    sides = [Side(np.full(2, 100.0), np.eye(2)[k], -np.eye(2)[1 - k]) for k in (0, 1)]

    def page(**least):
        drawn = [item for side in sides for item in running(side, marks, **least)]
        return Page("M01", (210.0, 297.0), tuple(drawn))

    assert clashes(page())
    assert clashes(page(least=-3.0)) == ()
