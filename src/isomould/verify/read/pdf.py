"""PDF files as the texts on their pages: pypdf unpacks the file, the text operators are read here.

Only what drawings need: literal strings of the standard fonts in WinAnsiEncoding (Windows-1252).
"""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pypdf import PdfReader

from isomould.verify.read.text import refusing
from isomould.verify.rules import Unreadable

_SHOWN = re.compile(rb"\(((?:[^()\\]|\\.)*)\)\s*Tj", re.DOTALL)
_ESCAPE = re.compile(rb"\\([0-7]{1,3}|.)", re.DOTALL)
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
    pages = [tuple(map(_decoded, _SHOWN.findall(_content(page)))) for page in reader.pages]
    if sorted(names) != list(range(len(pages))):
        message = f"{len(pages)} pages with bookmarks on {len(names)}"
        raise Unreadable(message)
    return Book(path.stem, tuple(Sheet(names[k], texts) for k, texts in enumerate(pages)))


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


def _decoded(literal: bytes) -> str:
    r"""Undo the escapes of a literal string.

    >>> _decoded(rb"\330 90 \(m\262\)")
    'Ø 90 (m²)'
    """
    return _ESCAPE.sub(_unescaped, literal).decode("cp1252")


def _unescaped(match: re.Match[bytes]) -> bytes:
    code = match[1]
    return bytes([int(code, 8)]) if code.isdigit() else _NAMED.get(code, code)
