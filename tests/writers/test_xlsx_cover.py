"""The cover: a logo that fits its frame, the same bytes every time."""

import io
import re
import struct
import zipfile
import zlib

import openpyxl
import pytest

from isomould.documents.costs import Result
from isomould.documents.info import ProjectInfo
from isomould.documents.live import Given
from isomould.project.logo import read_logo
from isomould.writers.xlsx import Words, workbook_bytes


def png(width, height):
    """Make a picture of one colour."""
    rows = b"".join(b"\0" + bytes([30, 90, 160]) * width for _ in range(height))
    chunks = ((b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(rows)))
    packed = [
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in (*chunks, (b"IEND", b""))
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(packed)


@pytest.fixture
def write(tables, tmp_path):
    def bytes_with(width, height):
        (tmp_path / "logo.png").write_bytes(png(width, height))
        words = Words(ProjectInfo(name="Vault"), logo=read_logo(tmp_path, "logo.png"))
        return workbook_bytes(tables, words)

    return bytes_with


def test_the_logo_is_embedded_as_it_is(write):
    with zipfile.ZipFile(io.BytesIO(write(240, 80))) as book:
        (name,) = [name for name in book.namelist() if "media" in name]
        assert book.read(name) == png(240, 80)


@pytest.mark.parametrize(
    ("size", "shown"), [((240, 80), (240, 80)), ((3600, 600), (360, 60)), ((100, 1200), (10, 120))]
)
def test_large_logos_are_scaled_into_their_frame(write, size, shown):
    with zipfile.ZipFile(io.BytesIO(write(*size))) as book:
        drawing = book.read("xl/drawings/drawing1.xml").decode()
    (extent,) = re.findall(r'<a:ext cx="(\d+)" cy="(\d+)"/>', drawing)
    assert [int(length) / 9525 for length in extent] == pytest.approx(shown, abs=1)


def test_the_same_words_give_the_same_bytes(write):
    assert write(240, 80) == write(240, 80)


def test_the_cover_says_the_datum(tables):
    info = ProjectInfo.model_validate({"name": "Vault", "datum": {"origin": [1000, 2000, "3 m"], "rotation_deg": 12.5}})
    book = openpyxl.load_workbook(io.BytesIO(workbook_bytes(tables, Words(info))))
    rows = {row[0].value: row[1].value for row in book["Cover"].iter_rows(max_col=2)}
    assert rows["Datum"] == "origin at 1000, 2000, 3000 mm; x axis turned by 12.5°"


def test_the_total_on_the_cover_is_the_named_one(tables):
    results = (Result("Total", "EUR", Given(12.5), "total_cost"),)
    book = openpyxl.load_workbook(io.BytesIO(workbook_bytes(tables, Words(ProjectInfo(name="Vault"), results=results))))
    rows = {row[0].value: row[1].value for row in book["Cover"].iter_rows(max_col=2)}
    assert rows["Total (EUR)"] == "=total_cost"
