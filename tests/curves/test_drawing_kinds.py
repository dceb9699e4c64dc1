"""The kinds of what files of others hold, made in many ways: units, arcs, versions, blocks, joints, damage, words."""

import math
import time
from decimal import Decimal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter

from isomould.curves.dxf import open_dxf_source
from isomould.curves.lengths import length
from isomould.curves.local_curves import build_local_curve
from isomould.curves.settings import CurveSettings
from isomould.curves.sources import open_source, read_chains
from isomould.curves.sweep import counter_clockwise
from isomould.errors import Refused

SETTINGS = TypeAdapter(CurveSettings)


def tags(*pairs):
    """Write tags, given as code and value in turn."""
    return "".join(f"{code}\n{value}\n" for code, value in zip(pairs[::2], pairs[1::2], strict=True))


def line(a, b, layer="RAIL", **more):
    return tags(0, "LINE", 8, layer, *more.get("tags", ()), 10, a[0], 20, a[1], 11, b[0], 21, b[1])


def arc(centre, radius, start, end, layer="RAIL"):
    return tags(0, "ARC", 8, layer, 10, centre[0], 20, centre[1], 40, radius, 50, start, 51, end)


def ellipse(start, end):
    place = (10, 0, 20, 0, 30, 0, 11, 9000, 21, 0, 31, 0)
    return tags(0, "ELLIPSE", 8, "RAIL", *place, 40, 0.5, 41, start, 42, end)


def drawing(*entities, blocks="", header=("9", "$INSUNITS", "70", "4"), tables=""):
    parts = [("HEADER", tags(*header)), ("TABLES", tables), ("BLOCKS", blocks), ("ENTITIES", "".join(entities))]
    sections = [tags(0, "SECTION", 2, name) + content + tags(0, "ENDSEC") for name, content in parts if content]
    return "".join(sections) + tags(0, "EOF")


@pytest.fixture
def read(tmp_path):
    """Give a function that writes a drawing and reads its curve."""

    def reading(content, **table):
        path = tmp_path / "rail.dxf"
        path.write_bytes(content if isinstance(content, bytes) else content.encode("cp1252"))
        given = SETTINGS.validate_python({"kind": "dxf", "file": "rail.dxf", "layer": "RAIL", **table})
        return build_local_curve(given, tmp_path, None, "rail.curve")

    return reading


def refusal(read, content, **table):
    with pytest.raises(Refused) as refused:
        read(content, **table)
    return str(refused.value)


def codes(local):
    return [note.code for note in local.notes]


L_SHAPE = (line((0, 0), (9000, 0)), arc((9000, 1000), 1000, 270, 0), line((10000, 1000), (10000, 5000)))
L_LENGTH = 13000 + 500 * np.pi

# --- K1: units


WITHOUT_UNIT = [(), (9, "$ACADVER", 1, "AC1009"), (9, "$INSUNITS", 70, 0), (9, "$MEASUREMENT", 70, 1)]


@pytest.mark.parametrize("header", WITHOUT_UNIT)
def test_a_unit_that_is_not_in_the_file_is_asked_for(read, header):
    assert "E-DXF-UNITS rail.curve.units" in refusal(read, drawing(*L_SHAPE, header=header))
    assert length(read(drawing(*L_SHAPE, header=header), units="cm").curve) == pytest.approx(10 * L_LENGTH)


# --- K2: arcs


@given(st.floats(-1440, 1440), st.floats(-1440, 360))
@settings(max_examples=200)
def test_arcs_are_counter_clockwise_whatever_their_angles(start, span):
    end = start + span
    if abs(end - start) < 1e-3:
        return
    low, high = counter_clockwise(math.radians(start), math.radians(end))
    turn = math.degrees(high - low)
    assert 0 < turn < 360 + 1e-9
    assert math.cos(math.radians(low + turn - end)) == pytest.approx(math.cos(math.radians(low - end + turn)))
    assert abs((turn - span + 180) % 360 - 180) < 1e-3


FULL_TURNS = [(0, 360), (360, 0), (90, 450), (-180, 180), (0, 359.9999), (0, 360.0001), (30, -330)]


