"""A text DXF file as records: an entity, a table's entry or a section's mark, each with its tags.

Structure is read here, from the bytes, so that a file needs to be sound only where its curve stands, and nothing that
a library would supply (units, a version) can be taken for what the file says. Entities are interpreted by ezdxf.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from ezdxf.lldxf.encoding import (
    decode_dxf_unicode,
    decode_mif_to_unicode,
    has_dxf_unicode,
    has_mif_encoding,
)
from ezdxf.tools.codepage import toencoding

_UTF8_SINCE = "AC1021"
"""Version from which on every DXF file is UTF-8; older ones name their code page."""

_CTRL_Z = b"\x1a"


class DamagedFile(Exception):
    """A file whose structure cannot be read; the text says where."""


class Tag(NamedTuple):
    """A group code and its value, as text without blanks around it."""

    code: int
    value: str


@dataclass(frozen=True)
class Record:
    """What begins with group code 0: its type, its tags and the line of the file where it begins."""

    kind: str
    tags: tuple[Tag, ...]
    line: int

    def first(self, code: int, default: str = "") -> str:
        """Give the value of the first tag with a group code."""
        return next((tag.value for tag in self.tags if tag.code == code), default)


@dataclass(frozen=True)
class Records:
    """The records of a file up to its end, and what had to be cleaned to read them."""

    text: "TagLines"
    cleaned: tuple[str, ...] = field(default=())

    def __iter__(self) -> Iterator[Record]:
        """Give the records in the file's order."""
        return iter(self.text)


class TagLines:
    """Group codes and values of a file, decoded record by record when they are asked for."""

    def __init__(self, codes: list[int], values: list[bytes], encoding: str, first_line: int) -> None:
        self.codes, self.values, self.encoding, self._first_line = codes, values, encoding, first_line
        self.starts = [k for k, code in enumerate(codes) if code == 0]

    def __len__(self) -> int:
        """Give the number of records."""
        return len(self.starts)

    def __iter__(self) -> Iterator[Record]:
        """Give the records in the file's order."""
        return map(self.record, range(len(self)))

    def kind(self, number: int) -> str:
        """Give the type of a record."""
        return self._text(self.values[self.starts[number]])

    def record(self, number: int) -> Record:
        """Give a record with its tags."""
        start, stop = self._span(number)
        tags = tuple(
            Tag(self.codes[k], self._text(self.values[k])) for k in range(start + 1, stop) if self.codes[k] != _COMMENT
        )
        return Record(self.kind(number), tags, self._first_line + 2 * start)

    def value(self, number: int, wanted: int) -> str | None:
        """Give the value of a record's first tag with a group code, without decoding the others."""
        start, stop = self._span(number)
        for k in range(start + 1, stop):
            if self.codes[k] == wanted:
                return self._text(self.values[k])
        return None

    def _span(self, number: int) -> tuple[int, int]:
        after = number + 1
        return self.starts[number], self.starts[after] if after < len(self.starts) else len(self.codes)

    def _text(self, value: bytes) -> str:
        text = value.decode(self.encoding, "surrogateescape").strip()
        return decoded(text) if "\\" in text else text


_COMMENT = 999
_PLAIN_CODE = re.compile(rb"\s*-?\d+\s*")


def decoded(text: str) -> str:
    r"""Give a text with its `\U+xxxx` and `\M+nxxxx` letters as letters.

    >>> decoded(r"TR\U+00C4GER")
    'TRÄGER'
    """
    if has_dxf_unicode(text):
        text = decode_dxf_unicode(text)
    return decode_mif_to_unicode(text) if has_mif_encoding(text) else text


def records_of(content: bytes) -> Records:
    """Read the records of a file's bytes; what stands after the end of the drawing is left out.

    Raises
    ------
    DamagedFile
        For an odd number of lines, a group code that is no number, or a file without an end.
    """
    lines, cleaned, blank = _cleaned_lines(content)
    codes, values, trailing = _tags(lines, blank)
    encoding = _encoding(codes, values, content)
    if trailing:
        cleaned = (*cleaned, f"{trailing} line(s) after the end of the drawing")
    return Records(TagLines(codes, values, encoding, blank + 1), cleaned)


def _cleaned_lines(content: bytes) -> tuple[list[bytes], tuple[str, ...], int]:
    """Give the lines, what was taken out of the bytes, and how many blank lines began the file."""
    cleaned = list[str]()
    if content.startswith(b"\xef\xbb\xbf"):
        content, _ = content[3:], cleaned.append("a byte order mark")
    if b"\x00" in content:
        cleaned.append(f"{content.count(0)} NUL byte(s)")
        content = content.replace(b"\x00", b"")
    lines = content.replace(b"\r\n", b"\n").replace(b"\r", b"\n").split(b"\n")
    blank = next((k for k, line in enumerate(lines) if line.strip()), len(lines))
    if blank:
        cleaned.append(f"{blank} blank line(s) at the beginning")
    return lines[blank:], tuple(cleaned), blank


def _tags(lines: list[bytes], blank: int) -> tuple[list[int], list[bytes], int]:
    """Pair the lines up to the end mark; say how many lines that hold anything stand after it."""
    end = _end_of_drawing(lines)
    codes = lines[0 : len(lines) if end is None else end : 2]
    for code in set(codes):
        if not _PLAIN_CODE.fullmatch(code) and (end is not None or _ends_well(lines)):
            line = blank + 2 * codes.index(code) + 1
            shown = code.decode("ascii", "backslashreplace").strip()[:20]
            message = f"line {line} should be a group code, but is {shown!r}"
            raise DamagedFile(message)
    if end is None:
        message = "it does not end like a DXF file (cut off, or another format)"
        raise DamagedFile(message)
    trailing = sum(1 for line in lines[end + 2 :] if line.strip(b" \t\x1a"))
    return [int(code) for code in codes], lines[1:end:2], trailing


def _end_of_drawing(lines: list[bytes]) -> int | None:
    """Give the index of the group code before EOF."""
    for k in range(0, len(lines) - 1, 2):
        if lines[k + 1].rstrip(_CTRL_Z + b" \t").lstrip() == b"EOF" and lines[k].strip() == b"0":
            return k
    return None


def _ends_well(lines: list[bytes]) -> bool:
    """Tell whether the last lines are the end mark: then lines were lost or added before it."""
    last = [line.strip(b" \t\x1a") for line in lines if line.strip(b" \t\x1a")][-2:]
    return last == [b"0", b"EOF"]


def _encoding(codes: list[int], values: list[bytes], content: bytes) -> str:
    """Give the encoding that a file's version or code page stands for; else UTF-8 where its bytes are that."""
    variables = header_of(codes, values)
    if variables.get("$ACADVER", "").upper() >= _UTF8_SINCE:
        return "utf-8"
    if "$DWGCODEPAGE" in variables:
        return toencoding(variables["$DWGCODEPAGE"])
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8"


def header_of(codes: list[int], values: list[bytes]) -> dict[str, str]:
    """Give the variables that the file's own HEADER holds, with the first value of each."""
    found = dict[str, str]()
    name, inside = "", False
    for code, value in zip(codes, values, strict=True):
        text = value.strip().decode("latin-1")
        if code == 0 and inside:
            break
        if code == 2 and text == "HEADER":
            inside = True
        elif inside and code == 9:
            name = text
        elif inside and name and name not in found:
            found[name] = text
    return found
