"""Plain text: Latin letters without accents and strokes, for machines and for fonts that know no others."""

import re
import unicodedata

_NAME = re.compile(
    r"LATIN (CAPITAL|SMALL) (?:LETTER|LIGATURE) (?:DOTLESS |OPEN )?"
    r"(SHARP S|ENG|EZH|ESH|SCHWA|THORN|ETH|[A-Z]{1,2})(?: WITH .*)?"
)
_WORDS = {"SHARP S": "SS", "ENG": "N", "EZH": "Z", "ESH": "S", "SCHWA": "E", "THORN": "TH", "ETH": "D"}


def plain_text(text: str) -> str:
    """Give text in printable ASCII; whatever has no plain form becomes a question mark.

    >>> plain_text("Südkuppel № 2, Łódź, Straße – Μονή")
    'Sudkuppel No 2, Lodz, Strasse - ????'
    """
    return plain_letters(text).encode("ascii", "replace").decode()


def plain_letters(text: str) -> str:
    """Give text with plain Latin letters and hyphens for dashes; what has no plain form stays.

    >>> plain_letters("Ærø, Đakovo, 日本")
    'AEro, Dakovo, 日本'
    """
    parts = unicodedata.normalize("NFKD", unicodedata.normalize("NFC", text))
    return "".join(_plain(character) for character in parts if not unicodedata.combining(character))


def _plain(character: str) -> str:
    """Give the letters that a Latin one with a stroke or hook is named after."""
    found = None if character.isascii() else _NAME.fullmatch(unicodedata.name(character, ""))
    if not found:
        return "-" if unicodedata.category(character) == "Pd" else character
    letters = _WORDS.get(found[2], found[2])
    return letters if found[1] == "CAPITAL" else letters.lower()
