"""Part lists as tables: a row per class of parts, whatever the columns are called and whatever stands around them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from isomould.errors import Note
from isomould.intake.columns_found import Found, find_heading
from isomould.intake.number_style import NumberStyle, find_style, unit_row
from isomould.intake.numbers import Signs, to_angle, to_count, to_length
from isomould.intake.part_rows import refuse, show
from isomould.intake.rows_left_out import check_totals, sort_rows
from isomould.intake.table_rows import read_rows
from isomould.intake.table_words import Line, Reading, Words
from isomould.intake.units_said import with_units
from isomould.intake.vocabulary import all_meanings, means, says

_NAMES_REPEAT = 2
"""Rank from which marks are names that may be there twice: labels, numbers of positions, descriptions."""


_UNSURE_COUNT = 2
"""Rank from which a column may be something else than a number of pieces."""


@dataclass(frozen=True)
class Sheet:
    """A table: its rows, how its numbers are written, its headings, and what should be known."""

    file: str
    lines: tuple[Line, ...]
    style: NumberStyle
    headings: tuple[str, ...]
    notes: tuple[Note, ...]

    def number(self, line: Line, column: str) -> float:
        """Give a cell as a length, mm."""
        return to_length(line.cells[column], self.style.signs, self.style.units[column], f"{line.field}: {column}")

    def angle(self, line: Line, column: str) -> float:
        """Give a cell as an angle in degrees, 0 where it is blank or there is no such column."""
        return to_angle(line.cells.get(column) or "0", self.style.signs, f"{line.field}: {column}")

    def quantity(self, line: Line) -> int:
        """Give the pieces of a row."""
        return to_count(line.cells["quantity"], f"{line.field}: quantity", self.style.signs)

    def points(self, line: Line) -> list[list[float]]:
        """Give the corners of a row: pairs divided by semicolons, numbers by a comma or blanks."""
        place = f"{line.field}: points"
        return [self._pair(pair, place) for pair in line.cells["points"].strip().rstrip(";").split(";")]

    def _pair(self, text: str, place: str) -> list[float]:
        blank = len(text.split()) == 2
        numbers = text.split() if blank else text.split(",")
        if len(numbers) != 2:
            limit = "corners as x,y;x,y with decimal points, or as x y;x y"
            refuse(place, show(text), limit, "Write decimal points, or blanks between x and y.")
        signs, unit = self.style.signs if blank else Signs("."), self.style.units["points"]
        return [to_length(one.strip().rstrip(","), signs, unit, place) for one in numbers]


def read_sheet(path: Path, words: Words, asked: Reading | None = None) -> Sheet:
    """Read a table: delimited text in any usual encoding, a report in columns, or an Excel file.

    Parameters
    ----------
    path
        The file.
    words
        What its columns may be.
    asked
        What the user says of it.

    Raises
    ------
    Refused
        E-NEST-11, naming the file, the line and the column.
    OutputFault
        If the file cannot be read.
    """
    asked = asked or Reading()
    file = str(path)
    ways, notes = read_rows(path)
    found = find_heading(ways, words.known, asked.columns, file)
    units, rows = unit_row(found)
    kinds = sort_rows(found, rows, words.lengths, file)
    lines = [Line(_cells(found, cells), f"{file}: line {number}") for number, cells in kinds.parts]
    lines = with_units(lines, [name for name in words.lengths if _has_no_unit(found, name)])
    if not lines:
        refuse(file, "a heading without rows", "at least one part")
    style = find_style(found, lines, units, asked, file)
    kept, dropped = _wanted(lines, style.signs, file)
    named, names = _named(kept, found, file)
    if "quantity" not in asked.columns:
        _refuse_half_known(found, file)
    _refuse_second_sizes(found, file)
    counted, counts = _counted(named, found, file)
    totals = check_totals(found, kinds.totals, lines, style.signs, file)
    told = (*notes, *kinds.notes, *totals, *dropped, *names, *counts, *style.notes, *_unread(found, file))
    return Sheet(file, counted, style, tuple(h.text for h in found.headings if h.text), told)


def heading_names(path: Path, asked: Reading) -> set[str]:
    """Tell what the columns of a table are."""
    ways, _ = read_rows(path)
    return set(find_heading(ways, all_meanings(), asked.columns, str(path)).columns)


def _cells(found: Found, cells: Sequence[str]) -> dict[str, str]:
    return {meaning: cells[at] for meaning, at in found.columns.items()}


def _has_no_unit(found: Found, name: str) -> bool:
    return name in found.columns and found.headings[found.columns[name]].unit is None


# --- rows and marks


def _wanted(lines: Sequence[Line], signs: Signs, file: str) -> tuple[list[Line], tuple[Note, ...]]:
    """Leave out rows that are switched off or count nothing, and say so."""
    kept, off, none = list[Line](), list[Line](), list[Line]()
    for line in lines:
        if not _is_enabled(line):
            off.append(line)
        elif "quantity" in line.cells and to_count(line.cells["quantity"], f"{line.field}: quantity", signs) == 0:
            none.append(line)
        else:
            kept.append(line)
    notes = [
        Note("W-PART-ROWS", file, f"left out, {why}: {_listed(rows)}")
        for rows, why in ((off, "switched off"), (none, "quantity 0"))
        if rows
    ]
    if not kept:
        refuse(file, "every row is switched off or counts nothing", "at least one part")
    return kept, tuple(notes)


def _is_enabled(line: Line) -> bool:
    cell = line.cells.get("enabled", "yes")
    if not says(cell, "yes") and not says(cell, "no"):
        refuse(f"{line.field}: enabled", show(cell) if cell else "blank", "yes or no, true or false, 1 or 0")
    return says(cell, "yes")


def _listed(lines: Sequence[Line]) -> str:
    names = [f"{line.cells.get('id') or '?'} (line {line.field.rsplit(' ', 1)[1]})" for line in lines]
    return ", ".join(names[:6]) + (f" and {len(names) - 6} more" if len(names) > 6 else "")


def _named(lines: Sequence[Line], found: Found, file: str) -> tuple[list[Line], tuple[Note, ...]]:
    """Give every row a mark of its own: where there is none its number, and names that repeat a number behind them."""
    if found.ranks.get("id", _NAMES_REPEAT) < _NAMES_REPEAT:
        return list(lines), ()
    names = _own_names([line.cells.get("id", "") for line in lines])
    named = [Line({**line.cells, "id": name}, line.field) for line, name in zip(lines, names, strict=True)]
    changed = [new.cells["id"] for new, old in zip(named, lines, strict=True) if new.cells["id"] != old.cells.get("id")]
    if not changed:
        return named, ()
    why = "marks are missing or repeated" if "id" in found.columns else "there is no column of marks"
    sample = ", ".join(changed[:4]) + (" …" if len(changed) > 4 else "")
    return named, (Note("W-PART-MARKS", file, f"{why}; parts are called {sample}"),)


def _own_names(marks: Sequence[str]) -> list[str]:
    taken, names = set(filter(None, marks)), list[str]()
    for number, mark in enumerate(marks, start=1):
        name, again = mark or str(number), 2
        while name in names or (name != mark and name in taken):
            name, again = f"{mark or number} ({again})", again + 1
        names.append(name)
    return names


def _counted(lines: Sequence[Line], found: Found, file: str) -> tuple[tuple[Line, ...], tuple[Note, ...]]:
    """Count one piece a row where there is no column of quantities."""
    if "quantity" in found.columns:
        return tuple(lines), ()
    counted = tuple(Line({**line.cells, "quantity": "1"}, line.field) for line in lines)
    text = f"no column of quantities: one piece a row, {len(lines)} in all"
    return counted, (Note("W-PART-QUANTITY", file, text),)


def _refuse_half_known(found: Found, file: str) -> None:
    """Refuse to count one piece a row where a heading that is not known speaks of pieces."""
    if found.ranks.get("quantity", _UNSURE_COUNT) < _UNSURE_COUNT:
        return
    used = set(found.columns.values())
    for at, heading in enumerate(found.headings):
        words = [word for word in heading.name.split() if means(word).get("quantity") == 1]
        if at not in used and words:
            way_out = f"Say --column quantity={heading.text!r}, or take the column out: every row is one piece then."
            refuse(file, f"{heading.text!r}, which may count pieces", "a heading such as Quantity, Qty, Pcs", way_out)


def _refuse_second_sizes(found: Found, file: str) -> None:
    """Refuse a second length or width, as of parts that taper: a rectangle would be another part."""
    used = set(found.columns.values())
    for at, heading in enumerate(found.headings):
        word, _, number = heading.name.rpartition(" ")
        sizes = [name for name in ("length", "width", "height") if name in found.columns and name in means(word)]
        if at not in used and number.isdigit() and sizes:
            way_out = "Give the parts as a, b, h, ol and orr, as points or drawings; or take the column out."
            refuse(file, f"{heading.text!r} beside a {sizes[0]}", "one column for every size of a rectangle", way_out)


def _unread(found: Found, file: str) -> tuple[Note, ...]:
    """Name the columns that are not read; those of our own schedules are known to say more than a nest asks."""
    used = set(found.columns.values())
    unread = [heading.text for at, heading in enumerate(found.headings) if heading.text and at not in used]
    if not unread or Path(file).parent.name == "tables":
        return ()
    return (Note("W-PART-COLUMNS", file, f"not read: {', '.join(unread[:12])}"),)
