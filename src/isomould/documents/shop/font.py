"""Widths of texts: what lays them out without overlap.

Texts are written in Helvetica, or in Arial, whose characters are equally wide. Those with letters that Helvetica
lacks in PDF files are written whole in DejaVu Sans, which goes into the file.
"""

import functools
import unicodedata
from pathlib import Path
from typing import Literal

from isomould.documents.ascii import plain_letters
from isomould.errors import Refused

Face = Literal["standard", "embedded"]

FONT_FILE = Path(__file__).parent / "fonts" / "DejaVuSans.ttf"
"""The embedded font: Latin, Greek, Cyrillic, Armenian and Georgian letters."""
_WIDTHS_FILE, _UNIT = FONT_FILE.with_name("widths.txt"), 2048

_CODES = range(32, 256)
_CAPITALS: dict[Face, float] = {"standard": 718, "embedded": 729}
"""Heights of capitals in thousandths of the font's size."""
_DESCENDERS: dict[Face, float] = {"standard": 0.3, "embedded": 0.42}
"""Depths of what hangs below the baseline, in heights of capitals."""
_BOX = "□"
"""Stands for a character that no font has."""

_REGULAR = """
278 278 355 556 556 889 667 191 333 333 389 584 278 333 278 278 556 556 556 556 556 556 556 556 556 556 278 278 584
584 584 556 1015 667 667 722 722 667 611 778 722 278 500 667 556 833 722 778 667 778 722 667 611 722 667 944 667 667
611 278 278 278 469 556 333 556 556 500 556 556 278 556 556 222 222 500 222 833 556 556 556 556 333 500 278 556 500
722 500 500 500 334 260 334 584 0 556 0 222 556 333 1000 556 556 333 1000 667 333 1000 0 611 0 0 222 222 333 333 350
556 1000 333 1000 500 333 944 0 500 667 278 333 556 556 556 556 260 556 333 737 370 556 584 333 737 333 400 584 333
333 333 556 537 278 333 333 365 556 834 834 834 611 667 667 667 667 667 667 1000 722 667 667 667 667 278 278 278 278
722 722 778 778 778 778 778 584 778 722 722 722 722 667 667 611 556 556 556 556 556 556 889 500 556 556 556 556 278
278 278 278 556 556 556 556 556 556 556 584 611 556 556 556 556 500 556 500
"""
_BOLD = """
278 333 474 556 556 889 722 238 333 333 389 584 278 333 278 278 556 556 556 556 556 556 556 556 556 556 333 333 584
584 584 611 975 722 722 722 722 667 611 778 722 278 556 722 611 833 722 778 667 778 722 667 611 722 667 944 667 667
611 333 278 333 584 556 333 556 611 556 611 556 333 611 611 278 278 556 278 889 611 611 611 611 389 556 333 611 556
778 556 556 500 389 280 389 584 0 556 0 278 556 500 1000 556 556 333 1000 667 333 1000 0 611 0 0 278 278 500 500 350
556 1000 333 1000 556 333 944 0 500 667 278 333 556 556 556 556 280 556 333 737 370 556 584 333 737 333 400 584 333
333 333 611 556 278 333 333 365 556 834 834 834 611 722 722 722 722 722 722 1000 722 667 667 667 667 278 278 278 278
722 722 778 778 778 778 778 584 778 722 722 722 722 667 667 611 556 556 556 556 556 556 889 556 556 556 556 556 278
278 278 278 611 611 611 611 611 611 611 584 611 611 611 611 611 556 611 556
"""


def _table(widths: str) -> dict[str, int]:
    """Widths by character of Windows-1252, in thousandths of the font's size; 0 stands for no character."""
    pairs = zip(_CODES, map(int, widths.split()), strict=True)
    return {bytes([code]).decode("cp1252"): width for code, width in pairs if width}


_WIDTHS = {False: _table(_REGULAR), True: _table(_BOLD)}


@functools.cache
def _embedded() -> dict[str, float]:
    """Widths by character of the embedded font, in thousandths of its size: lines of a first code and widths."""
    lines = _WIDTHS_FILE.read_text(encoding="utf-8").splitlines()[1:]
    runs = ((int(first, 16), map(int, widths)) for first, *widths in map(str.split, lines))
    return {chr(code): width * 1000 / _UNIT for first, widths in runs for code, width in enumerate(widths, first)}


def face_of(text: str) -> Face:
    """Tell which font a text is written in."""
    return "standard" if _WIDTHS[False].keys() >= set(text) else "embedded"


def drawable(text: str) -> str:
    """Give text in the characters of the fonts: letters that they lack stand plain, other characters as boxes.

    >>> drawable("Łódź, Süd – Đakovo № 2"), drawable("Ǆ日本")
    ('Łódź, Süd – Đakovo № 2', 'Ǆ□□')
    """
    composed = unicodedata.normalize("NFC", text)
    if face_of(composed) == "standard":
        return composed
    known = _embedded()
    return "".join(letter if letter in known else _or_box(plain_letters(letter)) for letter in composed)


def _or_box(letters: str) -> str:
    known = _embedded()
    return "".join(letter if letter in known else _BOX for letter in letters)


@functools.cache
def text_width(text: str, height: float, *, bold: bool = False) -> float:
    """Give the width in mm of a line of text whose capitals are `height` mm high.

    Raises
    ------
    Refused
        If the font lacks a character.

    Examples
    --------
    >>> round(text_width("1234.567", 7.18), 2)
    41.7
    """
    face = face_of(text)
    widths = _WIDTHS[bold] if face == "standard" else _embedded()
    missing = sorted({character for character in text if character not in widths})
    if missing:
        raise Refused(
            "E-DRAW-FONT",
            "a text of the drawings",
            f"{text!r} with {' '.join(missing)}",
            "Latin, Greek, Cyrillic, Armenian and Georgian letters and usual signs, which the fonts of drawings have",
            "Write it in these, or leave the drawings out: deliver.drawings = false.",
        )
    return sum(map(widths.__getitem__, text)) / _CAPITALS[face] * height


def font_size(height: float, face: Face = "standard") -> float:
    """Give the size of the font whose capitals are `height` high, in the same unit."""
    return height * 1000 / _CAPITALS[face]


def depth_below(text: str, height: float) -> float:
    """Give how far a text reaches below its baseline, mm.

    >>> depth_below("MG-03", 2.5), depth_below("glass", 2.5)
    (0.0, 0.75)
    """
    face = face_of(text)
    hangs = face == "embedded" or set(text) & set("gjpqyQ,;()[]{}|@_çÇ§µþ")
    return _DESCENDERS[face] * height if hangs else 0.0
