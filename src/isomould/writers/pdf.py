"""Pages as PDF: vector lines, searchable text in a standard font, a bookmark per page, the same bytes every time."""

import io
import math
from functools import singledispatch
from pathlib import Path

from reportlab.pdfgen.canvas import Canvas

from isomould.documents.shop.font import font_size, text_width
from isomould.documents.shop.page import Arc, Book, Item, Line, Page, Pen, Text
from isomould.writers.disk import write_bytes

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
    stream = io.BytesIO()
    canvas = Canvas(stream, invariant=1, pageCompression=1, initialFontName="Helvetica")
    canvas.setTitle(book.title)
    canvas.setSubject(subject)
    canvas.setCreator("isomould")
    for page in book.pages:
        _add_page(canvas, page)
    canvas.save()
    write_bytes(path, stream.getvalue())


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
            if not isinstance(item, Text) and item.pen == pen:
                _draw(item, canvas)
    for item in page.items:
        if isinstance(item, Text):
            _draw(item, canvas)
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
    path = canvas.beginPath()
    path.arc(x - r, y - r, x + r, y + r, math.degrees(item.start), math.degrees(item.end - item.start))
    canvas.drawPath(path)


@_draw.register
def _(item: Text, canvas: Canvas) -> None:
    canvas.setFont("Helvetica-Bold" if item.bold else "Helvetica", font_size(item.height))
    back = _SHARE[item.anchor] * text_width(item.text, item.height, bold=item.bold)
    cosine, sine = math.cos(item.turn), math.sin(item.turn)
    text = canvas.beginText()
    text.setTextTransform(cosine, sine, -sine, cosine, item.at[0] - back * cosine, item.at[1] - back * sine)
    text.textOut(item.text)
    canvas.drawText(text)
