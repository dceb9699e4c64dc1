"""Texts of a DXF file by its tags: group codes and values line by line, far quicker than whole documents."""

import re
from collections.abc import Iterator
from pathlib import Path

from isomould.verify.read.text import refusing
from isomould.verify.rules import Unreadable

_UNICODE = re.compile(r"\\U\+([0-9A-F]{4})")


@refusing
def read_dxf_texts(path: Path) -> tuple[str, ...]:
    """Give the content of every TEXT of the entities section, in the file's order."""
    lines = path.read_bytes().decode("utf-8").splitlines()
    if len(lines) % 2 or lines[-1].strip() != "EOF":
        message = "truncated: no EOF at the end"
        raise Unreadable(message)
    return tuple(_texts([int(code) for code in lines[::2]], lines[1::2]))


def _texts(codes: list[int], values: list[str]) -> Iterator[str]:
    """Walk over the tags: code 0 begins an entity, 1 is the content of a TEXT."""
    kind, inside = "", False
    for code, value in zip(codes, values, strict=True):
        if code == 2 and kind == "SECTION":
            inside = value == "ENTITIES"
        if code == 0:
            kind = value
        elif code == 1 and inside and kind == "TEXT":
            yield _plain(value)


def _plain(value: str) -> str:
    r"""Undo the codes of a content: characters by number, and the signs that otherwise begin codes.

    >>> _plain(r"\U+0141 %%%%%%d ^ J")
    'Ł %%d ^J'
    """
    text = _UNICODE.sub(lambda match: chr(int(match[1], 16)), value)
    return text.replace("%%%", "%").replace("^ ", "^")
