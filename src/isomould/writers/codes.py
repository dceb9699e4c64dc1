"""QR codes in PDF: vector, level M, one filled path."""

from collections.abc import Iterator, Sequence

import segno
from reportlab.pdfgen.canvas import Canvas

_MASK = 2
"""Of the eight patterns that are laid over a code; to try all and weigh them takes most of the time of making one."""


def draw_code(canvas: Canvas, text: str, corner: tuple[float, float], side: float) -> None:
    """Draw a code without its quiet zone of four modules, `corner` at its lower left: a bar for every run of a row."""
    matrix = segno.make_qr(text, error="m", mask=_MASK, boost_error=False).matrix
    (x, y), module, path = corner, side / len(matrix), canvas.beginPath()
    for k, row in enumerate(matrix):
        for start, end in _runs(row):
            path.rect(x + start * module, y + side - (k + 1) * module, (end - start) * module, module)
    canvas.drawPath(path, stroke=0, fill=1)


def _runs(row: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Give the beginnings and ends of the runs of dark modules.

    >>> list(_runs([1, 1, 0, 1]))
    [(0, 2), (3, 4)]
    """
    edges = [k for k, (before, after) in enumerate(zip((0, *row), (*row, 0), strict=True)) if before != after]
    return zip(edges[::2], edges[1::2], strict=True)
