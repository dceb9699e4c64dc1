"""NC1 files and R12 twins of a delivered folder are proved; seeded faults are found."""

import re
import shutil
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from verify_museum import holding

from isomould.documents.member_files import member_drawing
from isomould.documents.nc_parts import Blank, nc_part, plate_profile
from isomould.parts.catalogue import PlateSection
from isomould.parts.features import Hole
from isomould.parts.members import MemberShape
from isomould.verify.checks.machines import contours
from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.read.dxf import read_dxf
from isomould.verify.read.nc1 import read_nc1
from isomould.verify.rules import judge
from isomould.writers.dxf import write_dxf
from isomould.writers.nc1 import NcOrder, write_nc1

BY_ID = {rule.id: rule for rule in RULES}
CHECKS = ["V40", "V40f", "V42", "V42b", "V42c", "V42d", "V42e"]


@pytest.fixture
def folder(built_folder, tmp_path):
    return Path(shutil.copytree(built_folder, tmp_path / "delivered"))


@pytest.mark.parametrize("rule", CHECKS)
def test_the_good_folder_passes(built_folder, rule):
    found = judge(BY_ID[rule], Delivery(built_folder))
    assert found.status == "pass", found
    assert found.count > 0


def test_header_and_twins(built_folder):
    text = (built_folder / "members" / "M01.nc1").read_bytes().decode("ascii")
    assert text.startswith("ST\r\n  A-7\r\n  Sud No 2\r\n  1\r\n  M01\r\n")
    twin = ezdxf.readfile(built_folder / "r12" / "members" / "M01.dxf")
    assert twin.dxfversion == "AC1009"
    assert {path.parent.name for path in built_folder.glob("r12/*/*.dxf")} == {"panels", "members", "sheets", "strips"}


def rewrite(pattern, change, where="members/M01.nc1"):
    def seed(folder):
        path = folder / where
        text = path.read_bytes().decode("ascii")
        spoilt = re.sub(pattern, change, text, count=1, flags=re.MULTILINE)
        assert spoilt != text
        path.write_bytes(spoilt.encode("ascii"))

    return seed


def more(by):
    return lambda match: f"{match[1]}{float(match[2]) + by:10.2f}"


def move_twin(folder):
    path = folder / "r12" / "panels" / "P01.dxf"
    document = ezdxf.readfile(path)
    document.modelspace().query("POLYLINE[layer=='CUT']")[0].vertices[0].dxf.location += (0.01, 0, 0)
    document.saveas(path)


def swap_files(folder):
    one, other = (folder / "members" / f"M0{k}.nc1" for k in (1, 2))
    content = one.read_bytes()
    one.write_bytes(other.read_bytes())
    other.write_bytes(content)


SEEDS = {
    "corner moved 0.02 mm": ("V42", rewrite(r"(AK\r\n.*\r\n  v)\s+(\S+)u", lambda m: more(0.02)(m) + "u")),
    "corner moved: contour left open": ("V42b", rewrite(r"(AK\r\n  v)\s+(\S+)u", lambda m: more(0.02)(m) + "u")),
    "corner lost": ("V42", rewrite(r"(AK\r\n.*\r\n)(.*\r\n)", r"\1")),
    "arc instead of a line": ("V42", rewrite(r"(AK\r\n.*\r\n.*)      0.00\r", r"\g<1>     50.00\r")),
    "hole too many": ("V42", rewrite(r"AK\r\n", "BO\r\n  v  100.00u  50.00  18.00  0.00\r\nAK\r\n")),
    "quantity": ("V42b", rewrite(r"^(  M01\r\n.*\r\n)  (\d+)", r"\g<1>  999")),
    "mark": ("V42b", rewrite(r"^  M01\r", "  M02\r")),
    "stamp": ("V42b", rewrite(r"rM01", "rM02")),
    "profile": ("V42b", rewrite(r"FL200\*12", "FL200*15")),
    "order": ("V42b", rewrite(r"A-7", "A-8")),
    "files swapped": ("V42b", swap_files),
    "file lost": ("V42b", lambda folder: (folder / "members" / "M02.nc1").unlink()),
    "saw length": ("V42c", rewrite(r"(,\s*)(\d+\.\d+)", more(0.02))),
    "thickness": ("V42c", rewrite(r"^( *)(12.00)\r", lambda m: more(3)(m) + "\r")),
    "long point": ("V42c", rewrite(r"(  TOP )(\d+\.\d+)", lambda m: f"{m[1]}{float(m[2]) + 0.02:.2f}")),
    "contour of another mass": ("V42d", rewrite(r"(AK\r\n.*\r\n)(.*\r\n)", r"\1")),
    "mass per metre": ("V42e", rewrite(r"94.20", "94.30")),
    "truncated": ("V42", rewrite(r"EN\r\n", "")),
    "twin lost": ("V40f", lambda folder: (folder / "r12" / "sheets" / "S001.dxf").unlink()),
    "twin moved": ("V40f", move_twin),
}


