"""Drawings as other programs write them: each gives its right value, or the words that say what is wrong with it."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from pydantic import TypeAdapter

from isomould.curves.construction import build_curve
from isomould.curves.lengths import length
from isomould.curves.local_curves import build_local_curve
from isomould.curves.settings import CurveSettings
from isomould.errors import Refused

CASES = Path(__file__).parent / "cases"
SETTINGS = TypeAdapter(CurveSettings)


class Read(NamedTuple):
    """What a drawing gives: length in mm, pieces, whether closed, and the codes of its notes."""

    length: float
    pieces: int
    closed: bool
    notes: tuple[str, ...] = ()


READ = {
    "a01-arc-360-90.dxf": Read(4000 * np.pi, 1, False),
    "a02-arc-450-30.dxf": Read(8000 * np.radians(300), 1, False),
    "a06-arc-minus-ext.dxf": Read(4000 * np.pi, 1, False, ("W-DXF-OCS",)),
    "a08-arc-360-0.dxf": Read(16000 * np.pi, 1, True),
    "a10-arc-30-minus450.dxf": Read(8000 * np.radians(240), 1, False),
    "b01-bulge-closed-repeated-first.dxf": Read(69591.190, 4, True, ("W-CURVE-REPEATED",)),
    "b03-bulge-last-vertex-open.dxf": Read(2 * np.hypot(12000, 6000), 2, False),
    "by-fc2-line-arc-line.dxf": Read(24434.46, 3, False, ("W-DRAWN-JOINED", "W-DRAWN-SMOOTHED")),
    "by-fc2-rounded-rect-rotated.dxf": Read(3731.517, 8, True, ("W-DRAWN-JOINED", "W-DRAWN-SMOOTHED")),
    "by-ink-a.dxf": Read(711.9, 0, False, ("W-DRAWN-SMOOTHED",)),
    "by-mk-roundrect-rot.dxf": Read(3731.517, 8, True),
    "by-scad-square.dxf": Read(2200, 4, True),
    "by-tj-lw.dxf": Read(2542.478, 4, True),
    "d08-tiny-line-1e-7.dxf": Read(24000 + np.hypot(6000, 5000), 2, False, ("W-DRAWN-TINY",)),
    "e-ell02-6.283185.dxf": Read(44661.54, 1, True),
    "e01-umlaut-cp1252.dxf": Read(24000, 1, False),
    "e06-u-plus.dxf": Read(24000, 1, False),
    "f01-ctrl-z.dxf": Read(25.4 * (1000 + 150 * np.pi), 2, False),
    "f16-garbage-after-eof.dxf": Read(25.4 * (1000 + 150 * np.pi), 2, False, ("W-DXF-RECOVERED",)),
    "g-gap-0.001.dxf": Read(24000 + 4000 * np.pi, 2, False, ("W-DRAWN-JOINED",)),
    "g-gap-1e-05.dxf": Read(24000 + 4000 * np.pi, 2, False, ("W-DRAWN-JOINED",)),
    "k12-block-own-units-m.dxf": Read(20283.185, 3, False, ("W-DXF-BLOCK",)),
    "l01-layer-trailing-blank.dxf": Read(24000, 1, False),
    "n05-zwsoft-mult-4.dxf": Read(36417.519, 2, False),
    "n16-cp-duplicate-end.dxf": Read(20821.812, 1, False, ("W-DXF-DOUBLED",)),
    "p01-polyline-curvefit.dxf": Read(24951.361, 4, False, ("W-DXF-FIT",)),
    "u01-no-header-metres.dxf": Read(24000 + 4000 * np.pi, 2, False),
    "u08-ezdxf-default-metres-drawn-in-mm.dxf": Read(21991.149, 1, False, ("W-DRAWN-UNITS",)),
    "v-ac1009-marks-lwpoly-minus-z.dxf": Read(32707.516, 3, False, ("W-DXF-OCS",)),
    "v-ac1009-two-layers.dxf": Read(40707.516, 4, True),
    "v-ac1015-nomarks-lwpoly-closed.dxf": Read(40707.516, 4, True),
    "v-nohdr-marks-spline2.dxf": Read(34683.544, 3, False),
    "x01-utm-mm-circle.dxf": Read(16000 * np.pi, 1, True),
    "x01-utm-mm-line-arc-line.dxf": Read(23208.532, 3, False),
    "x01-utm-mm-lwpolyline-bulges.dxf": Read(29317.177, 4, False),
    "x01-utm-mm-spline.dxf": Read(17917.637, 1, False),
}

UNITS = {
    "by-ink-a.dxf": "mm",
    "by-scad-square.dxf": "mm",
    "u01-no-header-metres.dxf": "m",
    "u08-ezdxf-default-metres-drawn-in-mm.dxf": "mm",
    "v-nohdr-marks-spline2.dxf": "mm",
}

REFUSED = {
    "by-scad-square.dxf": ["E-DXF-UNITS rail.curve.units", "a drawing without units"],
    "u01-no-header-metres.dxf": ["E-DXF-UNITS rail.curve.units", "a drawing without units"],
    "d01-line-twice.dxf": ["E-DRAWN-CURVES", "LINE in line 19 and LINE in line 35 lie on each other"],
    "d03-open-polyline-twice.dxf": ["POLYLINE in line 19 and POLYLINE in line 67 lie on each other"],
    "d05-overlapping-lines.dxf": ["2 curves", "LINE in line 19 and LINE in line 35 lie on each other"],
    "d06-short-line-inside-long.dxf": ["turns back on itself at (24000, 0): LINE in line 19 and LINE in line 35"],
    "k09-block-minsert-9-million.dxf": ["E-DXF-BLOCK", "9000000 entities on layer 'RAIL'"],
    "k16-block-never-inserted.dxf": ["nothing on layer 'RAIL' in the model", "1 ARC, 2 LINE in block 'B', which is"],
    "p07-polyline-pface.dxf": ["E-DXF-ENTITY", "a mesh of faces"],
    "s01-paper-space-only.dxf": ["nothing on layer 'RAIL' in the model", "1 LINE in paper space"],
}


def layer_of(name):
    if name.startswith("e0"):
        return "TRÄGER"
    return "RAIL" if b"RAIL" in (CASES / name).read_bytes() else "0"


def table_of(name, **more):
    return SETTINGS.validate_python({"kind": "dxf", "file": name, "layer": layer_of(name), **more})


@pytest.mark.parametrize("name", READ)
def test_what_is_read(name):
    units = {"units": UNITS[name]} if name in UNITS else {}
    local = build_local_curve(table_of(name, **units), CASES, None, "rail.curve")
    expected = READ[name]
    assert length(local.curve) == pytest.approx(expected.length, abs=max(6e-4 * (expected.length > 1e3), 0.06))
    assert local.curve.closed == expected.closed
    assert expected.pieces in (0, len(local.curve.pieces))
    codes = {note.code for note in local.notes} - {"W-CURVE-SIZE"}
    assert codes == set(expected.notes)


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_refused_and_named(name):
    with pytest.raises(Refused) as refusal:
        build_curve(table_of(name), CASES, None, "rail.curve")
    for words in REFUSED[name]:
        assert words in str(refusal.value)


def test_every_drawing_has_a_right_value_or_act():
    drawings = {path.name for path in CASES.glob("*.dxf")}
    assert drawings == READ.keys() | REFUSED.keys()


def test_gaps_are_noted_with_number_size_and_place():
    _, notes = build_curve(table_of("g-gap-0.001.dxf"), CASES, None, "rail.curve")
    assert [str(note) for note in notes] == [
        "W-DRAWN-JOINED rail.curve: 1 gap closed, the largest 0.001 mm at (24000, 0)"
    ]


def test_a_mirrored_polyline_of_an_old_version_is_mirrored():
    curve, _ = build_curve(table_of("v-ac1009-marks-lwpoly-minus-z.dxf"), CASES, None, "rail.curve")
    np.testing.assert_allclose(curve.point(np.array([0]), np.ones(1)), [(-12000, 0)], atol=1e-9)


def test_a_noisy_model_is_laid_flat_with_a_note():
    pytest.importorskip("rhino3dm", reason="the extra isomould[rhino] is not installed")
    table = SETTINGS.validate_python({"kind": "rhino", "file": "rh13-z-noise.3dm", "layer": "RAIL"})
    curve, notes = build_curve(table, CASES, None, "rail.curve")
    assert len(curve.pieces) > 0
    assert "W-DRAWN-FLAT" in {note.code for note in notes}
