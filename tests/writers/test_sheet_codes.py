"""QR codes on shop drawings, read by an independent decoder from the rectangles of the page."""

import re

import numpy as np
import zxingcpp
from pypdf import PdfReader

from isomould.documents.info import ProjectInfo
from isomould.documents.shop.page import Book, Code
from isomould.documents.shop.title_block import Stationery, Subject, finish, read_title_block
from isomould.templates import template_folder
from isomould.writers.dxf_pages import write_pages
from isomould.writers.pdf import write_pdf

SIZE, DOTS = (210, 297), 8


def page(number, part):
    block = read_title_block((template_folder() / "sheets" / "title-block.toml").read_text("utf-8"))
    info = ProjectInfo(name="Vault", number=number, revision="B")
    return finish(Stationery(block, info), Subject("Node", part, "1:5", 3, 9), SIZE, [])


def decoded(path):
    """Draw what is filled in black on white and give the codes with their places and sizes, mm."""
    image = np.full((SIZE[1] * DOTS, SIZE[0] * DOTS), 255, dtype=np.uint8)
    content = PdfReader(path).pages[0].get_contents().get_data().decode("latin-1")
    for cells in re.findall(r"(\S+) (\S+) (\S+) (\S+) re\b", content):
        x, y, w, h = map(float, cells)
        left, low, right, high = np.rint(np.array([x, y, x + w, y + h]) * DOTS).astype(int)
        image[len(image) - high : len(image) - low, left:right] = 0
    return {code.text: code.position for code in zxingcpp.read_barcodes(image)}


def test_a_sheet_says_number_revision_and_part(tmp_path):
    for number, part in (("2026-014", "N07"), ("", "M12"), ("Süd 7 " * 20, "P003"), ("", "")):
        write_pdf(tmp_path / "nodes.pdf", Book("nodes", "Nodes", (page(number.strip(), part),)), "Vault")
        ((said, place),) = decoded(tmp_path / "nodes.pdf").items()
        assert said == f"{number.strip()}/B/{part or 'Node 3'}"
        assert abs((place.top_right.x - place.top_left.x) / DOTS - 18) < 0.5
        assert place.top_right.x / DOTS < SIZE[0] - 10 - 3


def test_the_quiet_zone_is_free():
    """Nothing is nearer to a code than four modules of the smallest one, 21 modules wide."""
    items = page("1", "N01").items
    (code,) = (item for item in items if isinstance(item, Code))
    low, high = np.array(code.at) - 4 / 21 * code.side, np.array(code.at) + 25 / 21 * code.side
    points = np.concatenate([item.points for item in items if hasattr(item, "points")])
    assert not ((points > low) & (points < high)).all(axis=1).any()


def test_the_dxf_does_without(tmp_path):
    sheet = page("1", "N01")
    bare = type(sheet)(sheet.name, sheet.size, tuple(item for item in sheet.items if not isinstance(item, Code)))
    for name, drawn in (("a", sheet), ("b", bare)):
        write_pages(tmp_path / f"{name}.dxf", Book("nodes", "Nodes", (drawn,)))
    assert (tmp_path / "a.dxf").read_bytes() == (tmp_path / "b.dxf").read_bytes()