@pytest.mark.parametrize(("start", "end"), FULL_TURNS)
def test_turns_that_are_nearly_full_are_full(read, start, end):
    local = read(drawing(arc((0, 0), 9000, start, end)))
    assert local.curve.closed
    assert length(local.curve) == pytest.approx(18000 * np.pi, rel=1e-12)


@pytest.mark.parametrize("end", [6.283185307179586, 6.28318, 6.283186, -6.28319])
def test_ellipses_alike(read, end):
    assert read(drawing(ellipse(0, end))).curve.closed


def test_arcs_over_more_than_a_turn_or_none_are_refused(read):
    assert "an arc over 365 degrees" in refusal(read, drawing(arc((0, 0), 9000, 0, 365)))
    assert "a point or a full circle" in refusal(read, drawing(arc((0, 0), 9000, 30, 30)))


def test_a_turn_within_join_of_a_full_one_is_full(read):
    almost = arc((0, 0), 9000, 0, 359.98)
    assert not read(drawing(almost)).curve.closed
    local = read(drawing(almost), join="5 mm")
    assert local.curve.closed
    assert length(local.curve) == pytest.approx(18000 * np.pi, rel=1e-12)


# --- K3: versions


MARKED = tags(0, "LWPOLYLINE", 5, "A1", 100, "AcDbEntity", 8, "RAIL", 100, "AcDbPolyline", 90, 3, 70, 1)
BARE = tags(0, "LWPOLYLINE", 5, "A1", 8, "RAIL", 90, 3, 70, 1)
CORNERS = tags(10, 0, 20, 0, 10, 9000, 20, 0, 42, 0.3, 10, 9000, 20, 8000)


@pytest.mark.parametrize("version", ["", "AC1009", "AC1006", "AC1015", "AC1032", "AC9999"])
@pytest.mark.parametrize("entity", [MARKED, BARE], ids=["marked", "bare"])
def test_newer_entities_in_files_of_any_version(read, version, entity):
    header = ((9, "$ACADVER", 1, version) if version else ()) + (9, "$INSUNITS", 70, 4)
    local = read(drawing(entity + CORNERS, header=header))
    assert local.curve.closed
    assert len(local.curve.pieces) == 3


def test_coordinates_in_another_order(read):
    turned = tags(0, "LINE", 8, "RAIL", 10, 0, 11, 9000, 20, 0, 21, 500)
    assert length(read(drawing(turned)).curve) == pytest.approx(math.hypot(9000, 500))


# --- K4: blocks


def block(name, *entities, base=(0, 0)):
    head = tags(0, "BLOCK", 8, "0", 2, name, 70, 0, 10, base[0], 20, base[1], 30, 0)
    return head + "".join(entities) + tags(0, "ENDBLK", 8, "0")


def insert(name, at, layer="0", *more):
    return tags(0, "INSERT", 8, layer, 2, name, 10, at[0], 20, at[1], *more)


def test_forests_of_blocks_beside_the_layer_cost_little(read, tmp_path):
    tree = block("TREE", *(line((0, 0), (k, 5), "TREES") for k in range(20)))
    trees = [insert("TREE", (k, -k), "TREES") for k in range(42_000)]
    content = drawing(*L_SHAPE, *trees, blocks=tree)
    before = time.process_time()
    local = read(content)
    assert time.process_time() - before < 2
    assert length(local.curve) == pytest.approx(L_LENGTH)


def test_blocks_of_blocks_that_explode_are_refused_at_once(read):
    inner = block("B0", line((0, 0), (5, 5), "0"))
    outer = [block(f"B{k}", *(insert(f"B{k - 1}", (j, 0)) for j in range(10))) for k in range(1, 30)]
    content = drawing(insert("B29", (0, 0), "OTHER"), *L_SHAPE, blocks=inner + "".join(outer))
    before = time.process_time()
    assert length(read(content).curve) == pytest.approx(L_LENGTH)
    assert f"{10**29} entities on layer 'OTHER'" in refusal(read, content, layer="OTHER")
    assert time.process_time() - before < 2


