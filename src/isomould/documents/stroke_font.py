"""A single-stroke font for engraved marks: A–Z, 0–9, - . / and an arrow on a grid of 4 by 6.

Every glyph is a list of strokes; a stroke is a chain of grid points, written as two digits x y. No
stroke runs over another, so that a machine engraves every line once.
"""

import numpy as np

from isomould.arrays import Floats
from isomould.documents.ascii import plain_text
from isomould.errors import Refused

_CAP = 6
_ADVANCE = 6
_WIDTH = 4

ARROW = ">"
"""Drawn as an arrow to the right."""

_GLYPHS = {
    "A": "00 26 40, 12 32",
    "B": "00 06 36 45 44 33 42 41 30 00, 03 33",
    "C": "45 36 16 05 01 10 30 41",
    "D": "00 06 26 44 42 20 00",
    "E": "46 06 00 40, 03 33",
    "F": "46 06 00, 03 33",
    "G": "45 36 16 05 01 10 30 41 43 23",
    "H": "00 06, 40 46, 03 43",
    "I": "10 30, 16 36, 20 26",
    "J": "01 10 30 41 46",
    "K": "00 06, 46 03 40",
    "L": "06 00 40",
    "M": "00 06 23 46 40",
    "N": "00 06 40 46",
    "O": "10 01 05 16 36 45 41 30 10",
    "P": "00 06 36 45 44 33 03",
    "Q": "10 01 05 16 36 45 41 30 10, 22 40",
    "R": "00 06 36 45 44 33 03, 23 40",
    "S": "01 10 30 41 42 33 13 04 05 16 36 45",
    "T": "06 46, 26 20",
    "U": "06 01 10 30 41 46",
    "V": "06 20 46",
    "W": "06 10 23 30 46",
    "X": "00 46, 06 40",
    "Y": "06 23 46, 23 20",
    "Z": "06 46 00 40",
    "0": "10 01 05 16 36 45 41 30 10, 12 34",
    "1": "05 26 20, 10 30",
    "2": "05 16 36 45 44 00 40",
    "3": "05 16 36 45 44 33 42 41 30 10 01, 23 33",
    "4": "30 36 02 42",
    "5": "46 06 03 33 42 41 30 10 01",
    "6": "45 36 16 05 01 10 30 41 42 33 13 02",
    "7": "06 46 10",
    "8": "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33",
    "9": "01 10 30 41 45 36 16 05 04 13 33 44",
    "-": "13 33",
    ".": "10 11",
    "/": "00 46",
    ARROW: "03 43, 25 43 21",
    " ": "",
}
_STROKES = {
    character: tuple(
        np.array([[int(x), int(y)] for x, y in chain.split()], float) for chain in text.split(",") if chain
    )
    for character, text in _GLYPHS.items()
}


def engravable(text: str) -> str:
    """Give a text in the letters that can be engraved: capitals without accents, a hyphen for what has no letter.

    >>> engravable("Süd_12 a")
    'SUD-12 A'
    """
    return "".join(character if character in _STROKES else "-" for character in plain_text(text).upper())


def text_width(text: str, height: float) -> float:
    """Give the width of a line of text of a cap height, mm."""
    return (_ADVANCE * len(text) - (_ADVANCE - _WIDTH)) * height / _CAP


def text_strokes(text: str, height: float) -> list[Floats]:
    """Draw a line of text as open polylines (k, 2), lower left corner at the origin, mm.

    Raises
    ------
    Refused
        If a character is not in the font.

    Examples
    --------
    >>> [stroke.tolist() for stroke in text_strokes("L-", 6.0)]
    [[[0.0, 6.0], [0.0, 0.0], [4.0, 0.0]], [[7.0, 3.0], [9.0, 3.0]]]
    """
    scale = height / _CAP
    return [
        (stroke + np.array([position * _ADVANCE, 0])) * scale
        for position, character in enumerate(text)
        for stroke in _glyph(character)
    ]


def _glyph(character: str) -> tuple[Floats, ...]:
    if character not in _STROKES:
        raise Refused("E-OUT-03", "engraved mark", repr(character), "A-Z 0-9 - . / >", "Choose another mark.")
    return _STROKES[character]
