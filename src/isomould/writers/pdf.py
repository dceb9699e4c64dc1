"""Pages as PDF: vector lines, searchable text, a bookmark per page, the same bytes every time.

Text stands in a standard font, which is not in the file, or in the embedded one, of which its characters are.
"""

import io
import math
from functools import singledispatch
from pathlib import Path

from reportlab import rl_config
from reportlab.pdfgen.canvas import Canvas

from isomould.documents.shop.font import text_width
from isomould.documents.shop.page import Arc, Book, Code, Item, Line, Page, Pen, Text
from isomould.writers.codes import draw_code
from isomould.writers.disk import write_bytes
from isomould.writers.pdf_fonts import font_for

_POINT = 72 / 25.4
"""Points per mm."""

_WIDTHS: dict[Pen, float] = {"frame": 0.7, "outline": 0.5, "hidden": 0.25, "centre": 0.18, "thin": 0.18}
_DASHES: dict[Pen, tuple[float, ...]] = {"hidden": (2.5, 1.0), "centre": (7.0, 1.2, 0.5, 1.2)}
_SHARE = {"start": 0.0, "middle": 0.5, "end": 1.0}


def write_pdf(path: Path, book: Book, subject: str) -> None:
    """Write a book of pages; `subject` says in the file's properties what project it is for.

    Raises
    ------
    OutputFault
        If the file cannot be written.
    """
    write_bytes(path, pdf_bytes(book, subject))


def pdf_bytes(book: Book, subject: str) -> bytes:
    """Give the bytes of a book of pages."""
    rl_config.useA85 = 0  # the streams need not be text
    stream = io.BytesIO()
    canvas = Canvas(stream, invariant=1, pageCompression=1)
    canvas.setTitle(book.title)
    canvas.setSubject(subject)
    canvas.setCreator("isomould")
    for page in book.pages:
        _add_page(canvas, page)
    canvas.save()
    return stream.getvalue()


def _add_page(canvas: Canvas, page: Page) -> None:
    canvas.setPageSize((page.size[0] * _POINT, page.size[1] * _POINT))
    canvas.bookmarkPage(page.name)
    canvas.addOutlineEntry(page.name, page.name)
    canvas.scale(_POINT, _POINT)
    canvas.setLineCap(1)
    canvas.setLineJoin(1)
    for pen in _WIDTHS:
        _use(canvas, pen)
        for item in page.items:
            if isinstance(item, Line | Arc) and item.pen == pen:
                _draw(item, canvas)
    for code in page.items:
        if isinstance(code, Code):
            draw_code(canvas, code.text, code.at, code.side)
    _write_texts(canvas, [item for item in page.items if isinstance(item, Text)])
    canvas.showPage()


def _use(canvas: Canvas, pen: Pen) -> None:
    canvas.setLineWidth(_WIDTHS[pen])
    canvas.setDash(list(_DASHES.get(pen, ())))


@singledispatch
def _draw(item: Item, canvas: Canvas) -> None:
    raise NotImplementedError(type(item).__name__)


@_draw.register
def _(item: Line, canvas: Canvas) -> None:
    (x, y), *others = item.points.tolist()
    path = canvas.beginPath()
    path.moveTo(x, y)
    for other in others:
        path.lineTo(*other)
    if item.closed:
        path.close()
    canvas.drawPath(path, stroke=int(not item.filled), fill=int(item.filled))


@_draw.register
def _(item: Arc, canvas: Canvas) -> None:
    (x, y), r = item.centre, item.radius
    angles = math.degrees(item.start), math.degrees(item.end - item.start)
    path = canvas.beginPath()
    path.arc(x - r, y - r, x + r, y + r, *angles)  # pyright: ignore[reportArgumentType] - floats are drawn
    canvas.drawPath(path)


def _write_texts(canvas: Canvas, texts: list[Text]) -> None:
    """Write all texts of a page in one text object, those of one font after each other."""
    block, font = canvas.beginText(), ("", 0.0)
    for text in sorted(texts, key=lambda text: (text.bold, text.height)):
        own = font_for(text.text, text.height, bold=text.bold)
        if own != font:
            block.setFont(*own)
            font = own
        block.setTextTransform(*_placed(text))
        block.textOut(text.text)
    canvas.drawText(block)


def _placed(text: Text) -> tuple[float, float, float, float, float, float]:
    """Give the matrix of a text: its direction and the start of its baseline."""
    back = _SHARE[text.anchor] * text_width(text.text, text.height, bold=text.bold)
    cosine, sine = math.cos(text.turn), math.sin(text.turn)
    return cosine, sine, -sine, cosine, text.at[0] - back * cosine, text.at[1] - back * sine
