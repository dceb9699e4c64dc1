"""Label sheets as PDF: A4 with 3 × 8 labels of 70 × 37 mm, each with a QR code; the same bytes every time."""

import io
from collections.abc import Sequence
from pathlib import Path

from reportlab import rl_config
from reportlab.pdfgen.canvas import Canvas

from isomould.documents.labels import PieceLabel
from isomould.documents.shop.font import drawable, text_width
from isomould.writers.codes import draw_code
from isomould.writers.disk import write_bytes
from isomould.writers.pdf_fonts import font_for

_MM = 72 / 25.4
_PAGE = (210.0, 297.0)
_COLUMNS, _ROWS = 3, 8
_LABEL = (70.0, 37.0)
_CODE = 25.0
"""Side of a code without its quiet zone of four modules, mm."""
_LEFT, _BELOW = 4.0, 6.0
_TEXT = (_LEFT + _CODE + 5.0, 31.0)
_WIDTH = _LABEL[0] - _TEXT[0] - 3.0


def write_label_sheets(path: Path, labels: Sequence[PieceLabel]) -> None:
    """Write labels row by row from the upper left, sheet after sheet.

    Raises
    ------
    OutputFault
        If the file cannot be written.
    """
    rl_config.useA85 = 0  # the streams need not be text
    stream = io.BytesIO()
    canvas = Canvas(stream, pagesize=(_PAGE[0] * _MM, _PAGE[1] * _MM), invariant=1, pageCompression=1)
    canvas.setTitle("Labels")
    for first in range(0, len(labels), _COLUMNS * _ROWS):
        _add_sheet(canvas, labels[first : first + _COLUMNS * _ROWS])
    canvas.save()
    write_bytes(path, stream.getvalue())


def _add_sheet(canvas: Canvas, labels: Sequence[PieceLabel]) -> None:
    canvas.scale(_MM, _MM)
    for k, label in enumerate(labels):
        row, column = divmod(k, _COLUMNS)
        canvas.saveState()
        canvas.translate(column * _LABEL[0], _PAGE[1] - (row + 1) * _LABEL[1])
        _add_label(canvas, label)
        canvas.restoreState()
    canvas.showPage()


def _add_label(canvas: Canvas, label: PieceLabel) -> None:
    """Draw the code on the left; mark, location, crate and project under each other on its right."""
    draw_code(canvas, label.code, (_LEFT, _BELOW), _CODE)
    x, y = _TEXT
    for text, height, drop in ((label.mark, 5.0, 6.0), (label.location, 3.2, 8.0), (label.crate, 2.5, 7.0)):
        y -= drop
        _write(canvas, x, y, text, height)
    _write(canvas, x, y - 6.0, drawable(label.project), 1.4)


def _write(canvas: Canvas, x: float, y: float, text: str, height: float) -> None:
    """Write a line with capitals of some height, mm, lower where it would be too wide."""
    width = text_width(text, height, bold=True)
    canvas.setFont(*font_for(text, height if width <= _WIDTH else height * _WIDTH / width, bold=True))
    canvas.drawString(x, y, text)