@pytest.mark.parametrize("name", SEEDS)
def test_every_fault_is_found(folder, name):
    rule, seed = SEEDS[name]
    seed(folder)
    found = judge(BY_ID[rule], Delivery(folder))
    assert found.status == "fail", found
    assert found.reason


LENGTHS = {
    "section": PlateSection(depth=200, thickness=12),
    "system_length": 480.0,
    "top_length": 440.0,
    "bottom_length": 400.0,
    "end_angle": (0.1, 0.1),
    "set_back": (20.0, 20.0),
}
HOLES = (Hole(90.0, 20.0, 18.0), Hole(240.0, -30.1234, 14.0, lengthening=12.0))


def deliver(folder, drawn, told):
    """Write one member, as drawn with some holes and told with others."""
    outline = [[40.0, -100.0], [440.0, -100.0], [460.123, 100.0], [20.0, 100.0]]
    shapes = [MemberShape(outline=np.array(outline), holes=holes, **LENGTHS) for holes in (drawn, told)]
    write_dxf(folder / "M01.dxf", member_drawing("M01", shapes[0]))
    blank = Blank("M01", 1, "S355", shapes[1].outline, holes=told, along=True)
    part = nc_part(blank, plate_profile("FL200*12", 200, 12, 7850, "kg/m"))
    write_nc1(folder / "M01.nc1", part, NcOrder())
    return holding(members={"M01": read_dxf(folder / "M01.dxf")}, nc1={"M01": read_nc1(folder / "M01.nc1")})


def test_holes_and_slots_agree(tmp_path):
    found = contours(deliver(tmp_path, HOLES, HOLES))
    assert found.worst <= 0.01


@pytest.mark.parametrize(
    "told",
    [
        HOLES[:1],
        (HOLES[0], Hole(240.02, -30.1234, 14.0, lengthening=12.0)),
        (HOLES[0], Hole(240.0, -30.1234, 14.1, lengthening=12.0)),
        (HOLES[0], Hole(240.0, -30.1234, 14.0, lengthening=12.1)),
        (HOLES[0], Hole(240.0, -30.1234, 26.0)),
    ],
)
def test_holes_told_otherwise_are_found(tmp_path, told):
    assert contours(deliver(tmp_path, HOLES, told)).worst > 0.01


def test_the_mark_stands_at_the_start_with_an_arrow_to_the_end(tmp_path):
    delivery = deliver(tmp_path, (), ())
    strokes = [o.points for o in delivery.members["M01"].outlines if o.layer == "ENGRAVE"]
    assert max(stroke[:, 0].max() for stroke in strokes) < 240, "in the first half"
    head = max(strokes, key=lambda stroke: stroke[:, 0].max())
    assert len(head) == 3 or head[-1, 0] > head[0, 0]
    assert delivery.nc1["M01"].stamps[0].text == "M01"
