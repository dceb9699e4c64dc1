"""One fault in the shop drawings of a delivered folder at a time, each found by the check that it concerns."""

import csv
import io
import json
import re
import shutil
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from pypdf import PdfWriter
from verify_museum import edit_table

from isomould.verify.delivery import Delivery
from isomould.verify.folder import RULES
from isomould.verify.rules import judge

BY_ID = {rule.id: rule for rule in RULES}
SHEETS = ("V43f", "V45", "V45b", "V45c", "V45d")
"""What concerns every folder with drawings; V45e only those with holes or trimmed panels."""


@pytest.fixture
def folder(built_folder, tmp_path):
    return Path(shutil.copytree(built_folder, tmp_path / "delivered"))


def rows_of(folder, name):
    return list(csv.DictReader(io.StringIO((folder / "tables" / f"{name}.csv").read_bytes().decode(), newline="")))


def edit_pdf(name, change):
    """Change the first text operator of a book that `change` names, and write the file anew."""

    def seed(folder):
        path = folder / "drawings" / f"{name}.pdf"
        old, new = change(folder)
        writer = PdfWriter(clone_from=path)
        streams = [page["/Contents"].get_object() for page in writer.pages]
        stream = next(stream for stream in streams if old in stream.get_data())
        stream.set_data(stream.get_data().replace(old, new, 1))
        writer.write(path)

    return seed


def shown(text, other):
    return lambda folder: (f"({text}) Tj".encode("cp1252"), f"({other}) Tj".encode("cp1252"))


def cut_length(folder):
    """A dimension of a member, one digit changed."""
    length = rows_of(folder, "members")[0]["cut_length_mm"]
    return f"({length}) Tj".encode(), f"({length[:-1]}{(int(length[-1]) + 1) % 10}) Tj".encode()


def last_digit(text):
    head, digit = re.fullmatch(r"(.*?)(\d)(\D*)", text).group(1), re.findall(r"\d", text)[-1]
    return f"{head}{(int(digit) + 1) % 10}{text[len(head) + 1 :]}"


def second(kind, column, form="{}"):
    """Change a digit of a dimension where it stands in the view: behind the list, which comes first."""

    def seed(folder):
        value = form.format(rows_of(folder, kind)[0][column])
        path = folder / "drawings" / f"{kind}.pdf"
        writer = PdfWriter(clone_from=path)
        stream = writer.pages[0]["/Contents"].get_object()
        old, new = (f"({text}) Tj".encode("cp1252") for text in (value, last_digit(value)))
        old, new = (text.replace(b"\xb0", b"\\260") for text in (old, new))
        data = stream.get_data()
        assert old in data
        at = data.rindex(old)
        stream.set_data(data[:at] + new + data[at + len(old) :])
        writer.write(path)

    return seed


def wider_slot(folder):
    return b"(Slots 12.5 wide", b"(Slots 13.5 wide"


def set_back_of_an_arm(folder):
    back = rows_of(folder, "members")[0]["set_back_start_mm"]
    edit_pdf("nodes", shown(back, last_digit(back)))(folder)


def edit_dxf(folder):
    path = folder / "drawings" / "panels.dxf"
    path.write_bytes(path.read_bytes().replace(b"\nQuantity\n", b"\nQuantities\n", 1))


def shear_member(folder):
    path = folder / "members" / "M01.dxf"
    document = ezdxf.readfile(path)
    cut = next(e for e in document.modelspace() if e.dxftype() == "LWPOLYLINE" and e.dxf.layer == "CUT")
    points = np.array(cut.get_points("xy"))
    cut.set_points([tuple(point) for point in points * 1.001], format="xy")
    document.saveas(path)


def swap_sheets(rows):
    rows[0]["drawing_file"], rows[1]["drawing_file"] = rows[1]["drawing_file"], rows[0]["drawing_file"]


def one_more(rows):
    rows[0]["quantity"] = str(int(rows[0]["quantity"]) + 1)


def digit(column):
    def change(rows):
        rows[0][column] += "1"

    return change


