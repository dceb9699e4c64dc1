"""Labels are proved from their PDF; their codes are read by an independent decoder."""

import re

import numpy as np
import pytest
import zxingcpp
from pypdf import PdfReader
from verify_museum import holding, vault

from isomould.documents.labels import PieceLabel
from isomould.verify.checks.labels import RULES
from isomould.verify.read.labels import read_label_texts
from isomould.verify.rules import judge
from isomould.writers.label_sheets import write_label_sheets

LABELS = [PieceLabel(f"M{k:02d}", f"MG-{k:02d}-07", f"R-{k:02d}", "2026-014 Süd (Kuppel), Łódź 本") for k in range(30)]
"""More than one sheet."""


@pytest.fixture(scope="module")
def sheets(tmp_path_factory):
    path = tmp_path_factory.mktemp("labels") / "labels.pdf"
    write_label_sheets(path, LABELS)
    return path


def test_texts_come_back(sheets):
    pages = read_label_texts(sheets)
    assert [len(page) // 4 for page in pages] == [24, 6]
    found = [text for page in pages for text in page]
    assert list(zip(*[iter(found)] * 4, strict=True)) == [
        (label.mark, label.location, label.crate, "2026-014 Süd (Kuppel), Łódź □") for label in LABELS
    ]


def test_codes_say_mark_and_location(sheets):
    """Every label, drawn from the rectangles of the page, is decoded at its place."""
    page = PdfReader(sheets).pages[0]
    found = {barcode.text for barcode in zxingcpp.read_barcodes(picture(page))}
    assert found == {label.code for label in LABELS[:24]}


def picture(page, dots=8):
    """Draw the filled rectangles of a page in black on white, some dots per mm."""
    image = np.full((297 * dots, 210 * dots), 255, dtype=np.uint8)
    origin = np.zeros(2)
    for line in page.get_contents().get_data().decode("latin-1").splitlines():
        if match := re.fullmatch(r"1 0 0 1 (\S+) (\S+) cm", line):
            origin = np.array(match.groups(), dtype=float)
        for cells in re.findall(r"(\S+) (\S+) (\S+) (\S+) re\b", line):
            x, y, w, h = map(float, cells)
            left, low, right, high = np.rint(np.array([x, y, x + w, y + h]) * dots + np.tile(origin, 2) * dots).astype(
                int
            )
            image[297 * dots - high : 297 * dots - low, left:right] = 0
    return image


def test_the_same_bytes_again(sheets, tmp_path):
    write_label_sheets(tmp_path / "again.pdf", LABELS)
    assert (tmp_path / "again.pdf").read_bytes() == sheets.read_bytes()


def pieces(mesh):
    kinds = (
        (mesh.node_mark, mesh.node_location, mesh.node_ij[:, 0]),
        (mesh.edge_mark, mesh.edge_location, mesh.node_ij[mesh.edges[:, 0], 0]),
        (mesh.face_mark, mesh.face_location, mesh.face_ij[:, 0]),
    )
    return [PieceLabel(m, where, f"R-{row:02d}", "P") for kind in kinds for m, where, row in zip(*kind, strict=True)]


def delivered(folder, labels, *, asked=True):
    """A mesh with a folder that holds these labels."""
    plain = vault()
    write_label_sheets(folder / "labels.pdf", labels)
    plain.design.raw["labels"] = asked
    return holding(mesh=plain.mesh, design=plain.design, folder=folder)


@pytest.fixture(scope="module")
def all_labels():
    return pieces(vault().mesh)


def test_all_pieces_have_labels(tmp_path, all_labels):
    found = judge(RULES[0], delivered(tmp_path, all_labels))
    assert found.status == "pass", found
    assert found.count == len(all_labels)
    assert judge(RULES[0], delivered(tmp_path, all_labels, asked=False)).status == "not_applicable"


@pytest.mark.parametrize("fault", ["lost", "doubled", "mark", "crate", "truncated"])
def test_every_fault_is_found(tmp_path, all_labels, fault):
    first, *others = all_labels
    other = {
        "lost": others,
        "doubled": [first, first, *others],
        "mark": [PieceLabel("N02", first.location, first.crate, "P"), *others],
        "crate": [PieceLabel(first.mark, first.location, "R-03", "P"), *others],
        "truncated": all_labels,
    }[fault]
    delivery = delivered(tmp_path, other)
    if fault == "truncated":
        path = tmp_path / "labels.pdf"
        path.write_bytes(path.read_bytes()[:-300])
    assert judge(RULES[0], delivery).status == "fail"
