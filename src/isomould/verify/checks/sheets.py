"""V43, V45: shop drawings print what the schedules print, digit by digit, in PDF and in DXF alike."""

import re
from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

from isomould.verify.delivery import Delivery
from isomould.verify.read.pdf import Book, Sheet
from isomould.verify.read.tables import Table, number, texts
from isomould.verify.rules import Measured, NotApplicable, Rule, Unreadable, faults
from isomould.verify.shown_digits import shows

KINDS = ("nodes", "members", "panels")
ARRANGEMENT = "general-arrangement"
_ELSEWHERE = re.compile(r"outline|files?|\w+_file|max_deviation_\w+")
"""Columns that sheets do not print, or not as one text."""
_DIMENSIONS = re.compile(
    r"drum_(diameter|height)_mm|(system|top|bottom|cut)_length_mm|set_back_(start|end)_mm|end_angle_(start|end)_deg"
    r"|side_[a-d]_mm|height_mm|diagonal_[12]_mm|angle_[1-4]_deg"
)
"""Columns that sheets print twice: listed, and as a dimension in a view."""
_UNLABELLED = re.compile(r"mark|(azimuth|elevation)_\d+_deg|(family|section)_\d+")
"""Columns that head the list, or stand in a table of their own."""
_UNITS = {"mm": "mm", "deg": "°", "kg": "kg", "m2": "m²", "cm3": "cm³"}
_AMOUNTS = frozenset(("kg", "m²", "cm³"))
"""Units that sheets show to the digits of their use; lengths and angles stand as scheduled."""
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def sheets_of_marks(delivery: Delivery) -> Measured:
    """Every class has the sheet that the schedule names, with its mark in the bookmark and on the page."""
    books, problems = books_of(delivery), list[str]()
    for kind in KINDS:
        table = delivery.table(kind)
        for place, (mark, named) in enumerate(zip(texts(table, "mark"), _named(table), strict=True)):
            problems += _sheet_faults(books[kind], place, mark, named)
        problems += [f"drawings/{kind}.pdf has {len(books[kind].sheets)} pages"] * (
            len(books[kind].sheets) != table.rows
        )
    return faults(sum(delivery.table(kind).rows for kind in KINDS), problems)


def _named(table: Table) -> tuple[str, ...]:
    column = "drawing_file" if "drawing_file" in table.columns else "files"
    return tuple(cell.split(";")[-1] for cell in texts(table, column))


def _sheet_faults(book: Book, place: int, mark: str, named: str) -> list[str]:
    wanted = f"drawings/{book.name}.pdf#page={place + 1}"
    found = [] if named == wanted else [f"{mark}: the schedule names {named or 'no drawing'}, not {wanted}"]
    if place >= len(book.sheets) or book.sheets[place].name != mark or book.sheets[place].texts.count(mark) < 2:
        found.append(f"{mark}: page {place + 1} of drawings/{book.name}.pdf is not its sheet")
    return found


def printed(delivery: Delivery) -> Measured:
    """Every value of a class in the schedules stands on its sheet exactly as printed there."""
    rows = [(sheet, row) for kind in KINDS for sheet, row in class_sheets(delivery, kind)]
    problems = [fault for sheet, row in rows for fault in _missing(sheet, row)]
    return faults(sum(len(row) for _, row in rows), problems)


def class_sheets(delivery: Delivery, kind: str) -> Iterator[tuple[Sheet, dict[str, str]]]:
    """Pair every sheet with what the schedule says of its class: column and text, blanks left out."""
    table = delivery.table(kind)
    columns = [name for name in table.columns if not _ELSEWHERE.fullmatch(name)]
    sheets = {sheet.name: sheet for sheet in books_of(delivery)[kind].sheets}
    for place, mark in enumerate(texts(table, "mark")):
        if mark not in sheets:
            message = f"drawings/{kind}.pdf has no sheet of {mark}"
            raise Unreadable(message)
        row = {name: texts(table, name)[place] for name in columns}
        sheet = sheets[mark]
        yield sheet, {name: _as_listed(sheet, name, text) for name, text in row.items() if text}


