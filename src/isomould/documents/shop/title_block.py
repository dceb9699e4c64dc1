"""The frame of a sheet and its title block (ISO 5457, ISO 7200), whose cells are data in `templates/sheets`."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from isomould.arrays import Floats
from isomould.documents.info import ProjectInfo
from isomould.documents.shop.font import depth_below, drawable, text_width
from isomould.documents.shop.page import BINDING, MARGIN, SMALLEST, Arc, Code, Item, Line, Page, Paper, Text
from isomould.settings import Settings

Value = Literal[
    "name",
    "number",
    "client",
    "revision",
    "author",
    "date",
    "title",
    "part",
    "scale",
    "sheet",
    "units",
    "projection",
    "code",
]
_HEIGHTS = (7.0, 5.0, 3.5, 2.5, SMALLEST)
_SIDE, _LABEL, _SPACING = 1.5, 3.2, 1.5
_CODE = 18.0
"""Side of the QR code, mm: around it, its cell leaves four modules and more of quiet zone."""
UNITS = "mm, °, kg, m²"
PLAIN_NOTE = "Characters that the fonts of the drawings lack stand plain or as boxes; the schedules have them as given."


class Cell(Settings):
    """A cell: its label, which value it shows, its lower left corner in the block, its size, mm."""

    label: str
    value: Value
    at: tuple[float, float]
    size: tuple[float, float]
    height: float


class TitleBlock(Settings):
    """The cells of a title block and its size, mm."""

    width: float
    height: float
    cells: tuple[Cell, ...]


@dataclass(frozen=True)
class Subject:
    """What a sheet is about: title of the drawing, part, scale, number of the sheet and of all sheets."""

    title: str
    part: str
    scale: str
    sheet: int
    sheets: int

    @property
    def name(self) -> str:
        """The part, or title and number of a sheet that shows many."""
        return self.part or f"{self.title} {self.sheet}"


@dataclass(frozen=True)
class Stationery:
    """What all sheets of a project have in common."""

    block: TitleBlock
    info: ProjectInfo
    paper: Paper | None = None
    """What all sheets are drawn on; None chooses by content."""


def read_title_block(text: str) -> TitleBlock:
    """Read the cells of a title block from TOML."""
    return TitleBlock.model_validate(tomllib.loads(text))


def finish(stationery: Stationery, subject: Subject, size: tuple[float, float], items: list[Item]) -> Page:
    """Put frame and title block around what is drawn."""
    frame = Line("frame", _box(BINDING, MARGIN, size[0] - MARGIN, size[1] - MARGIN), closed=True)
    block, values = stationery.block, _values(stationery.info, subject)
    corner = np.array([size[0] - MARGIN - block.width, MARGIN])
    cells = [item for cell in block.cells for item in _cell(cell, corner, values)]
    border = Line("frame", _box(*corner, *(corner + np.array([block.width, block.height]))), closed=True)
    return Page(subject.name, size, (frame, border, *cells, *_note(values), *items))


def _note(values: Mapping[Value, str]) -> list[Text]:
    """Say under the frame that letters of the title block are not those that were given."""
    kept = all(drawable(text) == text for value, text in values.items() if value != "code")
    return [] if kept else [Text(PLAIN_NOTE, (BINDING, MARGIN - 4.0), SMALLEST)]


def room(stationery: Stationery, size: tuple[float, float]) -> tuple[float, float, float, float]:
    """Give left, bottom, right and top (mm) of what frame and title block leave, with a margin inside the frame."""
    inside = 5.0
    bottom = MARGIN + stationery.block.height + inside
    return BINDING + inside, bottom, size[0] - MARGIN - inside, size[1] - MARGIN - inside


def _values(info: ProjectInfo, subject: Subject) -> Mapping[Value, str]:
    return {
        "name": info.name,
        "number": info.number,
        "client": info.client,
        "revision": info.revision,
        "author": info.author,
        "date": info.date.isoformat() if info.date else "",
        "title": subject.title,
        "part": subject.part,
        "scale": subject.scale,
        "sheet": f"{subject.sheet} of {subject.sheets}",
        "units": UNITS,
        "code": f"{info.number}/{info.revision}/{subject.name}",
    }


def _cell(cell: Cell, corner: Floats, values: Mapping[Value, str]) -> list[Item]:
    (x, y), (width, height) = np.array(cell.at) + corner, cell.size
    label = Text(cell.label, (float(x) + _SIDE, float(y) + height - 2.6), SMALLEST)
    border = Line("thin", _box(x, y, x + width, y + height), closed=True)
    if cell.value == "projection":
        return [border, label, *_symbol(x + width / 2 + 4, y + height / 2 - 1)]
    text = values[cell.value]
    if cell.value == "code":
        return [border, Code(text, (float(x + (width - _CODE) / 2), float(y + (height - _CODE) / 2)), _CODE)]
    return [border, label, *(_lines(drawable(text), cell, float(x) + _SIDE, float(y)) if text.strip() else [])]


def _lines(text: str, cell: Cell, x: float, y: float) -> list[Text]:
    """Write a text as high as its cell asks, lower or in several lines where it is longer."""
    room_across, room_up = cell.size[0] - 2 * _SIDE, cell.size[1] - _LABEL
    heights = [height for height in _HEIGHTS if height <= cell.height]
    ways = ((height, wrap(text, height, room_across)) for height in [*heights, *(SMALLEST / k for k in range(2, 20))])
    height, lines = next(way for way in ways if len(way[1]) * _SPACING * way[0] <= room_up)
    bottom = y + max(depth_below(lines[-1], height), 0.25 * height) + 0.4
    return [Text(line, (x, bottom + (len(lines) - 1 - k) * _SPACING * height), height) for k, line in enumerate(lines)]


def wrap(text: str, height: float, width: float) -> list[str]:
    """Break a text into lines no wider than a width: at spaces, and within words that are wider."""
    lines = [""]
    for piece in text.replace(" ", " \0").split("\0"):
        if text_width((lines[-1] + piece).rstrip(), height) <= width:
            lines[-1] += piece
        else:
            lines += _pieces(piece, height, width)
    return [line.rstrip() for line in lines if line.strip()]


def _pieces(word: str, height: float, width: float) -> list[str]:
    found = [""]
    for character in word:
        fits = text_width(found[-1] + character, height) <= width
        found = [*found[:-1], found[-1] + character] if fits else [*found, character]
    return found


def _symbol(x: float, y: float) -> list[Item]:
    """Draw the symbol of first-angle projection: the cone from the side, and to its right as seen from its left."""
    cone = np.array([[x - 8, y - 1.2], [x - 2.5, y - 2.4], [x - 2.5, y + 2.4], [x - 8, y + 1.2]])
    axes = [
        np.array([[x - 9, y], [x - 1.5, y]]),
        np.array([[x, y], [x + 6, y]]),
        np.array([[x + 3, y - 3], [x + 3, y + 3]]),
    ]
    rings = [Arc("outline", (float(x) + 3, float(y)), radius) for radius in (1.2, 2.4)]
    return [Line("outline", cone, closed=True), *rings, *(Line("centre", axis) for axis in axes)]


def _box(left: float, bottom: float, right: float, top: float) -> Floats:
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top]], dtype=float)
