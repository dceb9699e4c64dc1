"""Part lists as CSV: a row per class of parts, as trapezoid, as polygon, or drawn in a DXF file that it names."""

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from isomould.errors import Note
from isomould.intake.instance import read_text
from isomould.intake.numbers import decimal_sign, to_count, to_number
from isomould.intake.part_rows import TRAPEZOID, refuse, show
from isomould.units import MM_PER_UNIT, LengthUnit

_HEADER = re.compile(r"(?P<name>.*?)[ _]*(?:[(\[ _])(?P<unit>mm|cm|m|in|ft)[)\]]?")
_IDS = {"mark": "id", "part": "id", "qty": "quantity", "pieces": "quantity", "count": "quantity"}
_SEPARATORS = (";", "\t", ",")


@dataclass(frozen=True)
class Words:
    """What the columns of a table may be called: those that have to be there, numbers, other texts, other names."""

    required: tuple[str, ...]
    numbers: tuple[str, ...]
    texts: tuple[str, ...]
    others: Mapping[str, str]

    @property
    def known(self) -> set[str]:
        """All columns that mean something."""
        return {*self.required, *self.numbers, *self.texts}


PARTS = Words(
    ("id", "quantity"),
    TRAPEZOID,
    ("row", "points", "files"),
    {**_IDS, "height": "h", "outline": "points", "file": "files"},
)
MEMBERS = Words(
    ("section", "id", "quantity", "length"),
    ("length", "depth", "end_angle_start", "end_angle_end"),
    (),
    {
        **_IDS,
        "profile": "section",
        "cut_length": "length",
        **{
            f"end_angle_{end}_{unit}": f"end_angle_{end}"
            for end in ("start", "end")
            for unit in ("deg", "(deg)", "(°)")
        },
    },
)


@dataclass(frozen=True)
class Line:
    """A row of a CSV file: its cells by what they mean, and how messages call it."""

    cells: Mapping[str, str]
    field: str


@dataclass(frozen=True)
class Sheet:
    """A CSV file: rows, the mm that one unit of each column is, the decimal sign, and columns that are not read."""

    file: str
    lines: tuple[Line, ...]
    factors: Mapping[str, float]
    sign: str
    ignored: tuple[str, ...]

    @property
    def notes(self) -> tuple[Note, ...]:
        """Name the columns that are not read; those of our own schedules are known to say more than a nest asks."""
        if not self.ignored or Path(self.file).parent.name == "tables":
            return ()
        return (Note("W-PART-COLUMNS", self.file, f"not read: {', '.join(self.ignored[:12])}"),)

    def number(self, line: Line, column: str) -> float:
        """Give a cell as a length, mm."""
        return to_number(line.cells[column], self.sign, self.factors[column], f"{line.field}: {column}")

    def angle(self, line: Line, column: str) -> float:
        """Give a cell as an angle in degrees, 0 where it is blank or there is no such column."""
        return to_number(line.cells.get(column) or "0", self.sign, 1.0, f"{line.field}: {column}")

    def quantity(self, line: Line) -> int:
        """Give the pieces of a row."""
        return to_count(line.cells["quantity"], f"{line.field}: quantity")

    def points(self, line: Line) -> list[list[float]]:
        """Give the corners of a row: pairs divided by semicolons, numbers by a comma or blanks."""
        field = f"{line.field}: points"
        return [self._pair(pair, field) for pair in line.cells["points"].strip().rstrip(";").split(";")]

    def _pair(self, text: str, field: str) -> list[float]:
        numbers = text.split() if len(text.split()) == 2 else text.split(",")
        sign = self.sign if len(text.split()) == 2 else "."
        if len(numbers) != 2:
            limit = "corners as x,y;x,y with decimal points, or as x y;x y"
            refuse(field, show(text), limit, "Write decimal points, or blanks between x and y.")
        return [to_number(one.strip().rstrip(","), sign, self.factors["points"], field) for one in numbers]


