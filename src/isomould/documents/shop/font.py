"""Widths of texts in Helvetica and Arial, whose characters are equally wide: what lays texts out without overlap."""

import functools
import re
import unicodedata
from itertools import filterfalse

from isomould.errors import Refused

_CODES = range(32, 256)
_CAPITAL = 718
"""Height of capitals in thousandths of the font's size."""
_DESCENDER = 0.3
"""Depth of what hangs below the baseline, in heights of capitals."""

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
_NAME = re.compile(r"LATIN (CAPITAL|SMALL) LETTER (?:DOTLESS |OPEN )?(SHARP S|ENG|EZH|ESH|SCHWA|[A-Z])(?: WITH .*)?")
_WORDS = {"SHARP S": "SS", "ENG": "N", "EZH": "Z", "ESH": "S", "SCHWA": "E"}


def drawable(text: str) -> str:
    """Give text in the characters of the font: Latin letters that it lacks lose their accents and strokes.

    Dashes become hyphens. What has no plain Latin form stays, and is refused where it is drawn.

    >>> drawable("Łódź, Süd – Đakovo № 2"), drawable("日本")
    ('Lódz, Süd – Dakovo No 2', '日本')
    """
    return "".join(_plain(character) for character in unicodedata.normalize("NFC", text))


def _plain(character: str) -> str:
    """Keep a character that the font has, else take its compatible parts without their marks."""
    if character in _WIDTHS[False]:
        return character
    return "".join(map(_letter, filterfalse(unicodedata.combining, unicodedata.normalize("NFKD", character))))


def _letter(character: str) -> str:
    """Give the letter that a Latin one with a stroke or hook is named after."""
    found = _NAME.fullmatch(unicodedata.name(character, ""))
    if character in _WIDTHS[False]:
        return character
    if not found:
        return "-" if unicodedata.category(character) == "Pd" else character
    letter = _WORDS.get(found[2], found[2])
    return letter if found[1] == "CAPITAL" else letter.lower()


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
    widths = _WIDTHS[bold]
    missing = sorted({character for character in text if character not in widths})
    if missing:
        raise Refused(
            "E-DRAW-FONT",
            "a text of the drawings",
            f"{text!r} with {' '.join(missing)}",
            "Latin letters and what else Windows-1252 has, as do the fonts of all PDF readers",
            "Write it in these, or leave the drawings out: deliver.drawings = false.",
        )
    return sum(map(widths.__getitem__, text)) / _CAPITAL * height


def font_size(height: float) -> float:
    """Give the size of the font whose capitals are `height` high, in the same unit."""
    return height * 1000 / _CAPITAL


def depth_below(text: str, height: float) -> float:
    """Give how far a text reaches below its baseline, mm.

    >>> depth_below("MG-03", 2.5), depth_below("glass", 2.5)
    (0.0, 0.75)
    """
    return _DESCENDER * height if set(text) & set("gjpqyQ,;()[]{}|@_çÇ§µþ") else 0.0