def test_a_block_that_contains_itself_is_refused(read):
    content = drawing(insert("A", (0, 0), "RAIL"), blocks=block("A", insert("A", (1, 1)), insert("A", (2, 2))))
    assert "contains itself" in refusal(read, content)


def test_a_block_on_layer_0_shows_on_the_layer_of_its_insert(read):
    within = block("OUTER", insert("PART", (0, 0)))
    content = drawing(insert("OUTER", (500, 0), "RAIL"), blocks=block("PART", line((0, 0), (9000, 0), "0")) + within)
    np.testing.assert_allclose(read(content).curve.pieces[0].start, (500, 0))


@pytest.mark.parametrize("scales", [(41, 2, 42, 2, 43, 0), (41, 2, 42, 2)])
def test_heights_scaled_to_nothing_are_read(read, scales):
    content = drawing(insert("PART", (0, 0), "RAIL", *scales), blocks=block("PART", line((0, 0), (4500, 0), "0")))
    assert length(read(content).curve) == 9000
    flat = drawing(insert("PART", (0, 0), "RAIL", 41, 0), blocks=block("PART", line((0, 0), (4500, 0), "0")))
    assert "has scales 0, 1, 1" in refusal(read, flat)


# --- K5: joints


@pytest.mark.parametrize("gap", [2e-6, 1e-5, 0.001, 0.0099999, 0.01])
def test_gaps_up_to_join_are_closed_and_noted(read, gap):
    content = drawing(line((0, 0), (9000.12345678, 0)), line((9000.12345678 + gap, 0), (9000, 5000)))
    local = read(content)
    assert codes(local) == ["W-DRAWN-JOINED"]
    assert f"1 gap closed, the largest {gap:.3g} mm" in local.notes[0].text
    first, second = local.curve.pieces
    np.testing.assert_allclose(first.end, second.start, atol=1e-9)


def test_wider_gaps_are_joined_only_where_it_is_asked_for(read):
    content = drawing(line((0, 0), (9000, 0)), line((9000.02, 0), (9000, 5000)))
    assert "their nearest ends are 0.02 mm apart" in refusal(read, content)
    assert len(read(content, join=0.02).curve.pieces) == 2
    assert "0.02 mm apart" in refusal(read, content, join=0.019)


def test_arcs_keep_their_radius_where_lines_can_give_way(read):
    content = drawing(line((0, 0), (8999.995, 0.004)), arc((9000, 1000), 1000, 270, 0))
    straight, bend = read(content).curve.pieces
    assert np.hypot(*bend.major) == 1000
    np.testing.assert_allclose(straight.end, (9000, 0), atol=1e-9)


def test_two_arcs_meet_in_the_middle(read):
    content = drawing(arc((0, 0), 5000, 0, 90), arc((0, 10000.006), 5000, 180, 270))
    one, other = read(content).curve.pieces
    ends = [piece.point(np.array([0.0, 1.0])) for piece in (one, other)]
    away = min(np.linalg.norm(a - b) for a in ends[0] for b in ends[1])
    assert away < 1e-9
    assert np.hypot(*one.major) == pytest.approx(5000, abs=0.006)


def test_six_digits_lose_what_they_lose(read):
    """The true corner is at (12345.678, 6543.2109); every number is printed with six digits."""
    rounded = [(line((0.123456, 3.14159), (12345.7, 6543.21))), line((12345.6, 6543.21), (20111.1, 999.123))]
    local = read(drawing(*rounded))
    assert codes(local) == ["W-DRAWN-JOINED"]
    exact = [(line((0.1234567, 3.14159), (12345.7, 6543.21))), line((12345.6, 6543.21), (20111.1, 999.123))]
    assert "2 curves" in refusal(read, drawing(*exact))


def test_heights_within_join_are_laid_flat(read):
    def at_heights(low, high):
        return drawing(tags(0, "LINE", 8, "RAIL", 10, 0, 20, 0, 30, low, 11, 9000, 21, 0, 31, high))

    local = read(at_heights(5, 5.01))
    assert codes(local) == ["W-DRAWN-FLAT"]
    assert "1 of 1 entities laid flat, the farthest 0.01 mm" in local.notes[0].text
    assert read(at_heights(5, 5)).notes == ()
    assert "leaves the height of the drawing by 0.02 mm" in refusal(read, at_heights(5, 5.02))


