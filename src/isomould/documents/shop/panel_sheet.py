"""The sheet of a panel class: its view, its data, what it is made of; of outlines of their own the corners."""

from collections.abc import Sequence

import numpy as np

from isomould.documents.shop.grid import grid, grid_size
from isomould.documents.shop.page import MARGIN, SMALL, Item, Page, Text, paper_size
from isomould.documents.shop.panel_view import PanelDrawing, angle_texts, diagonal_texts, fitted_view, side_texts
from isomould.documents.shop.placing import led
from isomould.documents.shop.rows import data_rows
from isomould.documents.shop.title_block import Stationery, Subject, finish, room, wrap
from isomould.documents.shop.view import choose_paper, fit_scale, scale_text
from isomould.documents.table import Table

_BESIDE, _NOTE_PITCH = 4.0, 4.5
_A4_ROOM = (130.0, 100.0)


def panel_sheet(stationery: Stationery, table: Table, panel: PanelDrawing, sheet: int, sheets: int) -> Page:
    """Draw one panel class."""
    rough = fit_scale(np.ptp(panel.outline, axis=0), _A4_ROOM)
    size = paper_size(choose_paper(stationery.paper, rough), lying=True)
    left, bottom, right, top = room(stationery, size)
    grids = [[("Panel", panel.row["mark"]), *data_rows(table, panel.row)], *_corner_tables(panel)]
    column = right - max(grid_size(rows)[0] for rows in grids)
    box = np.array([[left, bottom], [column - _BESIDE, top]])
    beside = _beside(panel.notes, left, size[0] - MARGIN - stationery.block.width)
    for rows in grids:
        beside += grid(rows, (column, top), heading=len(rows) > 2)
        top -= grid_size(rows)[1] + _BESIDE
    scale, (drawn, waiting) = fitted_view(panel, box)
    subject = Subject("Panel", panel.row["mark"], scale_text(scale), sheet, sheets)
    items = [*beside, *drawn]
    return finish(stationery, subject, size, [*items, *led(waiting, items, box)])


def _beside(notes: Sequence[str], left: float, right: float) -> list[Item]:
    """Write notes to the left of the title block."""
    lines = [line for note in notes for line in wrap(note, SMALL, right - left - _BESIDE)]
    low = MARGIN + _BESIDE
    return [Text(line, (left, low + _NOTE_PITCH * k), SMALL) for k, line in enumerate(reversed(lines))]


def _corner_tables(panel: PanelDrawing) -> list[list[tuple[str, ...]]]:
    """List the corners of an outline as scheduled, its sides, angles and diagonals."""
    if not panel.own_outline:
        return []
    pairs = [pair.split(",") for pair in panel.row["outline"].split(";")]
    measured = zip(pairs, side_texts(panel), angle_texts(panel), strict=True)
    rows = [(str(k), x, y, side, angle[:-1]) for k, ((x, y), side, angle) in enumerate(measured, start=1)]
    diagonals = zip(("Diagonal 1-3 (mm)", "Diagonal 2-4 (mm)"), diagonal_texts(panel), strict=False)
    return [[("Corner", "x", "y", "To next", "Angle °"), *rows], *([list(diagonals)] if len(rows) == 4 else [])]