def _as_listed(sheet: Sheet, column: str, text: str) -> str:
    """Give a mass, an area or a volume as the sheet lists it, if that shows the number of the schedule."""
    unit = _UNITS.get(column.rpartition("_")[2], "")
    if unit not in _AMOUNTS:
        return text
    label, value = _label(column), number(text)
    behind = (after for before, after in pairwise(sheet.texts) if before == label)
    return next((found for found in behind if shows(found, value, unit)), text)


def _missing(sheet: Sheet, row: dict[str, str]) -> list[str]:
    """Name the values that a sheet does not list behind their names, or does not print as often as it should."""
    listed = set(zip(sheet.texts, sheet.texts[1:], strict=False))
    shown = Counter(word for text in sheet.texts for word in {text, *NUMBER.findall(text)})
    own = "Corner" in sheet.texts  # panels with an outline of their own show its sides
    twice = [text for name, text in row.items() if _DIMENSIONS.fullmatch(name) and not own]
    wanted = Counter(row.values()) + Counter(twice)
    absent = [name for name, text in row.items() if not (_UNLABELLED.fullmatch(name) or (_label(name), text) in listed)]
    absent += [name for name, text in row.items() if shown[text] < wanted[text] and name not in absent]
    return [f"{sheet.name}: {name} {row[name]} is not on its sheet" for name in absent]


def _label(column: str) -> str:
    """Give the name of a column as sheets print it.

    >>> _label("set_back_start_mm"), _label("handed")
    ('Set back start (mm)', 'Handed')
    """
    stem, _, unit = column.rpartition("_")
    words = (stem if unit in _UNITS else column).replace("_", " ").capitalize()
    return f"{words} ({_UNITS[unit]})" if unit in _UNITS else words


def located(delivery: Delivery) -> Measured:
    """The general arrangement names every location with its mark."""
    words = {text for sheet in books_of(delivery)[ARRANGEMENT].sheets for text in sheet.texts}
    problems, count = list[str](), 0
    for part in ("member", "panel"):
        table = delivery.table(f"{part}_instances")
        pairs = [f"{mark} {where}" for mark, where in zip(texts(table, "mark"), texts(table, "location"), strict=True)]
        problems += [f"{pair} is not in the general arrangement" for pair in pairs if pair not in words]
        count += len(pairs)
    table = delivery.table("node_instances")
    missing = [where for where in texts(table, "location") if where not in words]
    return faults(count + table.rows, [*problems, *(f"{where} is not in the general arrangement" for where in missing)])


def twins(delivery: Delivery) -> Measured:
    """PDF and DXF of a book say the same: all texts, as often."""
    problems, count = list[str](), 0
    for name, book in books_of(delivery).items():
        pdf = Counter(text for sheet in book.sheets for text in sheet.texts)
        dxf = Counter(delivery.sheet_texts[name])
        differing = sorted(((pdf - dxf) + (dxf - pdf)).keys())
        problems += [f"drawings/{name}: {text!r} is in the PDF or in the DXF only" for text in differing]
        count += pdf.total()
    return faults(count, problems)


def books_of(delivery: Delivery) -> dict[str, Book]:
    """Give the books that a delivery with drawings has."""
    if not delivery.design.raw.get("drawings", False):
        raise NotApplicable("the project asks for no drawings")
    missing = sorted({*KINDS, ARRANGEMENT} - delivery.books.keys())
    if missing:
        message = f"drawings/{missing[0]}.pdf is missing"
        raise Unreadable(message)
    return delivery.books


RULES = (
    Rule("V45", "every class has its sheet", 0, "faults", sheets_of_marks),
    Rule("V45b", "drawings print what the schedules print", 0, "faults", printed),
    Rule("V45d", "the general arrangement names every location", 0, "faults", located),
    Rule("V43f", "PDF and DXF of the drawings say the same", 0, "faults", twins),
)
