"""Pages as PDF and DXF, read back by other readers: texts, bookmarks, circles, layers, the same bytes."""

import re
from collections import Counter

import ezdxf
import numpy as np
import pytest
from pypdf import PdfReader

from isomould.documents.shop.page import Arc, Book, Line, Page, Text
from isomould.verify.read.dxf_texts import read_dxf_texts
from isomould.verify.read.pdf import read_pdf
from isomould.verify.rules import Unreadable
from isomould.writers.dxf_pages import write_pages
from isomould.writers.pdf import write_pdf

SHOWN = ["Ø90", "12.3456°", "m²", "(a\\b)", "Äpfel ü", "%%c ^J", "N01", "Łódź (Ж\\Ω)"]


def book():
    lines = [
        Line(pen, np.array([[10.0, 10.0], [60.0, 20.0 + k]]), closed=False)
        for k, pen in enumerate(("outline", "hidden", "centre", "thin", "frame"))
    ]
    arrow = Line("thin", np.array([[10.0, 10.0], [12.5, 10.4], [12.5, 9.6]]), closed=True, filled=True)
    arcs = [Arc("outline", (50.0, 50.0), 10.0), Arc("centre", (50.0, 50.0), 20.0, -np.pi / 2, np.pi / 2)]
    texts = [Text(text, (100.0, 20.0 + 10 * k), turn=0.3 * k, anchor="middle") for k, text in enumerate(SHOWN)]
    pages = [
        Page(name, size, (*lines, arrow, *arcs, *texts)) for name, size in (("N01", (210, 297)), ("N02", (420, 297)))
    ]
    return Book("nodes", "Nodes", tuple(pages))


@pytest.fixture
def files(tmp_path):
    paths = tmp_path / "nodes.pdf", tmp_path / "nodes.dxf"
    write_pdf(paths[0], book(), "Vault")
    write_pages(paths[1], book())
    return paths


def test_pdf_pages_sizes_bookmarks_and_texts(files):
    reader = PdfReader(files[0], strict=True)
    assert [entry.title for entry in reader.outline] == ["N01", "N02"]
    assert [round(float(page.mediabox.width) * 25.4 / 72, 3) for page in reader.pages] == [210.0, 420.0]
    assert (reader.metadata.title, reader.metadata.subject) == ("Nodes", "Vault")
    for page in reader.pages:
        lines = page.extract_text().splitlines()
        assert sorted(line.strip() for line in lines if line.strip()) == sorted(SHOWN)
        fonts = page["/Resources"]["/Font"].values()
        assert {font.get_object()["/BaseFont"] for font in fonts} == {"/Helvetica", "/AAAAAA+DejaVuSans"}


def test_pdf_draws_every_line_arc_and_arrow(files):
    content = PdfReader(files[0]).pages[0].get_contents().get_data()
    assert len(re.findall(rb"\bc\b", content)) >= 4 + 2
    assert len(re.findall(rb"\bl\b", content)) >= 5 + 2
    assert len(re.findall(rb"(?m)\bS$", content)) == 5 + 2
    assert len(re.findall(rb"(?m)\bf\*?$", content)) == 1


def test_own_readers_see_the_same_texts(files):
    found = read_pdf(files[0])
    assert [sheet.name for sheet in found.sheets] == ["N01", "N02"]
    assert all(sorted(sheet.texts) == sorted(SHOWN) for sheet in found.sheets)
    assert Counter(read_dxf_texts(files[1])) == Counter(2 * [*SHOWN])


def test_dxf_is_sound_and_complete(files):
    document = ezdxf.readfile(files[1])
    audit = document.audit()
    assert (audit.errors, audit.fixes) == ([], [])
    assert document.header["$INSUNITS"] == 4
    space = document.modelspace()
    kinds = Counter(entity.dxftype() for entity in space)
    assert kinds == {"LWPOLYLINE": 10, "SOLID": 2, "CIRCLE": 2, "ARC": 2, "TEXT": 2 * len(SHOWN)}
    assert {e.dxf.layer for e in space} == {"OUTLINE", "HIDDEN", "CENTRE", "DIMENSION", "FRAME", "TEXT"}
    assert [text.plain_text() for text in space.query("TEXT")][: len(SHOWN)] == [
        t.replace("%%c", "Ø") if "^" not in t else t for t in SHOWN
    ]
    arc = space.query("ARC").first
    assert (arc.dxf.start_angle, arc.dxf.end_angle) == (270.0, 90.0)


def test_the_same_bytes_twice(files, tmp_path):
    (tmp_path / "again").mkdir()
    write_pdf(tmp_path / "again" / "nodes.pdf", book(), "Vault")
    write_pages(tmp_path / "again" / "nodes.dxf", book())
    assert [path.read_bytes() for path in files] == [(tmp_path / "again" / path.name).read_bytes() for path in files]


@pytest.mark.parametrize("share", [0.3, 0.9])
def test_truncated_files_are_unreadable(files, share):
    for path, read in zip(files, (read_pdf, read_dxf_texts), strict=True):
        path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])
        with pytest.raises(Unreadable):
            read(path)
