"""Label sheets: the texts that are shown on their pages, in the order of the file."""

import re
from pathlib import Path

from pypdf import PdfReader

from isomould.verify.read.text import refusing

_SHOWN = re.compile(rb"\(((?:[^()\\]|\\.)*)\)\s*Tj", re.DOTALL)


@refusing
def read_label_texts(path: Path) -> tuple[tuple[str, ...], ...]:
    """Give the texts of every page."""
    pages = (page.get_contents() for page in PdfReader(path, strict=True).pages)
    return tuple(_texts(b"" if page is None else page.get_data()) for page in pages)


def _texts(content: bytes) -> tuple[str, ...]:
    return tuple(re.sub(r"\\(.)", r"\1", found.decode("ascii")) for found in _SHOWN.findall(content))
