"""The picture of an office on the cover of its workbook (`[project] logo`)."""

import struct
from pathlib import Path

from isomould.documents.info import Logo
from isomould.errors import Refused

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_LARGEST_FILE = 2_000_000
_LIMIT = f"a PNG picture of at most {_LARGEST_FILE} bytes"
_WAY_OUT = "Save the logo as PNG beside the project file, or leave project.logo out."


def read_logo(folder: Path, name: str) -> Logo | None:
    """Read a logo; None if the project names none.

    Raises
    ------
    Refused
        If there is no such file, or if it is no PNG or too large.
    """
    if not name:
        return None
    try:
        content = (folder / name).read_bytes()
    except OSError as error:
        raise Refused("E-LOGO", "project.logo", f"{name}: {error.strerror}", _LIMIT, _WAY_OUT) from None
    if len(content) > _LARGEST_FILE or not _is_png(content):
        raise Refused("E-LOGO", "project.logo", f"{name}: {len(content)} bytes, or no PNG", _LIMIT, _WAY_OUT)
    return Logo(content, *_size(content))


def _is_png(content: bytes) -> bool:
    """Tell by signature and header: a picture of some width and height."""
    header = content[:24]
    return len(header) == 24 and header.startswith(_SIGNATURE) and header[12:16] == b"IHDR" and min(_size(header)) > 0


def _size(content: bytes) -> tuple[int, int]:
    return struct.unpack(">II", content[16:24])
