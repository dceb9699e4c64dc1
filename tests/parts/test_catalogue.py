"""Sections: catalogue, look-up, areas against the tables of EN 10219-2."""

import csv
import math

import numpy as np
import pytest

from isomould.errors import Refused
from isomould.form.mesh import Family
from isomould.parts.bodies import member_body
from isomould.parts.catalogue import CATALOGUE, PlateSection, RhsSection, catalogue, find_section
from isomould.parts.features import EndPlate, Hole
from isomould.parts.members import MemberShape
from isomould.parts.settings import MemberSettings
from isomould.project.load import validate
from museum import SMALL, changed

EN_10219_TABLE = {  # kg/m, cm² as printed in EN 10219-2
    "SHS40*40*3": (3.30, 4.21),
    "SHS100*100*5": (14.4, 18.4),
    "SHS200*200*8": (46.5, 59.2),
    "RHS50*30*3": (3.30, 4.21),
    "RHS50*30*4": (4.20, 5.35),
    "RHS60*40*3": (4.25, 5.41),
    "RHS60*40*4": (5.45, 6.95),
    "RHS100*50*4": (8.59, 10.9),
    "RHS120*60*5": (12.8, 16.4),
    "RHS200*100*8": (33.9, 43.2),
}


@pytest.mark.parametrize("name", EN_10219_TABLE)
def test_hollow_sections_weigh_what_the_standard_prints(name):
    mass, area = EN_10219_TABLE[name]
    section = find_section(name)
    assert (float(f"{section.area * 7850e-6:.3g}"), float(f"{section.area / 100:.3g}")) == (mass, area)


def test_the_whole_catalogue_says_what_its_sections_are():
    with CATALOGUE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(catalogue()) > 300
    for row in rows:
        section = catalogue()[row["name"]]
        assert section.area / 100 == pytest.approx(float(row["area_cm2"]), rel=5.1e-3)
        assert section.area * 7850e-6 == pytest.approx(float(row["mass_kg_m"]), rel=5.1e-3)
        if isinstance(section, RhsSection):  # the rule of the standard, which sections without radii get
            plain = RhsSection(depth=section.depth, width=section.width, wall=section.wall)
            assert (plain.radii, plain.area) == (section.radii, section.area)


@pytest.mark.parametrize("text", ["RHS100*50*4", "RHS 100x50x4", "rhs 100 × 50 × 4.0"])
def test_designations_are_read_as_people_write_them(text):
    assert find_section(text) == RhsSection(depth=100, width=50, wall=4, outer_radius=8, inner_radius=4)


def test_nothing_near_is_taken():
    with pytest.raises(Refused) as refusal:
        validate(changed(SMALL, members={"section": "RHS 100x50x4.5"}), "project")
    for words in ("members.section", "RHS 100x50x4.5", "nearest are", "RHS100*50*4,"):
        assert words in str(refusal.value)


def test_families_have_their_own_sections():
    members = MemberSettings.model_validate({"section": "FL200*12", "parallel": "FL200*10", "sill": "FL100*10"})
    assert [members.of(family).name for family in Family] == ["FL200*12", "FL200*10", "FL100*10"]
    with pytest.raises(Refused, match="depths of 150 and 200 mm"):
        validate(changed(SMALL, members={"parallel": "FL150*12"}), "project")


def test_walls_must_fit():
    with pytest.raises(Refused, match="walls and corners of 12 mm"):
        validate(changed(SMALL, members={"section": {"kind": "rhs", "depth": 70, "width": 70, "wall": 12}}), "project")


def bar(section, **features):
    half, length = section.depth / 2, 1000.0
    outline = np.array([[0, half], [0, -half], [length, -half], [length, half]])
    return MemberShape(section, outline, length, length, length, (0.0, 0.0), (0.0, 0.0), **features)


HOLES = (Hole(100, 20, 18), Hole(300, -10, 26, lengthening=50))


def test_holes_go_through_plates():
    shape = bar(PlateSection(depth=100, thickness=10), holes=HOLES)
    openings = math.pi / 4 * (18**2 + 26**2) + 26 * 50
    assert shape.volume == pytest.approx((100 * 1000 - openings) * 10, rel=1e-14)
    around = 10 * math.pi * (18 + 26)  # chords of 0.002 mm, what V27c allows
    assert 0 <= member_body(shape).volume() - shape.volume < 0.002 * around
    assert member_body(shape).genus() == 2


@pytest.mark.parametrize(("face", "axis", "side"), [("front", 2, 1), ("back", 2, -1), ("top", 1, 1), ("bottom", 1, -1)])
def test_a_hole_goes_through_one_wall_of_a_hollow_section(face, axis, side):
    """The wall that its face is, at the place that its face's coordinates say."""
    section = RhsSection(depth=100, width=60, wall=4)
    shape = bar(section, holes=(Hole(200, 8, 20, face=face),))
    body = member_body(shape)
    assert (body.genus(), len(body.decompose())) == (2, 1)
    assert body.volume() == pytest.approx(shape.volume, rel=1e-3)
    plain = member_body(bar(section))
    removed = np.array((plain - body).bounding_box()).reshape(2, 3).mean(axis=0)
    expected = {2: (200, 8, 28), 1: (200, 48, -8)}[axis] * np.array(
        [1, side if axis == 1 else 1, side if axis == 2 else 1]
    )
    assert removed == pytest.approx(expected, abs=0.2)


def test_end_plates_close_a_hollow_section():
    section, plate = RhsSection(depth=100, width=50, wall=4), EndPlate(10, 14, (-25, 25))
    shape = bar(section, end_plates=(plate, plate))
    tube = section.area * 1000
    plates = 2 * 10 * (92 * 42 - (4 - math.pi) * 16 - 2 * math.pi / 4 * 14**2)
    assert shape.volume == pytest.approx(tube + plates, rel=1e-14)
    assert member_body(shape).volume() == pytest.approx(shape.volume, rel=1e-3)
    low, high = np.array(member_body(shape).bounding_box()).reshape(2, 3)
    assert high - low == pytest.approx([1000, 100, 50])