def heavier(rows):
    """Add what a sheet would show: a unit of the last digit that people read."""
    rows[0]["mass_kg"] = f"{float(rows[0]['mass_kg']) + 0.1:.3f}"


def other_location(rows):
    rows[0]["location"] += "-A"


SEEDS = {
    "sheet of another mark named": ("V45", edit_table("nodes", swap_sheets)),
    "no sheet named": ("V45", edit_table("panels", lambda rows: rows[0].update(files="panels/P01.dxf"))),
    "mark changed on its sheet": ("V45", edit_pdf("nodes", shown("N03", "N04"))),
    "quantity": ("V45b", edit_table("members", one_more)),
    "a digit of a mass in the schedule": ("V45b", edit_table("nodes", heavier)),
    "a digit of a height in the schedule": ("V45b", edit_table("panels", digit("height_mm"))),
    "a digit of a dimension on the drawing": ("V45b", edit_pdf("members", cut_length)),
    "a digit of a diagonal in its view": ("V45b", second("panels", "diagonal_2_mm")),
    "a digit of an angle in its view": ("V45b", second("panels", "angle_2_deg", "{}°")),
    "a digit of a side in its view": ("V45c", second("panels", "side_b_mm")),
    "a whole number that is nowhere": ("V45c", edit_pdf("panels", shown("Quantity", "777"))),
    "a set-back in the table of arms": ("V45c", set_back_of_an_arm),
    "a slot of another width": ("V45c", edit_pdf("nodes", wider_slot)),
    "a dimension that is in no schedule": ("V45c", edit_pdf("members", cut_length)),
    "part file of another size": ("V45c", shear_member),
    "location": ("V45d", edit_table("member_instances", other_location)),
    "node location": ("V45d", edit_table("node_instances", other_location)),
    "text in the DXF only": ("V43f", edit_dxf),
    "text in the PDF only": ("V43f", edit_pdf("general-arrangement", shown("Node", "Knot"))),
    "DXF lost": ("V43f", lambda folder: (folder / "drawings" / "nodes.dxf").unlink()),
    "PDF lost": ("V45", lambda folder: (folder / "drawings" / "nodes.pdf").unlink()),
}


@pytest.mark.parametrize("name", SEEDS)
def test_every_fault_is_found(folder, name):
    rule, seed = SEEDS[name]
    seed(folder)
    check = judge(BY_ID[rule], Delivery(folder))
    assert check.status == "fail", check
    assert check.reason


@pytest.mark.parametrize("rule", SHEETS)
def test_good_drawings_pass(built_folder, rule):
    check = judge(BY_ID[rule], Delivery(built_folder))
    assert check.status == "pass", check
    assert check.count > 30


def test_no_drawings_are_asked_for(folder):
    path = folder / "model" / "design.json"
    path.write_text(json.dumps({**json.loads(path.read_text("utf-8")), "drawings": False}), "utf-8")
    assert {judge(BY_ID[rule], Delivery(folder)).status for rule in SHEETS} == {"not_applicable"}


def test_numbers_of_title_block_and_holes_are_no_strangers(folder):
    """A project number with decimals, and holes that the part file has, explain what a sheet prints."""
    for path in sorted((folder / "drawings").glob("*.pdf")):
        writer = PdfWriter(clone_from=path)
        for page in writer.pages:
            stream = page["/Contents"].get_object()
            stream.set_data(stream.get_data().replace(b"(Small) Tj", b"(Small 7.25) Tj"))
        writer.write(path)
    edit_pdf("members", lambda folder: (b"(Quantity) Tj", b"(Quantity) Tj (31.415) Tj"))(folder)
    assert judge(BY_ID["V45c"], Delivery(folder)).status == "fail"
    path = folder / "members" / "M01.dxf"
    document = ezdxf.readfile(path)
    document.modelspace().add_circle((300, 31.415), 9, dxfattribs={"layer": "DRILL"})
    document.saveas(path)
    check = judge(BY_ID["V45c"], Delivery(folder))
    assert check.status == "pass", check