@given(st.permutations(range(3)), st.lists(st.booleans(), min_size=3, max_size=3))
@settings(max_examples=20, deadline=None)
def test_the_order_of_entities_changes_nothing(tmp_path_factory, order, flips):
    ends = [((0, 0), (9000.004, 0)), ((9000, 0), (9000, 5000.003)), ((9000.001, 5000), (3000, 7000))]
    lines = [line(*(ends[k][::-1] if flips[k] else ends[k])) for k in order]
    path = tmp_path_factory.mktemp("order") / "rail.dxf"
    path.write_text(drawing(*lines))
    (chain,) = read_chains(open_source(path, None, "x"), "RAIL", None, "x").chains
    corners = np.array([chain.pieces[0].start, *(piece.end for piece in chain.pieces)])
    corners = corners if corners[0][1] == 0 else corners[::-1]
    expected = [(0, 0), (9000.002, 0), (9000.0005, 5000.0015), (3000, 7000)]
    np.testing.assert_allclose(corners, expected, atol=1e-9)


@pytest.mark.parametrize(("east", "north"), [("691608123", "5334765400.25"), ("-1234567000", "0")])
def test_a_drawing_on_a_map_is_the_drawing_at_the_origin(read, east, north):
    """Digits of the file are subtracted as they are printed: nothing at all is lost."""

    def placed(x, y):
        return str(Decimal(x) + Decimal(east)), str(Decimal(y) + Decimal(north))

    ends = [("0", "0"), ("9000.123", "0"), ("9000.123", "4000.456789")]

    def sketch(place):
        a, b, c = (place(*end) for end in ends)
        bend = tags(0, "LWPOLYLINE", 8, "RAIL", 90, 2, 70, 0, 10, b[0], 20, b[1], 42, 0.4, 10, c[0], 20, c[1])
        return drawing(line(a, b), bend)

    near, far = read(sketch(lambda x, y: (x, y))), read(sketch(placed))
    index, t = np.repeat([0, 1], 9), np.tile(np.linspace(0, 1, 9), 2)
    shift = np.array([float(Decimal(east) - Decimal(far.origin[0])), float(Decimal(north) - Decimal(far.origin[1]))])
    np.testing.assert_allclose(far.curve.point(index, t) - shift, near.curve.point(index, t), atol=1e-9)
    assert np.abs(far.curve.point(index, t)).max() < 20_000


# --- K7: damage


SOUND = drawing(*L_SHAPE).encode()


@pytest.mark.parametrize(
    ("content", "noted"),
    [
        (SOUND + b"\x1a", False),
        (SOUND + b"\x1a\x1a rubbish", True),
        (SOUND + b"999\nmade by hand\n", True),
        (SOUND + bytes(100), True),
        (b"\xef\xbb\xbf" + SOUND, True),
        (b"\n\n" + SOUND, True),
        (SOUND.replace(b"\n", b"\r\n"), False),
        (b"999\na comment\n" + SOUND, False),
        (SOUND.rstrip(b"\n"), False),
        (SOUND.replace(b"8\nRAIL", b" 8 \n RAIL "), False),
        (drawing(*L_SHAPE, tables=tags(0, "TABLE", 2, "LAYER", 0, "LAYER", 70, 0, 0, "ENDTAB")).encode(), False),
        (drawing(*L_SHAPE, line((0, 0), ("1,5", "x"), "OTHER")).encode(), False),
    ],
)
def test_what_stands_around_the_drawing_is_left_out(read, content, noted):
    local = read(content)
    assert length(local.curve) == pytest.approx(L_LENGTH)
    assert codes(local) == ["W-DXF-RECOVERED"] * noted


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (SOUND.replace(b"10\n9000\n", b"10\n9000,0\n", 1), "E-DXF-ENTITY"),
        (SOUND[: len(SOUND) // 2], "does not end like a DXF file"),
        (SOUND.replace(b"20\n0\n", b"20\n", 1), "should be a group code"),
        (SOUND.replace(b"0\nENDSEC\n", b""), "has no end"),
        (b"0\nEOF\n", "no section of entities"),
    ],
)
def test_damage_of_the_drawing_itself_is_refused(read, content, words):
    assert words in refusal(read, content)


