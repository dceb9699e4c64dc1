"""PDF files as the texts on their pages: pypdf unpacks the file, the text operators are read here.

Only what drawings and labels need: literal strings of the standard fonts in WinAnsiEncoding (Windows-1252), and of
embedded fonts whose table `ToUnicode` says which character a byte is. What is shown at one place is one text.
"""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pypdf import PdfReader

from isomould.verify.read.text import refusing
from isomould.verify.rules import Unreadable

_TEXT = re.compile(rb"\(((?:[^()\\]|\\.)*)\)\s*Tj|/(\S+)\s+\S+\s+Tf|\b(Tm)\b", re.DOTALL)
"""A literal that is shown, the name of a font, or a new place."""
_PAIR = re.compile(rb"<([0-9A-Fa-f]+)>\s*<([0-9A-Fa-f]{4})>")
_ESCAPE = re.compile(rb"\\([0-7]{1,3}|.)", re.DOTALL)
Characters = dict[int, str]
"""Character by byte; empty for the standard fonts."""
_NAMED = {b"n": b"\n", b"r": b"\r", b"t": b"\t", b"b": b"\b", b"f": b"\f"}


@dataclass(frozen=True)
class Sheet:
    """A page: its bookmark, and every text shown on it."""

    name: str
    texts: tuple[str, ...]


@dataclass(frozen=True)
class Book:
    """A file of pages."""

    name: str
    sheets: tuple[Sheet, ...]


@refusing
def read_pdf(path: Path) -> Book:
    """Read the texts of all pages; a page without a bookmark, or several, makes the file unreadable."""
    reader = PdfReader(path, strict=True)
    names = _bookmarks(reader)
    pages = page_texts(reader)
    if sorted(names) != list(range(len(pages))):
        message = f"{len(pages)} pages with bookmarks on {len(names)}"
        raise Unreadable(message)
    return Book(path.stem, tuple(Sheet(names[k], texts) for k, texts in enumerate(pages)))


def page_texts(reader: PdfReader) -> list[tuple[str, ...]]:
    """Give the texts of every page, in the order of the file."""
    known = dict[Any, Characters]()
    return [_texts(_content(page), _fonts(page, known)) for page in reader.pages]


def _fonts(page: Any, known: dict[Any, Characters]) -> dict[str, Characters]:
    """Give the characters of the embedded fonts of a page by the fonts' names there."""
    found = dict[str, Characters]()
    for name, font in page["/Resources"].get("/Font", {}).items():
        key = (font.idnum if hasattr(font, "idnum") else id(font)), name
        if key not in known:
            table = font.get_object().get("/ToUnicode")
            known[key] = {} if table is None else _characters(table.get_object().get_data())
        found[name.removeprefix("/")] = known[key]
    return found


def _characters(table: bytes) -> Characters:
    """Read which character every byte is from the pairs of a table `ToUnicode`."""
    pairs = table[table.index(b"beginbfchar") :] if b"beginbfchar" in table else table
    return {int(code, 16): chr(int(character, 16)) for code, character in _PAIR.findall(pairs)}


def _texts(content: bytes, fonts: dict[str, Characters]) -> tuple[str, ...]:
    found, own, fresh = list[str](), Characters(), True
    for literal, font, place in _TEXT.findall(content):
        if font:
            own = fonts.get(font.decode("latin-1"), {})
        elif place:
            fresh = True
        else:
            text = _decoded(literal, own)
            found, fresh = ([*found, text] if fresh else [*found[:-1], found[-1] + text]), False
    return tuple(found)


def _bookmarks(reader: PdfReader) -> dict[int, str]:
    found = {reader.get_destination_page_number(entry): str(entry.title) for entry in _flat(reader.outline)}
    return {page: title for page, title in found.items() if page is not None}


def _flat(outline: Any) -> list[Any]:
    if any(isinstance(entry, list) for entry in outline):
        message = "nested bookmarks"
        raise Unreadable(message)
    return list(outline)


def _content(page: Any) -> bytes:
    content = page.get_contents()
    return b"" if content is None else bytes(content.get_data())


def _decoded(literal: bytes, characters: Characters | None = None) -> str:
    r"""Undo the escapes of a literal string.

    >>> _decoded(rb"\330 90 \(m\262\)")
    'Ø 90 (m²)'
    """
    codes = _ESCAPE.sub(_unescaped, literal)
    return "".join(characters[code] for code in codes) if characters else codes.decode("cp1252")


def _unescaped(match: re.Match[bytes]) -> bytes:
    code = match[1]
    return bytes([int(code, 8)]) if code.isdigit() else _NAMED.get(code, code)
