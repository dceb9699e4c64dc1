"""Label sheets: the texts that are shown on their pages, in the order of the file."""

from pathlib import Path

from pypdf import PdfReader

from isomould.verify.read.pdf import page_texts
from isomould.verify.read.text import refusing


@refusing
def read_label_texts(path: Path) -> tuple[tuple[str, ...], ...]:
    """Give the texts of every page."""
    return tuple(page_texts(PdfReader(path, strict=True)))