# --- K8: fitted polylines, encoded names


def vertex(x, y, flags):
    return tags(0, "VERTEX", 8, "RAIL", 10, x, 20, y, 30, 0, 70, flags)


@pytest.mark.parametrize("flags", [4, 12])
def test_the_frame_of_a_smoothed_polyline_is_no_part_of_it(read, flags):
    kind = 32 if flags & 8 else 0
    frame = [vertex(x, y, 16 | kind) for x, y in ((0, 0), (5000, 9000), (9000, 0))]
    curve = [vertex(x, y, 8 | kind) for x, y in ((0, 0), (4500, 4500), (9000, 0))]
    head = tags(0, "POLYLINE", 8, "RAIL", 66, 1, 70, flags)
    local = read(drawing(head, *frame, *curve, tags(0, "SEQEND")))
    assert length(local.curve) == pytest.approx(2 * math.hypot(4500, 4500))
    assert codes(local) == ["W-DXF-FIT"]


@pytest.mark.parametrize(
    ("written", "asked"),
    [(r"TR\U+00C4GER", "träger"), (r"\M+182A0", "あ"), ("Träger", " TRA\u0308GER "), ("A  B", "a  b")],
)
def test_encoded_names_of_layers(read, written, asked):
    assert length(read(drawing(line((0, 0), (9000, 0), written)), layer=asked).curve) == 9000


# --- K9: words


def test_what_is_on_layers_is_said(read):
    text = refusal(read, drawing(line((0, 0), (9, 0), "A B"), arc((0, 0), 5, 0, 90, "A B"), line((0, 0), (9, 0), "C")))
    assert "nothing on layer 'RAIL'" in text
    assert "one of 'A B' (1 ARC, 1 LINE); 'C' (1 LINE)" in text


def test_undecodable_names_are_printable(read):
    content = drawing(line((0, 0), (9, 0), "R?IL"), header=(9, "$ACADVER", 1, "AC1032", 9, "$INSUNITS", 70, 4))
    text = refusal(read, content.encode().replace(b"R?IL", b"R\xffIL"))
    assert r"'R\xffIL' (1 LINE)" in text
    text.encode("utf-8")


def test_a_closed_polyline_over_lines_is_named(read):
    square = tags(0, "LWPOLYLINE", 8, "RAIL", 90, 3, 70, 1) + CORNERS
    text = refusal(read, drawing(square, line((0, 0), (9000, 0)), line((9000, 8000), (0, 0))))
    assert "lie on each other" in text


def test_layers_tell_what_they_hold_and_where(tmp_path):
    path = tmp_path / "a.dxf"
    paper = tags(0, "LINE", 8, "SHEET", 67, 1, 10, 0, 20, 0, 11, 9, 21, 9)
    off = tags(0, "TABLE", 2, "LAYER", 0, "LAYER", 2, "SHEET", 70, 0, 62, -7, 0, "ENDTAB")
    inner = line((0, 0), (9, 0), "IN")
    parts = block("PART", line((0, 0), (9, 0), "0"), inner) + block("IDLE", inner)
    path.write_text(drawing(*L_SHAPE, paper, insert("PART", (0, 0), "RAIL"), blocks=parts, tables=off, header=()))
    source = open_dxf_source(path, None, "x")
    found = {content.name: content for content in source.layers()}
    assert source.unit is None
    assert found["RAIL"].kinds == {"ARC": 1, "LINE": 3}
    assert found["IN"].kinds == {"LINE": 1}
    assert found["IN"].elsewhere == ("1 LINE in block 'IDLE', which is never inserted",)
    assert (found["SHEET"].kinds, found["SHEET"].state) == ({}, "off")
    assert found["SHEET"].elsewhere == ("1 LINE in paper space",)
    assert source.holds("rail")
    assert not source.holds("SHEET")