def read_sheet(path: Path, units: LengthUnit | None, words: Words) -> Sheet:
    """Read a CSV file with a heading in its first line.

    Parameters
    ----------
    path
        In UTF-8, with or without a byte order mark; cells separated by commas, semicolons or tabs.
    units
        Of columns whose heading has none; mm by default.
    words
        What its columns may be.

    Raises
    ------
    Refused
        E-NEST-11, naming the file, the line and the column.
    """
    text, file = read_text(path, "a CSV file in UTF-8"), str(path)
    separator = _separator(text, file)
    rows = _rows(text, separator, file)
    heading = [_meaning(cell, words) for cell in rows[0][1]]
    names = [name for name, _ in heading]
    _refuse_headings(rows[0][1], names, words, file)
    lines = tuple(_line(row, names, f"{file}: line {number}", separator) for number, row in rows[1:])
    if not lines:
        refuse(file, "a heading without rows", "at least one part")
    factors = {name: MM_PER_UNIT[unit or units or "mm"] for name, unit in heading}
    numbers = [line.cells[name] for line in lines for name in words.numbers if name in line.cells]
    ignored = tuple(cell for cell, name in zip(rows[0][1], names, strict=True) if name not in words.known)
    return Sheet(file, lines, factors, decimal_sign([*numbers, *_blank_pairs(lines)], separator, file), ignored)


def heading_names(path: Path, words: Words) -> set[str]:
    """Tell what the columns of a CSV file are."""
    text, file = read_text(path, "a CSV file in UTF-8"), str(path)
    return {_meaning(cell, words)[0] for cell in _rows(text, _separator(text, file), file)[0][1]}


def _blank_pairs(lines: Sequence[Line]) -> list[str]:
    """Give the numbers of corners that are written with blanks between."""
    cells = [cell for line in lines for cell in line.cells.get("points", "").split(";")]
    return [number for cell in cells if len(cell.split()) == 2 and ", " not in cell for number in cell.split()]


def _separator(text: str, file: str) -> str:
    """Take the first of semicolon, tab and comma that the heading has; a heading of one column has none."""
    heading = text.split("\n", 1)[0]
    if not heading.strip('; \t\r,"'):
        refuse(file, "an empty first line", "a heading such as id,quantity,a,b,h,ol,orr")
    return next((sign for sign in _SEPARATORS if sign in heading), ",")


def _rows(text: str, separator: str, file: str) -> list[tuple[int, list[str]]]:
    """Give the rows that hold anything, with the numbers of their lines."""
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    try:
        return [(reader.line_num, [cell.strip() for cell in row]) for row in reader if any(map(str.strip, row))]
    except csv.Error as fault:
        refuse(f"{file}: line {reader.line_num}", str(fault), "cells as CSV has them, quotes in pairs")


def _meaning(cell: str, words: Words) -> tuple[str, LengthUnit | None]:
    """Tell what a heading means, and its unit if it has one.

    >>> _meaning("Height (mm)", PARTS), _meaning("a_cm", PARTS), _meaning("Mark", PARTS)
    (('h', 'mm'), ('a', 'cm'), ('id', None))
    """
    found = _HEADER.fullmatch(cell.strip().casefold())
    name = (found["name"] if found else cell.strip().casefold()).replace(" ", "_")
    unit: LengthUnit | None = found["unit"] if found else None  # pyright: ignore[reportAssignmentType]
    return words.others.get(name, name), unit


def _refuse_headings(cells: Sequence[str], names: Sequence[str], words: Words, file: str) -> None:
    for column in words.required:
        if column not in names:
            near = get_close_matches(column, [*names, *(n for n, other in words.others.items() if other == column)], 1)
            hint = f"Is it {near[0]!r}?" if near else "Add the column."
            refuse(f"{file}: line 1", f"no column {column!r} among {', '.join(cells)}", "a heading with it", hint)
    for name in names:
        if name in words.known and names.count(name) > 1:
            twice = ", ".join(cell for cell, other in zip(cells, names, strict=True) if other == name)
            refuse(f"{file}: line 1", f"{twice}: two columns for {name}", "one", "Rename one of them.")


def _line(row: Sequence[str], names: Sequence[str], field: str, separator: str) -> Line:
    if len(row) != len(names):
        commas = (
            " Decimal commas want semicolons between the cells." if separator == "," and len(row) > len(names) else ""
        )
        refuse(field, f"{len(row)} cells", f"{len(names)}, as in the heading", f"Correct the line.{commas}")
    return Line(dict(zip(names, row, strict=True)), field)
