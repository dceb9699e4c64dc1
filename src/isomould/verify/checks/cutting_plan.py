"""V45f: the cutting plan says what schedule and layout say, and numbers parts in the order in which they fall."""

import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

from isomould.errors import OutputFault
from isomould.verify.delivery import Delivery
from isomould.verify.read.tables import half_unit, number, texts
from isomould.verify.rules import Measured, NotApplicable, Rule, faults
from isomould.verify.shown_digits import shows

_LABELS = {
    "parts": "Parts",
    "yield_percent": "Yield (%)",
    "cut_length_mm": "Cut length (mm)",
    "cuts": "Cuts",
    "offcut_width_mm": "Offcut width (mm)",
    "offcut_height_mm": "Offcut height (mm)",
}
"""What the plan prints of the schedule of sheets, in the order of its list."""

Row = Mapping[str, str | float]
"""What the plan has to say of a sheet; a column that is not there is not looked for."""


def planned(delivery: Delivery) -> Measured:
    """Every sheet is listed and has a page with its row of the schedule and its parts, numbered."""
    if not delivery.design.raw.get("drawings", False):
        raise NotApplicable("the project asks for no drawings")
    sheets = delivery.table("sheets")
    columns = {name: texts(sheets, name) for name in ("sheet", "stock", *_LABELS)}
    rows = [{name: column[k] for name, column in columns.items()} for k in range(sheets.rows)]
    return plan_faults(delivery, rows)


def plan_faults(delivery: Delivery, rows: Sequence[Row]) -> Measured:
    """Hold the plan to a row per sheet: texts letter by letter, numbers to half a unit of what is printed."""
    pages = {page.name: page.texts for page in delivery.plan.sheets}
    listed = [text for name, found in pages.items() if name not in delivery.layout.sheets for text in found]
    problems = list[str]()
    for row in rows:
        sheet = str(row["sheet"])
        own = [text for name, found in pages.items() if name.partition(" (")[0] == sheet for text in found]
        problems += _row_faults(row, own, listed)
        problems += [f"{sheet}: {' '.join(part)} is not on its page" for part in _missing_parts(delivery, sheet, own)]
    return faults(len(rows) + len(delivery.layout.placements), problems)


def _row_faults(row: Row, own: list[str], listed: list[str]) -> Iterator[str]:
    shown = dict[str, list[str]]()
    for label, text in pairwise(own):
        shown.setdefault(label, []).append(text)
    yield from (
        f"{row['sheet']}: {label} {row[name]} is not on its page"
        for name, label in _LABELS.items()
        if name in row and not any(says(text, row[name], name) for text in shown.get(label, []))
    )
    starts = [k for k, text in enumerate(listed) if text == row["sheet"]]
    if not any(_says_all(listed[k + 2 : k + 2 + len(_LABELS)], row) for k in starts):
        yield f"{row['sheet']}: not listed as scheduled"


def _says_all(found: list[str], row: Row) -> bool:
    cells = zip(_LABELS, found, strict=False)
    return len(found) == len(_LABELS) and all(says(text, row[name], name) for name, text in cells if name in row)


def says(text: str, wanted: str | float, column: str) -> bool:
    """Tell whether a text is the one that is wanted, or a number within half a unit of what its column prints.

    Percentages have the digits that people read.
    """
    if column.endswith("_percent") and wanted != "":
        return shows(text, number(wanted) if isinstance(wanted, str) else wanted, "%")
    if isinstance(wanted, str):
        return text == wanted
    try:
        return abs(number(text) - wanted) <= half_unit(column) * (1 + 1e-6)
    except OutputFault:
        return False


def _missing_parts(delivery: Delivery, sheet: str, own: list[str]) -> Iterator[tuple[str, str, str]]:
    """Give number, mark and location (where there is none, the turn) of parts that are not listed in cutting order."""
    placed = delivery.layout.placements
    tree = (delivery.layout.raw.get("cut_tree") or {}).get(sheet)
    lying = [k for k, item in enumerate(placed) if item.sheet == sheet]
    shown = dict[tuple[str, str], list[str]]()
    for number_shown, text, beside in zip(own, own[1:], own[2:], strict=False):
        shown.setdefault((number_shown, beside), []).append(text)
    for place, k in enumerate(_falling(tree) if tree else lying, start=1):
        item = placed[k]
        turn = f"{item.rotation_deg:g}{', over' if item.turned_over else ''}"
        row = (str(place), item.mark, item.location or turn)
        if not any(is_shown(item.mark, text) for text in shown.get((row[0], row[2]), [])):
            yield row


def is_shown(mark: str, text: str) -> bool:
    """Tell whether a text is a mark; what the standard font lacks may be any other characters."""
    letters = (re.escape(c) if c.encode("cp1252", "ignore") else ".+" for c in unicodedata.normalize("NFC", mark))
    return text == mark or re.fullmatch("".join(letters), text) is not None


def _falling(tree: dict[str, Any]) -> list[int]:
    """Give the placements of a cutting tree in the order in which its pieces fall."""
    if not tree.get("pieces"):
        return [tree["placement"]] if "placement" in tree else []
    return [index for piece in tree["pieces"] for index in _falling(piece)]


RULES = (Rule("V45f", "the cutting plan shows every sheet as scheduled", 0, "faults", planned),)
