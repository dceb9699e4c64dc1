"""V43, V45: shop drawings print what the schedules print, digit by digit, in PDF and in DXF alike."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator

import numpy as np

from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, one_outline, outlines_on
from isomould.verify.read.pdf import Book, Sheet
from isomould.verify.read.tables import Table, texts
from isomould.verify.rules import Floats, Measured, NotApplicable, Rule, Unreadable, faults

KINDS = ("nodes", "members", "panels")
ARRANGEMENT = "general-arrangement"
_ELSEWHERE = re.compile(r"outline|files?|\w+_file|max_deviation_\w+")
"""Columns that sheets do not print, or not as one text."""
_DIMENSIONS = frozenset(
    """drum_diameter_mm drum_height_mm system_length_mm top_length_mm bottom_length_mm cut_length_mm set_back_start_mm
    set_back_end_mm end_angle_start_deg end_angle_end_deg side_a_mm side_b_mm side_c_mm side_d_mm height_mm""".split()  # noqa: SIM905
)
"""Columns that sheets print twice: listed, and as a dimension in a view."""
_UNLABELLED = re.compile(r"mark|(azimuth|elevation)_\d+_deg|(family|section)_\d+")
"""Columns that head the list, or stand in a table of their own."""
_UNITS = {"mm": "mm", "deg": "°", "kg": "kg", "m2": "m²", "cm3": "cm³"}
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
_DECIMALS = 3


def sheets_of_marks(delivery: Delivery) -> Measured:
    """Every class has the sheet that the schedule names, with its mark in the bookmark and on the page."""
    books, problems = _books(delivery), list[str]()
    for kind in KINDS:
        table = delivery.table(kind)
        for number, (mark, named) in enumerate(zip(texts(table, "mark"), _named(table), strict=True)):
            problems += _sheet_faults(books[kind], number, mark, named)
        problems += [f"drawings/{kind}.pdf has {len(books[kind].sheets)} pages"] * (
            len(books[kind].sheets) != table.rows
        )
    return faults(sum(delivery.table(kind).rows for kind in KINDS), problems)


def _named(table: Table) -> tuple[str, ...]:
    column = "drawing_file" if "drawing_file" in table.columns else "files"
    return tuple(cell.split(";")[-1] for cell in texts(table, column))


def _sheet_faults(book: Book, number: int, mark: str, named: str) -> list[str]:
    wanted = f"drawings/{book.name}.pdf#page={number + 1}"
    found = [] if named == wanted else [f"{mark}: the schedule names {named or 'no drawing'}, not {wanted}"]
    if number >= len(book.sheets) or book.sheets[number].name != mark or book.sheets[number].texts.count(mark) < 2:
        found.append(f"{mark}: page {number + 1} of drawings/{book.name}.pdf is not its sheet")
    return found


def printed(delivery: Delivery) -> Measured:
    """Every value of a class in the schedules stands on its sheet exactly as printed there."""
    rows = [(sheet, row) for kind in KINDS for sheet, row in _rows(delivery, kind)]
    problems = [fault for sheet, row in rows for fault in _missing(sheet, row)]
    return faults(sum(len(row) for _, row in rows), problems)


def _rows(delivery: Delivery, kind: str) -> Iterator[tuple[Sheet, dict[str, str]]]:
    """Pair every sheet with what the schedule says of its class: column and text, blanks left out."""
    table = delivery.table(kind)
    columns = [name for name in table.columns if not _ELSEWHERE.fullmatch(name)]
    sheets = {sheet.name: sheet for sheet in _books(delivery)[kind].sheets}
    for number, mark in enumerate(texts(table, "mark")):
        if mark not in sheets:
            message = f"drawings/{kind}.pdf has no sheet of {mark}"
            raise Unreadable(message)
        row = {name: texts(table, name)[number] for name in columns}
        yield sheets[mark], {name: text for name, text in row.items() if text}


def _missing(sheet: Sheet, row: dict[str, str]) -> list[str]:
    """Name the values that a sheet does not list behind their names, or does not print as often as it should."""
    listed = set(zip(sheet.texts, sheet.texts[1:], strict=False))
    shown = Counter(word for text in sheet.texts for word in {text, *_NUMBER.findall(text)})
    drawn = () if "Corner" in sheet.texts else _DIMENSIONS  # panels with an outline of their own show its sides
    wanted = Counter(row.values()) + Counter(text for name, text in row.items() if name in drawn)
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


def explained(delivery: Delivery) -> Measured:
    """Every number with decimals on a sheet is scheduled, asked for, or measured in the part's own file.

    Parts without a file of their own, such as hollow sections, which are cut from NC1, are left out.
    """
    problems, count = list[str](), 0
    for kind, drawings in (("members", delivery.members), ("panels", delivery.panels)):
        asked = _numbers([*_asked(delivery), *_on_all_sheets(delivery, kind)])
        for sheet, row in _rows(delivery, kind):
            shown = {number for number in _numbers(sheet.texts) if "." in number and sheet.name in drawings}
            known = asked | _numbers([*row.values(), _outline_text(delivery, kind, sheet.name)])
            strange = shown - known and shown - known - set(_measured(drawings[sheet.name]))
            problems += [f"{sheet.name}: {text} is in no schedule" for text in sorted(strange)]
            count += len(shown)
    return faults(count, problems)


def _numbers(found: Iterable[str]) -> set[str]:
    return {number for text in found for number in _NUMBER.findall(text)}


def _asked(delivery: Delivery) -> list[str]:
    """Print what the project asked for of its parts."""
    raw = delivery.design.raw
    values = [value for part in ("member", "panel", "node") for value in raw[part].values()]
    return [_text(value) if isinstance(value, float | int) else str(value) for value in values]


def _on_all_sheets(delivery: Delivery, kind: str) -> set[str]:
    """Give the texts of the title block and of notes: those that all sheets of a book share, if it has several."""
    books = _books(delivery)
    own = [set(sheet.texts) for sheet in books[kind].sheets]
    every = [set(sheet.texts) for name in KINDS for sheet in books[name].sheets]
    return set.intersection(*every) | (set.intersection(*own) if len(own) > 1 else set())


def _outline_text(delivery: Delivery, kind: str, mark: str) -> str:
    """Give the corners of a trimmed panel as the schedule prints them."""
    table = delivery.table(kind)
    return texts(table, "outline")[texts(table, "mark").index(mark)] if "outline" in table.columns else ""


def _measured(drawing: Drawing) -> list[str]:
    """Print what a part is measured by: coordinates, distances along both axes and between points, angles, holes."""
    outline = one_outline(drawing).points
    slots = [hole.points for hole in outlines_on(drawing, "CUT_INNER")]
    drilled = [entity for entity in drawing.entities if entity.layer == "DRILL"]
    middles = [(slot.min(axis=0) + slot.max(axis=0)) / 2 for slot in slots]
    middles += [np.array(circle.points[0][:2]) for circle in drilled]
    points = np.vstack([outline, *middles])
    between = points[:, None] - points[None]
    sizes = [size for slot in slots for size in (*np.ptp(slot, axis=0), abs(np.diff(np.ptp(slot, axis=0)))[0])]
    lengths = [points, between, np.hypot(between[..., 0], between[..., 1]), [2 * d.radius for d in drilled], sizes]
    return [_text(value) for values in (*lengths, _angles(outline)) for value in np.ravel(values)]


def _angles(points: Floats) -> Floats:
    ahead, behind = np.roll(points, -1, axis=0) - points, np.roll(points, 1, axis=0) - points
    cosine = (ahead * behind).sum(axis=1) / np.linalg.norm(ahead, axis=1) / np.linalg.norm(behind, axis=1)
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _text(value: float) -> str:
    """Print a number as the schedules do: three decimals, no trailing zeros; snapped first, as they are (E5)."""
    return f"{round(round(float(value), 6), _DECIMALS) + 0.0:.{_DECIMALS}f}".rstrip("0").rstrip(".")


def located(delivery: Delivery) -> Measured:
    """The general arrangement names every location with its mark."""
    words = {text for sheet in _books(delivery)[ARRANGEMENT].sheets for text in sheet.texts}
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
    for name, book in _books(delivery).items():
        pdf = Counter(text for sheet in book.sheets for text in sheet.texts)
        dxf = Counter(delivery.sheet_texts[name])
        differing = sorted(((pdf - dxf) + (dxf - pdf)).keys())
        problems += [f"drawings/{name}: {text!r} is in the PDF or in the DXF only" for text in differing]
        count += pdf.total()
    return faults(count, problems)


def _books(delivery: Delivery) -> dict[str, Book]:
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
    Rule("V45c", "numbers on drawings are scheduled or measured in the part files", 0, "faults", explained),
    Rule("V45d", "the general arrangement names every location", 0, "faults", located),
    Rule("V43f", "PDF and DXF of the drawings say the same", 0, "faults", twins),
)
