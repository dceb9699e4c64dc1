"""What stands around the rows of a table: titles before its heading, totals behind it, lines between."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from isomould.errors import Note
from isomould.intake.columns_found import Found
from isomould.intake.numbers import Signs, to_count
from isomould.intake.part_rows import refuse
from isomould.intake.table_rows import BLANKS, Row
from isomould.intake.table_words import Line
from isomould.intake.vocabulary import says

_RULE = re.compile(r"[-=_*+.\s]*")


@dataclass(frozen=True)
class SortedRows:
    """The rows of parts, with as many cells as the heading, and what was left out."""

    parts: tuple[Row, ...]
    totals: tuple[Row, ...]
    notes: tuple[Note, ...]


def sort_rows(found: Found, rows: Sequence[Row], lengths: Sequence[str], file: str) -> SortedRows:
    """Tell the rows of parts from titles, totals, repeated headings and ruled lines.

    A row whose first words are those of a total is one; a row of one text alone is a title. Whatever else is not a
    part is refused when its cells are read.

    Raises
    ------
    Refused
        E-NEST-11: a row with more cells than the heading.
    """
    parts, titles, totals = list[Row](), list[Row](), list[Row]()
    heading = [cell.text for cell in found.headings]
    for number, cells in rows:
        filled = [cell for cell in cells if cell]
        if all(_RULE.fullmatch(cell) for cell in filled) or cells == heading:
            continue
        if _is_total(filled[0], cells, [found.columns[name] for name in lengths if name in found.columns]):
            totals.append((number, cells))
        elif _is_title(filled, cells, found):
            titles.append((number, cells))
        else:
            parts.append((number, _padded(cells, found, f"{file}: line {number}")))
    ruled = [(number, cells) for number, cells in found.before if not all(_RULE.fullmatch(cell) for cell in cells)]
    notes = [
        *_told("before the heading", ruled, file),
        *_told("no parts", titles, file),
        *_told("totals", totals, file),
    ]
    return SortedRows(tuple(parts), tuple(totals), tuple(notes))


def _is_total(first: str, cells: Sequence[str], lengths: Sequence[int]) -> bool:
    """Tell a row of totals: by its whole first text, or by the first word of it where a length is missing."""
    missing = any(at >= len(cells) or not cells[at] for at in lengths)
    return says(first, "total") or (missing and says(re.split(r"[:\s]", first)[0], "total"))


def _is_title(filled: Sequence[str], cells: Sequence[str], found: Found) -> bool:
    """Tell a row of one text, where the table has columns enough for a part."""
    return len(filled) == 1 and len(found.columns) > 1 and not any(sign.isdigit() for sign in _sizes(cells, found))


def _sizes(cells: Sequence[str], found: Found) -> str:
    places = [at for meaning, at in found.columns.items() if meaning not in ("id", "material", "section")]
    return "".join(cells[at] for at in places if at < len(cells))


def _padded(cells: list[str], found: Found, field: str) -> list[str]:
    """Fill up a row whose last cells are blank; refuse one that has more than the heading."""
    count = len(found.headings)
    more = [cell for cell in cells[count:] if cell]
    if more or (found.separator == BLANKS and len(cells) < count):
        commas = " Decimal commas want semicolons between the cells." if found.separator == "," else ""
        refuse(field, f"{len(cells)} cells", f"{count}, as in the heading", f"Correct the line.{commas}")
    return [*cells[:count], *[""] * (count - len(cells))]


def _told(what: str, rows: Sequence[Row], file: str) -> tuple[Note, ...]:
    if not rows:
        return ()
    texts = [f"line {number} {' '.join(cell for cell in cells if cell)[:48]!r}" for number, cells in rows]
    more = f" and {len(texts) - 4} more" if len(texts) > 4 else ""
    return (Note("W-PART-ROWS", file, f"left out, {what}: {', '.join(texts[:4])}{more}"),)


def check_totals(
    found: Found, totals: Sequence[Row], lines: Sequence[Line], signs: Signs, file: str
) -> tuple[Note, ...]:
    """Compare the pieces of the only row of totals with those of the rows, and say where they differ."""
    at = found.columns.get("quantity")
    cells = [cells[at] for _, cells in totals if at is not None and at < len(cells) and cells[at]]
    if len(cells) != 1:
        return ()
    claimed = to_count(cells[0], f"{file}: the total", signs)
    counted = sum(to_count(line.cells["quantity"], f"{line.field}: quantity", signs) for line in lines)
    if claimed == counted:
        return ()
    return (Note("W-PART-TOTAL", file, f"the total says {claimed} pieces, the rows {counted}"),)
