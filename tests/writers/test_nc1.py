"""NC1 files: the layout of the format, and that a reader of its own finds what was meant."""

from dataclasses import replace

import numpy as np
import pytest

from isomould.documents.nc_parts import Blank, nc_part, plate_profile, tube_profile
from isomould.parts.catalogue import RhsSection
from isomould.parts.features import Hole
from isomould.verify.read.nc1 import NcHole, read_nc1
from isomould.verify.rules import Unreadable
from isomould.writers.nc1 import NcOrder, nc1_text, write_nc1

CORNERS = np.array([[-10.0, -100.0], [410.0, -100.0], [410.0, 50.0], [360.0, 100.0], [-10.0, 100.0]])
ROUND = np.array([0.0, 0.0, np.tan(np.pi / 8), 0.0, 0.0])
"""A quarter circle from the third corner to the fourth."""
HOLES = (Hole(40, -50, 22), Hole(45, 50, 22, lengthening=10))
PLATE = Blank("FIN-0001", 4, "S355J2", CORNERS, ROUND, HOLES, along=True)
ORDER = NcOrder("ORDER-1", "DWG-12", "1")
FIN = """ST
  ORDER-1
  DWG-12
  1
  FIN-0001
  S355J2
  4
  FL200*15
  B
      420.00,    420.00
      200.00
       15.00
       15.00
       15.00
        0.00
       23.55
        0.43
        0.00
        0.00
        0.00
        0.00
  -
  -
  -
  -
BO
  v      50.00u     50.00     22.00      0.00
  v      50.00u    150.00     22.00      0.00l   10.00      0.00      0.00
AK
  v       0.00u      0.00      0.00
  v     420.00u      0.00      0.00
  v     420.00u    150.00     50.00
  v     370.00u    200.00      0.00
  v       0.00u    200.00      0.00
  v       0.00u      0.00      0.00
SI
"""


def fin(**changes):
    return nc_part(replace(PLATE, **changes), plate_profile("FL200*15", 200, 15, 7850, "kg/m"))


def test_the_example_of_the_format():
    """The plate with a round corner, a hole and a slot that nc1.md writes out, the stamp apart."""
    assert nc1_text(fin(), ORDER).replace("\r\n", "\n").startswith(FIN)


def test_a_plate_comes_back(tmp_path):
    write_nc1(tmp_path / "F.nc1", fin(notes=("TOP 1.00",)), ORDER)
    read = read_nc1(tmp_path / "F.nc1")
    assert read.texts == {"order": "ORDER-1", "drawing": "DWG-12", "phase": "1", "mark": "FIN-0001", "grade": "S355J2"}
    assert (read.quantity, read.profile, read.code, read.length, read.saw_length) == (4, "FL200*15", "B", 420, 420)
    assert read.holes == (NcHole("v", 50, 50, 22), NcHole("v", 50, 150, 22, (10, 0)))
    assert np.array_equal(read.outer[0], np.column_stack((CORNERS + np.array([10, 100]), [0, 0, 50, 0, 0])))
    assert read.notes == ("TOP 1.00", "-", "-", "-")
    assert [stamp.text for stamp in read.stamps] == ["FIN-0001"]


def test_a_hollow_section_has_holes_on_its_faces_and_no_contour(tmp_path):
    box = np.array([[25.0, -60.0], [1025.0, -60.0], [1025.0, 60.0], [25.0, 60.0]])
    faces = ("front", "back", "top", "bottom")
    blank = Blank("M01", 2, "S355J2H", box, holes=tuple(Hole(75, 10, 18, face=face) for face in faces))
    profile = tube_profile(RhsSection(depth=120, width=80, wall=5), 7850)
    write_nc1(tmp_path / "M01.nc1", nc_part(blank, profile), ORDER)
    read = read_nc1(tmp_path / "M01.nc1")
    assert (read.code, read.length, read.outer) == ("M", 1000, ())
    assert [(h.view, h.x, h.y) for h in read.holes] == [("v", 50, 70), ("h", 50, 70), ("o", 50, 50), ("u", 50, 50)]
    assert [read.sizes[key] for key in ("height", "width", "flange", "web", "radius")] == [120, 80, 5, 5, 10]


@pytest.mark.parametrize(
    ("size", "wall", "radius", "mass", "paint"),
    [((120, 80), 5, 10, 14.4, 0.383), ((200, 200), 10, 25, 57.0, 0.757), ((50, 30), 3, 6, 3.30, 0.150)],
)
def test_tubes_weigh_what_the_standard_prints(size, wall, radius, mass, paint):
    """EN 10219-2, tables B.2 and B.3: kg/m to three digits, m²/m."""
    profile = tube_profile(RhsSection(depth=size[0], width=size[1], wall=wall, outer_radius=radius), 7850)
    assert profile.mass == pytest.approx(mass, rel=6e-3)
    assert profile.paint == pytest.approx(paint, abs=6e-4)


def test_plates_may_be_weighed_per_area():
    assert plate_profile("", 200, 10, 7850, "kg/m2").mass == pytest.approx(78.5)


def test_text_is_plain():
    text = nc1_text(fin(grade="Stähl\u00a0№"), NcOrder("Łódź", "", ""))
    assert text.isascii()
    assert "\r\n  Lodz\r\n  -\r\n  -\r\n" in text


FAULTS = {
    "no end": lambda text: text.replace("EN\n", ""),
    "no start": lambda text: text[3:],
    "a line of the header lost": lambda text: text.replace("  B\n", ""),
    "open contour": lambda text: text.replace("  v       0.00u      0.00      0.00\nSI", "SI"),
    "a decimal comma": lambda text: text.replace("150.00     50.00", "150,00     50.00"),
    "a blind hole": lambda text: text.replace("22.00      0.00\n", "22.00      9.00\n"),
    "a turned slot": lambda text: text.replace("10.00      0.00      0.00\n", "10.00      0.00     45.00\n"),
    "a saw cut beside the contour": lambda text: text.replace("0.43\n        0.00", "0.43\n       12.00"),
    "an unknown block": lambda text: text.replace("BO", "PU"),
    "no data": lambda text: text.replace("SI\n", "SI\nSI\n"),
    "not a number": lambda text: text.replace("23.55", "  nan"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_the_reader_is_strict(name, tmp_path):
    good = nc1_text(fin(), ORDER).replace("\r\n", "\n")
    spoilt = FAULTS[name](good)
    assert spoilt != good
    (tmp_path / "F.nc1").write_text(spoilt, "ascii", newline="")
    with pytest.raises(Unreadable):
        read_nc1(tmp_path / "F.nc1")
