"""The cells of a table, whatever file holds it: delimited text in any usual encoding, columns of a report, Excel."""

import codecs
import csv
import io
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from zipfile import BadZipFile

import openpyxl
from openpyxl.utils.exceptions import InvalidFileException

from isomould.errors import Note, OutputFault
from isomould.intake.part_rows import refuse

TEXTS = {".csv", ".txt", ".tsv", ".tab", ".prn", ".asc", ".xsr"}
BOOKS = {".xlsx", ".xlsm"}

BLANKS = "  "
"""Stands for the separator of reports with fixed columns: two blanks or more."""

_SEPARATORS = (";", "\t", ",", "|", BLANKS)
_NAMED = re.compile(r'\s*"?sep=(?P<sign>.)"?\s*', re.IGNORECASE)
_BOMS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
"""Those of 32 bits first: the mark of UTF-16 is the beginning of theirs."""

Row = tuple[int, list[str]]
"""Number of a line, and its cells."""


@dataclass(frozen=True)
class Rows:
    """One way to read a file: its rows that hold anything, what separates their cells, and the sheet of a workbook."""

    rows: list[Row]
    separator: str
    sheet: str = ""


def is_table(path: Path) -> bool:
    """Tell a table by the end of its name; everything else is JSON."""
    return path.suffix.lower() in TEXTS | BOOKS


def read_rows(path: Path) -> tuple[list[Rows], tuple[Note, ...]]:
    """Give every way to read a file as a table, the likeliest first, and what was assumed.

    Raises
    ------
    Refused
        E-NEST-11, naming file and line.
    OutputFault
        If the file cannot be read.
    """
    try:
        if path.suffix.lower() in BOOKS:
            return _read_book(path), ()
        data = path.read_bytes()
    except OSError as fault:
        message = f"E-NEST-10 {path}: {fault.strerror or fault}. Give a file that can be read."
        raise OutputFault(message) from fault
    text, notes = _decoded(data, str(path))
    return _read_text(text, str(path)), notes


# --- encodings


def _decoded(data: bytes, file: str) -> tuple[str, tuple[Note, ...]]:
    """Decode by the mark at the beginning, by zeros between Latin letters, as UTF-8, or else as a code page."""
    for mark, encoding in _BOMS:
        if data.startswith(mark):
            return _strict(data[len(mark) :], encoding, file), ()
    if b"\0" in data[:200]:
        return _strict(data, _wide(data), file), ()
    try:
        return data.decode("utf-8"), ()
    except UnicodeDecodeError:
        return _by_code_page(data, file)


def _strict(data: bytes, encoding: str, file: str) -> str:
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as fault:
        refuse(file, f"byte {fault.start} is not {encoding.upper()}", "a table in one encoding", "Save it as UTF-8.")


def _wide(data: bytes) -> str:
    """Tell the order of bytes of UTF-16 without a mark: the zeros of Latin letters come first or second."""
    return "utf-16-be" if data[:200:2].count(0) > data[1:200:2].count(0) else "utf-16-le"


_CODE_PAGES = {"cp1252": "Windows-1252", "cp850": "code page 850 (DOS)"}


def _by_code_page(data: bytes, file: str) -> tuple[str, tuple[Note, ...]]:
    """Take the code page that makes letters of the bytes between letters; of Windows where both do."""
    texts = {page: data.decode(page, errors="replace") for page in _CODE_PAGES}
    best = max(texts, key=lambda page: _letters(texts[page]))
    odd = next(k for k, byte in enumerate(data) if byte > 127)
    line = data[:odd].count(b"\n") + 1
    text = f"line {line} is not UTF-8; read as {_CODE_PAGES[best]}"
    return texts[best], (Note("W-PART-ENCODING", file, text),)


def _letters(text: str) -> int:
    """Count what looks right: letters of European words beyond ASCII, less what no list has."""
    odd = [letter for letter in text if not letter.isascii()]
    return sum(1 if letter in _EUROPEAN else -1 for letter in odd)


_EUROPEAN = frozenset("ÄÖÜäöüßÀÂÇÈÉÊËÎÏÔŒÙÛàâçèéêëîïôœùûÁÍÑÓÚáíñóúÌÒìò°²³×ØøÅåÆæ½¼¾®€–’")


# --- delimited text


def _read_text(text: str, file: str) -> list[Rows]:
    """Split a text at every usual separator, or at the one that it names in a first line `sep=;`."""
    text = text.rstrip("\x1a \r\n\t") + "\n"
    first, rest = text.split("\n", 1)
    named = _NAMED.fullmatch(first.rstrip("\r"))
    if named is not None:
        # The line stays as a blank one, so that numbers of lines are those of the file.
        text = "\n" + rest
    ways, faults = list[Rows](), list[csv.Error]()
    for separator in (named["sign"],) if named else _SEPARATORS:
        try:
            ways.append(Rows(_split(text, separator), separator))
        except csv.Error as fault:
            faults.append(fault)
    if not ways:
        refuse(file, str(faults[0]), "cells as CSV has them, quotes in pairs")
    return ways


def _split(text: str, separator: str) -> list[Row]:
    if separator == BLANKS:
        lines = enumerate(text.splitlines(), start=1)
        return [(number, re.split(r"\s{2,}|\t", line.strip())) for number, line in lines if line.strip()]
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    found = list[Row]()
    try:
        for row in reader:
            cells = [cell.strip() for cell in row]
            if any(cells):
                found.append((reader.line_num, cells))
    except csv.Error as fault:
        message = f"line {reader.line_num}: {fault}"
        raise csv.Error(message) from fault
    return found


# --- Excel


def _read_book(path: Path) -> list[Rows]:
    """Give the sheets of a workbook; numbers have decimal points, whatever the system's language."""
    try:
        book = openpyxl.load_workbook(path, read_only=True, data_only=True)
    except (BadZipFile, InvalidFileException, KeyError, ValueError) as fault:
        refuse(str(path), f"no workbook: {fault}", "an Excel file (.xlsx)", "Save it again as .xlsx or CSV.")
    try:
        sheets = [Rows(_cells(sheet.iter_rows(values_only=True)), ",", sheet.title) for sheet in book.worksheets]
    finally:
        book.close()
    ways = [way for way in sheets if way.rows]
    if not ways:
        refuse(str(path), "an empty workbook", "a sheet with a table")
    return ways


def _cells(rows: Iterable[Iterable[object]]) -> list[Row]:
    """Give the rows that hold anything."""
    numbered = enumerate(rows, start=1)
    texts = [(number, [_cell(value) for value in row]) for number, row in numbered]
    return [row for row in texts if any(row[1])]


def _cell(value: object) -> str:
    if value is None:
        return ""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return str(value).strip()
