"""Fonts of PDF files: standard ones, and one that is embedded where texts need it."""

import functools

from reportlab.pdfbase.pdfmetrics import registerFont
from reportlab.pdfbase.ttfonts import TTFont

from isomould.documents.shop.font import FONT_FILE, face_of, font_size

_EMBEDDED = "DejaVuSans"


def font_for(text: str, height: float, *, bold: bool = False) -> tuple[str, float]:
    """Give the font of a text and its size, in the unit of the height of its capitals."""
    face = face_of(text)
    if face == "standard":
        return "Helvetica-Bold" if bold else "Helvetica", font_size(height)
    _register()
    return _EMBEDDED, font_size(height, face)


@functools.cache
def _register() -> None:
    """Make the font known; a canvas takes from it the characters that are written."""
    registerFont(TTFont(_EMBEDDED, str(FONT_FILE)))
