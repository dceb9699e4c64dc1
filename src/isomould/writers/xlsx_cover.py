"""The first sheet: project, logo, key figures, total, checks, and what the other sheets hold."""

import io
from collections.abc import Sequence
from dataclasses import dataclass

import pandas as pd
from xlsxwriter.utility import quote_sheetname

from isomould.documents.info import Logo, ProjectInfo
from isomould.documents.table import Table, cells
from isomould.documents.title_block import title_lines
from isomould.writers.xlsx_checks import FAILED, RED
from isomould.writers.xlsx_page import Page, absolute, write_cell, write_texts

_LOGO_PX = (360, 120)
_LOGO_COLUMN = 4
_KEY = ("Nodes", "Node classes", "Members", "Member classes", "Panels", "Panel classes", "Sheets", "Bars")
"""Lines of the summary that the cover repeats."""
_LABEL_WIDTH, _VALUE_WIDTH = 26, 34


@dataclass(frozen=True)
class Figures:
    """What the cover shows of the sheets behind it; None where there is no such sheet."""

    total: float | None = None
    currency: str = ""
    failed: int | None = None


def write_cover(cover: Page, pages: Sequence[Page], info: ProjectInfo, logo: Logo | None, figures: Figures) -> None:
    """Write the cover; all numbers on it are formulas."""
    sheet = cover.sheet
    sheet.set_column(0, 0, _LABEL_WIDTH)
    sheet.set_column(1, 1, _VALUE_WIDTH)
    sheet.hide_gridlines(2)
    if logo:
        _insert_logo(cover, logo)
    write_cell(cover, (0, 0), info.name, cover.style(bold=True, font_size=20))
    write_texts(cover, (2, 0), title_lines(info)[1:])
    row = _write_figures(cover, 4 + len(title_lines(info)), pages, figures)
    _write_contents(cover, row + 1, pages)


def _insert_logo(cover: Page, logo: Logo) -> None:
    """Put the picture at the right, no larger than its frame."""
    scale = min(1.0, _LOGO_PX[0] / logo.width, _LOGO_PX[1] / logo.height)
    options = {"image_data": io.BytesIO(logo.content), "x_scale": scale, "y_scale": scale, "object_position": 3}
    cover.sheet.insert_image(0, _LOGO_COLUMN, "logo.png", options)


def _write_figures(cover: Page, row: int, pages: Sequence[Page], figures: Figures) -> int:
    """Write key figures from a row on; give the first free one."""
    write_cell(cover, (row, 0), "Key figures", cover.style(bold=True, bottom=1))
    for item, value, place in _key_figures(pages):
        row += 1
        write_cell(cover, (row, 0), item)
        write_cell(cover, (row, 1), value, cover.style(num_format="#,##0", align="left"), place)
    if figures.total is not None:
        row += 1
        write_cell(cover, (row, 0), f"Total ({figures.currency})")
        style = cover.style(num_format="#,##0.00", align="left", bold=True)
        write_cell(cover, (row, 1), figures.total, style, "=total_cost")
    if figures.failed is not None:
        row += 1
        _write_status(cover, row, figures.failed)
    return row + 1


def _key_figures(pages: Sequence[Page]) -> list[tuple[str, float, str]]:
    """Items of the summary with value and place, in the cover's order."""
    found: dict[str, tuple[float, str]] = {}
    for page in (page for page in pages if page.table.name == "summary"):
        items, values = (cells(page.table, column) for column in page.table.columns[:2])
        for row, (item, value) in enumerate(zip(items, values, strict=True), start=1):
            if isinstance(value, int | float):
                found.setdefault(str(item), (value, absolute(page, row, 1)))
    return [(item, *found[item]) for item in _KEY if item in found]


def _write_status(cover: Page, row: int, failed: int) -> None:
    write_cell(cover, (row, 0), "All checks")
    word = "pass" if failed == 0 else "fail"
    write_cell(cover, (row, 1), word, cover.style(bold=True), f'=IF({FAILED}=0,"pass","fail")')
    failing = {"type": "cell", "criteria": "==", "value": '"fail"', "format": cover.style(**RED)}
    cover.sheet.conditional_format(row, 1, row, 1, failing)


def _write_contents(cover: Page, row: int, pages: Sequence[Page]) -> None:
    """List the sheets with links and their numbers of rows."""
    bold = cover.style(bold=True, bottom=1)
    for column, text in enumerate(("Sheet", "Rows")):
        write_cell(cover, (row, column), text, bold)
    for at, page in enumerate(pages, start=row + 1):
        title = page.table.title
        cover.sheet.write_url(at, 0, f"internal:{quote_sheetname(title)}!A1", None, title)
        write_cell(cover, (at, 1), len(page.table.frame), cover.style(num_format="#,##0", align="left"))


def cover_table() -> Table:
    """Stand in for the table that the cover does not have."""
    return Table("cover", "Cover", (), pd.DataFrame())
